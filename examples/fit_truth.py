"""How true a fit is to the part behind a decimated or a noisy mesh, and whether its stated error covers that.

    python examples/fit_truth.py --out out/fit_truth

Parts of revolution as fine irregular meshes are decimated by quadric error, and as coarser ones are moved by Gaussian
noise.  Distances are rms over the part's diagonal, away from the rims; those of noisy meshes over the noise.  Writes
fit_truth.csv.
"""

import argparse
from pathlib import Path
from typing import Any

import numpy as np
from charts.record import Results
from comparison.parts import PARTS, Revolved, decimated, irregular
from comparison.truth import Truth, measure

FINE, KEPT = 32_000, (0.25, 0.1, 0.03)
"""Faces of the meshes that are decimated, and the shares of them that are kept."""
VERTICES, NOISE = 4000, (0.02, 0.1, 0.3)
"""Vertices of the meshes that are moved, and the standard deviation of their noise in mean edges."""
FIGURES = ("facets", "surface", "stated")
"""Distances of facets and surface from the part, and what the surface states."""


def measure_decimated(name: str, part: Revolved) -> list[dict[str, Any]]:
    """A row for each share of the faces that is kept, distances over the diagonal."""
    vertices, faces = irregular(part, FINE)
    rows = []
    for kept in KEPT:
        points, corners = decimated(vertices, faces, kept)
        found = measure(part, points, corners)
        rows.append(row("decimated", name, kept, found, found.surface.size))
        print(
            f"{name:12}{kept:6.2f}{len(corners):8d}  {rows[-1]['led by']:14}"
            + "".join(f"{rows[-1][what]:10.1e}" for what in FIGURES)
            + f"{100.0 * rows[-1]['within']:8.1f} %",
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
        rows.append(row("noisy", name, share, measure(part, moved, faces), size))
        print(
            f"{name:12}{share:6.2f}  {rows[-1]['led by']:14}{rows[-1]['noise']:10.2f}"
            + "".join(f"{rows[-1][what]:10.2f}" for what in FIGURES)
            + f"{100.0 * rows[-1]['within']:8.1f} %",
            flush=True,
        )
    return rows


def row(mesh: str, part: str, much: float, found: Truth, unit: float) -> dict[str, Any]:
    """A row of the table, in a unit of length; much: share of the faces kept, or noise in mean edges."""
    noise = {"led by": found.led_by, "noise": found.noise / unit}
    return {"mesh": mesh, "part": part, "much": much, **noise, **found.over(unit), "within": found.within}


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
