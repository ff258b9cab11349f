"""Compiled: where lines come into a convex section, and where its normal has an angle."""

from math import atan2, ceil, floor, hypot, inf, pi
from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.kernel import njit


class Meeting(NamedTuple):
    """Where lines come into a section: lengths along them, 0 inside and infinite where they pass by or have left it.

    passed: lengths along the section there; depth: how far lines lead through it, seen along them, from its nearer
    side, negative where they pass by.  All (n,).
    """

    length: Floats
    passed: Floats
    depth: Floats


class Ring(NamedTuple):
    """A convex section of n points: these (n, 2), its edges to the next ones (n, 2), and their lengths (n,).

    facing (3 n,): angles of the normals of the edges, growing, in three loops; passed, turned (n + 1,): length up to
    each point and the angle of the normal there, the first point once more at the end.
    """

    points: Floats
    sides: Floats
    sizes: Floats
    facing: Floats
    passed: Floats
    turned: Floats


@njit(cache=True)
def between(x, at, values):
    """Value at x, which lies within the growing places `at` (n,), between values (n,)."""
    k = min(max(np.searchsorted(at, x, side="right") - 1, 0), len(at) - 2)
    span = at[k + 1] - at[k]
    share = (x - at[k]) / span if span > 0.0 else 0.0
    return values[k] + share * (values[k + 1] - values[k])


@njit(cache=True)
def passed_at(ring, turned):
    """Length along the section where its normal has an angle, unwrapped."""
    more = turned - ring.turned[0]
    whole = floor(more / (2.0 * pi))
    return whole * ring.passed[-1] + between(more - 2.0 * pi * whole + ring.turned[0], ring.turned, ring.passed)


@njit(cache=True)
def point_at(ring, passed):
    """Point of the section at a length along it."""
    count, perimeter = len(ring.points), ring.passed[-1]
    rest = passed - perimeter * floor(passed / perimeter)
    k = min(max(np.searchsorted(ring.passed, rest, side="right") - 1, 0), count - 1)
    share = (rest - ring.passed[k]) / ring.sizes[k]
    return ring.points[k, 0] + share * ring.sides[k, 0], ring.points[k, 1] + share * ring.sides[k, 1]


@njit(cache=True)
def left_of(ring, x, y, wx, wy, corner):
    """How far a corner lies to the left of a line, times the size of its direction."""
    k = corner % len(ring.points)
    return wx * (ring.points[k, 1] - y) - wy * (ring.points[k, 0] - x)


@njit(cache=True)
def crossed(ring, x, y, wx, wy, low, high):
    """The edge, between two corners, on which these come to the left of a line, and how far along the line."""
    while high - low > 1:
        middle = (low + high) // 2
        if left_of(ring, x, y, wx, wy, middle) >= 0.0:
            low = middle
        else:
            high = middle
    k = low % len(ring.points)
    ex, ey = ring.sides[k, 0], ring.sides[k, 1]
    cross = ey * wx - ex * wy
    return k, (ey * (ring.points[k, 0] - x) - ex * (ring.points[k, 1] - y)) / cross


@njit(cache=True)
def meet(ring, x, y, wx, wy):
    """Where a line from a point in a direction comes into the section, as the three numbers of `Meeting`.

    On the edges that face a line the side of it that a corner lies on changes once, which is found by halving.
    """
    facing, count = ring.facing, len(ring.points)
    ahead = atan2(wy, wx) + 0.5 * pi
    ahead += 2.0 * pi * ceil((facing[0] - ahead) / (2.0 * pi))
    low = np.searchsorted(facing, ahead, side="right")
    high = np.searchsorted(facing, ahead + pi, side="left")
    depth = min(left_of(ring, x, y, wx, wy, low), -left_of(ring, x, y, wx, wy, high)) / hypot(wx, wy)
    k, off = crossed(ring, x, y, wx, wy, low, high)
    ex, ey = x + off * wx - ring.points[k, 0], y + off * wy - ring.points[k, 1]
    along = (ex * ring.sides[k, 0] + ey * ring.sides[k, 1]) / ring.sizes[k]
    length = inf
    if depth > 0.0:
        if off > 0.0:
            length = off
        # of lines that came in before, those that have not gone out again are inside
        elif crossed(ring, x, y, -wx, -wy, high, low + count)[1] < 0.0:
            length = 0.0
    return length, ring.passed[k] + along, depth


@njit(cache=True)
def meet_all(ring, start, way, found):
    """Write where lines from points (n, 2) with directions (n, 2) come into the section."""
    for i in range(len(start)):
        length, passed, depth = meet(ring, start[i, 0], start[i, 1], way[i, 0], way[i, 1])
        found.length[i], found.passed[i], found.depth[i] = length, passed, depth
