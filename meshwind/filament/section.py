"""A convex section of a prism: what a fibre in a turnaround beyond a rim lies on."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from meshwind.core.cast import Floats, Ints, floats, frozen
from meshwind.core.errors import BadInputError

_HOLLOW = 1e-9
"""Turn of the normal backwards, in radians, that is round-off."""


class Meeting(NamedTuple):
    """Where lines come into a section: lengths along them, 0 inside and infinite where they pass by or have left it.

    passed: lengths along the section there; depth: how far lines lead through it, seen along them, from its nearer
    side, negative where they pass by.  All (n,).
    """

    length: Floats
    passed: Floats
    depth: Floats


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

    def met(self, start: Floats, way: Floats) -> Meeting:
        """Where lines from points (n, 2) with directions (n, 2) come into the section.

        On the edges that face a line the side of it that a corner lies on changes once, which is found by halving.
        """
        facing, count = self._facing, len(self.points)
        ahead = np.arctan2(way[:, 1], way[:, 0]) + 0.5 * np.pi
        ahead += 2.0 * np.pi * np.ceil((facing[0] - ahead) / (2.0 * np.pi))
        low = np.searchsorted(facing, ahead, side="right")
        high = np.searchsorted(facing, ahead + np.pi, side="left")
        left = self._left(start, way, low), self._left(start, way, high)
        depth = np.minimum(left[0], -left[1]) / np.hypot(way[:, 0], way[:, 1])
        side, off = self._crossed(start, way, low, high)
        along = ((start + off[:, None] * way - self.points[side]) * self._sides[side]).sum(axis=1) / self._sizes[side]
        through = depth > 0.0
        length = np.where(through & (off > 0.0), off, np.inf)
        behind = np.flatnonzero(through & ~(off > 0.0))
        if len(behind):
            # of lines that came in before, those that have not gone out again are inside
            out = self._crossed(start[behind], -way[behind], high[behind], low[behind] + count)[1]
            length[behind[out < 0.0]] = 0.0
        return Meeting(length, self.passed[side] + along, depth)

    def _crossed(self, start: Floats, way: Floats, low: Ints, high: Ints) -> tuple[Ints, Floats]:
        """The edges (n,), between two corners each, on which these come to the left of lines, and how far along."""
        count = len(self.points)
        x, y = self._corners
        level = way[:, 0] * start[:, 1] - way[:, 1] * start[:, 0]
        for _ in range(int((high - low).max(initial=1)).bit_length()):
            middle = (low + high) // 2
            there = way[:, 0] * y[middle] - way[:, 1] * x[middle] >= level
            low, high = np.where(there, middle, low), np.where(there, high, np.maximum(middle, low + 1))
        side = low % count
        corner, edge = self.points[side], self._sides[side]
        cross = edge[:, 1] * way[:, 0] - edge[:, 0] * way[:, 1]
        return side, (edge[:, 1] * (corner - start)[:, 0] - edge[:, 0] * (corner - start)[:, 1]) / cross

    def _left(self, start: Floats, way: Floats, corner: Ints) -> Floats:
        """How far corners (n,) lie to the left of lines, times the size of their directions."""
        off = self.points[corner % len(self.points)] - start
        return np.asarray(way[:, 0] * off[:, 1] - way[:, 1] * off[:, 0])

    @cached_property
    def _corners(self) -> tuple[Floats, Floats]:
        """Both coordinates of the points, in four loops."""
        return np.tile(self.points[:, 0], 4), np.tile(self.points[:, 1], 4)

    @cached_property
    def _sizes(self) -> Floats:
        """Lengths (n,) of the edges."""
        return np.hypot(self._sides[:, 0], self._sides[:, 1])

    @cached_property
    def _sides(self) -> Floats:
        """Edges (n, 2), from each point to the next."""
        return np.roll(self.points, -1, axis=0) - self.points

    @cached_property
    def _facing(self) -> Floats:
        """Angles (3 n,) of the normals of the edges, growing, in three loops."""
        angle = np.unwrap(np.arctan2(-self._sides[:, 0], self._sides[:, 1]))
        return np.asarray((angle + 2.0 * np.pi * np.arange(3)[:, None]).ravel())

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
