"""Closing a layer: revolutions, phase and turnarounds with which its paths join to one filament."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, Ints
from meshwind.core.progress import Progress, silent
from meshwind.core.threads import side_by_side
from meshwind.filament.cap_turn import Cap, ends_with_caps, joined_on_caps, passes_on_caps
from meshwind.filament.course import Course, Courses, Kind, Stretches, in_line
from meshwind.filament.ends import CAP, LayerPlan, Pairs
from meshwind.filament.joining import Joining, join, passes
from meshwind.filament.lift import Hung, hung
from meshwind.filament.pattern import Pattern
from meshwind.filament.settling import Settled, lay
from meshwind.filament.turnaround import Turnaround
from meshwind.path import Paths
from meshwind.path.winding_angle import winding_angle
from meshwind.surface.rims import rim
from meshwind.surface.surface import Surface


@dataclass(frozen=True)
class ClosedLayer:
    """A layer of closed filaments.

    Attributes
    ----------
    plan : LayerPlan
        What was asked for.
    revolutions : float
        Turns of a path with which the layer closes.
    paths : Paths
        The paths that are joined, family +1 first, as many of each.
    hung : Hung
        The paths as their fibres lie: before a rim that its prism stands up from they leave the part.
    joining : Joining
        Which path follows which.
    turnarounds : tuple of Turnaround or Cap
        At the start and at the end.
    filaments : tuple of Course
        Each filament in the order of winding, from the start of its first path back to it.
    left_out : int
        Paths that are not in the filament, as they or others of their family are not in equilibrium.
    words : str
        What passes over caps need, and what would help where they do not hold; "" without a cap.
    """

    plan: LayerPlan
    revolutions: float
    paths: Paths
    hung: Hung
    joining: Joining
    turnarounds: tuple[Turnaround | Cap, Turnaround | Cap]
    filaments: tuple[Course, ...]
    left_out: int = 0
    words: str = ""

    __repr__ = brief

    @property
    def pattern(self) -> Pattern:
        """The pattern that the circuits close in."""
        return self.joining.pattern

    @property
    def length(self) -> float:
        """Length of all filaments, in the surface's units."""
        return float(sum(each.arc_length[-1] for each in self.filaments))


def close_layer(surface: Surface, plan: LayerPlan, say: Progress = silent) -> ClosedLayer:
    """Wind a layer as one closed filament.

    The revolutions are moved to R = (M/N - d_A - d_B) / 2, d_A and d_B being the dwells that the turnarounds need and M
    the nearest number of turns of the N circuits without a common divisor with N; family -1 starts d_A before +1.

    Parameters
    ----------
    surface : Surface
        Surface that closes in u.
    plan : LayerPlan
        What is to be wound.
    say : callable, default silent
        Called with a few words as it goes on.

    Returns
    -------
    ClosedLayer
        Paths, their joining, and the filaments.

    Raises
    ------
    BadInputError
        If no path of a family is in equilibrium, or a turnaround cannot be made.
    """
    if CAP in plan.turns:
        return _on_caps(surface, plan)
    settled, kept, left_out = lay(surface, plan, say)
    turned, angle = side_by_side(partial(_turned, settled, kept), partial(winding_angle, kept))
    pairs, joining, turns = turned
    fibres = _hung(kept, pairs, angle)
    filaments = _filaments(_laid(kept, fibres), kept.family, joining, turns)
    turnarounds = (settled.ends[0].turnaround, settled.ends[1].turnaround)
    plan = replace(plan, paths=settled.plan.paths)
    return ClosedLayer(plan, settled.revolutions, kept, fibres, joining, turnarounds, filaments, left_out)


def _turned(settled: Settled, paths: Paths) -> tuple[list[Pairs], Joining, tuple[Courses | None, Courses | None]]:
    """The legs at both ends, which path follows which, and the turnarounds between them."""
    pairs = [end.pairs(paths) for end in settled.ends]
    joining = _joined(pairs)
    return pairs, joining, _turns(pairs, joining)


def _on_caps(surface: Surface, plan: LayerPlan) -> ClosedLayer:
    """The layer where one end or both turn on a cap."""
    over = passes_on_caps(surface, plan)
    ends = ends_with_caps(surface, plan, over)
    pairs = [None if isinstance(end, Cap) else end.pairs(over.paths) for end in ends]
    joining = joined_on_caps(over) if over.pattern is not None else _joined_at_rim(surface, over.paths, pairs)
    fibres = _hung(over.paths, pairs, over.angle)
    filaments = _filaments(_laid(over.paths, fibres), over.paths.family, joining, _turns(pairs, joining))
    start, end = (end if isinstance(end, Cap) else end.turnaround for end in ends)
    turned = np.abs(over.paths.uv[:, -1, 0] - over.paths.uv[:, 0, 0]).mean()
    return ClosedLayer(
        plan,
        float(turned),
        over.paths,
        fibres,
        joining,
        (start, end),
        filaments,
        words=over.words.removeprefix(f"{joining.pattern.words}; "),
    )


def _joined_at_rim(surface: Surface, paths: Paths, pairs: list[Pairs | None]) -> Joining:
    """The joining where passes turn on the cap at one end, and over the rim at the other."""
    at: list[tuple[Floats, Floats]] = []
    for v, each in zip((0, 1), pairs, strict=True):
        if each is not None:
            at.append((each.off, each.at) if v == 0 else (each.at, each.off))
            continue
        there, back = (rim(surface, float(v)).shares(paths.uv[paths.family == family, -v, 0]) for family in (1, -1))
        at.append((there, back))
    (start, home), (end, away) = at
    dwells = [None if each is None else each.surplus for each in pairs]
    return join(passes(start, end), passes(away, home), end_dwell=dwells[1], start_dwell=dwells[0])


def _joined(pairs: list[Pairs]) -> Joining:
    start, end = pairs
    there = passes(start.off, end.at)
    # family -1 is walked from the end rim to the start rim
    back = passes(end.off, start.at)
    return join(there, back, end_dwell=end.surplus, start_dwell=start.surplus)


def _filaments(
    laid: Courses, families_: Ints, joining: Joining, turns: tuple[Courses | None, Courses | None]
) -> tuple[Course, ...]:
    """The courses of all filaments: each path there, the turn at the end, the path back, and the turn at the start."""
    (over_start, over_end), ways = turns, [np.flatnonzero(families_ == family) for family in (1, -1)]
    found, done = [], 0
    for there in joining.filaments:
        back = joining.back[there]
        stretches = [Stretches(laid, ways[0][there]), Stretches(laid, ways[1][back], backwards=True, back=1)]
        if over_end is not None:
            stretches.insert(1, Stretches(over_end, there))
        if over_start is not None:
            stretches.append(Stretches(over_start, back, back=1))
        found.append(in_line(stretches, done))
        done += len(there)
    return tuple(found)


def _turns(pairs: Sequence[Pairs | None], joining: Joining) -> tuple[Courses | None, Courses | None]:
    """The turnarounds after each path back, at the start, and after each path there, at the end; None on a cap."""
    each = np.arange(len(joining.back))
    made: list[Courses | None] = []
    ways = ((joining.there, joining.start_dwell), (joining.back, joining.end_dwell))
    for pair, (out, dwell) in zip(pairs, ways, strict=True):
        if pair is None:
            made.append(None)
            continue
        arriving, leaving = pair.arriving.chosen(each), pair.leaving.chosen(out)
        made.append(pair.end.turnaround.courses(arriving, leaving, pair.later(each, out, dwell)))
    return made[0], made[1]


def _hung(paths: Paths, pairs: Sequence[Pairs | None], angle: Floats) -> Hung:
    """The paths as their fibres lie; angle: those of the paths."""
    over = [
        (legs, pair.end.edge.end, legs.sense if pair.end.edge.end else -legs.sense)
        for pair in pairs
        if pair is not None
        for legs in (pair.arriving, pair.leaving)
    ]
    return hung(paths, angle, over)


def _laid(paths: Paths, fibres: Hung) -> Courses:
    """The courses of all paths from the start rim to the end rim."""
    kind = np.where(paths.on_surface & ~fibres.aloft, int(Kind.LAID), int(Kind.BRIDGE))
    # where a fibre comes to its prism, its turnaround begins
    kind[:, [0, -1]] = np.where(fibres.aloft[:, [0, -1]], int(Kind.TURN), kind[:, [0, -1]])
    count = np.full(len(paths), paths.gap.shape[1])
    none = np.broadcast_to(-1, kind.size)  # a filament numbers them
    slip = np.where(fibres.aloft, np.nan, paths.slip)
    return Courses(
        Course(
            fibres.points.reshape(-1, 3), fibres.normal.reshape(-1, 3), fibres.angle.ravel(), slip.ravel(),
            kind.ravel(), none, none, np.repeat(np.arange(len(paths)), count),
        ),
        count,
    )  # fmt: skip
