"""How the cost of a run grows: time and peak memory of `meshwind wind` against faces, paths and particles.

    python examples/scaling.py --out out/scaling

Each run is the command itself, from the mesh file to all files and pictures, in a process of its own, on an irregular
mesh of a vase.  With more paths revolutions are fewer, so that each path crosses as many others: at constant
revolutions the number of crossings grows with the square of the number of paths.  Exponents are those of power laws
through the upper half of the points, where the constant cost matters least, and from reading to the surface through all
points, each with its standard error.  Writes scaling.csv, scaling_growth.csv and scaling.png.
"""

import argparse
import json
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from benchmarks import command
from charts.record import Results
from charts.style import BLUE, GREY, ORANGE, PURPLE, RED, log_axes, save
from comparison.parts import VASE, irregular, write_ply
from scipy.stats import linregress

FACES = (10_000, 30_000, 100_000, 300_000, 1_000_000, 2_000_000)
PATHS = (100, 300, 1_000, 3_000, 5_000)
"""Per family: twice as many in all."""
PARTICLES = (101, 201, 501, 1_001, 2_001, 5_001)
CROSSED = 50.0
"""Revolutions times paths per family where these grow; half of the number of paths that each crosses."""
TO_SURFACE = ("read", "ends", "flatten", "fit")
"""Stages from reading to the surface."""
SWEPT = {"faces": "faces of the mesh", "paths": "paths in all", "particles": "particles per path"}


def run(folder: Path, faces: int, paths: int, particles: int, revolutions: float, *options: str) -> dict[str, Any]:
    """Wind once; seconds, peak memory in bytes, and seconds of each stage."""
    mesh = folder / f"vase-{faces}.ply"
    if not mesh.exists():
        write_ply(mesh, *irregular(VASE, faces))
    out = folder / "out"
    words = [sys.executable, "-m", "meshwind", "wind", str(mesh), "--out", str(out), "--overwrite", *options,
             "--paths", str(paths), "--particles", str(particles), "--revolutions", repr(revolutions)]  # fmt: skip
    cost = command.run(words)
    report = json.loads((out / "report.json").read_text(encoding="utf-8"))
    surface = sum(report["seconds"].get(stage, 0.0) for stage in TO_SURFACE)
    return {
        "faces": report["mesh"]["faces"], "paths": 2 * paths, "particles": particles, **cost._asdict(),
        "surface_seconds": surface, "at_rest": report["paths"]["converged"], "crossings": report["crossings"]["count"],
    } | {f"{stage}_seconds": value for stage, value in report["seconds"].items()}  # fmt: skip


def sweep(folder: Path, faces: Sequence[int], paths: Sequence[int], particles: Sequence[int]) -> list[dict[str, Any]]:
    """A row per run: each of the three grows while the others stay; at last the most paths without pictures."""
    run(folder, 10_000, 2, 101, 0.5)  # compile
    jobs: list[tuple[str, tuple[Any, ...]]] = [("faces", (n, 100, 401, 0.5)) for n in faces]
    jobs += [("paths", (10_000, n, 401, min(CROSSED / n, 0.5))) for n in paths]
    jobs += [("particles", (10_000, 20, n, 0.5)) for n in particles]
    jobs += [("paths without pictures", (10_000, paths[-1], 401, min(CROSSED / paths[-1], 0.5), "--no-render"))]
    rows = []
    for swept, job in jobs:
        rows.append({"swept": swept, **run(folder, *job)})
        print(swept, *(f"{value:.4g}" for key, value in rows[-1].items() if key != "swept"), flush=True)
    return rows


class Exponent(NamedTuple):
    """Exponent of a power law, and its standard error."""

    value: float
    error: float

    def __str__(self) -> str:
        return f"{self.value:.2f} +- {self.error:.2f}"


def exponent(x: Sequence[float], y: Sequence[float], upper: bool = True) -> Exponent:
    """The power law through the points, or through the upper half of them, by least squares of the logarithms."""
    some = slice(len(x) // 2 if upper and len(x) > 3 else 0, None)
    found = linregress(np.log(x[some]), np.log(y[some]))
    return Exponent(float(found.slope), float(found.stderr))


def draw(rows: list[dict[str, Any]], folder: Path) -> dict[str, tuple[Exponent, Exponent]]:
    """Time and memory against each of the three; returns both exponents of each."""
    figure, grid = plt.subplots(2, 3, figsize=(13.5, 10))
    found = {}
    for (swept, words), (above, below) in zip(SWEPT.items(), grid.T, strict=True):
        some = [row for row in rows if row["swept"] == swept]
        x = [row[swept] for row in some]
        stages = [
            key for key in some[0] if key.endswith("_seconds") and key not in ("processor_seconds", "surface_seconds")
        ]
        largest = sorted(stages, key=lambda key: -some[-1][key])[:3]
        seconds, memory = ([row[key] for row in some] for key in ("seconds", "memory"))
        found[swept] = exponent(x, seconds), exponent(x, memory)
        above.plot(x, seconds, "o-", color=RED, label=f"whole run: exponent {found[swept][0]}")
        if swept == "faces":
            to_surface = [row["surface_seconds"] for row in some]
            label = f"reading to surface: exponent {exponent(x, to_surface, upper=False)}"
            above.plot(x, to_surface, "^-", color=PURPLE, label=label)
        for key, colour in zip(largest, (BLUE, ORANGE, GREY), strict=True):
            y = [row[key] for row in some]
            label = f"{key.removesuffix('_seconds')}: exponent {exponent(x, y)}"
            above.plot(x, y, "s--", color=colour, ms=4, lw=1, label=label)
        below.plot(x, np.array(memory) / 1e9, "o-", color=RED, label=f"peak memory: exponent {found[swept][1]}")
        log_axes(above, words, "time [s]")
        log_axes(below, words, "peak memory [GB]")
        for axes in (above, below):
            axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16))
    figure.suptitle(
        "meshwind wind, from the file to all files and pictures; exponents of the upper half of the points\n"
        f"faces: 200 paths of 401 particles; paths: 10,000 faces, {CROSSED:g} revolutions over the paths of a family; "
        "particles: 10,000 faces, 40 paths"
    )
    figure.tight_layout()
    save(figure, folder, "scaling")
    return found


def main() -> None:
    """Measure, print, draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/scaling"), help="folder for the table and the chart")
    parser.add_argument("--quick", action="store_true", help="two small runs of each")
    given = parser.parse_args()
    results = Results(given.out, "scaling", given.quick)
    few = 2 if given.quick else None
    with tempfile.TemporaryDirectory() as folder:
        rows = sweep(Path(folder), FACES[:few], PATHS[:few], PARTICLES[:few])
    results.table("scaling", rows)
    grows = [
        {"over": swept, "of": of, "power": found.value, "error": found.error}
        for swept, both in draw(rows, given.out).items()
        for of, found in zip(("time", "memory"), both, strict=True)
    ]
    some = [row for row in rows if row["swept"] == "faces"]
    for of, least in (("reading to surface", 0), ("reading to surface, from 100k on", 100_000)):
        chosen = [row for row in some if row["faces"] > 0.9 * least]
        if len(chosen) > 1:
            faces, seconds = ([row[key] for row in chosen] for key in ("faces", "surface_seconds"))
            found = exponent(faces, seconds, upper=False)
            grows.append({"over": "faces", "of": of, "power": found.value, "error": found.error})
    results.table("scaling_growth", grows)
    for row in grows:
        print(f"{row['over']}: {row['of']} grows with the power {row['power']:.2f} +- {row['error']:.2f}")
    results.finish(f"{len(rows)} runs")


if __name__ == "__main__":
    main()
