"""The rounds of an edit on one surface: wind, move the control points, wind again (section 6.4)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse

from meshwind.core.cast import Bools, Floats
from meshwind.core.errors import BadInputError
from meshwind.core.progress import Progress
from meshwind.editing.demands import press, reach, together
from meshwind.editing.edited_mesh import within
from meshwind.editing.freedom import free_moves, frozen_mask
from meshwind.editing.left import Held, Left, bridges_left
from meshwind.editing.merit import ALIKE, SAME, is_better
from meshwind.editing.options import EditOptions
from meshwind.editing.program import ACCURACY
from meshwind.editing.result import Outcome, Round
from meshwind.editing.shape_rows import FINE, Kept, nothing, one_way, same_volume, volume_gain
from meshwind.editing.stencil import pitches
from meshwind.editing.step import Demanded, Limits, Step, energy, step
from meshwind.editing.symmetry import net_group, planes
from meshwind.editing.trust import FAILED, Trust
from meshwind.editing.windings import Course, marked_share
from meshwind.path import Paths
from meshwind.path.lengths import tolerated
from meshwind.surface.surface import Surface
from meshwind.workflow.options import Options

LEAST_GAP = 1e-6
"""Largest gap, over the part's size, that counts as none on any surface, unless a threshold is given."""
LAST = 0.12
"""Of the largest gap before all rounds: below it a round that does not gain much is followed by ones that take nothing
back, which would lift other fibres again."""
FINISH = 1.5
"""Factor of the pressing in those rounds, which leaves room for the refit's error."""
QUICK = 0.1
"""Of the largest gap before a round: what a round leaves that gains much."""
RIM = 4.0
"""Factor of the pressing within a span of a rim, where a fit knows one side only and its curvature is less certain.

The refit of the edited sample cast lifted fibres along its rims, and nowhere else; with 4, at 0.5 revolutions, none.
"""
SHARES = (1.0, 0.5, 0.25, 0.1)
"""Of a change that leaves fibres out of reach: those that are tried in turn until the largest gap is lower."""
LEAST_PART = 0.5
"""Of the largest gap left: what the paths that are asked for may always have."""
MAX_IDLE_ROUNDS = 2
"""Rounds in succession without a gain after which the edit stops."""
UNSOLVED = 1e3 * ACCURACY
"""KKT residual above which a round's program counts as not solved."""


@dataclass(frozen=True)
class Edit:
    """An edited surface: the rounds' figures, the surface, each winding's paths on it, how it ended, what is left."""

    rounds: tuple[Round, ...]
    surface: Surface
    wound: tuple[Paths, ...]
    outcome: Outcome
    threshold: float
    left: tuple[Left, ...] = ()
    at_most: float = 0.0

    @property
    def paths(self) -> Paths:
        """The paths of the first winding."""
        return self.wound[0]

    @property
    def bridged(self) -> float:
        """Share of all particles that lie off the surface by more than counts as none, and than may stay."""
        return marked_share([lifted(paths, self.at_most) for paths in self.wound])


@dataclass(frozen=True)
class _State:
    """A surface with the paths of each winding on it."""

    surface: Surface
    wound: tuple[Paths, ...]
    at_most: float

    @property
    def gap(self) -> float:
        """Largest gap of the paths."""
        return max(float(paths.gap.max()) for paths in self.wound)

    @property
    def bridged(self) -> float:
        """Share of the particles that lie off the surface by more than counts as none."""
        return marked_share([lifted(paths, self.at_most) for paths in self.wound])

    def worst(self, parts: Sequence[Floats]) -> float:
        """Largest gap beyond what may stay, each over the part (p,) that its path may have."""
        gaps = [paths.gap.max(axis=1) - self.at_most for paths in self.wound]
        return max(float((gap / part).max(initial=0.0)) for gap, part in zip(gaps, parts, strict=True))


@dataclass(frozen=True)
class _Problem:
    """What is the same in all rounds: first surface and largest gap, windings, free moves and cost, limits.

    parts: of the largest gap left, what the paths (p,) of each winding may have.
    """

    first: Surface
    courses: tuple[Course, ...]
    moves: sparse.csr_array
    cost: sparse.csr_array
    options: EditOptions
    threshold: float
    gap: float
    parts: tuple[Floats, ...]

    @property
    def curvature(self) -> float:
        """Least normal curvature along the fibres."""
        return self.options.pressing / self.first.size

    @property
    def rim(self) -> float:
        """Factor of the pressing at the rims: a refit changes the more, the more was changed."""
        return 1.0 + (RIM - 1.0) * min(1.0, self.gap / self.pitch)

    @property
    def pitch(self) -> float:
        """Length of a span."""
        return max(pitches(self.first))

    def kept(self, surface: Surface, moved: Floats) -> Kept:
        """What every change keeps, on a surface whose control points have moved so far (m, 3)."""
        options, rows = self.options, nothing(self.first)
        if options.only_outward or options.only_inward:
            rows = rows.and_(one_way(self.first, moved, options.only_inward))
        return rows.and_(same_volume(self.first, surface)) if options.keep_volume else rows

    def holds(self, state: _State) -> bool:
        """Whether what is kept to first order only is kept indeed."""
        return not self.options.keep_volume or abs(volume_gain(self.first, state.surface)) <= FINE

    @property
    def bounds(self) -> Floats:
        """Largest displacement of each control point (m,)."""
        return _bounds(self.first, self.options)

    def stalls(self, gap: float, before: float) -> bool:
        """Whether the largest gap, after a round from `before`, is small but no longer falls fast."""
        return QUICK * before < gap <= LAST * self.gap

    def moved(self, surface: Surface) -> Floats:
        """How far the control points of a surface have been moved (m, 3)."""
        return np.asarray((surface.control_points - self.first.control_points).reshape(-1, 3))

    def step(self, now: _State, total: bool, short: bool, near: float) -> Step:
        """Solve for the change of the control points that the paths demand; arguments as in `step` and `Limits`."""
        moved, curvature = self.moved(now.surface), self.curvature * (1.0 if total else FINISH)
        at_most = self.options.at_most
        limits = Limits(self.moves, moved, self.bounds, self.kept(now.surface, moved), near)
        demands = (
            together([reach(*each) for each in zip(now.wound, [at_most] * len(now.wound), self.parts, strict=True)]),
            together([press(paths, curvature, at_most, self.rim) for paths in now.wound]),
        )
        early = total and now.gap > max(LAST * self.gap, self.pitch)
        return step(Demanded(*demands, self.cost, limits, self.threshold, total), short, early)

    def after(self, now: _State, found: Step) -> tuple[_State, float]:
        """Change the control points, and lay the paths again from where they were; also the share that was changed.

        Where a fibre stays out of reach the paths may leave what the program knows of them.  Then only a share of the
        change is made, if less lowers the largest gap, and none where that does not help.
        """
        if found.least == 0.0:
            return self.changed(now, found.change), 1.0
        for share in SHARES:
            after = self.changed(now, share * found.change)
            if self.gains(after, now, now.worst(self.parts), True):
                return after, share
        return now, share

    def trust(self, trust: Trust, now: _State, after: _State, found: Step, share: float) -> Trust:
        """How far the next round may go, when a share of a change was made."""
        change = float(np.linalg.norm(found.change, axis=1).max())
        return trust.after(change, share, (now.worst(self.parts), found.shortfall, after.worst(self.parts)))

    def gains(self, now: _State, best: _State, lowest: float, short: bool) -> bool:
        """Whether a state is better than the best so far and its gap; short: where not all can be met."""
        gap, same = (now.worst(self.parts), ALIKE) if short else (now.gap, SAME)
        return is_better((now.bridged, gap), (best.bridged, lowest), same)

    def changed(self, now: _State, change: Floats) -> _State:
        """A state with its control points changed (m, 3)."""
        # round-off may leave the bound's ball
        moves = within(self.moved(now.surface) + change, None if self.options.bound is None else self.bounds)
        net = self.first.control_points
        surface = replace(self.first, control_points=net + moves.reshape(net.shape))
        laid = [each.again(surface, paths) for each, paths in zip(self.courses, now.wound, strict=True)]
        return _State(surface, tuple(laid), self.options.at_most)

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
    surface: Surface,
    winding: Options | Sequence[Course],
    options: EditOptions | None = None,
    progress: Progress | None = None,
    frozen: Mapping[str, Bools] | None = None,
    middle: Floats | None = None,
) -> Edit:
    """Move the control points as little as possible until no path of any winding bridges.

    winding: numbers of paths, revolutions and particles, or several windings.  Between these paths others are wound, no
    further apart than the control points, so that the result does not depend on where the first path starts.
    progress: called with a line before each round.  frozen: masks (nu, nv) of what is frozen, by names, for what is
    said of bridges left.  middle (3,): of the part, for mirror planes through it.
    """
    options = options or EditOptions()
    if options.threshold is not None:
        surface = replace(surface, threshold=options.threshold)
    limit = threshold_of(surface)
    mask, still = frozen_mask(surface, options.frozen), _bounds(surface, options) == 0.0
    names = _named(mask, frozen) | ({"a bound of 0": still} if still.any() else {})
    mask = mask | still.reshape(mask.shape)
    moves = free_moves(surface, mask, net_group(surface, options.symmetry, planes(options.mirror), middle))
    if moves.shape[1] == 0:
        raise BadInputError("every control point is frozen; leave some free to move")
    cost = energy(surface, options.fairness)
    courses = (Course.of(winding),) if isinstance(winding, Options) else tuple(winding)
    now = _State(surface, tuple(each.dense(surface) for each in courses), options.at_most)
    problem = _Problem(surface, courses, moves, cost, options, limit, now.gap, _parts(courses, now.wound))
    best, outcome, figures = _rounds(problem, now, options.rounds, progress)
    final = tuple(each.own(best.surface, paths) for each, paths in zip(courses, best.wound, strict=True))
    held = Held(problem.moved(best.surface), np.where(still, np.inf, problem.bounds), names)
    left = bridges_left(final, [lifted(paths, options.at_most) for paths in final], held)
    return Edit(figures, best.surface, final, outcome, limit, left, options.at_most)


def _bounds(surface: Surface, options: EditOptions) -> Floats:
    """Largest displacement of each control point (m,), infinite without one."""
    return np.broadcast_to(np.inf if options.bound is None else options.bound, surface.control_points.size // 3)


def _parts(courses: Sequence[Course], wound: Sequence[Paths]) -> tuple[Floats, ...]:
    """Of the largest gap left, what each path (p,) of each winding may have: 1 for those between the ones asked for.

    Others that bridge more lie between these; when their gaps fall at the cost of the ones asked for, the latter would
    grow.  So all fall by the same share.
    """
    asked = [each.asked(len(paths)) for each, paths in zip(courses, wound, strict=True)]
    most = max(float(paths.gap.max()) for paths in wound)
    mine = max(float(paths.gap[which].max()) for which, paths in zip(asked, wound, strict=True))
    part = max(mine / most, LEAST_PART) if most > 0.0 else 1.0
    return tuple(np.where(which, part, 1.0) for which in asked)


def _named(mask: Bools, frozen: Mapping[str, Bools] | None) -> dict[str, Bools]:
    """Masks (m,) of what is frozen, by names."""
    if not mask.any():
        return {}
    return {name: each.ravel() for name, each in (frozen or {"frozen": mask}).items()}


def _rounds(
    problem: _Problem, now: _State, most: int, progress: Progress | None
) -> tuple[_State, Outcome, tuple[Round, ...]]:
    """Do up to so many rounds; returns the best state, the outcome, and the figures of the rounds."""
    best, idle, total, short, trust, figures = now, 0, True, False, Trust(), list[Round]()
    outcome, lowest = Outcome.ROUNDS_SPENT, best.gap  # against the best gap alone, small losses would add up
    for number in range(most):
        if now.bridged == 0.0 and problem.holds(now):
            break
        if progress is not None:
            progress(f"round {number + 1}: {100 * now.bridged:.2g} % bridged, gap {now.gap:.3g}")
        found = problem.step(now, total, short, trust.near)
        short = found.least > 0.0
        after, share = problem.after(now, found)
        trust = problem.trust(trust, now, after, found, share) if short else trust
        total = total and not problem.stalls(after.gap, now.gap)
        figures.append(problem.figures(now, after, found))
        now = after
        holds = problem.holds(now)
        better = holds and problem.gains(now, best, lowest, short)
        lowest = min(lowest, now.worst(problem.parts) if short else now.gap) if holds else lowest
        best, idle = (now, 0) if better else (best, idle + holds)
        ended = idle >= (1 if short and trust.at_rest else FAILED if short else MAX_IDLE_ROUNDS)
        outcome = _outcome(now.bridged == 0.0 and holds, found, ended)
        if outcome != Outcome.ROUNDS_SPENT:
            break
    if short and outcome == Outcome.ROUNDS_SPENT:
        outcome = Outcome.OUT_OF_REACH
    return best, Outcome.WINDABLE if best.bridged == 0.0 else outcome, tuple(figures)


def lifted(paths: Paths, at_most: float = 0.0) -> Bools:
    """Mask (p, n) of the particles that lie off the surface by more than counts as none, and than may stay."""
    surface = paths.surface
    limit = tolerated(paths)
    if surface.threshold is None:
        limit = np.maximum(limit, LEAST_GAP * surface.size)
    return np.asarray(paths.gap > np.maximum(limit, at_most))


def threshold_of(surface: Surface) -> float:
    """A usual gap that counts as none: the threshold, or the root mean square of the surface's uncertainty."""
    if surface.threshold is not None:
        return surface.threshold
    doubt = 0.0 if surface.uncertainty is None else float(np.sqrt(np.mean(surface.uncertainty**2)))
    return max(doubt, LEAST_GAP * surface.size)


def _outcome(windable: bool, found: Step, ended: bool) -> Outcome:
    if windable:
        return Outcome.WINDABLE
    if max(found.solution.primal, found.solution.dual) > UNSOLVED:
        return Outcome.NOT_SOLVED
    if not ended:
        return Outcome.ROUNDS_SPENT
    return Outcome.OUT_OF_REACH if found.least > 0.0 else Outcome.NO_GAIN
