"""Ways on the part from one level line to another, by which the fibre comes from layer to layer."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from meshwind.core.cast import Floats, frozen
from meshwind.filament.bend import bend
from meshwind.filament.course import Course, Kind
from meshwind.filament.levels import Levels, level_at
from meshwind.filament.stations import angles_at
from meshwind.path.paths import Paths
from meshwind.surface.surface import Surface

_SAMPLES = 1025
"""Places between the lines at which the angle is summed up to turns."""
_PER_TURN = 180
"""Points of the way in a turn, two degrees apart."""
_FEWEST = 90
"""Points of a way at least: a short one bends as much as a long one."""
_TRIES = 9
"""Angles that are tried between two hoops."""
_LATE = np.arange(10) / 10
"""Shares of the way that lie as a path, of which the one with the least slip is taken."""
_FLATTEST = np.radians(10.0)
"""Least winding angle of a way: along the part nothing holds it."""
Profile: TypeAlias = Callable[[Floats, Floats, Floats], Floats]
"""Angle at shares of the way, from the v there and the angle of a hoop."""


@dataclass(frozen=True)
class Spiral:
    """A way on the part.

    Attributes
    ----------
    course : Course
        Its n points, all of kind JOIN.
    u, v : float
        Where it ends, with u unwrapped.
    slip : float
        Friction that it needs; infinite where the fibre would lift.
    leaves, comes : float
        Winding angle, in radians, at the start and at the end.
    late : float
        Share of the way on which it lies as a path, where it bends on the rest.
    """

    course: Course
    u: float
    v: float
    slip: float
    leaves: float
    comes: float
    late: float = 0.0


@dataclass(frozen=True)
class Ground:
    """A surface with its level lines, and the pitch of a hoop on it, in the surface's units."""

    surface: Surface
    lines: Levels
    pitch: float

    @cached_property
    def _passed(self) -> Floats:
        return self.lines.mean

    @cached_property
    def _along(self) -> CubicHermiteSpline:
        return level_at(self._passed, self.lines)

    def course_of(self, paths: Paths) -> Floats:
        """Median winding angle (k,) of paths where they cross the level lines."""
        angle = angles_at(paths, self.lines.v)
        here = np.isfinite(angle).any(axis=0)
        return np.asarray(np.interp(self.lines.v, self.lines.v[here], np.nanmedian(angle[:, here], axis=0)))

    def round(self, u: float, v: float, to: tuple[float, float]) -> Course:
        """The way from (u, v) round the part to a place a little further on, as good as along a level line."""
        count = int(np.ceil((to[0] - u) * _PER_TURN)) + 2
        share = np.linspace(0.0, 1.0, count)
        at = u + share * (to[0] - u)
        span = max(to[0] - u, 1e-9)
        uv = np.stack([at, np.clip(v + _smooth(share) * (to[1] - v), 0.0, 1.0)], axis=1)
        slope = 6.0 * share * (1.0 - share) * (to[1] - v) / span
        second = 6.0 * (1.0 - 2.0 * share) * (to[1] - v) / span**2
        return self._laid(uv, slope, second)

    def way(self, u: float, v: float, to: float, angle: Profile) -> Spiral:
        """The way from (u, v) to the line `to` at this angle."""
        first, last = np.interp([v, to], self.lines.v, self._passed)
        share = _smooth(np.linspace(0.0, 1.0, _SAMPLES))  # dense where the way is a hoop, and the turns many
        distance = first + share * (last - first)
        length, at_v = (np.interp(distance, self._passed, each) for each in (self.lines.length, self.lines.v))
        hoop = np.arctan2(length, self.pitch)
        lean = np.clip(angle(share, at_v, hoop), _FLATTEST, hoop)
        rate = np.tan(lean) / length * abs(last - first)  # turns for a share of the way
        turned = u + np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(share))])
        along = CubicSpline(turned, distance)
        many = max(int(np.ceil((turned[-1] - turned[0]) * _PER_TURN)), _FEWEST) + 2
        at = np.linspace(turned[0], turned[-1], many)
        d, slope, second = along(at), along(at, 1), along(at, 2)
        line = self._along
        uv = np.stack([at, np.clip(line(d), 0.0, 1.0)], axis=1)
        course = self._laid(uv, line(d, 1) * slope, line(d, 1) * second + line(d, 2) * slope**2)
        return Spiral(course, float(at[-1]), float(uv[-1, 1]), most_slip(course), float(lean[0]), float(lean[-1]))

    def _laid(self, uv: Floats, slope: Floats, second: Floats) -> Course:
        bent = bend(self.surface, uv, slope, second)
        none, zero = np.full(len(uv), -1), np.zeros(len(uv), dtype=np.int64)
        return Course(
            frozen(bent.points), frozen(bent.normal), frozen(bent.angle), frozen(bent.slip),
            np.full(len(uv), int(Kind.JOIN)), zero, zero, none,
        )  # fmt: skip


def from_path(on: Ground, u: float, v: float, to: float, course: Floats) -> Spiral:
    """A way from (u, v) to the line `to`, at first as paths of this course (k,) lie and at last as a hoop."""
    return _bending(on, (u, v, to), course, lambda share, late: (share - late) / (1.0 - late))


def to_path(on: Ground, u: float, v: float, to: float, course: Floats, late: float | None = None) -> Spiral:
    """A way from a hoop at v to the line `to`, at last as paths of this course (k,) lie.

    late: share of the way on which it does, by default that with the least slip.  Ways with the same share turn as far,
    wherever they begin.
    """
    tries = _LATE if late is None else np.array([late])
    return _bending(on, (u, v, to), course, lambda share, late: 1.0 - share / (1.0 - late), tries)


def _bending(
    on: Ground, between: tuple[float, float, float], course: Floats, bend_at: Callable[[Floats, float], Floats],
    tries: Floats = _LATE,
) -> Spiral:  # fmt: skip
    """The way with the least slip of those that lie as a path for shares of it, and bend on the rest."""

    def tried(late: float) -> Spiral:
        way = on.way(*between, lambda share, v, hoop: _bent(on, v, hoop, course, bend_at(share, late)))
        return replace(way, late=float(late))

    return min(map(tried, tries), key=lambda way: way.slip)


def path_on(on: Ground, u: float, v: float, to: float, courses: tuple[Floats, Floats]) -> Spiral:
    """A way from (u, v) to the line `to`, at first as paths of one course (k,) lie and at last as those of another."""
    first, last = (np.asarray(each) for each in courses)

    def mixed(share: Floats, v: Floats, _: Floats) -> Floats:
        return np.asarray((1.0 - share) * np.interp(v, on.lines.v, first) + share * np.interp(v, on.lines.v, last))

    return on.way(u, v, to, mixed)


def between_hoops(on: Ground, u: float, v: float, to: float, friction: float) -> Spiral:
    """A way from a hoop at v to one on the line `to`: as steep as friction holds, or as needs least friction."""

    def tried(low: float) -> Spiral:
        return on.way(u, v, to, lambda share, _, hoop: hoop + (low - hoop) * np.sin(np.pi * share) ** 2)

    ways = []
    for low in np.linspace(_FLATTEST, 0.5 * np.pi, _TRIES):
        ways.append(tried(low))
        if ways[-1].slip <= friction:
            return ways[-1]
    return min(ways, key=lambda way: way.slip)


def _bent(on: Ground, v: Floats, hoop: Floats, course: Floats, share: Floats) -> Floats:
    """The angle of a path that bends to a hoop, at shares of the bend.

    On a cylinder the friction that is needed is the radius times the change of 1/sin(angle) over the distance along it.
    """
    path = np.interp(v, on.lines.v, course)
    inverse = [1.0 / np.sin(np.maximum(each, _FLATTEST)) for each in (path, hoop)]
    bent = inverse[0] + (inverse[1] - inverse[0]) * np.clip(share, 0.0, 1.0)
    return np.asarray(np.arcsin(np.minimum(1.0 / bent, 1.0)))


def _smooth(share: Floats) -> Floats:
    return np.asarray(share**2 * (3.0 - 2.0 * share))


def most_slip(course: Course) -> float:
    """Largest friction that a way needs; infinite where its fibre would lift."""
    return float(course.slip.max(initial=0.0))
