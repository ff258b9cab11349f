"""Turnarounds over pins: the fibre goes straight on over the rim, round a pin, and along behind the pins.

Behind the pins it is a hoop on the prism, which needs no friction; the pins carry what turns it.  With a shaft it goes
from the pin inwards to a shaft on the axis, round it, and out again.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, frozen
from meshwind.core.vectors import TINY
from meshwind.filament.course import Course, Courses, Kind, in_turn, runs
from meshwind.filament.edge import Edge, Legs
from meshwind.filament.turnaround import Catch, Place, on_prism, shares, straight

_STEEPEST = np.radians(85.0)
"""Winding angle above which a leg is taken to have this one: a hoop never comes up to the pins."""
_BEND = 9
"""Points of a fibre round a pin."""
_STEP = np.radians(3.0)
"""Turn of the fibre between points round the shaft."""


@dataclass
class Pins:
    """Pins that stand out from the prism at one height.

    Parameters
    ----------
    edge : Edge
        The prism.
    height : float
        Height of the pins' middles over the rim's highest point.
    radius : float
        Radius of a pin.
    pitch : float
        Distance of the pins: a fibre is held by two of them at least.
    """

    edge: Edge
    height: float
    radius: float
    pitch: float
    name: str = field(default="pins", init=False)
    rule: str = field(default="held by pins; the hoop behind them needs no friction", init=False)
    slip: float = field(default=0.0, init=False)

    __repr__ = brief

    @property
    def catch(self) -> Catch:
        """See `Turnaround.catch`."""
        return Catch(self.edge.highest + self.reach, self.radius)

    @property
    def reach(self) -> float:
        """Height of the fibre behind the pins over the rim's highest point."""
        return self.height + self.radius

    def _legs(self, legs: Legs) -> tuple[Floats, Floats, Floats, Floats]:
        """Angle of each leg, the radius on which it bends, where it meets its pin, and where it has gone round it.

        The last two, (n,), are from where it starts.  A leg that comes to lie on the prism beside its pin bends from
        there on, on less than the pin's radius.
        """
        angle = np.minimum(legs.angle, _STEEPEST)
        radius, room = np.full(len(legs), self.radius), self.edge.highest + self.reach - legs.height
        beside = room < self.radius * (1.0 - np.sin(angle))
        if legs.lift is not None:
            beside &= ~legs.lift.held
        radius[beside] = np.maximum(room[beside], 0.0) / (1.0 - np.sin(angle[beside]))
        meets = (room - radius * (1.0 - np.sin(angle))) * np.tan(angle)
        return angle, radius, meets, meets + radius * np.cos(angle)

    def surplus(self, arriving: Legs, leaving: Legs, later: Floats) -> Floats:
        """Turns (n,) to spare beyond the ways to the pins and back."""
        return np.asarray(
            (later - arriving.around - self._legs(arriving)[3] - self._legs(leaving)[3] - self.pitch)
            / self.edge.hull.perimeter
        )

    def courses(self, arriving: Legs, leaving: Legs, later: Floats) -> Courses:
        """See `Turnaround.courses`."""
        (into, there), (away, back) = self._over_pins(arriving, arriving.around), self._over_pins(leaving, later)
        hoop = straight(self.edge, there, back, Kind.DWELL)
        return in_turn([into, hoop, away.backwards], share=True).between(arriving.points, leaving.points)

    def _over_pins(self, legs: Legs, start: Floats) -> tuple[Courses, Place]:
        """The way of each leg from the rim, at `start` (n,) along the hull, until it is a hoop behind its pin there."""
        angle, radius, meets, _ = self._legs(legs)
        top, sense = self.edge.highest + self.reach, legs.sense
        pin = start + sense * meets
        up = straight(self.edge, (start, legs.height), (pin, top - radius * (1.0 - np.sin(angle))), Kind.TURN)
        bend = angle[:, None] + (0.5 * np.pi - angle)[:, None] * np.linspace(0.0, 1.0, _BEND)
        around = (pin + sense * radius * np.cos(angle))[:, None] - sense * radius[:, None] * np.cos(bend)
        height = top - radius[:, None] * (1.0 - np.sin(bend))
        round_ = on_prism(
            self.edge, (around.ravel(), height.ravel()), bend.ravel(), np.zeros(bend.size),
            np.full(len(legs), _BEND), Kind.TURN,
        )  # fmt: skip
        round_ = self._straight_to(legs, start, round_)
        return in_turn([_begun(legs, up), round_], share=True), (around[:, -1], height[:, -1])

    def _straight_to(self, legs: Legs, start: Floats, round_: Courses) -> Courses:
        """The ways round pins; of legs that come to theirs through the air in the plane of both stretches."""
        if legs.lift is None or not legs.lift.held.any():
            return round_
        which = np.flatnonzero(legs.lift.held)
        start, level, ahead = start[which], legs.height[which], legs.lift.ahead[which][:, None]
        corner, along = self.edge.points(start, level)[:, None], legs.sense * self.edge.tangents(start)[:, None]
        turn = 0.5 * np.pi - legs.angle[which][:, None]
        bend = turn * np.linspace(0.0, 1.0, _BEND)
        inner = along - np.cos(turn)[..., None] * ahead
        inner /= np.maximum(np.linalg.norm(inner, axis=2, keepdims=True), TINY)
        passed = np.sin(bend) - np.tan(0.5 * turn)
        points = corner + self.radius * (passed[..., None] * ahead + (1.0 - np.cos(bend))[..., None] * inner)
        # past the corner it goes round with the prism
        on = np.maximum(((points - corner) * along).sum(axis=2), 0.0)
        place = (start[:, None] + legs.sense * on).ravel(), np.repeat(level, _BEND)
        points += self.edge.points(*place).reshape(points.shape) - corner - on[..., None] * along
        way = np.cos(bend)[..., None] * ahead + np.sin(bend)[..., None] * inner
        course, at = round_.course, (round_.first[which, None] + np.arange(_BEND)).ravel()
        new, angle = np.array(course.points), np.array(course.angle)
        new[at], angle[at] = points.reshape(-1, 3), np.arccos(np.clip(np.abs(way @ self.edge.axis), 0.0, 1.0)).ravel()
        return Courses(replace(course, points=frozen(new), angle=frozen(angle)), round_.count)


def _begun(legs: Legs, up: Courses) -> Courses:
    """The ways up the prism; of legs that come to their pins through the air the first point alone."""
    if legs.lift is None:
        return up
    count = np.where(legs.lift.held, 1, up.count)
    return Courses(up.course.chosen(runs(up.first, count)), count)


@dataclass
class Shaft:
    """A shaft on the axis, behind pins that the fibre passes between.

    Parameters
    ----------
    edge : Edge
        The prism.
    height : float
        Height, over the rim's highest point, at which the fibre passes the pins and goes round the shaft.
    radius : float
        Radius of the shaft, less than the hull's least.
    """

    edge: Edge
    height: float
    radius: float
    name: str = field(default="shaft", init=False)
    rule: str = field(default="held by pins and round a shaft, where it needs no friction", init=False)
    slip: float = field(default=0.0, init=False)

    @property
    def catch(self) -> Catch:
        """See `Turnaround.catch`."""
        return Catch(self.edge.highest + self.height)

    @property
    def reach(self) -> float:
        """Height of the fibre round the shaft over the rim's highest point."""
        return self.height

    def _at_pins(self, legs: Legs, start: Floats) -> tuple[Floats, Floats, Floats]:
        """Length along the hull (n,) where legs pass the pins, its polar angle, unwrapped, and the distance there."""
        angle = np.minimum(legs.angle, _STEEPEST)
        at = start + legs.sense * (self.edge.highest + self.height - legs.height) * np.tan(angle)
        flat = self.edge.hull.at(at)
        turn = 2.0 * np.pi * at / self.edge.hull.perimeter
        polar = np.arctan2(flat[:, 1], flat[:, 0])
        zero = float(np.arctan2(*self.edge.hull.points[0][::-1]))
        polar = polar - zero
        polar += 2.0 * np.pi * np.round((turn - polar) / (2.0 * np.pi))
        return at, polar + zero, np.hypot(flat[:, 0], flat[:, 1])

    def surplus(self, arriving: Legs, leaving: Legs, later: Floats) -> Floats:
        """Turns (n,) to spare beyond it takes to reach the shaft and to leave it."""
        _, first, near = self._at_pins(arriving, arriving.around)
        _, last, far = self._at_pins(leaving, later)
        least = np.arccos(self.radius / near) + np.arccos(self.radius / far)
        return np.asarray((last - first - least) / (2.0 * np.pi))

    def courses(self, arriving: Legs, leaving: Legs, later: Floats) -> Courses:
        """See `Turnaround.courses`."""
        at, first, near = self._at_pins(arriving, arriving.around)
        end, last, far = self._at_pins(leaving, later)
        level = np.full(len(later), self.edge.highest + self.height)
        up = _begun(arriving, straight(self.edge, (arriving.around, arriving.height), (at, level), Kind.TURN))
        down = _begun(leaving, straight(self.edge, (later, leaving.height), (end, level), Kind.TURN))
        touch = first + np.arccos(self.radius / near)
        leave = np.maximum(last - np.arccos(self.radius / far), touch)
        whole = in_turn([up, self._round(touch, leave), down.backwards], share=False)
        return whole.between(arriving.points, leaving.points)

    def _round(self, first: Floats, last: Floats) -> Courses:
        """The ways round the shaft between polar angles (n,)."""
        count = np.ceil((last - first) / _STEP).astype(np.int64) + 2
        polar = np.repeat(first, count) + shares(count) * np.repeat(last - first, count)
        flat = np.stack([np.cos(polar), np.sin(polar)], axis=1)
        normal = flat @ self.edge.across
        points = self.edge.origin + self.radius * normal + (self.edge.highest + self.height) * self.edge.axis
        none = np.full(len(polar), -1)
        kind = np.full(len(polar), int(Kind.DWELL))
        kind[np.cumsum(count) - count] = Kind.TURN  # it comes in through the air
        hoop = np.full_like(polar, 0.5 * np.pi)
        return Courses(Course(points, normal, hoop, np.zeros_like(polar), kind, none, none, none), count)
