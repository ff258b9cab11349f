"""How true a fit is to the part behind a decimated or a noisy mesh, and whether its stated error covers that.

    python examples/fit_truth.py

Parts of revolution as fine irregular meshes are decimated by quadric error, and as coarser ones are moved by Gaussian
noise.  Distances are rms over the part's diagonal, away from the rims; those of noisy meshes over the noise.
"""

import igl
import numpy as np
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


def print_decimated(name: str, part: Revolved) -> None:
    """Print a line for each share of the faces that is kept."""
    vertices, faces = irregular(part, FINE)
    for kept in KEPT:
        points, corners = decimated(vertices, faces, kept)
        surface, each = measure(part, points, corners)
        print(
            f"{name:12}{kept:6.2f}{len(corners):8d}  {_led(surface):14}"
            + "".join(f"{each[what] / surface.size:10.1e}" for what in ("facets", "surface", "stated"))
            + f"{100.0 * each['within']:8.1f} %",
            flush=True,
        )


def print_noisy(name: str, part: Revolved) -> None:
    """Print a line for each noise."""
    vertices, faces = irregular(part, 2 * VERTICES)
    edges = np.linalg.norm(vertices[faces] - np.roll(vertices[faces], 1, axis=1), axis=2)
    for share in NOISE:
        size = share * float(edges.mean())
        moved = vertices + size * np.random.default_rng(2).normal(size=vertices.shape)
        surface, each = measure(part, moved, faces)
        assert surface.error is not None
        print(
            f"{name:12}{share:6.2f}  {_led(surface):14}{surface.error.noise / size:10.2f}"
            + "".join(f"{each[what] / size:10.2f}" for what in ("facets", "surface", "stated"))
            + f"{100.0 * each['within']:8.1f} %",
            flush=True,
        )


def _led(surface: mw.Surface) -> str:
    assert surface.error is not None
    return surface.error.data


def main() -> None:
    """Print the tables."""
    print(
        f"{'decimated':12}{'kept':>6}{'faces':>8}  {'led by':14}{'facets':>10}{'surface':>10}{'stated':>10}  within it"
    )
    for name, part in PARTS.items():
        print_decimated(name, part)
    print(
        f"\n{'noisy':12}{'noise':>6}  {'led by':14}{'found':>10}{'facets':>10}{'surface':>10}{'stated':>10}  within it"
    )
    for name, part in PARTS.items():
        print_noisy(name, part)


if __name__ == "__main__":
    main()
