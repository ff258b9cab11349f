"""Where penalty, KKT and backward Euler fail: over width and stiffness, stabilisation and step, step and problem."""

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from comparison.attempt import attempt, polyline
from comparison.problem import Problem
from comparison.problems import TABLE

from charts.maps import classify, key, paint
from charts.record import Results
from charts.style import save

N = 51
ALLOWED = 1e-3
"""Relative error of the length beyond which KKT's answer at rest is wrong; its chords' own error is below 1e-4."""
FLOATING = 1e-2
"""The same for the penalty force, which floats: with less than that it would hardly be right anywhere."""


def penalty(results: Results, quick: bool) -> None:
    """Penalty force over its width and stiffness, on a sphere."""
    problem = TABLE["sphere"]
    widths = np.geomspace(1e-6, 1e-1, 11)
    pushes = np.geomspace(1e-2, 1e4, 5 if quick else 13)
    size = problem.surface().size
    spring = problem.length / (N - 1)
    classes, rows = [], []
    for push in pushes:
        line = []
        for width in widths:
            found = attempt(
                "penalty",
                problem,
                N,
                dict(step_size=0.5, damping=0.13, steps=3000, tolerance=1e-6, width=width * size, push=push * spring),
            )
            error = problem.error(found.length)
            line.append(classify(found, error, FLOATING))
            rows.append(dict(width=width, push=push, result=line[-1], error=error, steps=found.iterations))
        classes.append(line)
    figure, axes = plt.subplots(figsize=(7.5, 5.6))
    paint(axes, list(widths), list(pushes), classes, log_x=True, log_y=True)
    need = spring / 2.0  # on radius R = 2 a particle is pressed by the tension times ds / R
    axes.axhline(need, color="k", ls="--", lw=1.4)
    axes.text(
        widths[0],
        need * 0.8,
        "below the dashed line the fibre sinks in",
        fontsize=8,
        va="top",
        bbox=dict(fc="white", ec="none", alpha=0.8),
    )
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
    shares = np.linspace(0.0, 1.0, 6 if quick else 11)
    steps = np.geomspace(1e-2, 1e4, 7 if quick else 13)
    figure, grid = plt.subplots(1, 2, figsize=(14, 5.6), sharey=True)
    rows = []
    for name, axes in zip(("sphere", "vase"), grid, strict=True):
        problem, classes = TABLE[name], []
        for share in shares:
            line = []
            for h in steps:
                found = attempt(
                    "kkt", problem, N, dict(step_size=h, damping=0.1, steps=800, tolerance=1e-6, stabilisation=share)
                )
                error = problem.error(found.length)
                line.append(classify(found, error, ALLOWED))
                rows.append(
                    dict(
                        problem=name, stabilisation=share, step=h, result=line[-1], error=error, steps=found.iterations
                    )
                )
            classes.append(line)
        paint(axes, list(steps), list(shares), classes, log_x=True)
        axes.set(xlabel="time step h [sqrt(m/K)]", title=f"KKT (7.2 to 7.9) on {name}: {problem.hard}")
        key(axes, classes)
    grid[0].set_ylabel("stabilisation: share of a gap taken back in a step")
    figure.suptitle(
        f"{N} particles, damping 0.1 sqrt(K m), 800 steps; right means at rest with an error below {ALLOWED:g}"
    )
    save(figure, results.folder, "kkt")
    results.table("kkt", rows)


def allowance(problem: Problem) -> float:
    """Ten times the error of the chords between 101 particles of the right path."""
    points = attempt("meshwind", problem, 101).points
    if points is None:
        raise SystemExit(f"no path for {problem.name}")
    return max(10.0 * problem.error(polyline(points)), 1e-6)


def time_step(results: Results, quick: bool) -> None:
    """Backward Euler over twelve decades of time step on every kind of problem; ours, which has none, beside."""
    names = [
        n
        for n, p in TABLE.items()
        if n
        in (
            "cone-1",
            "cone-6",
            "barrel-1.5",
            "barrel-4",
            "sphere",
            "ellipsoid",
            "helix-5",
            "hyperboloid-0.9",
            "vase",
            "elbow",
            "catenary-0.3",
            "stick-slip",
            "bottle-turn",
            "bottle-neck",
        )
    ]
    steps = np.geomspace(1e-6, 1e6, 7 if quick else 13)
    figure, grid = plt.subplots(1, 3, figsize=(16, 6.2), sharey=True, gridspec_kw={"width_ratios": (6, 6, 1)})
    rows = []
    for axes, damping in zip(grid, (0.0, 0.1), strict=False):
        classes = []
        for name in names:
            problem, line = TABLE[name], []
            allowed = allowance(problem)
            for h in steps:
                found = attempt(
                    "backward-euler", problem, 101, dict(step_size=h, damping=damping, steps=500, tolerance=1e-6)
                )
                error = problem.error(found.length)
                line.append(classify(found, error, allowed))
                rows.append(
                    dict(
                        problem=name,
                        method="backward-euler",
                        damping=damping,
                        step=h,
                        result=line[-1],
                        error=error,
                        steps=found.iterations,
                    )
                )
            classes.append(line)
        paint(axes, list(steps), list(range(len(names))), classes, log_x=True)
        axes.set(xlabel="time step h [sqrt(m/K)]", title=f"backward Euler, damping {damping:g} sqrt(K m), 500 steps")
        key(axes, classes)
    ours: list[list[str]] = []
    for name in names:
        problem = TABLE[name]
        found = attempt("meshwind", problem, 101)
        ours.append([classify(found, problem.error(found.length), allowance(problem))])
        rows.append(
            dict(
                problem=name,
                method="meshwind",
                damping=0.0,
                step=0.0,
                result=ours[-1][0],
                error=problem.error(found.length),
                steps=found.iterations,
            )
        )
    paint(grid[2], [0.0, 1.0], list(range(len(names))), [line * 2 for line in ours])
    grid[2].set(xticks=[], title="meshwind:\nno step to set")
    grid[0].set_yticks(range(len(names)), names)
    figure.suptitle(
        "101 particles from the problem's own start; right means at rest within 10 times the error of the chords"
    )
    save(figure, results.folder, "time_step")
    results.table("time_step", rows)


def draw(results: Results, quick: bool) -> None:
    """All three."""
    for chart in (penalty, kkt, time_step):
        _: Any = chart(results, quick)
