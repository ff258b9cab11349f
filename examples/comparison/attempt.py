"""Any method on any problem, with the outcome in one form: what charts, tests and golden figures compare."""

from collections.abc import Mapping
from dataclasses import astuple, dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from comparison.problem import Problem
from meshwind.core.cast import Floats
from meshwind.methods.driver import run
from meshwind.methods.motion import Ending, Method, Motion
from meshwind.path.drag import drag
from meshwind.path.length import Laid, measured
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


ENDINGS = {Ending.CONVERGED: Outcome.REST, Ending.STOPPED: Outcome.STALLED, Ending.DIVERGED: Outcome.DIVERGED}
STATUSES = {Status.CONVERGED: Outcome.REST, Status.STALLED: Outcome.STALLED}
"""Outcomes of our own solver; all other statuses are refusals."""


@dataclass(frozen=True)
class Attempt:
    """One path by one method.

    length in the surface's units, that of the polyline where the method computes no other; numbers of surface
    evaluations, foot points, linear solves and iterations (time steps); gap: the largest distance of a point from the
    surface; points (n, 3), None where the method gives a length only.
    """

    outcome: Outcome
    length: float
    evaluations: int
    feet: int = 0
    solves: int = 0
    iterations: int = 0
    gap: float = 0.0
    points: Floats | None = None


def polyline_length(points: Floats) -> float:
    """Length of a polyline (n, 3)."""
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def move(scheme: str, problem: Problem, particles: int, **settings: Any) -> Motion:
    """Run one of `Method` on the surface and between the ends of a problem, from a straight line in (u, v)."""
    return run(scheme, problem.surface(), problem.start, problem.end, particles=particles, **settings)


def attempt(method: str, problem: Problem, particles: int, settings: Mapping[str, Any] | None = None) -> Attempt:
    """Solve a problem by one of `Method` or by ours, from the problem's starting curve.

    With the setting `rule` the length of another method's chain is computed by our own rule of the fourth order instead
    of its polyline's, so that solvers can be compared apart from rules.
    """
    given = dict(settings or {})
    curve = None if problem.initial is None else problem.initial(particles)
    if method == OURS:
        return _ours(problem, particles, curve, given)
    return _theirs(Method(method), problem, particles, curve, given)


def _theirs(method: Method, problem: Problem, particles: int, curve: Floats | None, given: dict[str, Any]) -> Attempt:
    """A scheme of the literature; where the ends move, it runs until it is at rest for each position of theirs."""
    by_rule = bool(given.pop("rule", False))
    if problem.friction:
        given["friction"] = problem.friction
    if not method.in_space:
        given = {"lifting": problem.bridges, "weighted": True} | given
    surface = problem.surface()
    starts, ends = problem.motion if problem.dragged_from else ([problem.start], [problem.end])
    counts = np.zeros(4, np.int64)
    for start, end in zip(starts, ends, strict=True):
        found = run(method, surface, start, end, particles=particles, initial=curve, **given)
        curve, counts = found.uv, counts + astuple(found.counters)
        if found.status != Ending.CONVERGED:
            break
    length = found.length
    if by_rule and found.status != Ending.DIVERGED:
        gap, normals = np.abs(found.gap)[None], surface.normals(found.uv)[None]
        laid = Laid(found.points[None], found.uv[None], found.on_surface[None], gap, normals)
        length = float(measured(surface, laid).length[0])
    counters = Counters(*(int(k) for k in counts))
    return _attempt(ENDINGS[found.status], length, counters, float(np.abs(found.gap).max()), found.points)


def _ours(problem: Problem, particles: int, curve: Floats | None, given: dict[str, Any]) -> Attempt:
    """Our own solver; where the ends move, the last position counts, and the first status that is not converged."""
    given |= dict(particles=particles, friction=problem.friction)
    if problem.dragged_from:
        found = drag(problem.surface(), *problem.motion, **given)
    else:
        initial = None if curve is None else curve[None]
        found = solve(problem.surface(), [problem.start], [problem.end], initial=initial, **given)
    status = next((Status(int(each)) for each in found.status if each != Status.CONVERGED), Status.CONVERGED)
    outcome = STATUSES.get(status, Outcome.REFUSED)
    return _attempt(outcome, float(found.length[-1]), found.counters, float(found.gap[-1].max()), found.points[-1])


def _attempt(outcome: Outcome, length: float, counters: Counters, gap: float, points: Floats) -> Attempt:
    return Attempt(
        outcome,
        length,
        counters.evaluations,
        counters.feet,
        counters.solves,
        counters.iterations,
        gap,
        points,
    )
