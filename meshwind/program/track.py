"""The fibre as the machine lays it: pieces that are laid, spans that land at once, and turns at a fixed point."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.vectors import TINY, dots, sizes, unit
from meshwind.filament.course import Kind
from meshwind.filament.filament import Filament

LAY, AIR, PIVOT = 0, 1, 2
"""A piece that is laid; a bridge, which lands at once; a turn of the free span about a point."""
_NO_STEP = 1e-9
"""Steps below this share of the length hold no direction."""
_SMOOTH = np.radians(20.0)
"""Turn between two steps above which the fibre has a corner: it is sampled at under half of this in turnarounds."""
_UNEVEN = 4.0
"""A step this many times longer than both its neighbours is straight: it spans from one contact to the next."""
_SAME = np.radians(0.05)
"""Turn at a point below which it is round-off of the tangents, and no turn."""
_ZIGZAG = np.radians(30.0)
"""Turn there and back by which a short step, such as that up to the next layer, is told from the fibre's course."""


@dataclass(frozen=True)
class Track:
    """A filament of m pieces in a row.

    Attributes
    ----------
    motion : ndarray of int, shape (m,)
        LAY, AIR or PIVOT.
    points, tangents, normals : ndarray of float, shape (m, 2, 3)
        At the start and the end of each piece.
    arc, slip : ndarray of float, shape (m, 2)
        Length laid, and friction needed.
    layer, circuit, passed, path, kind : ndarray of int, shape (m,)
        As in a filament.
    """

    motion: Ints
    points: Floats
    tangents: Floats
    normals: Floats
    arc: Floats
    slip: Floats
    layer: Ints
    circuit: Ints
    passed: Ints
    path: Ints
    kind: Ints

    __repr__ = brief

    def __len__(self) -> int:
        return len(self.motion)

    @cached_property
    def corner(self) -> Floats:
        """Turn (m,) of the tangent over each piece, in radians."""
        return _turn(self.tangents[:, 0], self.tangents[:, 1])

    def piece(self, at: Floats) -> tuple[Ints, Floats]:
        """The piece (n,) at places (n,), whole numbers being starts of pieces, and the share of it that is done."""
        index = np.minimum(np.floor(at).astype(np.int64), len(self) - 1)
        return index, at - index

    def contact(self, at: Floats) -> tuple[Floats, Floats]:
        """Points and unit tangents (n, 3) where the fibre leaves what it lies on, at places (n,)."""
        index, share = self.piece(at)
        s = share[:, None]
        p0, p1 = self.points[index, 0], self.points[index, 1]
        t0, t1 = self.tangents[index, 0], self.tangents[index, 1]
        chord = p1 - p0
        size = sizes(chord)[:, None]
        d0, d1 = size * t0, size * t1
        bend, twist = 3.0 * chord - 2.0 * d0 - d1, d0 + d1 - 2.0 * chord
        lay = self.motion[index] == LAY
        point = p0 + s * (d0 + s * (bend + s * twist))
        ahead = d0 + s * (2.0 * bend + 3.0 * s * twist)
        landed = (s >= 1.0) & (self.motion[index] == AIR)[:, None]
        point = np.where(lay[:, None], point, np.where(landed, p1, p0))
        tangent = unit(ahead)
        turns = np.flatnonzero(~lay)
        tangent[turns] = swung(t0[turns], t1[turns], share[turns])
        return point, tangent

    def laid(self, at: Floats) -> Floats:
        """Length (n,) laid up to places (n,)."""
        index, share = self.piece(at)
        share = np.where(self.motion[index] == AIR, np.floor(share), share)
        return np.asarray(self.arc[index, 0] + share * (self.arc[index, 1] - self.arc[index, 0]))

    def landing(self, at: Floats) -> Bools:
        """Whether places (n,) are where a bridge lands."""
        index, share = self.piece(at)
        before = np.where(share == 0.0, np.maximum(index - 1, 0), index)
        return np.asarray((self.motion[before] == AIR) & ((share == 0.0) | (share >= 1.0)) & (at > 0.0))


def track(filament: Filament, backwards: bool = False) -> Track:
    """The pieces of a filament; backwards: laid from its end to its start."""
    course = filament.course
    held = np.flatnonzero(_held(course.points, course.kind))
    if backwards:
        held = held[::-1]
    points = course.points[held]
    step, chord = _steps(points)
    # what a step does is told by its later point in order of winding; a bridge has points in the air at both or one end
    later = course.kind[held[:-1] if backwards else held[1:]]
    air = _bridged(course.kind, held)
    arc = course.arc_length[held]
    arc = arc[0] - arc if backwards else arc
    before, after = _tangents(step, chord, air, _apart(chord, later, air, filament.layer[held]))
    turns = np.zeros(len(step), dtype=np.int64)  # at the start of a step, the span turns about the vertex
    turns[1:] = _turned(before[1:-1], after[1:-1], _SAME)
    start = np.repeat(np.arange(len(step)), 1 + turns)
    pivot = np.append(start[1:] == start[:-1], False)
    end, told = start + 1 - pivot, start - pivot
    at = np.flatnonzero(pivot)
    leaving, arriving = after.take(start, axis=0), before.take(end, axis=0)
    leaving[at], arriving[at] = before[start[at]], after[start[at]]
    both = np.stack([start, end], axis=1)

    def of_step(values: Ints) -> Ints:
        on = values[held]
        return (on[:-1] if backwards else on[1:])[told].astype(np.int64)

    kinds = np.where(air, Kind.BRIDGE, np.where(later == Kind.BRIDGE, Kind.LAID, later))
    return Track(
        motion=np.where(pivot, PIVOT, np.where(air, AIR, LAY)[start]).astype(np.int64),
        points=points.take(both, axis=0),
        tangents=np.stack([leaving, arriving], axis=1),
        normals=course.normal.take(held[both], axis=0),
        arc=arc.take(both),
        slip=course.slip.take(held[both]),
        layer=of_step(filament.layer),
        circuit=of_step(course.circuit),
        passed=of_step(course.passed),
        path=of_step(course.path),
        kind=kinds[told].astype(np.int64),
    )


def _held(points: Floats, kind: Ints) -> Bools:
    """Which points (n,) the pieces start and end at: none in the air, none twice, none of a step there and back."""
    held = kind != Kind.BRIDGE
    held[0] = held[-1] = True
    for drop in (_twice, _zigzag):
        index = np.flatnonzero(held)
        held[index[drop(points[index])]] = False
    return held


def _twice(points: Floats) -> Ints:
    """Points that lie where the one before does."""
    step = sizes(np.diff(points, axis=0))
    return np.flatnonzero(step <= _NO_STEP * step.sum()) + 1


def _zigzag(points: Floats) -> Ints:
    """The ends of steps that turn aside from a course that goes on as it came."""
    step = unit(np.diff(points, axis=0))
    if len(step) < 3:
        return np.empty(0, dtype=np.int64)
    sharp = _turned(step[:-1], step[1:], _ZIGZAG)
    near = np.flatnonzero(sharp[:-1] & sharp[1:])
    one, two, three = step[near], step[near + 1], step[near + 2]
    aside = np.minimum(_turn(one, two), _turn(two, three))
    return near[_turn(one, three) < 0.5 * aside] + 2


def _bridged(kind: Ints, held: Ints) -> Bools:
    """Whether steps (n - 1,) between held points go through the air: points in the air lay between."""
    count = np.concatenate([[0], np.cumsum(kind == Kind.BRIDGE)])
    low, high = np.minimum(held[:-1], held[1:]), np.maximum(held[:-1], held[1:])
    return np.asarray(count[high + 1] - count[low] > 0)


def _steps(points: Floats) -> tuple[Floats, Floats]:
    """Unit vectors (n - 1, 3) from point to point, and the lengths (n - 1,)."""
    move = np.diff(points, axis=0)
    chord = sizes(move)
    return move / np.where(chord > 0.0, chord, 1.0)[:, None], chord


def _apart(chord: Floats, kind: Ints, air: Bools, layer: Ints) -> Bools:
    """Whether the tangents on both sides of each inner point (n - 2,) are taken apart: the fibre may have a corner."""
    straight = air.copy()
    straight[1:-1] |= chord[1:-1] > _UNEVEN * np.maximum(chord[:-2], chord[2:])
    on_part = np.isin(kind, (Kind.LAID, Kind.BRIDGE))
    return np.asarray(
        (on_part[1:] != on_part[:-1]) | straight[1:] | straight[:-1] | (layer[1:-1] != layer[2:])
    )  # fmt: skip


def _tangents(step: Floats, chord: Floats, air: Bools, apart: Bools) -> tuple[Floats, Floats]:
    """Unit tangents (n, 3) of arriving at and leaving from each point: those of parabolas, the chord in the air."""
    # at a corner or an end, the parabola through the points on one side, if the next of them is smooth
    inner = np.zeros(len(step) + 1, dtype=bool)
    inner[1:-1] = ~(apart | _turned(step[:-1], step[1:], _SMOOTH))
    before = np.concatenate([step[:1], step])
    before[1:-1] = unit(chord[1:, None] * step[:-1] + chord[:-1, None] * step[1:])
    after, corners = before.copy(), np.flatnonzero(~inner)
    before[corners], after[corners] = step[np.maximum(corners - 1, 0)], step[np.minimum(corners, len(step) - 1)]
    start = np.flatnonzero(~inner[:-1] & inner[1:])  # steps whose start is a corner
    after[start] = _mirrored(step[start], after[start + 1])
    end = np.flatnonzero(inner[:-1] & ~inner[1:])
    before[end + 1] = _mirrored(step[end], before[end])
    after[:-1][air], before[1:][air] = step[air], step[air]
    small = corners[~_turned(before[corners], after[corners], _SAME)]
    mean = unit(before[small] + after[small])
    lands, lifts = np.append(False, air)[small], np.append(air, False)[small]
    mean = np.where(lands[:, None], before[small], np.where(lifts[:, None], after[small], mean))
    before[small] = after[small] = mean
    before[0], after[-1] = after[0], before[-1]
    return before, after


def _mirrored(chord: Floats, tangent: Floats) -> Floats:
    """The tangents (n, 3) at one end of chords, by those at the other: of a circle."""
    return unit(2.0 * dots(chord, tangent)[:, None] * chord - tangent)


def _turn(one: Floats, other: Floats) -> Floats:
    """Angles (n,) between unit vectors (n, 3)."""
    return np.asarray(2.0 * np.arcsin(np.minimum(0.5 * sizes(other - one), 1.0)))


def _turned(one: Floats, other: Floats, angle: float) -> Bools:
    """Whether unit vectors (n, 3) are more than an angle apart."""
    return np.asarray(sizes(other - one) > 2.0 * np.sin(0.5 * angle))


def swung(one: Floats, other: Floats, share: Floats) -> Floats:
    """Unit vectors (n, 3) turned evenly by shares (n,) from one to another."""
    angle = _turn(one, other)
    sine = np.sin(angle)
    plain = sine < 1e-9  # the same, or opposite, where no plane is told
    a = np.where(plain, 1.0 - share, np.sin((1.0 - share) * angle) / np.maximum(sine, TINY))
    b = np.where(plain, share, np.sin(share * angle) / np.maximum(sine, TINY))
    return unit(a[:, None] * one + b[:, None] * other)
