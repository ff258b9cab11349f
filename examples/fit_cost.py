"""The cost of fitting a surface to a mesh: time in units of one sparse factorisation of the same mesh, and memory.

    python examples/fit_cost.py --out out/fit_cost

For irregular meshes of a vase with 10k, 100k and 1M faces: reading, opening, flattening and fitting, each in units
of one SuperLU factorisation of the mesh's cotangent Laplacian, the fit's true error, and the peak memory of the
process.  Small meshes are measured several times, and the shortest time counts.  A second table has the true error
from 1k to 64k vertices where the tolerance does not limit the fit.  A third has fits that the facets lead, of
decimated meshes.  Writes fit_cost.csv, fit_order.csv and fit_facets.csv.
"""

import argparse
import resource
import subprocess
import sys
import tempfile
from pathlib import Path
from time import perf_counter
from typing import Any

import igl
import numpy as np
from charts.record import Results
from comparison.parts import PARTS, VASE, Revolved, decimated, irregular, write_ply
from scipy import sparse
from scipy.sparse.linalg import splu

import meshwind as mw
from meshwind.core.cast import Floats, Ints
from meshwind.mesh import mesh_from

SIZES = (10_000, 100_000, 1_000_000)
STAGES = ("read", "open", "flatten", "fit")
VERTICES = (1_000, 4_000, 16_000, 64_000)
"""Of the meshes for the order of convergence."""
LED_BY_FACETS = (1_000, 8_000, 60_000)
"""Faces of decimated meshes, whose facets lead the fit, and ..."""
FINER = 4
"""... how many times as many the mesh had before."""
MAX_RUNS, FACES_IN_ALL = 9, 200_000
"""Most runs of a mesh, and the faces of all its runs together: one run alone is noisy on a shared machine."""


def runs(faces: int) -> int:
    """Number of times that a mesh is measured."""
    return min(MAX_RUNS, max(1, FACES_IN_ALL // faces))


def factorisation(vertices: Floats, faces: Ints) -> float:
    """Seconds of one SuperLU factorisation of the cotangent Laplacian with one vertex fixed."""
    laplacian = sparse.csc_matrix(-igl.cotmatrix(vertices, faces))[1:, 1:]
    seconds = []
    for _ in range(runs(len(faces))):
        start = perf_counter()
        splu(laplacian)
        seconds.append(perf_counter() - start)
    return min(seconds)


def measure(path: Path, tolerance: float) -> dict[str, float]:
    """Seconds of each stage from the file to the surface, the size of the control net and the true error."""
    marks = [perf_counter()]
    mesh = mw.read(path)
    marks.append(perf_counter())
    annulus = mw.annulus(mesh)
    marks.append(perf_counter())
    chart = mw.flatten(annulus)
    marks.append(perf_counter())
    surface = mw.fit(chart, tolerance)
    marks.append(perf_counter())
    seconds: dict[str, float] = dict(zip(STAGES, np.diff(marks).tolist(), strict=True))
    net = surface.control_points
    return seconds | {"nu": net.shape[0], "nv": net.shape[1], "error": VASE.error(surface), "faces": len(mesh.faces)}


def child(path: Path, tolerance: float) -> None:
    """Measure in this process, so that its peak memory counts, after compiling on a small mesh."""
    small = path.parent / "small.ply"
    write_ply(small, *irregular(VASE, 2000))
    measure(small, tolerance)
    found = measure(path, tolerance)
    for _ in range(runs(int(found["faces"])) - 1):
        again = measure(path, tolerance)
        found |= {stage: min(found[stage], again[stage]) for stage in STAGES}
    found["memory"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024.0
    print(" ".join(f"{key}={value!r}" for key, value in found.items()))


def cost(folder: Path, faces: int, tolerance: float) -> dict[str, Any]:
    """The row of a mesh, in a process of its own."""
    vertices, corners = irregular(VASE, faces)
    path = folder / f"vase-{faces}.ply"
    write_ply(path, vertices, corners)
    lu = factorisation(vertices, corners)
    command = [sys.executable, __file__, "--measure", str(path), "--tolerance", repr(tolerance)]
    words = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()
    found = {key: float(value) for key, value in (word.split("=") for word in words)}
    total = sum(found[stage] for stage in STAGES)
    return {"asked": faces, "lu": lu, **found, "total": total, "total over lu": total / lu}


def told(row: dict[str, Any]) -> str:
    """A row in a line."""
    parts = "".join(f"{row[stage] / row['lu']:9.2f}" for stage in STAGES)
    net = f"{row['nu']:.0f}x{row['nv']:.0f}"
    return (
        f"{row['faces']:9.0f}{row['lu']:9.3f} s{parts}{row['total over lu']:9.2f}{row['total']:11.2f} s"
        f"{row['memory'] / 2**30:8.2f} GB{net:>10}{row['error']:10.1e}"
    )


def orders(name: str, part: Revolved) -> list[dict[str, Any]]:
    """True errors of fits to ever finer meshes, and the order between neighbours."""
    rows: list[dict[str, Any]] = []
    for count in VERTICES:
        vertices, faces = irregular(part, 2 * count)
        surface = mw.fit(mw.flatten(mw.annulus(mesh_from(vertices, faces))), 1e-12)
        row: dict[str, Any] = {"part": name, "asked": count, "vertices": len(vertices), "error": part.error(surface)}
        if rows:
            before = rows[-1]
            row["order"] = -2 * np.log(row["error"] / before["error"]) / np.log(len(vertices) / before["vertices"])
        rows.append(row)
    return rows


def facets(count: int) -> dict[str, Any]:
    """The row of a decimated mesh: seconds of its fit, the least of some, and what led it."""
    chart = mw.flatten(mw.annulus(mesh_from(*decimated(*irregular(VASE, FINER * count), 1.0 / FINER))))
    spent = []
    for _ in range(min(3, runs(count))):
        begin = perf_counter()
        surface = mw.fit(chart)
        spent.append(perf_counter() - begin)
    error = surface.error
    return {"asked": count, "fit": min(spent), "led by": error.data if error else "", "error": VASE.error(surface)}


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/fit_cost"), help="folder for the tables")
    parser.add_argument("--largest", type=int, default=SIZES[-1], help="most faces of a mesh")
    parser.add_argument("--tolerance", type=float, default=1e-5, help="the fit's, over the diagonal")
    parser.add_argument("--measure", type=Path, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.measure is not None:
        child(given.measure, given.tolerance)
        return
    results = Results(given.out, "fit_cost", given.largest < SIZES[-1])
    heads = "".join(f"{stage:>9}" for stage in (*STAGES, "total"))
    print(f"{'faces':>9}{'one LU':>11}{heads}  (of one LU){'memory':>11}{'net':>10}{'error':>10}")
    rows: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as folder:
        for faces in (size for size in SIZES if size <= given.largest):
            rows.append(cost(Path(folder), faces, given.tolerance))
            print(told(rows[-1]), flush=True)
    results.table("fit_cost", rows)
    print("\nrms error over the diagonal, and its order in the vertices' spacing; tolerance 1e-12")
    print(f"{'vertices':12}", "".join(f"{count:10d}      " for count in VERTICES))
    found: list[dict[str, Any]] = []
    for name, part in PARTS.items():
        found += orders(name, part)
        mine = found[-len(VERTICES) :]
        words = "".join(
            f"{row['error']:10.1e} {'({order:.1f})'.format(**row) if 'order' in row else '':5}" for row in mine
        )
        print(f"{name:12}", words, flush=True)
    results.table("fit_order", found)
    led = [facets(count) for count in LED_BY_FACETS]
    print("\nfits of decimated meshes:", ", ".join("{asked} faces {fit:.2f} s, {led by}".format(**row) for row in led))
    results.table("fit_facets", led)
    results.finish(f"{len(rows)} meshes")


if __name__ == "__main__":
    main()
