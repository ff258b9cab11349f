"""Any method on any problem, with the outcome in one form: what charts, tests and golden figures compare."""

from collections.abc import Mapping
from dataclasses import astuple, dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from comparison.problem import Problem
from meshwind.core.cast import Floats
from meshwind.methods.driver import run
from meshwind.methods.motion import Ending
from meshwind.path.drag import drag
from meshwind.path.length import fibre_lengths
from meshwind.path.paths import Counters, Status
from meshwind.path.solve import solve

OURS = "meshwind"
"""The name of our own solver among the methods; the others are those of `Method`."""


class Outcome(StrEnum):
    """How an attempt ended, before its answer is compared with the truth."""

    REST = "at rest"
    STALLED = "stalled"
    DIVERGED = "diverged"
    REFUSED = "refused"


@dataclass(frozen=True)
class Attempt:
    """One path by one method.

    length in the surface's units as the method tells it, of the polyline where it tells none; counts of surface
    evaluations, foot points, linear solves and iterations (time steps); points (n, 3), None where the method gives a
    length only; gap: the largest distance of a point from the surface.
    """

    outcome: Outcome
    length: float
    evaluations: int
    feet: int = 0
    solves: int = 0
    iterations: int = 0
    gap: float = 0.0
    points: Floats | None = None


ENDINGS = {Ending.CONVERGED: Outcome.REST, Ending.STOPPED: Outcome.STALLED, Ending.DIVERGED: Outcome.DIVERGED}


def polyline(points: Floats) -> float:
    """Length of a polyline (n, 3)."""
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def attempt(method: str, problem: Problem, particles: int, setting: Mapping[str, Any] | None = None) -> Attempt:
    """Solve a problem by one of `Method` or by ours, from the problem's starting curve.

    The setting `rule` tells the length of another method's chain by our own rule of the fourth order instead of its
    polyline's, so that solvers can be compared apart from rules.
    """
    given = dict(setting or {})
    by_rule = bool(given.pop("rule", False))
    curve = None if problem.initial is None else problem.initial(particles)
    if method == OURS:
        return _ours(problem, particles, curve, given)
    if problem.friction:
        given["friction"] = problem.friction
    if method not in ("penalty", "kkt"):
        given = {"lifting": problem.bridges, "weighted": True} | given
    surface = problem.surface()
    starts, ends = problem.way if problem.before else ([problem.start], [problem.end])
    counts = np.zeros(4, np.int64)
    for start, end in zip(starts, ends, strict=True):
        found = run(method, surface, start, end, particles=particles, initial=curve, **given)
        curve, counts = found.uv, counts + astuple(found.counters)
        if found.status != Ending.CONVERGED:
            break
    c, length = Counters(*(int(k) for k in counts)), found.length
    if by_rule and found.status != Ending.DIVERGED:
        length = float(fibre_lengths(surface, found.points[None], found.uv[None], found.on_surface[None])[0])
    return Attempt(
        ENDINGS[found.status],
        length,
        c.evaluations,
        c.feet,
        c.solves,
        c.iterations,
        float(np.abs(found.gap).max()),
        found.points,
    )


def _ours(problem: Problem, particles: int, curve: Floats | None, given: dict[str, Any]) -> Attempt:
    given |= dict(particles=particles, friction=problem.friction)
    if problem.before:
        found = drag(problem.surface(), *problem.way, **given)
    else:
        initial = None if curve is None else curve[None]
        found = solve(problem.surface(), [problem.start], [problem.end], initial=initial, **given)
    c = found.counters
    worst = next((status for status in found.status if status != Status.CONVERGED), Status.CONVERGED)
    outcome = {Status.CONVERGED: Outcome.REST, Status.STALLED: Outcome.STALLED}.get(Status(int(worst)), Outcome.REFUSED)
    return Attempt(
        outcome,
        float(found.length[-1]),
        c.evaluations,
        c.feet,
        c.solves,
        c.iterations,
        float(found.gap[-1].max()),
        found.points[-1],
    )
