"""Closing a layer: revolutions, phase and turnarounds with which its paths join to one filament."""

from dataclasses import dataclass, field, replace

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.core.errors import BadInputError
from meshwind.filament.collar_turn import Collar
from meshwind.filament.course import Course, Kind, joined
from meshwind.filament.edge import Edge, Legs, edge, legs
from meshwind.filament.joining import Joining, Surplus, join, passes
from meshwind.filament.pattern import Pattern, nearest_pattern, patterns
from meshwind.filament.pin_turn import Pins, Shaft
from meshwind.filament.turnaround import Turnaround
from meshwind.path import Paths, Status, solve
from meshwind.path.friction import Friction, friction_of
from meshwind.path.winding_angle import winding_angle
from meshwind.planning.families import families
from meshwind.surface.rims import rim
from meshwind.surface.surface import Surface

AUTO = "auto"
_SCOUTS = 24
"""Paths per family from which the turnarounds are chosen and their dwell is planned."""
_ROUNDS = 4
"""Windings at most until the turnarounds have room with the revolutions that they ask for."""
_SETTLED = 60
"""Rounds in which the least dwell is found."""
_SETTLED_IN = 8
"""Rounds in which revolutions and dwells are to suit one another."""
_FAR = 1.0
"""Revolutions times the circuits by which those that close may differ from those asked for; they are 1/2 apart."""
_CONTRACTS = 0.95
"""Share of a shortage of dwell that may be left after a round for the secant to be taken."""
_ROOM = 1e-6
"""Turns of dwell beyond the least, so that round-off does not cost a place."""
_PIN_WIDE, _PIN_HIGH = 1 / 6, 1 / 2
"""Radius of a pin, and height of its middle over the rim, over the distance of the paths along the rim."""
_SHAFT = 0.5
"""Radius of a shaft over the least distance of the hull from its axis."""
_LONGEST_DWELL = 20.0
"""Turns that a turnaround may take: the fibre of a longer one would be most of the layer."""
_LONGEST_COLLAR = 1.0
"""Collar over the rim's mean diameter, above which pins are taken instead."""


@dataclass(frozen=True)
class LayerPlan:
    """What a closed layer is to be.

    Parameters
    ----------
    paths : int
        Paths per family: circuits of the layer.
    revolutions : float
        Turns of a path from end to end; moved to where the layer closes.
    friction : float or Friction, default 0
        Coefficient of friction, as for `solve`.
    particles : int or None, default 401
        Particles per path.
    turns : tuple of str, default ("auto", "auto")
        Turnarounds at the start and at the end: "collar", "pins", "shaft" or "auto".
    """

    paths: int
    revolutions: float
    friction: float | Friction = 0.0
    particles: int | None = 401
    turns: tuple[str, str] = (AUTO, AUTO)


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
    joining : Joining
        Which path follows which.
    turnarounds : tuple of Turnaround
        At the start and at the end.
    filaments : tuple of Course
        Each filament in the order of winding, from the start of its first path back to it.
    left_out : int
        Paths that are not in the filament, as they or others of their family are not in equilibrium.
    """

    plan: LayerPlan
    revolutions: float
    paths: Paths
    joining: Joining
    turnarounds: tuple[Turnaround, Turnaround]
    filaments: tuple[Course, ...]
    left_out: int = 0

    @property
    def pattern(self) -> Pattern:
        """The pattern that the circuits close in."""
        return self.joining.pattern

    @property
    def length(self) -> float:
        """Length of all filaments, in the surface's units."""
        return float(sum(each.arc_length[-1] for each in self.filaments))


@dataclass(frozen=True)
class _End:
    """One end: the edge, what turns there, and its rim, in shares of which ends are spread."""

    surface: Surface
    v: float
    edge: Edge
    turnaround: Turnaround
    shift: float = field(default=0.0)

    def shares(self, paths: Paths, family: int) -> Floats:
        """Shares of the rim's length, unwrapped, at which the paths of a family cross it."""
        u = paths.uv[paths.family == family, -1 if self.v else 0, 0]
        return rim(self.surface, self.v).shares(u)

    def pairs(self, paths: Paths) -> "_Pairs":
        """The legs that arrive and those that leave."""
        families_ = (1, -1) if self.v else (-1, 1)
        into, out = (legs(self.edge, paths, self.v, family) for family in families_)
        at, off = (self.shares(paths, family) for family in families_)
        return _Pairs(self, into, out, at, off)


@dataclass(frozen=True)
class _Pairs:
    """At one end: legs that arrive and leave (N,), and the shares (N,) of the rim where they do."""

    end: _End
    arriving: Legs
    leaving: Legs
    at: Floats
    off: Floats

    def later(self, into: Ints, out: Ints, dwell: Floats) -> Floats:
        """Lengths (n,) along the hull at which legs `out` leave, a dwell (n,) of the rim after legs `into` came."""
        turns = np.round(self.at[into] + dwell - self.off[out])
        return np.asarray(self.leaving.around[out] + turns * self.end.edge.hull.perimeter)

    @property
    def surplus(self) -> Surplus:
        """What each dwell has to spare."""
        return lambda into, out, dwell: self.end.turnaround.surplus(
            self.arriving.chosen(into), self.leaving.chosen(out), self.later(into, out, dwell)
        )

    def least_dwell(self) -> float:
        """Least dwell with which every arriving leg has room to a leg that leaves at just that dwell.

        Legs that leave are taken from those that do, as periodic functions of where.
        """
        edge_ = self.end.edge
        order = np.argsort(np.mod(self.off, 1.0))
        place = np.mod(self.off, 1.0)[order]
        perimeter = edge_.hull.perimeter

        def between(values: Floats, share: Floats) -> Floats:
            return np.asarray(np.interp(share, place, values[order], period=1.0))

        ahead = self.leaving.around - perimeter * self.off
        dwell = 0.0
        for _ in range(_SETTLED):
            share = self.at + dwell
            later = perimeter * share + between(ahead, share)
            leave = Legs(later, between(self.leaving.height, share), between(self.leaving.angle, share),
                         self.leaving.points, -1)  # fmt: skip
            short = -float(self.end.turnaround.surplus(self.arriving, leave, later).min())
            if short <= _ROOM:
                break
            dwell += short
            if not dwell < _LONGEST_DWELL:
                raise BadInputError(
                    f"the turnaround at the {'end' if self.end.v else 'start'} ({self.end.turnaround.name}) would take "
                    f"more than {_LONGEST_DWELL:g} turns; give pins or a shaft, more friction, or a larger angle"
                )
        return dwell + 2.0 * _ROOM


def close_layer(surface: Surface, plan: LayerPlan) -> ClosedLayer:
    """Wind a layer as one closed filament.

    The revolutions are moved to R = (M/N - d_A - d_B) / 2, d_A and d_B being the dwells that the turnarounds need and M
    the nearest number of turns of the N circuits without a common divisor with N; family -1 starts d_A before +1.

    Parameters
    ----------
    surface : Surface
        Surface that closes in u.
    plan : LayerPlan
        What is to be wound.

    Returns
    -------
    ClosedLayer
        Paths, their joining, and the filaments.

    Raises
    ------
    BadInputError
        If no path of a family is in equilibrium, or a turnaround cannot be made.
    """
    scouts, _ = _at_rest(_solved(surface, plan, min(plan.paths, _SCOUTS), plan.revolutions, 0.0))
    ends = [_end(surface, v, plan, word, scouts) for v, word in zip((0.0, 1.0), plan.turns, strict=True)]
    planned = _planned(surface, plan, ends, scouts)
    for _ in range(_ROUNDS):
        kept, left_out = _at_rest(_solved(surface, plan, plan.paths, planned.revolutions, -planned.dwells[0]))
        pairs = [end.pairs(kept) for end in ends]
        joining = _joined(pairs)
        if left_out or joining.turns == planned.turns:
            break
        planned = planned.with_room([each.least_dwell() for each in pairs])
    turnarounds = (ends[0].turnaround, ends[1].turnaround)
    return ClosedLayer(
        plan, planned.revolutions, kept, joining, turnarounds, _filaments(kept, joining, pairs), left_out
    )  # fmt: skip


@dataclass(frozen=True)
class _Planned:
    """A pattern of N circuits in so many turns, and the dwells in turns at the start and at the end."""

    plan: LayerPlan
    turns: int
    dwells: tuple[float, float]

    @property
    def revolutions(self) -> float:
        """Turns of a path from end to end."""
        return 0.5 * (self.turns / self.plan.paths - sum(self.dwells))

    @property
    def near(self) -> bool:
        """Whether the revolutions are next to those that were asked for."""
        return self.revolutions >= 0.0 and abs(self.revolutions - self.plan.revolutions) <= _FAR / self.plan.paths

    def with_room(self, needed: list[float]) -> "_Planned":
        """The same pattern with dwells no shorter than needed; or, as the revolutions stay, with longer ones."""
        start, end = map(max, self.dwells, needed)
        moved = replace(self, dwells=(start, end))
        return moved if moved.near else _as_asked(self.plan, [start, end])


def _as_asked(plan: LayerPlan, needed: list[float]) -> _Planned:
    """The nearest pattern with the revolutions that were asked for: the filament waits as hoops until it closes."""
    pattern = patterns(plan.paths, 2.0 * plan.revolutions + sum(needed))[0]
    more = 0.5 * pattern.dwell
    # round-off must not leave fewer revolutions than none
    return _Planned(
        plan, pattern.turns, (needed[0] + more, min(needed[1] + more, pattern.turns / plan.paths - needed[0] - more))
    )


def _planned(surface: Surface, plan: LayerPlan, ends: list[_End], scouts: Paths) -> _Planned:
    """The pattern next to what was asked for, with dwells that are long enough at the revolutions that it leaves.

    Longer dwells leave fewer revolutions, with which collars need still longer ones: the secant of the two gives where
    they meet.  Where they do not, the revolutions stay, and the filament waits as hoops until it closes.
    """
    needed = [end.pairs(scouts).least_dwell() for end in ends]
    pattern = nearest_pattern(plan.paths, 2.0 * plan.revolutions + sum(needed))
    planned = _Planned(plan, pattern.turns, (needed[0], needed[1]))
    short = np.inf
    for _ in range(_SETTLED_IN):
        if not planned.near:
            break
        tried, _ = _at_rest(_solved(surface, plan, len(scouts) // 2, planned.revolutions, -planned.dwells[0]))
        now = np.array([end.pairs(tried).least_dwell() for end in ends]) - planned.dwells
        if now.max() <= _ROOM:
            return planned
        factor = 1.0 / (1.0 - now.sum() / short) if now.sum() < _CONTRACTS * short else 1.0
        short = now.sum()
        start, end = np.array(planned.dwells) + factor * now
        planned = replace(planned, dwells=(float(start), float(end)))
    return _as_asked(plan, needed)


def _solved(surface: Surface, plan: LayerPlan, count: int, revolutions: float, phase: float) -> Paths:
    ends = families(surface, count, revolutions, phase=phase)
    return solve(surface, ends.start, ends.end, family=ends.family, particles=plan.particles, friction=plan.friction)


def _at_rest(paths: Paths) -> tuple[Paths, int]:
    """The paths in equilibrium, evened to as many of each family, and how many are left out."""
    rest: Bools = paths.status == Status.CONVERGED
    counts = [int((rest & (paths.family == family)).sum()) for family in (1, -1)]
    if not min(counts):
        raise BadInputError(
            "no filament can be wound, as no path of a family is at rest; " + paths.advice(int(np.argmin(rest)))
        )
    keep = np.flatnonzero(rest)
    richer = 1 if counts[0] > counts[1] else -1
    mine = keep[paths.family[keep] == richer]
    spare = abs(counts[0] - counts[1])
    out = mine[np.linspace(0, len(mine) - 1, spare).round().astype(np.int64)] if spare else mine[:0]
    keep = np.setdiff1d(keep, out)
    return (paths if len(keep) == len(paths) else paths.subset(keep)), len(paths) - len(keep)


def _end(surface: Surface, v: float, plan: LayerPlan, word: str, scouts: Paths) -> _End:
    """An end with the turnaround that was asked for, or that suits it."""
    on = edge(surface, v)
    friction = float(friction_of(surface, plan.friction).table[:, -1 if v else 0].min())
    pitch = on.hull.perimeter / plan.paths
    pins = Pins(on, _PIN_HIGH * pitch, _PIN_WIDE * pitch, pitch)
    if word == "pins":
        return _End(surface, v, on, pins)
    if word == "shaft":
        least = float(np.linalg.norm(on.hull.points, axis=1).min())
        return _End(surface, v, on, Shaft(on, _PIN_HIGH * pitch, _SHAFT * least))
    if word == "collar" and not friction > 0.0:
        raise BadInputError("a collar holds no fibre without friction; give friction, or pins or a shaft for this end")
    if friction > 0.0:
        collar = Collar(on, friction)
        if word == "collar":
            return _End(surface, v, on, collar)
        tops = [collar.reached(legs(on, scouts, v, family), np.zeros(len(scouts) // 2))[1].max() for family in (1, -1)]
        if max(tops) - on.highest <= _LONGEST_COLLAR * on.hull.perimeter / np.pi:
            return _End(surface, v, on, collar)
    return _End(surface, v, on, pins)


def _joined(pairs: list[_Pairs]) -> Joining:
    start, end = pairs
    there = passes(start.off, end.at)
    # family -1 is walked from the end rim to the start rim
    back = passes(end.off, start.at)
    return join(there, back, end_dwell=end.surplus, start_dwell=start.surplus)


def _filaments(paths: Paths, joining: Joining, pairs: list[_Pairs]) -> tuple[Course, ...]:
    """The courses of all filaments."""
    start, end = pairs
    count = len(joining.back)
    each = np.arange(count)
    over_end = _turns(end, each, joining.back, joining.end_dwell)
    over_start = _turns(start, each, joining.there, joining.start_dwell)
    laid = _laid(paths)
    plus, minus = (np.flatnonzero(paths.family == family) for family in (1, -1))
    found, circuit = [], 0
    for circuits in joining.filaments:
        parts = []
        for there in circuits:
            back = int(joining.back[there])
            row = [
                (laid[plus[there]], 0),
                (over_end[there], 0),
                (_reversed(laid[minus[back]]), 1),
                (over_start[back], 1),
            ]
            parts += [_numbered(part, circuit, 2 * circuit + passed) for part, passed in row]
            circuit += 1
        found.append(joined(parts))
    return tuple(found)


def _turns(pairs: _Pairs, into: Ints, out: Ints, dwell: Floats) -> list[Course]:
    arriving, leaving = pairs.arriving.chosen(into), pairs.leaving.chosen(out)
    return pairs.end.turnaround.courses(arriving, leaving, pairs.later(into, out, dwell))


def _laid(paths: Paths) -> list[Course]:
    """The course of each path from the start rim to the end rim."""
    angle, kind = winding_angle(paths), np.where(paths.on_surface, Kind.LAID, Kind.BRIDGE)
    none = np.full(paths.gap.shape[1], -1)
    return [
        Course(paths.points[k], paths.normal[k], angle[k], paths.slip[k], kind[k], none, none, np.full_like(none, k))
        for k in range(len(paths))
    ]


def _reversed(course: Course) -> Course:
    return Course(*(getattr(course, name)[::-1] for name in course.__dataclass_fields__))


def _numbered(course: Course, circuit: int, passed: int) -> Course:
    none = np.zeros(len(course), dtype=np.int64)
    return replace(course, circuit=frozen(none + circuit), passed=frozen(none + passed))
