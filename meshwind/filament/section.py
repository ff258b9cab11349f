"""A convex section of a prism: what a fibre in a turnaround beyond a rim lies on."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.filament.line_meetings import Ring

_HOLLOW = 1e-9
"""Turn of the normal backwards, in radians, that is round-off."""


@dataclass(frozen=True)
class Section:
    """A closed convex curve on points (n, 2), the last of which is not the first again.

    turned, passed (n,): the angle of its normal, growing, and the length up to each point; perimeter.  Lengths along
    it are unwrapped: a perimeter more is the same point a turn later.
    """

    points: Floats
    turned: Floats
    passed: Floats
    perimeter: float

    __repr__ = brief

    def at(self, passed: Floats) -> Floats:
        """Points (n, 2) at lengths (n,) along the section."""
        rest, loop = np.mod(passed, self.perimeter), np.append(self.passed, self.perimeter)
        closed = np.concatenate([self.points, self.points[:1]])
        return np.stack([np.interp(rest, loop, closed[:, k]) for k in (0, 1)], axis=1)

    def normal_angle(self, passed: Floats) -> Floats:
        """Angle (n,) of the normal at lengths (n,) along the section, unwrapped."""
        whole, rest = np.divmod(np.asarray(passed), self.perimeter)
        return np.asarray(whole * 2.0 * np.pi + np.interp(rest, *self._loop))

    def passed_at(self, turned: Floats) -> Floats:
        """Lengths (n,) along the section where its normal has the angles (n,), unwrapped."""
        loop, angles = self._loop
        whole, rest = np.divmod(np.asarray(turned) - angles[0], 2.0 * np.pi)
        return np.asarray(whole * self.perimeter + np.interp(rest + angles[0], angles, loop))

    @cached_property
    def ring(self) -> Ring:
        """The section as kernels take it."""
        sides = np.roll(self.points, -1, axis=0) - self.points
        angle = np.unwrap(np.arctan2(-sides[:, 0], sides[:, 1]))
        facing = (angle + 2.0 * np.pi * np.arange(3)[:, None]).ravel()
        size = np.hypot(sides[:, 0], sides[:, 1])
        passed, turned = self._loop
        return Ring(self.points, frozen(sides), frozen(size), frozen(facing), frozen(passed), frozen(turned))

    @cached_property
    def _loop(self) -> tuple[Floats, Floats]:
        """Lengths and angles of the normal (n + 1,) all around, the first point once more at the end."""
        return np.append(self.passed, self.perimeter), np.append(self.turned, self.turned[0] + 2.0 * np.pi)


def section(points: ArrayLike) -> Section:
    """Take a convex section from points (n, 2) on it, in the sense in which it is passed.

    Raises
    ------
    BadInputError
        If there are too few points, or the section is not convex.
    """
    ring = floats(points, "points", -1, 2)
    if len(ring) < 3:
        raise BadInputError(f"a section of {len(ring)} points is no curve; give at least 3")
    way = np.roll(ring, -1, axis=0) - ring
    size = np.hypot(way[:, 0], way[:, 1])
    if not (size > 0.0).all():
        raise BadInputError("two points of the section coincide; give each once")
    heading = np.arctan2(way[:, 1], way[:, 0])
    bend = (heading - np.roll(heading, 1) + np.pi) % (2.0 * np.pi) - np.pi
    if abs(bend.sum() - 2.0 * np.pi) > 1e-6:
        raise BadInputError("the section is not passed once against the clock; give its points in that sense")
    if bend.min() < -_HOLLOW:
        raise BadInputError("the section is hollow somewhere; a fibre that turns on its collar would not press there")
    # the normal at a point is half-way between those of its two edges
    at_edge = heading[0] - 0.5 * np.pi + np.concatenate([[0.0], np.cumsum(bend[1:])])
    return Section(frozen(ring), frozen(at_edge - 0.5 * bend), frozen(np.append(0.0, np.cumsum(size[:-1]))), size.sum())
