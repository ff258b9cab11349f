"""The work-precision diagrams in figures: which methods are better than ours and where, by how much, and what fails."""

from collections.abc import Sequence
from statistics import median
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from comparison.attempt import OURS
from comparison.problems import TABLE

from charts.record import Results
from charts.style import LOOKS, save
from charts.work_precision import Point, Reason, cannot, front

NOISE = 1.1
"""A time counts as shorter if it is by this factor: repeats on a shared machine agree no better."""
TIE = 1.02
"""Errors are equal to this factor: schemes on one chain of particles share its error to many digits."""
FLYING = ("hyperboloid", "elbow")
"""Problems whose fibre is in the air from end to end: there every method is exact with any number of particles."""
ERRORS = (1e-4, 1e-6, 1e-8)
"""At which times are compared."""
DARK = 0.6
"""Share of failures above which the text on a cell is white."""
SHORT = {
    Reason.NO_FRICTION: "no\nfriction",
    Reason.NO_GAIN: "no gain",
    Reason.NO_BRIDGES: "cannot\nbridge",
    Reason.SHORTEST: "shortest\nonly",
}
"""Reasons as the table of failures has them."""


def of(points: Sequence[Point], problem: str, method: str) -> list[Point]:
    """The settings of a method that converged on a problem."""
    return [p for p in points if p.problem == problem and p.method == method and p.result == "ok"]


def beaten(points: Sequence[Point], cost: str = "seconds") -> list[dict[str, Any]]:
    """Settings of ours to which another method is cheaper and at least as accurate, with the cheapest such method."""
    rows = []
    for problem in dict.fromkeys(p.problem for p in points):
        for mine in front(of(points, problem, OURS), cost):
            better = [
                p
                for p in points
                if p.problem == problem
                and p.method != OURS
                and p.result == "ok"
                and p.error <= TIE * mine.error
                and (cost == "seconds" or p.evaluations)
                and NOISE * getattr(p, cost) < getattr(mine, cost)
            ]
            if better:
                worst = min(better, key=lambda p: getattr(p, cost))
                rows.append(
                    dict(
                        problem=problem,
                        cost=cost,
                        particles=mine.size,
                        setting=mine.setting,
                        ours=getattr(mine, cost),
                        our_error=mine.error,
                        by=worst.method,
                        its_setting=worst.setting,
                        its_size=worst.size,
                        its=getattr(worst, cost),
                        its_error=worst.error,
                        factor=getattr(mine, cost) / getattr(worst, cost),
                    )
                )
    return rows


def ratios(points: Sequence[Point]) -> list[dict[str, Any]]:
    """Time of each method over ours at equal error: at each point of its front, the quickest of ours as accurate."""
    rows = []
    for problem in dict.fromkeys(p.problem for p in points):
        ours = of(points, problem, OURS)
        for method in LOOKS:
            found = []
            for p in front(of(points, problem, method), "seconds"):
                mine = [q for q in ours if q.error <= TIE * p.error]
                if mine:
                    found.append((p.error, p.seconds / min(q.seconds for q in mine)))
            if found and method != OURS:
                row: dict[str, Any] = dict(
                    problem=problem,
                    method=method,
                    settings=len(found),
                    least=min(r for _, r in found),
                    middle=median(r for _, r in found),
                    most=max(r for _, r in found),
                )
                rows.append(row | {f"at {e:g}": at_error(points, problem, method, e) for e in ERRORS})
    return rows


def summary(rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Ratios at equal error per method and error: median over the problems, the least, the largest and their number.

    Problems whose fibre is in the air from end to end are left out.
    """
    table = []
    for method in (name for name in LOOKS if name != OURS):
        for error in ERRORS:
            key = f"at {error:g}"
            found = [
                row[key]
                for row in rows
                if row["method"] == method and row[key] is not None and not row["problem"].startswith(FLYING)
            ]
            row: dict[str, Any] = dict(method=method, error=error, problems=len(found))
            table.append(row | dict(middle=median(found), least=min(found), most=max(found)) if found else row)
    return table


def scaled(points: Sequence[Point]) -> list[dict[str, Any]]:
    """Least errors of velocity scaling (4.19) on each problem with friction, by number of particles."""
    rows = []
    for problem in dict.fromkeys(p.problem for p in points if TABLE[p.problem].friction):
        mine = [p for p in points if p.problem == problem and p.method == "backward-euler" and p.result == "ok"]
        for size in sorted({p.size for p in mine}):
            best = min((p for p in mine if p.size == size), key=lambda p: p.error)
            rows.append(dict(problem=problem, particles=size, error=best.error, setting=best.setting))
    return rows


def at_error(points: Sequence[Point], problem: str, method: str, error: float) -> float | None:
    """Seconds of a method over ours, each the quickest setting with at most this error; None where one has none."""
    times = [min((p.seconds for p in of(points, problem, m) if p.error <= error), default=None) for m in (method, OURS)]
    return None if times[0] is None or times[1] is None else times[0] / times[1]


def failures(points: Sequence[Point]) -> list[dict[str, Any]]:
    """Settings tried and how they ended, by problem and method, or the reason why a method cannot solve a problem."""
    rows = []
    for problem in dict.fromkeys(p.problem for p in points):
        for method in LOOKS:
            mine = [p for p in points if p.problem == problem and p.method == method]
            why = cannot(TABLE[problem], method)
            count = {
                key: sum(p.result == key for p in mine) for key in ("ok", "wrong", "refused", "stalled", "diverged")
            }
            rows.append(dict(problem=problem, method=method, tried=len(mine), **count, cannot=why or ""))
    return rows


def draw_failures(results: Results, rows: Sequence[dict[str, Any]]) -> None:
    """A table as a picture: settings that failed, of those tried, by method and problem."""
    problems = list(dict.fromkeys(row["problem"] for row in rows))
    methods = list(LOOKS)
    share = np.full((len(methods), len(problems)), np.nan)
    figure, axes = plt.subplots(figsize=(1.0 + 0.72 * len(problems) + 3, 0.42 * len(methods) + 2.2))
    for row in rows:
        i, j = methods.index(row["method"]), problems.index(row["problem"])
        failed = row["tried"] - row["ok"]
        if row["cannot"] or not row["tried"]:
            text = SHORT.get(row["cannot"], "not\ntried")
            axes.text(j, i, text, ha="center", va="center", fontsize=5.5, color="#888888")
            continue
        share[i, j] = failed / row["tried"]
        colour = "white" if share[i, j] > DARK else "black"
        axes.text(j, i, f"{failed}/{row['tried']}", ha="center", va="center", fontsize=7, color=colour)
    axes.imshow(share, cmap="Blues", vmin=0, vmax=1.1, aspect="auto")
    axes.set_xticks(range(len(problems)), problems, rotation=45, ha="right")
    axes.set_yticks(range(len(methods)), [LOOKS[m].label for m in methods])
    axes.grid(visible=False)
    axes.set_title(
        "Settings that failed (diverged, not at rest within the step budget, or wrong by over 30 %), of those tried"
    )
    save(figure, results.folder, "failures")


CAPABILITIES = (
    # method, several turns, bridging, friction, ends, certificate
    ("meshwind", "yes", "yes", "yes, Coulomb's law", "a surface: any point", "residual and status"),
    (
        "backward-euler",
        "yes",
        "yes, with (5.2)'s weights; Algorithm 1's test chatters",
        "roughly, depends on the step (4.19)",
        "a surface: any point",
        "residual",
    ),
    ("backward-euler-reuse", "yes", "as backward Euler", "as backward Euler", "a surface: any point", "residual"),
    ("backward-euler-ruled", "yes", "as backward Euler", "not tried", "a surface: any point", "residual"),
    ("explicit-euler", "yes", "yes", "yes (4.19)", "a surface: any point", "residual"),
    ("symplectic-euler", "yes", "yes", "yes (4.19)", "a surface: any point", "residual"),
    ("rk4", "yes", "yes", "yes (4.19)", "a surface: any point", "residual"),
    ("kkt", "yes", "yes", "no", "a surface: any point", "residual"),
    ("penalty", "yes", "yes, floating by its width", "no", "a surface: any point", "residual"),
    ("flipout", "yes, by way points", "no: stays on the facets", "no", "vertices only", "none"),
    (
        "mmp-pygeodesic",
        "no: the shortest only",
        "no: stays on the facets",
        "no",
        "vertices only",
        "exact on the facets",
    ),
    (
        "mmp-libigl",
        "no: the shortest only",
        "no: stays on the facets",
        "no",
        "vertices or faces; no path",
        "exact on the facets",
    ),
    (
        "shooting-dop853",
        "yes, ill-conditioned with length",
        "no",
        "only where it is known what slips and which way",
        "a surface: any point",
        "miss of the end",
    ),
    (
        "shooting-trace",
        "yes, ill-conditioned with length",
        "no",
        "only where it is known what slips and which way",
        "a surface: any point",
        "miss of the end",
    ),
    (
        "collocation",
        "yes",
        "no",
        "only where it is known what slips and which way",
        "a surface: any point",
        "residual; not stability",
    ),
)


def capabilities() -> list[dict[str, str]]:
    """The table of what each method can do."""
    heads = ("several turns", "bridging", "friction", "ends", "certificate")
    return [dict(zip(("method", *heads), (LOOKS[m].label, *rest), strict=True)) for m, *rest in CAPABILITIES]
