"""Where penalty, KKT and backward Euler fail: over width and stiffness, stabilisation and step, step and problem."""

from functools import partial

import matplotlib.pyplot as plt
import numpy as np
from comparison.attempt import OURS, attempt, polyline_length
from comparison.problem import Problem
from comparison.problems import TABLE

from charts.maps import Row, classify, key, paint, sweep
from charts.record import Results
from charts.style import note, save

N = 51
"""Particles of the methods in space."""
M = 101
"""Particles of backward Euler."""
ALLOWED = 1e-3
"""Relative error of the length beyond which KKT's answer at rest is wrong; its chords' own error is below 1e-4."""
FLOATING = 1e-2
"""The same for the penalty force, which floats: with less than that it would hardly be right anywhere."""
CHORDS = 10.0
"""Times the error of the chords that backward Euler is allowed."""
NAMES = ("cone-1", "barrel-1.5", "sphere", "ellipsoid", "cone-6", "hyperboloid-0.9", "vase", "elbow", "barrel-4",
         "helix-5", "catenary-0.3", "stick-slip", "bottle-turn", "bottle-neck")  # fmt: skip
"""Problems over which the time step of backward Euler varies."""


def penalty(results: Results, quick: bool) -> None:
    """Penalty force over its width and stiffness, on a sphere."""
    problem = TABLE["sphere"]
    widths = np.geomspace(1e-6, 1e-1, 11).tolist()
    pushes = np.geomspace(1e-2, 1e4, 5 if quick else 13).tolist()
    size = problem.surface().size
    spring = problem.length / (N - 1)
    settings = dict(step_size=0.5, damping=0.13, steps=3000, tolerance=1e-6)

    def cell(push: float, width: float) -> Row:
        found = attempt("penalty", problem, N, settings | dict(width=width * size, push=push * spring))
        error = problem.error(found.length)
        return dict(width=width, push=push, result=classify(found, error, FLOATING), error=error,
                    steps=found.iterations)  # fmt: skip

    classes, rows = sweep(pushes, widths, cell)
    figure, axes = plt.subplots(figsize=(7.5, 5.6))
    paint(axes, widths, pushes, classes, log_x=True, log_y=True)
    need = spring / 2.0  # on radius R = 2 a particle is pressed by the tension times ds / R
    axes.axhline(need, color="k", ls="--", lw=1.4)
    note(axes, widths[0], need * 0.8, "below the dashed line the fibre sinks in", va="top")
    axes.set(
        xlabel="width epsilon_PF over the part's size",
        ylabel="force k_PF over the tension",
        title=(
            f"Penalty force (7.1) on {problem.name}, {N} particles, h = 0.5 sqrt(m/K), damping 0.13 sqrt(K m),\n3000"
            f" steps; right means at rest with an error below {FLOATING:g}"
        ),
    )
    key(axes, classes)
    save(figure, results.folder, "penalty")
    results.table("penalty", rows)


def kkt(results: Results, quick: bool) -> None:
    """KKT over its stabilisation and time step, on the surface and bridging."""
    shares = np.linspace(0.0, 1.0, 6 if quick else 11).tolist()
    steps = np.geomspace(1e-2, 1e4, 7 if quick else 13).tolist()
    figure, grid = plt.subplots(1, 2, figsize=(14, 5.6), sharey=True)
    rows = []
    settings = dict(damping=0.1, steps=800, tolerance=1e-6)
    for name, axes in zip(("sphere", "vase"), grid, strict=True):
        problem = TABLE[name]

        def cell(share: float, h: float, problem: Problem = problem) -> Row:
            found = attempt("kkt", problem, N, settings | dict(step_size=h, stabilisation=share))
            error = problem.error(found.length)
            return dict(problem=problem.name, stabilisation=share, step=h, result=classify(found, error, ALLOWED),
                        error=error, steps=found.iterations)  # fmt: skip

        classes, found = sweep(shares, steps, cell)
        rows += found
        paint(axes, steps, shares, classes, log_x=True)
        axes.set(xlabel="time step h [sqrt(m/K)]", title=f"KKT (7.2 to 7.9) on {name}: {problem.difficulty}")
        key(axes, classes)
    grid[0].set_ylabel("stabilisation: share of a gap taken back in a step")
    figure.suptitle(
        f"{N} particles, damping 0.1 sqrt(K m), 800 steps; right means at rest with an error below {ALLOWED:g}"
    )
    save(figure, results.folder, "kkt")
    results.table("kkt", rows)


def allowance(problem: Problem) -> float:
    """Error allowed: a multiple of that of the chords between the particles of the right path."""
    points = attempt(OURS, problem, M).points
    if points is None:
        raise SystemExit(f"no path for {problem.name}")
    return max(CHORDS * problem.error(polyline_length(points)), 1e-6)


def time_step(results: Results, quick: bool) -> None:
    """Backward Euler over twelve decades of time step on every kind of problem; ours, which has none, beside."""
    names = [name for name in TABLE if name in NAMES]
    allowed = {name: allowance(TABLE[name]) for name in names}
    steps = np.geomspace(1e-6, 1e6, 7 if quick else 13).tolist()
    figure, grid = plt.subplots(1, 3, figsize=(16, 6.2), sharey=True, gridspec_kw={"width_ratios": (6, 6, 1)})
    rows = []

    def cell(name: str, step: float, damping: float = 0.0, method: str = "backward-euler") -> Row:
        settings = {} if method == OURS else dict(step_size=step, damping=damping, steps=500, tolerance=1e-6)
        found = attempt(method, TABLE[name], M, settings)
        error = TABLE[name].error(found.length)
        return dict(problem=name, method=method, damping=damping, step=step, error=error, steps=found.iterations,
                    result=classify(found, error, allowed[name]))  # fmt: skip

    for axes, damping in zip(grid, (0.0, 0.1), strict=False):
        classes, found = sweep(names, steps, partial(cell, damping=damping))
        rows += found
        paint(axes, steps, list(range(len(names))), classes, log_x=True)
        axes.set(xlabel="time step h [sqrt(m/K)]", title=f"backward Euler, damping {damping:g} sqrt(K m), 500 steps")
        key(axes, classes)
    classes, found = sweep(names, [0.0], partial(cell, method=OURS))
    rows += found
    paint(grid[2], [0.0, 1.0], list(range(len(names))), [line * 2 for line in classes])
    grid[2].set(xticks=[], title="meshwind:\nno step to set")
    grid[0].set_yticks(range(len(names)), names)
    figure.suptitle(
        f"{M} particles from the problem's own start; right means at rest within {CHORDS:g} times the error of the"
        " chords"
    )
    save(figure, results.folder, "time_step")
    results.table("time_step", rows)


def draw(results: Results, quick: bool) -> None:
    """All three maps."""
    penalty(results, quick)
    kkt(results, quick)
    time_step(results, quick)
