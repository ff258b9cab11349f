"""The cost of a filament, its program and its winding again, over the solving of the same paths.

    python examples/filament_cost.py --out out/filament_cost

Each part is wound with 200 circuits of 800 particles, and with fewer of both.  "closing" is all that makes a closed
filament, the solving of its paths included: settling its revolutions, turnarounds, pattern.  "program" is the program
of a lathe of four axes with its checks, its text for LinuxCNC, and that text read back and compared.  "winding again"
is the program wound by physics.  Seconds are the shortest of some runs.  In brackets are ratios to the solving, of
seconds and of work (seconds of a core), which are to be at most 2, 20 and 60.  On closed ends paths are marched, not
solved: there the measure is to march all half-legs once, with the slips that were found, and to put all particles on
them, which solving gives on open ends as well.  Writes filament_cost.csv.
"""

import argparse
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter, process_time
from typing import Any, NamedTuple, TypeVar

import numpy as np
from charts.record import Results

import meshwind as mw
from meshwind.filament.closing import ClosedLayer, close_layer
from meshwind.filament.ends import LayerPlan
from meshwind.filament.filament import filaments_of
from meshwind.filament.polar_legs import Half
from meshwind.filament.polar_rows import Stretch, evenly
from meshwind.march.forward import marched
from meshwind.program.machine import read_machine
from meshwind.program.program import Program, program
from meshwind.program.rewinding.rewind import Ground, rewind
from meshwind.program.texts import write_texts
from meshwind.program.work import Work
from meshwind.surface.surface import Surface

DATA = Path(__file__).parents[1] / "data"
FULL = (200, 800)
"""Circuits and particles of a path for which the ratios count."""
FEWER = ((200, 200), (200, 400), (50, 800), (100, 800))
BARS = {"closing": 2.0, "program": 20.0, "winding again": 60.0}
BAND = 3.0
"""Width of the band in mm, half of which a fibre may come to lie aside."""
ENOUGH = 1.0
"""Seconds after which a thing that was measured twice is not measured once more, ..."""
RUNS = 5
"""... or runs: one alone is noisy on a shared machine."""
T = TypeVar("T")


@dataclass(frozen=True)
class Part:
    """A part: its surface, the revolutions of its paths, their friction, and what turns at both ends."""

    surface: Surface
    revolutions: float
    friction: float = 0.0
    turns: tuple[str, str] = ("auto", "auto")

    def plan(self, circuits: int, particles: int) -> LayerPlan:
        """The layer of so many circuits."""
        return LayerPlan(circuits, self.revolutions, self.friction, particles, self.turns)


def of(name: str, revolutions: float) -> Part:
    """A part of the folder data/."""
    return Part(mw.fit(mw.flatten(mw.annulus(mw.read(DATA / name)))), revolutions)


PARTS: dict[str, Callable[[], Part]] = {
    "tank": lambda: of("tank.ply", 0.55),
    "vase": lambda: of("vase.stl", 0.35),
    "bottle": lambda: of("bottle.obj", 0.55),
    "wing": lambda: of("wing.stl", 0.55),
    "ball": lambda: Part(
        mw.shapes.sphere_band(80.0, 0.35, np.pi - 0.35, spans=(96, 48)), 0.5, friction=0.2, turns=("cap", "cap")
    ),
}


class Cost(NamedTuple):
    """Seconds that a thing took, and seconds of a core that it worked: these hardly depend on what else runs."""

    seconds: float
    work: float


def timed(work: Callable[[], T]) -> tuple[Cost, T]:
    """The least cost of some runs, and what comes of them."""
    best, begin = Cost(np.inf, np.inf), perf_counter()
    for run in range(RUNS):
        start = perf_counter(), process_time()
        made = work()
        best = Cost(*np.minimum(best, np.subtract((perf_counter(), process_time()), start)).tolist())
        if run and perf_counter() - begin > ENOUGH:
            break
    return best, made


def solve_again(part: Part, layer: ClosedLayer, particles: int) -> object:
    """The paths of a layer once more, from their ends; on closed ends by marching half-legs, with particles on them."""
    uv, family = layer.paths.uv, layer.paths.family
    if "cap" not in part.turns:
        return mw.solve(part.surface, uv[:, 0], uv[:, -1], particles=particles, family=family, friction=part.friction)
    slip, half = np.nan_to_num(layer.paths.slip[:, [1, -2]]), Half(part.surface, 0.0, 1.0)
    legs = []
    for end in (0, 1):
        way = (1 - 2 * end) * family.astype(float)
        found = marched(
            part.surface, uv[:, -end], np.stack([way, 0.0 * way], axis=1), 0.5 * layer.paths.length,
            slip=slip[:, end], press="ignore",
        )  # fmt: skip
        legs.append(Stretch(found, half, bool(end)))
    return evenly(part.surface, legs, particles)


def programmed(work: Work, folder: Path) -> Program:
    """A program with its checks, its text, and that read back."""
    made = program(work, read_machine("lathe-4"))
    write_texts(folder, made, ["linuxcnc"])
    return made


def measure(name: str, part: Part, circuits: int, particles: int) -> dict[str, Any]:
    """Cost of each thing for so many circuits of so many particles, and its ratio to the solving."""
    closing, layer = timed(lambda: close_layer(part.surface, part.plan(circuits, particles)))
    solving, _ = timed(lambda: solve_again(part, layer, particles))
    points = part.surface.net.reshape(-1, 3)
    work = Work(tuple(filaments_of(layer)), part.surface, float(np.linalg.norm(np.ptp(points, axis=0))), "mm", name)
    with TemporaryDirectory() as folder:
        writing, made = timed(lambda: programmed(work, Path(folder)))
    again, found = timed(lambda: rewind(made, Ground((part.surface,), (BAND,), (part.friction,))))
    row: dict[str, Any] = {"part": name, "circuits": circuits, "particles": particles, "blocks": len(made.blocks)}
    for key, cost in zip(("solving", *BARS), (solving, closing, writing, again), strict=True):
        row |= {key: cost.seconds, f"{key} work": cost.work}
        row |= {f"{key} over solving": cost.seconds / solving.seconds, f"{key} work over": cost.work / solving.work}
    return row | {"passes": len(found.good), "lie well": int(found.good.sum())}


def told(row: dict[str, Any]) -> str:
    """A row in a line."""
    each = [f"{key} {row[key]:.2f} s ({row[f'{key} over solving']:.2f}, {row[f'{key} work over']:.2f})" for key in BARS]
    return (
        f"{row['part']:7}{row['circuits']:4} circuits of {row['particles']:4}: solving {row['solving']:.3f} s, "
        f"{', '.join(each)}; {row['blocks']} blocks, {row['lie well']} of {row['passes']} passes lie well"
    )


def growth(rows: list[dict[str, Any]], by: str, other: str) -> str:
    """With which power of a number the work of each thing grows, from the smallest to the largest."""
    some = sorted((row for row in rows if row[other] == rows[-1][other]), key=lambda row: float(row[by]))
    first, last = some[0], some[-1]
    across = np.log(last[by] / first[by])
    powers = [f"{key} {np.log(last[f'{key} work'] / first[f'{key} work']) / across:.2f}" for key in ("solving", *BARS)]
    return f"       {last[by] / first[by]:g} times the {by}: work grows with the power {', '.join(powers)}"


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/filament_cost"), help="folder for the table")
    parser.add_argument("--only", choices=tuple(PARTS), help="one part")
    parser.add_argument("--friction", type=float, default=0.0, help="coefficient of friction of parts with open ends")
    parser.add_argument("--quick", action="store_true", help="few circuits of few particles")
    given = parser.parse_args()
    results = Results(given.out, "filament_cost.py", given.quick)
    cases = ((8, 51), (4, 101), (8, 101)) if given.quick else (*FEWER, FULL)
    kept: list[dict[str, Any]] = []
    for name in PARTS if given.only is None else (given.only,):
        part = PARTS[name]()
        part = replace(part, friction=max(part.friction, given.friction))
        measure(name, part, 4, 51)  # compile
        rows = []
        for circuits, particles in cases:
            rows.append(measure(name, part, circuits, particles))
            print(told(rows[-1]), flush=True)
        for by, other in (("particles", "circuits"), ("circuits", "particles")):
            print(growth(rows, by, other), flush=True)
        kept += rows
        results.table("filament_cost", kept)
    largest = [row for row in kept if (row["circuits"], row["particles"]) == cases[-1]]
    for key, bar in BARS.items():
        ratios = [f"{row['part']} {row[f'{key} over solving']:.2f} ({row[f'{key} work over']:.2f})" for row in largest]
        print(f"{key} over solving: {', '.join(ratios)}; bar {bar:g}")
    results.finish(f"{len(kept)} cases")


if __name__ == "__main__":
    main()
