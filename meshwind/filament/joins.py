"""Joins between layers: the way of the fibre from the end of one to the start of the next, on the surface of the next.

A layer whose paths turn on an edge is left, and begun, over the rim: the last turnaround leads to the next layer's
first path.  A hoop is left and begun on the part, by a way whose angle changes no faster than friction holds.
"""

from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import AUTO
from meshwind.filament.cap_turn import Cap
from meshwind.filament.closing import ClosedLayer
from meshwind.filament.course import Course, Kind, joined
from meshwind.filament.edge import Edge, Legs
from meshwind.filament.ends import choose_end
from meshwind.filament.hoop import Hoop, HoopPlan, begins_at, hoop
from meshwind.filament.lift import legs_over
from meshwind.filament.part_turn import Bend
from meshwind.filament.spiral import Ground, between_hoops, from_path, most_slip, path_on, to_path
from meshwind.filament.turnaround import Turnaround

_AROUND = 360
"""Places round a rim at which a way to a hoop may begin."""
_SAME = 1e-9
"""Distance in v at which two lines are one, ..."""
_CLOSE = 1e-3
"""... and at which a fibre that touches one of them is taken to the other as it goes round."""
_SETTLED = 8
"""Rounds in which the least dwell to a place is found: each is a whole turn more at most."""


@dataclass(frozen=True)
class Tail:
    """Where the fibre of a layer ends.

    Attributes
    ----------
    end : int
        The end of the part, 0 or 1, at which or near which that is.
    u, v : float
        The place, u unwrapped.
    layer : ClosedLayer or None
        The layer, if its fibre ends with a path; None for a hoop.
    path : int
        That path.
    """

    end: int
    u: float
    v: float
    layer: ClosedLayer | None = None
    path: int = -1

    @property
    def turnaround(self) -> Turnaround | None:
        """What the fibre turns on there, if that is beyond the rim."""
        if self.layer is None:
            return None
        turn = self.layer.turnarounds[self.end]
        return None if isinstance(turn, Cap) else turn


@dataclass(frozen=True)
class Strand:
    """The fibre of one layer of a filament, in order of winding, from where the one before ended.

    Attributes
    ----------
    join : Course or None
        The way from the layer before; None for the first layer.
    course : Course
        The layer itself; a closed one with its last turnaround, which falls away where another layer follows.
    tail : Tail
        Where the layer ends.
    slip : float
        Friction that the join needs, 0 without one; infinite where its fibre would lift.
    cut : bool
        Whether the fibre is cut before the layer: it is a filament of its own.
    """

    join: Course | None
    course: Course
    tail: Tail
    slip: float = 0.0
    cut: bool = False

    @property
    def left(self) -> Course:
        """The layer up to its tail."""
        if self.tail.layer is None:
            return self.course
        last = int(np.flatnonzero(self.course.path >= 0)[-1])
        return self.course.chosen(slice(0, last + 1))


def strand_of_paths(closed: ClosedLayer, tail: Tail | None, ground: Ground, friction: float) -> Strand:
    """The fibre of a closed layer, begun at the end of the part that is nearer to where the layer before ended.

    After a hoop it is begun at the other end where the way to the nearer one needs more friction than there is.

    Raises BadInputError if the layer is of several filaments.
    """
    if len(closed.filaments) > 1:
        raise BadInputError(
            f"it closes as {len(closed.filaments)} filaments, which no join leads to; give other revolutions or paths"
        )
    if tail is None:
        return _begun(closed, None, 0, 0)
    strand = _from_tail(closed, tail, ground, friction)
    if tail.layer is None and strand.slip > friction:  # from a hoop that ends too near to the rim, by the other one
        other = _from_tail(closed, replace(tail, end=1 - tail.end), ground, friction)
        return min(strand, other, key=lambda each: each.slip)
    return strand


def _from_tail(closed: ClosedLayer, tail: Tail, ground: Ground, friction: float) -> Strand:
    """The fibre of a closed layer, begun at the end of the part at which the tail is."""
    turn = closed.turnarounds[tail.end]
    if isinstance(turn, Cap | Bend):
        first, ways, slip = _on_part(closed, turn, tail, ground, friction)
    else:
        leaving = legs_over(turn, closed.paths, _away(tail.end))
        arriving, ways, slip = _arriving(tail, turn.edge, ground, closed)
        first, later = _next(turn, arriving, leaving)
        ways = [*ways, turn.courses(arriving, leaving.chosen(np.array([first])), later).course]
        slip = max(slip, turn.slip)
    return _begun(closed, _as_join(ways), tail.end, first, slip)


def strand_of_hoop(plan: HoopPlan, tail: Tail | None, ground: Ground, friction: float) -> tuple[Strand, Hoop]:
    """The fibre of a hoop, and the hoop.

    It begins at the line that is nearer to the end of the layer before or, where friction does not hold the way there,
    at the one to which it needs less.
    """
    join, slip = None, 0.0
    if tail is not None:
        lines = ground.lines
        starts = [begins_at(replace(plan, from_end=way), lines) for way in (False, True)]
        here = float(tail.end) if tail.turnaround is not None else tail.v
        far = np.abs(np.interp(starts, lines.v, lines.mean) - np.interp(here, lines.v, lines.mean))
        from_end = bool(far[1] < far[0])
        reached = _onto(tail, ground, starts[from_end], friction)
        if reached.slip > friction:  # too near to where the layer before ends
            other = _onto(tail, ground, starts[not from_end], friction)
            from_end, reached = min((from_end, reached), (not from_end, other), key=lambda each: each[1].slip)
        plan = replace(plan, from_end=from_end, u=reached.u)
        join, slip = (_as_join(reached.ways) if reached.ways else None), reached.slip
    laid = hoop(ground.surface, plan)
    u, v = (float(each) for each in laid.tracks.uv[0, -1])
    along = float(np.interp(v, ground.lines.v, ground.lines.mean)) / float(ground.lines.mean[-1])
    return Strand(join, laid.course, Tail(int(along > 0.5), u, v), slip), laid


@dataclass(frozen=True)
class _Reached:
    """Ways to a place (u, v) on the part, and the friction that they need."""

    ways: list[Course]
    u: float
    v: float
    slip: float


def _away(end: int) -> int:
    """The family whose paths leave an end."""
    return -1 if end else 1


def _on_part(
    closed: ClosedLayer, turn: Cap | Bend, tail: Tail, ground: Ground, friction: float
) -> tuple[int, list[Course], float]:
    """The ways to a path whose layer begins on the part, which path it is, and the friction that they need.

    The fibre goes round as a hoop, where those of the layer turn, until it can bend into a path.
    """
    rows = np.flatnonzero(closed.paths.family == _away(tail.end))
    starts = closed.paths.uv[rows, -tail.end]
    line = float(starts[:, 1].mean())
    if isinstance(turn, Cap):
        reached, bent = _onto(tail, ground, line, friction), None
    else:
        reached = _onto(tail, ground, turn.line, friction)
        bent = to_path(ground, 0.0, turn.line, line, ground.course_of(closed.paths))
    leaves = starts[:, 0] - (0.0 if bent is None else bent.u)
    ahead = leaves + np.ceil(reached.u - leaves)
    first = int(np.argmin(ahead))
    at = float(starts[first, 1]) if isinstance(turn, Cap) else turn.line
    ring = ground.round(reached.u, reached.v, (float(ahead[first]), at))
    ways, slip = [*reached.ways, ring], max(reached.slip, most_slip(ring))
    if bent is not None:
        way = to_path(ground, float(ahead[first]), at, line, ground.course_of(closed.paths), bent.late)
        ways, slip = [*ways, way.course], max(slip, way.slip)
    return first, ways, slip


def _onto(tail: Tail, ground: Ground, to: float, friction: float) -> _Reached:
    """From the end of a layer to the line `to` on the part, there as a hoop."""
    layer = tail.layer
    if layer is None:
        if abs(to - tail.v) <= _SAME:
            return _Reached([], tail.u, tail.v, 0.0)
        over = between_hoops(ground, tail.u, tail.v, to, friction)
        return _Reached([over.course], over.u, over.v, over.slip)
    course = ground.course_of(layer.paths)
    beyond = to >= tail.v - _SAME if tail.end else to <= tail.v + _SAME
    if tail.turnaround is None or beyond:
        if abs(to - tail.v) <= _CLOSE:
            return _Reached([], tail.u, tail.v, 0.0)
        over = from_path(ground, tail.u, tail.v, to, course)
        return _Reached([over.course], over.u, over.v, over.slip)
    turn = choose_end(ground.surface, tail.end, layer.plan, _word(tail.turnaround), layer.paths).turnaround
    u = np.arange(_AROUND) / _AROUND
    leaving = _legs_at(turn.edge, ground, u, tail.v, float(np.interp(tail.v, ground.lines.v, course)), -1)
    arriving = _arrived(tail, turn.edge)
    first, later = _next(turn, arriving, leaving)
    over = from_path(ground, float(u[first]), tail.v, to, course)
    way = turn.courses(arriving, leaving.chosen(np.array([first])), later).course
    return _Reached([way, over.course], over.u, over.v, max(over.slip, turn.slip))


def _word(turn: Turnaround) -> str:
    """The word that asks for such a turnaround."""
    return AUTO if isinstance(turn, Bend) else turn.name


def _arriving(tail: Tail, on: Edge, ground: Ground, closed: ClosedLayer) -> tuple[Legs, list[Course], float]:
    """The leg over the rim on which the fibre comes from a layer, the ways to it, and the friction that they need."""
    rim = float(tail.end)
    if tail.turnaround is not None and abs(tail.v - rim) <= _SAME:
        return _arrived(tail, on), [], 0.0
    course = ground.course_of(closed.paths)
    if tail.layer is None:
        way = to_path(ground, tail.u, tail.v, rim, course)
    else:
        way = path_on(ground, tail.u, tail.v, rim, (ground.course_of(tail.layer.paths), course))
    return _legs_at(on, ground, np.array([way.u]), rim, way.comes, 1), [way.course], way.slip


def _arrived(tail: Tail, on: Edge) -> Legs:
    """The last path of a layer, on the edge of the next."""
    assert tail.layer is not None
    paths = tail.layer.paths
    mine = np.flatnonzero(paths.family == -_away(tail.end))
    turn = tail.turnaround
    assert turn is not None
    leg = legs_over(turn, paths, -_away(tail.end)).chosen(np.flatnonzero(mine == tail.path))
    own = turn.edge
    around = on.around(own.turned(leg.around))
    return replace(leg, around=frozen(around), height=frozen(leg.height + (own.origin - on.origin) @ on.axis))


def _legs_at(on: Edge, ground: Ground, u: Floats, v: float, angle: float, sense: int) -> Legs:
    """Legs that cross an edge at u (n,), all at one angle."""
    points = ground.surface.points(np.stack([u, np.full_like(u, v)], axis=1))
    height = (points - on.origin) @ on.axis
    return Legs(frozen(on.around(u)), frozen(height), frozen(np.full_like(u, angle)), frozen(points), sense)


def _next(turn: Turnaround, arriving: Legs, leaving: Legs) -> tuple[int, Floats]:
    """The leg that leaves soonest after the one that arrives, and the length (1,) along the hull where it does."""
    perimeter = turn.edge.hull.perimeter
    into = arriving.chosen(np.zeros(len(leaving), dtype=np.int64))
    later = leaving.around + perimeter * np.ceil((into.around - leaving.around) / perimeter)
    for _ in range(_SETTLED):
        spare = turn.surplus(into, leaving, later)
        if not (spare < 0.0).any():
            break
        later = later + perimeter * np.ceil(np.maximum(-spare, 0.0))
    first = int(np.argmin(later))
    return first, later[first : first + 1]


def _begun(closed: ClosedLayer, join: Course | None, end: int, first: int, slip: float = 0.0) -> Strand:
    """The layer from its path `first` of those that leave the end."""
    circuits = closed.joining.filaments[0]
    back = closed.joining.back[circuits]
    passed = 2 * int(np.flatnonzero((back if end else circuits) == first)[0]) + end
    course = _begun_at(closed.filaments[0], passed, 2 * len(circuits))
    path = int(course.path[np.flatnonzero(course.path >= 0)[-1]])
    u, v = closed.paths.uv[path, -end]
    return Strand(join, course, Tail(end, float(u), float(v), closed, path), slip)


def _begun_at(course: Course, passed: int, passes: int) -> Course:
    """A closed course, begun with another of its passes."""
    if passed:
        first = int(np.flatnonzero(course.passed == passed)[0]) - 1  # the pass before holds the point where it starts
        order: Ints = np.concatenate([np.arange(first, len(course)), np.arange(1, first + 1)])
        labels = order.copy()
        labels[0] = order[1]
        course = replace(
            course.chosen(order),
            **{name: frozen(getattr(course, name)[labels]) for name in ("kind", "circuit", "passed", "path")},
        )
    now = (course.passed - passed) % passes
    return replace(course, passed=frozen(now), circuit=frozen(now // 2))


def _as_join(ways: list[Course]) -> Course:
    """Ways in a row as a join."""
    way = joined(ways)
    none, zero = np.full(len(way), -1), np.zeros(len(way), dtype=np.int64)
    kind = np.full(len(way), int(Kind.JOIN))
    return replace(way, kind=frozen(kind), circuit=frozen(zero), passed=frozen(zero), path=frozen(none))
