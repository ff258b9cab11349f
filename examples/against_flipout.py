"""Taut paths on a barrel's mesh against FlipOut's polyhedral geodesics: time a path and error, in one run.

    python examples/against_flipout.py --vertices 16000

Both get the same irregular mesh and the same pairs of vertices on its rims, one thread each, and are timed after a
warm-up; a time is the median of single calls.  The exact length for each pair is Clairaut's.  FlipOut's length is that
of its polyline; ours is told twice, of the polyline through the particles and of the fibre (`Paths.length`).  FlipOut
is that of potpourri3d (`pip install 'meshwind[peers]'`).
"""

import argparse
from collections.abc import Callable
from functools import partial
from time import perf_counter

import numba
import numpy as np
import potpourri3d
from fit_cost import PARTS, irregular
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.spatial import cKDTree

import meshwind as mw
from meshwind.core.cast import Floats, Ints
from meshwind.mesh import mesh_from

BARREL = PARTS["barrel"]
PARTICLES = (51, 101, 201, 401)
REPEATS = 5


def exact(twist: float) -> float:
    """Length of the barrel's geodesic that turns by `twist` from rim to rim, by Clairaut's relation."""

    def integral(c: float, f: Callable[[float, float], float]) -> float:
        def rate(z: float) -> float:
            r = 1 - 0.3 * (z - 1) ** 2
            return f(r, float(np.sqrt((1 + 0.36 * (z - 1) ** 2) / (r * r - c * c))))

        return float(quad(rate, 0, 2, epsabs=1e-13, epsrel=1e-13)[0])

    c = float(brentq(lambda c: integral(c, lambda r, q: c * q / r) - twist, 1e-3, 0.699, xtol=1e-15))
    return integral(c, lambda r, q: r * q)


def angle(points: Floats) -> Floats:
    """Polar angles (n,) of points (n, 3)."""
    return np.asarray(np.arctan2(points[:, 1], points[:, 0]))


def pairs(annulus: mw.Annulus, twist: float, count: int) -> tuple[Ints, Floats]:
    """Rim vertices (count, 2) about `twist` apart, and their true distance in angle (count,)."""
    first, second = annulus.rims
    start = first[np.linspace(0, len(first), count, endpoint=False).astype(int)]
    off = angle(annulus.vertices[second])[None] - angle(annulus.vertices[start])[:, None] - twist
    off = (off + np.pi) % (2 * np.pi) - np.pi
    near = np.abs(off).argmin(axis=1)
    return np.stack([start, second[near]], axis=1), twist + off[np.arange(count), near]


def on_rim(surface: mw.Surface, points: Floats, v: float) -> Floats:
    """Where on the surface's rim the points (n, 3) lie, (n, 2)."""
    u = np.arange(2048) / 2048
    uv = np.stack([u[cKDTree(surface.points(np.c_[u, 0 * u + v])).query(points)[1]], np.full(len(points), v)], axis=1)
    for _ in range(8):
        at = surface.frames(uv)
        uv[:, 0] += ((points - at[:, 0]) * at[:, 1]).sum(axis=1) / (at[:, 1] ** 2).sum(axis=1)
    return uv


def median(calls: list[Callable[[], object]]) -> float:
    """Median of the shortest time of each call, in milliseconds."""
    times = np.empty((REPEATS, len(calls)))
    for row in times:
        for k, call in enumerate(calls):
            begin = perf_counter()
            call()
            row[k] = perf_counter() - begin
    return float(np.median(times.min(axis=0))) * 1e3


def line(name: str, setup: float, times: tuple[float, float], found: Floats, lengths: Floats) -> str:
    """A row of the table: times of a path and of FlipOut's, and the worst error of what was found."""
    error = np.abs(found / lengths - 1)
    ratio = times[1] / times[0]
    return f"{name:34}{setup:8.2f} s{times[0]:10.3f} ms{ratio:8.1f} x{np.median(error):12.1e}{error.max():12.1e}"


def length(path: Floats) -> float:
    """Length of a polyline (n, 3)."""
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])  # type: ignore[union-attr]
    parser.add_argument("--vertices", type=int, default=16_000)
    parser.add_argument("--paths", type=int, default=24)
    parser.add_argument("--twist", type=float, default=1.5, help="radians from rim to rim, below pi")
    given = parser.parse_args()
    numba.set_num_threads(1)
    mw.fit(mw.flatten(mw.annulus(mesh_from(*irregular(BARREL, 2000)))))  # compile

    mesh = mesh_from(*irregular(BARREL, 2 * given.vertices))
    begin = perf_counter()
    annulus = mw.annulus(mesh)
    surface = mw.fit(mw.flatten(annulus))
    fitted = perf_counter() - begin
    begin = perf_counter()
    solver = potpourri3d.EdgeFlipGeodesicSolver(annulus.vertices, annulus.faces)
    prepared = perf_counter() - begin

    ends, twists = pairs(annulus, given.twist, given.paths)
    lengths = np.array([exact(twist) for twist in twists])
    start, end = (on_rim(surface, annulus.vertices[ends[:, k]], float(k)) for k in (0, 1))
    # the rims are ordered in the sense of growing u, which is that of growing angle or its opposite
    turns = twists / (2 * np.pi) * np.sign(np.diff(np.unwrap(angle(annulus.vertices[annulus.rims[0]]))).sum())
    end[:, 0] += np.round(start[:, 0] + turns - end[:, 0])

    print(f"barrel of {len(annulus.vertices)} vertices, {given.paths} paths, twist {given.twist:g} rad, one thread")
    print(f"{'':34}{'set-up':>10}{'a path':>13}{'quicker':>10}{'median err':>12}{'worst err':>12}")
    calls: list[Callable[[], object]] = [partial(solver.find_geodesic_path, int(a), int(b)) for a, b in ends]
    polyhedral = np.array([length(solver.find_geodesic_path(int(a), int(b))) for a, b in ends])
    flipping = median(calls)
    print(line("FlipOut", prepared, (flipping, flipping), polyhedral, lengths))
    for particles in PARTICLES:
        paths = mw.solve(surface, start, end, particles=particles)
        if (paths.status != mw.Status.CONVERGED).any():
            raise SystemExit("a path did not come to rest; choose a smaller twist")
        calls = [
            partial(mw.solve, surface, a[None], b[None], particles=particles) for a, b in zip(start, end, strict=True)
        ]
        found = np.array([length(path) for path in paths.points])
        times = median(calls), flipping
        print(line(f"meshwind, {particles} particles, polyline", fitted, times, found, lengths))
        print(line(f"meshwind, {particles} particles, fibre", fitted, times, paths.length, lengths))


if __name__ == "__main__":
    main()
