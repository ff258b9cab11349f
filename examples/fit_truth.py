"""How true a fit is to the part behind a decimated or a noisy mesh, and whether its stated error covers that.

    python examples/fit_truth.py --out out/fit_truth

Parts of revolution as fine irregular meshes are decimated by quadric error, and as coarser ones are moved by Gaussian
noise.  Distances are rms over the part's diagonal, away from the rims; those of noisy meshes over the noise.  Writes
fit_truth.csv.
"""

import argparse
from pathlib import Path
from typing import Any

import igl
import numpy as np
from charts.record import Results
from comparison.parts import PARTS, Revolved, decimated, irregular
from scipy.spatial import cKDTree

import meshwind as mw
from meshwind.core.cast import Floats, Ints
from meshwind.mesh import mesh_from

FINE, KEPT = 32_000, (0.25, 0.1, 0.03)
"""Faces of the meshes that are decimated, and the shares of them that are kept."""
VERTICES, NOISE = 4000, (0.02, 0.1, 0.3)
"""Vertices of the meshes that are moved, and the standard deviation of their noise in mean edges."""
PLACES, RIM, PROFILE = 20_000, 0.03, 20_001
"""Places where distances are taken, how far they keep from the rims, and points of a profile."""
FIGURES = ("facets", "surface", "stated")
"""Distances of facets and surface from the part, and what the surface states."""


def off(part: Revolved, points: Floats) -> Floats:
    """Distances (n,) of points from the part's profile, a fine polyline."""
    z = np.linspace(0.0, part.height, PROFILE)
    profile = np.stack([part.radius(z), z], axis=1)
    here = np.stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]], axis=1)
    near = np.clip(cKDTree(profile).query(here)[1], 1, PROFILE - 2)
    distance = np.full(len(here), np.inf)
    for first in (near - 1, near):
        a, b = profile[first], profile[first + 1]
        share = np.clip(((here - a) * (b - a)).sum(1) / ((b - a) ** 2).sum(1), 0.0, 1.0)
        distance = np.minimum(distance, np.linalg.norm(here - a - share[:, None] * (b - a), axis=1))
    return distance


def rms(values: Floats) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2)))


def measure(part: Revolved, vertices: Floats, faces: Ints) -> tuple[mw.Surface, dict[str, float]]:
    """The surface, and rms distances of facets and surface from the part, with those that the surface states."""
    chart = mw.flatten(mw.annulus(mesh_from(vertices, faces)))
    surface, rng = mw.fit(chart), np.random.default_rng(1)
    corners = chart.annulus.faces
    area = igl.doublearea(np.array(chart.annulus.vertices), np.array(corners))
    face, share = rng.choice(len(area), PLACES, p=area / area.sum()), rng.dirichlet([1.0, 1.0, 1.0], PLACES)
    uv = (chart.corner_uv[face] * share[:, :, None]).sum(axis=1)
    inner = (uv[:, 1] > RIM) & (uv[:, 1] < 1.0 - RIM)
    flat = (chart.annulus.vertices[corners[face]] * share[:, :, None]).sum(axis=1)[inner]
    true, stated = off(part, surface.points(uv[inner])), surface.uncertainty_at(uv[inner])
    figures = {"facets": rms(off(part, flat)), "surface": rms(true), "stated": rms(stated)}
    return surface, figures | {"within": float((true <= stated).mean())}


def measure_decimated(name: str, part: Revolved) -> list[dict[str, Any]]:
    """A row for each share of the faces that is kept, distances over the diagonal."""
    vertices, faces = irregular(part, FINE)
    rows = []
    for kept in KEPT:
        points, corners = decimated(vertices, faces, kept)
        surface, each = measure(part, points, corners)
        rows.append(row("decimated", name, kept, surface, each, surface.size))
        print(
            f"{name:12}{kept:6.2f}{len(corners):8d}  {rows[-1]['led by']:14}"
            + "".join(f"{rows[-1][what]:10.1e}" for what in FIGURES)
            + f"{100.0 * each['within']:8.1f} %",
            flush=True,
        )
    return rows


def measure_noisy(name: str, part: Revolved) -> list[dict[str, Any]]:
    """A row for each noise, distances over it."""
    vertices, faces = irregular(part, 2 * VERTICES)
    edges = np.linalg.norm(vertices[faces] - np.roll(vertices[faces], 1, axis=1), axis=2)
    rows = []
    for share in NOISE:
        size = share * float(edges.mean())
        moved = vertices + size * np.random.default_rng(2).normal(size=vertices.shape)
        surface, each = measure(part, moved, faces)
        rows.append(row("noisy", name, share, surface, each, size))
        print(
            f"{name:12}{share:6.2f}  {rows[-1]['led by']:14}{rows[-1]['noise']:10.2f}"
            + "".join(f"{rows[-1][what]:10.2f}" for what in FIGURES)
            + f"{100.0 * each['within']:8.1f} %",
            flush=True,
        )
    return rows


def row(
    mesh: str, part: str, much: float, surface: mw.Surface, figures: dict[str, float], unit: float
) -> dict[str, Any]:
    """A row of the table, in a unit of length; much: share of the faces kept, or noise in mean edges."""
    assert surface.error is not None
    return {
        "mesh": mesh, "part": part, "much": much, "led by": surface.error.data, "noise": surface.error.noise / unit,
        **{what: figures[what] / unit for what in FIGURES}, "within": figures["within"],
    }  # fmt: skip


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/fit_truth"), help="folder for the table")
    given = parser.parse_args()
    results = Results(given.out, "fit_truth", False)
    rows: list[dict[str, Any]] = []
    heads = "".join(f"{what:>10}" for what in FIGURES)
    print(f"{'decimated':12}{'kept':>6}{'faces':>8}  {'led by':14}{heads}  within it")
    for name, part in PARTS.items():
        rows += measure_decimated(name, part)
    print(f"\n{'noisy':12}{'noise':>6}  {'led by':14}{'found':>10}{heads}  within it")
    for name, part in PARTS.items():
        rows += measure_noisy(name, part)
    results.table("fit_truth", rows)
    results.finish(f"{len(rows)} meshes")


if __name__ == "__main__":
    main()
