"""Particles against error: the order of convergence of our solver on every problem."""

from collections.abc import Sequence

import matplotlib.pyplot as plt
import numpy as np
from comparison.attempt import OURS
from comparison.problem import Kind
from comparison.problems import TABLE

from charts.record import Results
from charts.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, RED, SKY, log_axes, save
from charts.work_precision import Point

CYCLE = (RED, BLUE, GREEN, ORANGE, PURPLE, SKY, BLACK, GREY)
LEAST, ACROSS = 26, 3
"""Particles at which the slopes begin, and panels side by side."""


def draw(results: Results, points: Sequence[Point]) -> None:
    """A panel per kind and a line per problem, with slopes 2 and 4 beside."""
    kinds = [kind for kind in Kind if any(p.kind == kind for p in points)]
    figure, grid = plt.subplots(
        -(-len(kinds) // ACROSS), ACROSS, figsize=(15, 5.6 * -(-len(kinds) // ACROSS)), squeeze=False
    )
    for axes in grid.flat[len(kinds) :]:
        axes.set_visible(False)
    for axes, kind in zip(grid.flat, kinds, strict=False):
        names = [name for name, problem in TABLE.items() if problem.kind == kind]
        for colour, marker, name in zip(CYCLE, "osD^vP*X", names, strict=False):
            mine = sorted(
                {
                    p.size: p
                    for p in points
                    if p.problem == name and p.method == OURS and p.result == "ok" and "default" in p.setting
                }.values(),
                key=lambda p: p.size,
            )
            if mine:
                axes.plot(
                    [p.size for p in mine], [p.error for p in mine], marker=marker, ms=4.5, color=colour, label=name
                )
        n = np.array([LEAST, 6401.0])
        axes.plot(n, 1e-2 * (n / LEAST) ** -2, "k--", lw=1, label="slope -2, a polyline's")
        axes.plot(n, 1e-4 * (n / LEAST) ** -4, "k:", lw=1, label="slope -4")
        axes.set_ylim(1e-13, 1e-1)
        log_axes(axes, "particles", "relative error of the length")
        axes.set_title(str(kind))
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncol=3)
    figure.suptitle(
        "meshwind, default settings: error against particles. Flat at the bottom: the spline's own distance from "
        "the exact shape, or exact chords."
    )
    figure.tight_layout()
    save(figure, results.folder, "particles")
