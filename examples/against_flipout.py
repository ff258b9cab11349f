"""Taut paths on a barrel's mesh against FlipOut's polyhedral geodesics: time per path and error.

    python examples/against_flipout.py --out out/against_flipout

Both get the same irregular mesh and the same pairs of vertices on its rims, one thread each, and are timed after a
warm-up; a time is the median of single calls.  The exact length for each pair is Clairaut's.  FlipOut's length is that
of its polyline; ours is given twice, for the polyline through the particles and for the fibre (`Paths.length`).
FlipOut is that of potpourri3d (`pip install 'meshwind[peers]'`).  Writes against_flipout.csv.
"""

import argparse
from collections.abc import Callable
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import Any

import numba
import numpy as np
import potpourri3d
from charts.record import Results
from comparison.attempt import polyline_length
from comparison.parts import PARTS, irregular
from comparison.problem import TURN
from comparison.problems import barrel_length
from scipy.spatial import cKDTree

import meshwind as mw
from meshwind.core.cast import Floats, Ints
from meshwind.mesh import mesh_from

BARREL = PARTS["barrel"]
PARTICLES = (51, 101, 201, 401)
REPEATS = 5
"""Of each call: the shortest counts."""


def angle(points: Floats) -> Floats:
    """Polar angles (n,) of points (n, 3)."""
    return np.asarray(np.arctan2(points[:, 1], points[:, 0]))


def pairs(annulus: mw.Annulus, twist: float, count: int) -> tuple[Ints, Floats]:
    """Rim vertices (count, 2) about `twist` apart, and their true distance in angle (count,)."""
    first, second = annulus.rims
    start = first[np.linspace(0, len(first), count, endpoint=False).astype(int)]
    off = angle(annulus.vertices[second])[None] - angle(annulus.vertices[start])[:, None] - twist
    off = (off + np.pi) % TURN - np.pi
    near = np.abs(off).argmin(axis=1)
    return np.stack([start, second[near]], axis=1), twist + off[np.arange(count), near]


def on_rim(surface: mw.Surface, points: Floats, v: float) -> Floats:
    """Parameters (n, 2) of points (n, 3) on a rim of the surface."""
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


def line(row: dict[str, Any]) -> str:
    """A row in a line."""
    name = f"{row['method']}, {row['particles']} particles, {row['length']}" if row["particles"] else row["method"]
    return (
        f"{name:34}{row['set-up']:8.2f} s{row['milliseconds']:10.3f} ms{row['quicker']:8.1f} x"
        f"{row['median error']:12.1e}{row['largest error']:12.1e}"
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/against_flipout"), help="folder for the table")
    parser.add_argument("--vertices", type=int, default=16_000)
    parser.add_argument("--paths", type=int, default=24)
    parser.add_argument("--twist", type=float, default=1.5, help="radians from rim to rim, below pi")
    given = parser.parse_args()
    numba.set_num_threads(1)
    results = Results(given.out, "against_flipout", given.vertices < 16_000)
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
    lengths = np.array([barrel_length(twist) for twist in twists])
    start, end = (on_rim(surface, annulus.vertices[ends[:, k]], float(k)) for k in (0, 1))
    # the rims are ordered in the sense of growing u, which is that of growing angle or its opposite
    turns = twists / TURN * np.sign(np.diff(np.unwrap(angle(annulus.vertices[annulus.rims[0]]))).sum())
    end[:, 0] += np.round(start[:, 0] + turns - end[:, 0])

    print(f"barrel of {len(annulus.vertices)} vertices, {given.paths} paths, twist {given.twist:g} rad, one thread")
    print(f"{'':34}{'set-up':>10}{'per path':>13}{'quicker':>10}{'median err':>12}{'worst err':>12}")
    calls: list[Callable[[], object]] = [partial(solver.find_geodesic_path, int(a), int(b)) for a, b in ends]
    polyhedral = np.array([polyline_length(solver.find_geodesic_path(int(a), int(b))) for a, b in ends])
    flipping = median(calls)
    rows: list[dict[str, Any]] = []

    def tell(method: str, particles: int, length: str, setup: float, times: float, found: Floats) -> None:
        error = np.abs(found / lengths - 1)
        rows.append({
            "method": method, "particles": particles, "length": length, "vertices": len(annulus.vertices),
            "set-up": setup, "milliseconds": times, "quicker": flipping / times,
            "median error": float(np.median(error)), "largest error": float(error.max()),
        })  # fmt: skip
        print(line(rows[-1]), flush=True)

    tell("FlipOut", 0, "polyline", prepared, flipping, polyhedral)
    for particles in PARTICLES:
        paths = mw.solve(surface, start, end, particles=particles)
        if (paths.status != mw.Status.CONVERGED).any():
            raise SystemExit("a path did not come to rest; choose a smaller twist")
        calls = [
            partial(mw.solve, surface, a[None], b[None], particles=particles) for a, b in zip(start, end, strict=True)
        ]
        found = np.array([polyline_length(path) for path in paths.points])
        spent = median(calls)
        tell("meshwind", particles, "polyline", fitted, spent, found)
        tell("meshwind", particles, "fibre", fitted, spent, np.asarray(paths.length))
    results.table("against_flipout", rows)
    results.finish(f"{given.paths} paths")


if __name__ == "__main__":
    main()
