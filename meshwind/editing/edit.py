"""The rounds of the redesign on a surface: wind, move the control points, wind again (section 6.4)."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.editing.demands import press, reach
from meshwind.editing.edited_mesh import within
from meshwind.editing.freedom import Frozen, free_moves, frozen_mask
from meshwind.editing.program import ACCURACY
from meshwind.editing.result import Outcome, Round
from meshwind.editing.step import Step, energy, step
from meshwind.path import Paths, solve
from meshwind.path.lengths import lifted_share
from meshwind.planning.families import families
from meshwind.surface.surface import Surface

FAIRNESS = 0.4
"""Wave length over the part's size at which a change of the net costs as much by its bending as by its size."""
PRESSING = 0.2
"""Least normal curvature along the fibres, times the part's size: a bow of 1/40 of a chord as long as the part.

A refit of the edited mesh moves the surface by its fit error over waves of some spans; with this much the fibres of
the sample parts lift off again by less than that error.
"""
FIRM = 0.3
"""Of the threshold: the rounds go on while a gap is above this, so that what is left has room for the refit."""
LEAST_GAP = 1e-6
"""Threshold over the part's size where the surface carries no fit error."""
FAR_SHORT = 0.5
"""Of the largest gap: a surface that is left further below the fibre cannot reach it, and such an edit is not made."""
PATIENCE = 2

Tell = Callable[[str], None]


@dataclass(frozen=True)
class Edit:
    """An edited surface: the rounds' figures, the surface, the paths on it and how it ended."""

    rounds: tuple[Round, ...]
    surface: Surface
    paths: Paths
    outcome: Outcome
    threshold: float

    @property
    def bridged(self) -> float:
        """Share of the paths' particles whose gap is above the threshold."""
        return lifted_share(self.paths.gap, self.threshold)


def edit(  # noqa: PLR0913
    surface: Surface,
    *,
    revolutions: float,
    paths: int = 12,
    particles: int = 401,
    rounds: int = 10,
    frozen: Frozen = None,
    bound: float | None = None,
    symmetry: int = 1,
    fairness: float = FAIRNESS,
    pressing: float = PRESSING,
    threshold: float | None = None,
    progress: Tell | None = None,
) -> Edit:
    """Move the control points as little as possible until no path of two families bridges.

    paths, revolutions, particles: as in `families` and `solve`.  Between the paths asked for others are wound, no
    further apart than the control points, so that the part does not depend on where the first one starts.
    rounds: at most so many; frozen: mask (nu, nv) of control points that stay, or a function from their places
    (m, 3) to one (m,); bound: largest displacement in the surface's units; symmetry: the order about u that is
    kept; fairness, pressing: see FAIRNESS and PRESSING, 0 for (6.12) alone; threshold: a gap up to this is none, by
    default the largest distance of a vertex to the fitted surface.
    """
    check(rounds, bound, fairness, pressing, threshold)
    limit = threshold_of(surface, threshold)
    moves = free_moves(surface, frozen_mask(surface, frozen), symmetry)
    if moves.shape[1] == 0:
        raise BadInputError("every control point is frozen; leave some free to move")
    cost = energy(surface, fairness)
    asked = families(surface, paths, revolutions)
    between = -(-surface.control_points.shape[0] // paths)
    ends = families(surface, paths * between, revolutions)
    laid = solve(surface, ends.start, ends.end, family=ends.family, particles=particles)
    now, figures, best, idle = surface, list[Round](), (surface, laid), 0
    outcome = Outcome.WINDABLE if laid.gap.max() <= limit else Outcome.ROUNDS_SPENT
    for number in range(rounds):
        if laid.gap.max() <= FIRM * limit:
            break
        if progress is not None:
            progress(
                f"round {number + 1}: {100 * lifted_share(laid.gap, limit):.2g}% bridged, gap {laid.gap.max():.3g}"
            )
        moved = (now.control_points - surface.control_points).reshape(-1, 3)
        curvature = pressing / surface.size
        found = step(reach(laid), press(laid, curvature), cost, moves, moved, bound, limit)
        if found.shortfall > max(limit, FAR_SHORT * float(laid.gap.max())):
            outcome = Outcome.OUT_OF_REACH
            figures.append(_figures(laid, laid, found, now, surface, limit))
            break
        now = _moved(surface, moved + found.change, bound)
        after = _rewound(now, laid, particles)
        figures.append(_figures(laid, after, found, now, surface, limit))
        laid = after
        better = _worst(laid, limit) < _worst(best[1], limit)
        idle = 0 if better else idle + 1
        best = (now, laid) if better else best
        outcome = _outcome(laid, found, limit, idle)
        if outcome != Outcome.ROUNDS_SPENT and (outcome != Outcome.WINDABLE or not better):
            break
    now, laid = best
    if laid.gap.max() <= limit:
        outcome = Outcome.WINDABLE
    mine = np.arange(2 * paths) * between
    own = solve(now, asked.start, asked.end, family=asked.family, particles=particles, initial=np.array(laid.uv[mine]))
    return Edit(tuple(figures), now, own, outcome, limit)


def check(rounds: int, bound: float | None, fairness: float, pressing: float, threshold: float | None) -> None:
    """Raise BadInputError for a number that makes no sense."""
    if not isinstance(rounds, int | np.integer) or rounds < 0:
        raise BadInputError(f"rounds is {rounds}; give a whole number from 0 up")
    for name, value, least in (("bound", bound, "above 0"), ("threshold", threshold, "above 0")):
        if value is not None and not (np.isfinite(value) and value > 0):
            raise BadInputError(f"{name} is {value}; give a length {least}, or None")
    for name, value in (("fairness", fairness), ("pressing", pressing)):
        if not (np.isfinite(value) and value >= 0):
            raise BadInputError(f"{name} is {value}; give a number from 0 up")


def threshold_of(surface: Surface, given: float | None = None) -> float:
    """The largest gap that counts as none: the one given, or the largest distance of a vertex to the surface."""
    if given is not None:
        return float(given)
    error = 0.0 if surface.error is None else surface.error.to_surface_max
    return max(error, LEAST_GAP * surface.size)


def _moved(surface: Surface, moved: Floats, bound: float | None) -> Surface:
    """The surface with its control points moved by `moved` (m, 3), pulled back to the bound's ball by round-off."""
    moves = within(moved, bound).reshape(surface.control_points.shape)
    return replace(surface, control_points=surface.control_points + moves)


def _rewound(surface: Surface, laid: Paths, particles: int) -> Paths:
    """The paths laid again from where they were."""
    uv = np.array(laid.uv)
    return solve(surface, uv[:, 0], uv[:, -1], family=laid.family, particles=particles, initial=uv)


def _worst(paths: Paths, threshold: float) -> tuple[float, float]:
    return lifted_share(paths.gap, threshold), float(paths.gap.max())


def _figures(before: Paths, after: Paths, found: Step, now: Surface, first: Surface, limit: float) -> Round:
    return Round(
        threshold=limit,
        bridged_before=lifted_share(before.gap, limit),
        bridged_after=lifted_share(after.gap, limit),
        gap_before=float(before.gap.max()),
        gap_after=float(after.gap.max()),
        change=float(np.linalg.norm(now.control_points - first.control_points, axis=2).max()),
        objective=found.objective,
        shortfall=found.shortfall,
        primal=found.solution.primal,
        dual=found.solution.dual,
        rows=found.rows,
        iterations=found.solution.iterations,
    )


def _outcome(laid: Paths, found: Step, limit: float, idle: int) -> Outcome:
    if laid.gap.max() <= limit:
        return Outcome.WINDABLE
    if max(found.solution.primal, found.solution.dual) > 1e3 * ACCURACY:
        return Outcome.NOT_SOLVED
    return Outcome.NO_GAIN if idle >= PATIENCE else Outcome.ROUNDS_SPENT
