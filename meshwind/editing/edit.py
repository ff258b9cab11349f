"""The rounds of an edit on one surface: wind, move the control points, wind again (section 6.4)."""

from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse

from meshwind.core.cast import Bools, Floats
from meshwind.core.defaults import PATHS
from meshwind.core.errors import BadInputError
from meshwind.editing.demands import press, reach
from meshwind.editing.edited_mesh import within
from meshwind.editing.freedom import free_moves, frozen_mask
from meshwind.editing.options import EditOptions
from meshwind.editing.program import ACCURACY
from meshwind.editing.result import Outcome, Round
from meshwind.editing.step import Step, energy, step
from meshwind.path import Paths, solve
from meshwind.path.lengths import tolerated
from meshwind.planning.families import families
from meshwind.surface.surface import Surface
from meshwind.workflow.clock import Progress
from meshwind.workflow.options import Options

FIRM = 0.3
"""Of a gap that counts as none: the rounds go on while one is above this, which leaves room for the refit's error."""
LEAST_GAP = 1e-6
"""Largest gap, over the part's size, that counts as none on any surface, unless a threshold is given."""
FAR_SHORT = 0.5
"""Of the largest gap: a surface that is left further below the fibre cannot reach it, and such an edit is not made."""
MAX_IDLE_ROUNDS = 2
"""Rounds in succession without a gain after which the edit stops."""
UNSOLVED = 1e3 * ACCURACY
"""KKT residual above which a round's program counts as not solved."""


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
        """Share of the paths' particles that lie off the surface by more than counts as none."""
        return float(lifted(self.paths).mean())


@dataclass(frozen=True)
class _State:
    """A surface with the paths on it."""

    surface: Surface
    paths: Paths

    @property
    def gap(self) -> float:
        """Largest gap of the paths."""
        return float(self.paths.gap.max())

    @property
    def bridged(self) -> float:
        """Share of the particles that lie off the surface by more than counts as none."""
        return float(lifted(self.paths).mean())


@dataclass(frozen=True)
class _Problem:
    """What is the same in all rounds: the surface before them, the free moves and their cost, and the limits."""

    first: Surface
    moves: sparse.csr_array
    cost: sparse.csr_array
    curvature: float
    bound: float | None
    threshold: float

    def moved(self, surface: Surface) -> Floats:
        """How far the control points of a surface have been moved (m, 3)."""
        return np.asarray((surface.control_points - self.first.control_points).reshape(-1, 3))

    def step(self, now: _State) -> Step:
        """Solve for the change of the control points that the paths demand."""
        demands = reach(now.paths), press(now.paths, self.curvature)
        return step(*demands, self.cost, self.moves, self.moved(now.surface), self.bound, self.threshold)

    def after(self, now: _State, found: Step) -> _State:
        """Change the control points, and lay the paths again from where they were."""
        # round-off may leave the bound's ball
        moves = within(self.moved(now.surface) + found.change, self.bound)
        net = self.first.control_points
        surface, uv = replace(self.first, control_points=net + moves.reshape(net.shape)), np.array(now.paths.uv)
        laid = solve(surface, uv[:, 0], uv[:, -1], family=now.paths.family, particles=uv.shape[1], initial=uv)
        return _State(surface, laid)

    def merit(self, state: _State) -> tuple[float, float]:
        """Bridged share and largest gap, in this order: less is better."""
        return state.bridged, state.gap

    def figures(self, before: _State, after: _State, found: Step) -> Round:
        """The figures of a round."""
        return Round(
            threshold=self.threshold,
            bridged_before=before.bridged,
            bridged_after=after.bridged,
            gap_before=before.gap,
            gap_after=after.gap,
            change=float(np.linalg.norm(self.moved(after.surface), axis=1).max()),
            objective=found.objective,
            shortfall=found.shortfall,
            primal=found.solution.primal,
            dual=found.solution.dual,
            rows=found.rows,
            iterations=found.solution.iterations,
        )


def edit(
    surface: Surface, winding: Options, options: EditOptions | None = None, progress: Progress | None = None
) -> Edit:
    """Move the control points as little as possible until no path of two families bridges.

    winding: numbers of paths, revolutions and particles.  Between these paths others are wound, no further apart than
    the control points, so that the result does not depend on where the first path starts.  progress: called with a
    line before each round.
    """
    options = options or EditOptions()
    if options.threshold is not None:
        surface = replace(surface, threshold=options.threshold)
    limit = threshold_of(surface)
    moves = free_moves(surface, frozen_mask(surface, options.frozen), options.symmetry)
    if moves.shape[1] == 0:
        raise BadInputError("every control point is frozen; leave some free to move")
    cost = energy(surface, options.fairness)
    problem = _Problem(surface, moves, cost, options.pressing / surface.size, options.bound, limit)
    revolutions, particles = float(winding.turns), winding.particles
    paths = winding.paths or PATHS
    per_gap = -(-surface.control_points.shape[0] // paths)
    ends = families(surface, paths * per_gap, revolutions)
    laid = solve(surface, ends.start, ends.end, family=ends.family, particles=particles)
    best, outcome, figures = _rounds(problem, _State(surface, laid), options.rounds, progress)
    own = families(surface, paths, revolutions)
    curves = np.array(best.paths.uv[np.arange(2 * paths) * per_gap])
    final = solve(best.surface, own.start, own.end, family=own.family, particles=particles, initial=curves)
    return Edit(figures, best.surface, final, outcome, limit)


def _rounds(
    problem: _Problem, now: _State, most: int, progress: Progress | None
) -> tuple[_State, Outcome, tuple[Round, ...]]:
    """Do up to so many rounds; returns the best state, the outcome, and the figures of the rounds."""
    limit, best, idle, figures = problem.threshold, now, 0, list[Round]()
    outcome = Outcome.ROUNDS_SPENT
    for number in range(most):
        if not lifted(now.paths, FIRM).any():
            break
        if progress is not None:
            progress(f"round {number + 1}: {100 * now.bridged:.2g} % bridged, gap {now.gap:.3g}")
        found = problem.step(now)
        if found.shortfall > max(limit, FAR_SHORT * now.gap):
            outcome = Outcome.OUT_OF_REACH
            figures.append(problem.figures(now, now, found))
            break
        after = problem.after(now, found)
        figures.append(problem.figures(now, after, found))
        now = after
        better = problem.merit(now) < problem.merit(best)
        best, idle = (now, 0) if better else (best, idle + 1)
        outcome = _outcome(now, found, idle)
        if outcome != Outcome.ROUNDS_SPENT and (outcome != Outcome.WINDABLE or not better):
            break
    return best, Outcome.WINDABLE if best.bridged == 0.0 else outcome, tuple(figures)


def lifted(paths: Paths, share: float = 1.0) -> Bools:
    """Mask (p, n) of the particles that lie off the surface by more than this share of what counts as none."""
    surface = paths.surface
    limit = tolerated(paths)
    if surface.threshold is None:
        limit = np.maximum(limit, LEAST_GAP * surface.size)
    return np.asarray(paths.gap > share * limit)


def threshold_of(surface: Surface) -> float:
    """A usual gap that counts as none: the threshold, or the root mean square of the surface's uncertainty."""
    if surface.threshold is not None:
        return surface.threshold
    doubt = 0.0 if surface.uncertainty is None else float(np.sqrt(np.mean(surface.uncertainty**2)))
    return max(doubt, LEAST_GAP * surface.size)


def _outcome(now: _State, found: Step, idle: int) -> Outcome:
    if now.bridged == 0.0:
        return Outcome.WINDABLE
    if max(found.solution.primal, found.solution.dual) > UNSOLVED:
        return Outcome.NOT_SOLVED
    return Outcome.NO_GAIN if idle >= MAX_IDLE_ROUNDS else Outcome.ROUNDS_SPENT
