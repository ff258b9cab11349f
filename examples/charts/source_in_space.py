"""Figure 7.6 (a, b) of the source redone: length over wall-clock time and over simulated time, method by method."""

from dataclasses import dataclass, field
from functools import partial
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from comparison.attempt import OURS, attempt, move
from comparison.problems import TABLE
from matplotlib.axes import Axes

from charts.record import Results
from charts.style import GREEN, LOOKS, ORANGE, PURPLE, save
from charts.timing import least
from meshwind.methods import Motion

PROBLEM = TABLE["bottle-neck"]
PARTICLES = 201
STEP, DAMPING, STEPS = 3.0, 0.1, 1000
"""One step size for all methods, as in the source."""
WIDTHS = (1e-2, 1e-3, 1e-4)
"""Of the penalty force, over the part's size."""
SETTLED = 1e-6
"""Relative difference from the last length up to which a length has settled."""
MARKS = 7
"""Numbers of steps at which seconds are measured: the cost of a step depends on which particles touch."""


@dataclass(frozen=True)
class Line:
    """A method in the figure: its name, scheme, colour, line style and parameters."""

    name: str
    scheme: str
    colour: str
    style: str
    parameters: dict[str, Any] = field(default_factory=dict)

    def run(self, steps: int, history: bool = False) -> Motion:
        """Run it for a number of steps."""
        return move(self.scheme, PROBLEM, PARTICLES, steps=steps, step_size=STEP, damping=DAMPING, history=history,
                    tolerance=0.0, **self.parameters)  # fmt: skip

    def draw(self, wall: Axes, simulated: Axes) -> dict[str, Any]:
        """Run it once with its history, and several times without for the seconds; the row of the table."""
        found = self.run(STEPS, history=True)
        if found.history is None:
            raise SystemExit("the run kept no history")
        taken = max(found.counters.iterations, 1)
        marks = np.unique(np.r_[1, np.geomspace(4, taken, MARKS).astype(int)])
        measured = [least(partial(self.run, int(steps))) for steps in marks]
        seconds = np.interp(np.arange(1, taken + 1), marks, measured)
        off = np.maximum(np.abs(found.history.length[1 : taken + 1] / PROBLEM.length - 1), 1e-12)
        wall.plot(1e3 * seconds, off, self.style, color=self.colour, label=self.name)
        simulated.plot(STEP * np.arange(1, taken + 1), off, self.style, color=self.colour)
        unsettled = np.flatnonzero(np.abs(found.history.length / found.length - 1) >= SETTLED)
        return dict(
            method=self.name,
            steps=taken,
            status=found.status.name,
            seconds=float(seconds[-1]),
            error=float(off[-1]),
            steps_until_settled=int(unsettled[-1] + 1) if len(unsettled) else 0,
            evaluations=found.counters.evaluations,
            length=found.length,
        )


def lines() -> list[Line]:
    """All methods but ours."""
    size = PROBLEM.surface().size
    be, reused, kkt = (LOOKS[name].colour for name in ("backward-euler", "backward-euler-reuse", "kkt"))
    return [
        Line("backward Euler (the source's own method)", "backward-euler", be, "-", dict(weighted=True)),
        Line("the same, matrix reused 5 steps", "backward-euler", reused, "--", dict(weighted=True, reuse=5)),
        Line("KKT method", "kkt", kkt, "-"),
        *(
            Line(f"penalty force, width {width:g} of the size", "penalty", colour, ":", dict(width=width * size))
            for width, colour in zip(WIDTHS, (ORANGE, PURPLE, GREEN), strict=True)
        ),
    ]


def measure(results: Results) -> list[dict[str, Any]]:
    """Measure all methods and ours, and draw both panels."""
    figure, (wall, simulated) = plt.subplots(1, 2, figsize=(13, 5.2), sharey=True)
    rows = [line.draw(wall, simulated) for line in lines()]
    ours = attempt(OURS, PROBLEM, PARTICLES)
    spent = least(lambda: attempt(OURS, PROBLEM, PARTICLES))
    look, error = LOOKS[OURS], PROBLEM.error(ours.length)
    wall.plot([1e3 * spent], [error], "o", ms=9, color=look.colour, label=look.label)
    simulated.axhline(error, color=look.colour, lw=1)
    rows.append(
        dict(
            method=OURS,
            steps=ours.iterations,
            status=str(ours.outcome),
            seconds=spent,
            error=error,
            steps_until_settled=ours.iterations,
            evaluations=ours.evaluations,
            length=ours.length,
        )
    )
    wall.set(
        xscale="log",
        yscale="log",
        xlabel="wall-clock time [ms], one thread",
        ylabel="relative error of the length",
        title="as the source's 7.6 (a)",
    )
    simulated.set(xscale="log", xlabel="simulated time [sqrt(m/K)]", title="as the source's 7.6 (b)")
    figure.suptitle(
        f"{PROBLEM.name}, {PROBLEM.difficulty}: {PARTICLES} particles, length {PROBLEM.length:.9g}; every scheme with"
        f" h = {STEP:g} sqrt(m/K), damping {DAMPING:g} sqrt(K m), {STEPS} steps"
    )
    figure.tight_layout(rect=(0, 0.1, 1, 1))
    figure.legend(*wall.get_legend_handles_labels(), loc="lower center", ncol=4)
    save(figure, results.folder, "source_7_6")
    results.table("source_7_6", rows)
    return rows
