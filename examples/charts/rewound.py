"""Programs wound again by physics: a mandrel that is off against the exact shift, and the parts of data/."""

from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt
import numpy as np
from comparison.attempt import OURS
from matplotlib.axes import Axes

import meshwind as mw
from charts.maps import Row, key, paint, sweep
from charts.record import Results
from charts.style import save
from meshwind.core.errors import BadInputError
from meshwind.filament.closing import close_layer
from meshwind.filament.course import Kind
from meshwind.filament.ends import LayerPlan
from meshwind.filament.filament import filaments_of
from meshwind.program.faults import LIES, SPAN
from meshwind.program.machine import read_machine
from meshwind.program.program import Program, program
from meshwind.program.rewinding.rewind import Ground, rewind
from meshwind.program.targets import write_program
from meshwind.program.work import Work
from meshwind.surface import shapes

RADIUS, LENGTH, BAND = 50.0, 400.0, 4.0
"""Of the tube and of the band on it, in mm."""
CIRCUITS, PARTICLES = 4, 401
TURNS = (0.2, 0.4, 0.6, 0.8, 1.2, 1.6)
"""Revolutions of its passes."""
OFF = (0.0, 0.1, 0.5, 1.0, 2.0, 2.5, 4.0)
"""Degrees that the mandrel is off."""
SHARE, CORNERS = 0.02, 3e-4
"""What a shift may be off its exact value, relative, and over the diagonal, as the eye cuts corners between blocks."""
MACHINE = "lathe-4"
DATA = Path(__file__).parents[2] / "data"
PARTS = {"tank.ply": 0.45, "vase.stl": 0.35, "bottle.obj": 0.55, "wing.stl": 0.55, "cast.ply": 0.5, "elbow.obj": 0.5}
"""Parts of data/, and the revolutions of their passes."""
FRICTION = (0.0, 0.2)
WOUND = dict(paths=8, continuous=True, band_width=8.0, units="mm", render=False)


@cache
def tube(turns: float) -> Program:
    """The program of a tube."""
    surface = shapes.cylinder(RADIUS, LENGTH)
    layer = close_layer(surface, LayerPlan(CIRCUITS, turns, 0.2, PARTICLES, ("collar", "collar")))
    diagonal = float(np.linalg.norm([LENGTH, 2 * RADIUS, 2 * RADIUS]))
    return program(Work(tuple(filaments_of(layer)), surface, diagonal, "mm"), read_machine(MACHINE))


def shifted(off: float, turns: float) -> Row:
    """A row of a tube whose mandrel is off all the time: the fibre closes on the eye's shift as a curve of pursuit.

    It is the farthest from its plan, which ends at the rim, where it crosses that.
    """
    made = tube(turns)
    blocks = made.blocks
    aside = replace(made, blocks=replace(blocks, mandrel=blocks.mandrel + off))
    found = rewind(aside, Ground((shapes.cylinder(RADIUS, LENGTH),), (BAND,), (1.0,)))
    one = (blocks.passed == 0) & (blocks.kind == Kind.LAID)
    span, laid = float(np.median(blocks.free_length[one])), float(np.ptp(blocks.arc_length[one]))
    exact = RADIUS * np.radians(off) * (1.0 - np.exp(-laid / span))
    shift, slack = float(found.distance.max()), SHARE * exact + CORNERS * made.work.diagonal
    lies_well, half = bool(found.good.all()), 0.5 * BAND
    told = exact > half - slack if not lies_well else exact < half + slack
    right = abs(shift - exact) <= slack and told
    result = "ok" if right else "wrong"
    return dict(method=OURS, turns=turns, off=off, result=result, shift=shift, exact=exact, lies_well=int(lies_well))


def part(friction: float, name: str) -> Row:
    """A row of a part: how many passes lie well when wound again, and of the others how many have a clear span."""
    row: Row = dict(method=OURS, part=name, friction=friction)
    with TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        try:
            mw.wind(DATA / name, out=out, revolutions=PARTS[name], friction=friction, **WOUND)  # type: ignore[arg-type]
            written = write_program(out, MACHINE)
        except BadInputError as refusal:
            return row | dict(result="refused", why=str(refusal))
    made, again = written.program, written.figures["rewound"]
    blocks = made.blocks
    passes = {kind: {(int(blocks.layer[each.index]), int(blocks.circuit[each.index]), int(blocks.passed[each.index]))
                     for each in made.faults if each.kind == kind} for kind in (SPAN, LIES)}  # fmt: skip
    distance = again["distance"]["max"] if again["distance"] else np.nan
    return row | dict(
        result="ok" if again["good"] == again["passes"] else "refused", passes=again["passes"], good=again["good"],
        span_meets_part=len(passes[SPAN]), astray_with_clear_span=len(passes[LIES] - passes[SPAN]),
        distance=distance / made.work.diagonal, slip=again["slip"], why="",
    )  # fmt: skip


def draw(results: Results, quick: bool) -> None:
    """Both maps."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(15, 5.2))
    turns, off = (TURNS[1::2], OFF[::2]) if quick else (TURNS, OFF)
    classes, rows = sweep(off, turns, shifted)
    words = [f"{row['shift']:.2g} of {row['exact']:.2g}" for row in rows]
    _map(left, classes, words, ([f"{each:g}" for each in turns], [f"{each:g}" for each in off]))
    left.set(
        xlabel="revolutions of a pass",
        ylabel="degrees that the mandrel is off",
        title=f"a tube of radius {RADIUS:g}, length {LENGTH:g}; right: the shift in mm that is found is the"
        f"\nexact one to {SHARE:.0%}, and passes lie well only where it is below {BAND / 2:g} mm",
    )
    results.table("rewound_tube", rows)
    parts = list(PARTS)[:2] if quick else list(PARTS)
    classes, rows = sweep(FRICTION, parts, part)
    words = [f"{row['good']} of {row['passes']}\n{row['distance']:.0e}" if "good" in row else "" for row in rows]
    _map(right, classes, words, (parts, [f"{each:g}" for each in FRICTION]))
    right.set(
        ylabel="friction",
        title="the parts of data/; right: all passes lie within half a band of where they were planned\n(numbers:"
        " passes that do; the farthest of these, over the diagonal)",
    )
    figure.suptitle(f"meshwind's programs for {MACHINE}, wound again by physics from their blocks alone")
    figure.tight_layout()
    save(figure, results.folder, "rewound")
    results.table("rewound_parts", rows)


def _map(axes: Axes, classes: list[list[str]], words: list[str], ticks: tuple[list[str], list[str]]) -> None:
    x, y = ([float(k) for k in range(len(each))] for each in ticks)
    paint(axes, x, y, classes)
    for k, text in enumerate(words):
        axes.text(x[k % len(x)], y[k // len(x)] - 0.25, text, ha="center", va="center", fontsize=7)
    axes.set_xticks(x, ticks[0])
    axes.set_yticks(y, ticks[1])
    key(axes, classes)
