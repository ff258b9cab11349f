"""Compiled: rays along fibres, by how much they pass the prism on a rim, and the first of them that do."""

from math import atan2, ceil, inf, sqrt
from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.kernel import njit
from meshwind.core.vectors import TINY
from meshwind.filament.line_meetings import Ring, meet, passed_at, point_at

_SHARES = 8
"""Parts of the way between two places, ends of all of which are tried."""
_ROUNDS = 48
"""Most rounds in which the place where a fibre leaves is found; five do where the part is smooth."""
_HALVED = 4
"""Rounds of which one halves the way that is left, however the others get on."""
_NEAR = 1e-13
"""Numbers of a particle, and lengths over the hull's, that are round-off: the last round to them is a short way."""
_WITHIN = 0.02
"""Depth below the rim, over the hull's perimeter, of what would be the prism within the part."""
_LEAP = 1e-6
"""Length over the hull's by which no ray that grazes the prism passes it by."""


class Fibres(NamedTuple):
    """Fibres of k particles that rays run along: points (m, k, 3), and whether their rim is that at the last.

    rows, sense (n,): whose the rays are, and +1 or -1 as in `Rays`; slopes: as `_slopes` has them.
    """

    points: Floats
    end: bool
    rows: Ints
    sense: Ints
    slopes: Floats


class Prism(NamedTuple):
    """A prism as kernels take it: as `Edge` has it, and the height at which pins catch fibres."""

    origin: Floats
    axis: Floats
    across: Floats
    ring: Ring
    lowest: float
    catch: float


class Looks(NamedTuple):
    """Rays at places on n fibres.

    point, ahead (n, 3): these, and outward unit tangents; length, passed: where they come into the prism, as `Meeting`;
    grazed, reach (n,): length along the hull where those that pass it by touch it or come nearest, and how far off.
    """

    point: Floats
    ahead: Floats
    length: Floats
    passed: Floats
    grazed: Floats
    reach: Floats


@njit(cache=True)
def ray(fibres, number, place, point, ahead):
    """Write the point and the outward unit tangent of ray `number` at a place.

    The fibre is a cubic between two particles; its tangents there are those of polynomials through some in a row.
    """
    points, slopes = fibres.points[fibres.rows[number]], fibres.slopes
    many, wide = len(points), len(slopes)
    index = min(int(place), many - 2)
    begin = min(max(index - (wide - 1) // 2, 0), many - wide - 1)
    at, s = index - begin, place - index
    # numbers of particles, from the rim on
    zero, way = (many - 1, -1) if fibres.end else (0, 1)
    size = 0.0
    for k in range(3):
        left = right = 0.0
        # the tangents at both ends, from the first points and from the last but the first
        for j in range(wide):
            left += slopes[at, j] * points[zero + way * (begin + j), k]
            right += slopes[at, j] * points[zero + way * (begin + j + 1), k]
        a, b = points[zero + way * index, k], points[zero + way * (index + 1), k]
        rise = b - a
        point[k] = a + (3.0 - 2.0 * s) * s * s * rise + (s**3 - 2.0 * s**2 + s) * left + (s**3 - s**2) * right
        ahead[k] = -(6.0 * s * (1.0 - s) * rise + (3.0 * s**2 - 4.0 * s + 1.0) * left + (3.0 * s**2 - 2.0 * s) * right)
        size += ahead[k] * ahead[k]
    size = sqrt(size)
    for k in range(3):
        ahead[k] = ahead[k] / size if size > 0.0 else 0.0


@njit(cache=True)
def along(prism, vector):
    """The part of a vector along the axis."""
    return vector[0] * prism.axis[0] + vector[1] * prism.axis[1] + vector[2] * prism.axis[2]


@njit(cache=True)
def flat(prism, vector):
    """A vector as seen along the axis."""
    x = vector[0] * prism.across[0, 0] + vector[1] * prism.across[0, 1] + vector[2] * prism.across[0, 2]
    y = vector[0] * prism.across[1, 0] + vector[1] * prism.across[1, 1] + vector[2] * prism.across[1, 2]
    return x, y


@njit(cache=True)
def graze(prism, off, ahead, sense):
    """Length along the hull where a ray that passes the prism by touches it, or comes nearest, and how far off.

    There its normal is square to the ray.  off: its start from the prism's origin.
    """
    x, y = flat(prism, off)
    wx, wy = flat(prism, ahead)
    grazed = passed_at(prism.ring, atan2(-sense * wx, sense * wy))
    hx, hy = point_at(prism.ring, grazed)
    return grazed, ((hx - x) * wx + (hy - y) * wy) / max(wx * wx + wy * wy, TINY)


@njit(cache=True)
def beyond(prism, fibres, number, place, off, ahead):
    """Length, over the hull's, by which a ray at a place passes the prism by, or meets it above the pins.

    It is endless below where the ray would touch the prism within the part, as beside a notch.
    """
    ray(fibres, number, place, off, ahead)
    for k in range(3):
        off[k] -= prism.origin[k]
    x, y = flat(prism, off)
    wx, wy = flat(prism, ahead)
    perimeter = prism.ring.passed[-1]
    length, _, depth = meet(prism.ring, x, y, wx, wy)
    if length < inf:
        return max(-depth, along(prism, off) + length * along(prism, ahead) - prism.catch) / perimeter
    if along(prism, off) + graze(prism, off, ahead, fibres.sense[number])[1] * along(prism, ahead) < (
        prism.lowest - _WITHIN * perimeter
    ):
        return -inf
    # one that has the prism behind it passes by as well
    return abs(depth) / perimeter


@njit(cache=True)
def settled(prism, fibres, number, low, high, off, ahead):
    """Place between two of a ray, and whether it grazes the prism there or comes to the pins.

    low, high: places and values there, the first negative.  On a rough part what is beyond may begin with a leap, where
    no fibre lies on both.
    """
    (a, under), (b, above) = low, high
    value, middle, passes = above, b, above
    # false position as in the Illinois method: an end that stays counts half
    stayed = 0
    for turn in range(_ROUNDS):
        share = 0.5
        if turn % _HALVED != _HALVED - 1 and under < 0.0 and above - under < inf:
            share = -under / (above - under)
        middle = a + share * (b - a)
        value = beyond(prism, fibres, number, middle, off, ahead)
        if value >= 0.0:
            b, above, passes = middle, value, value
            under *= 0.5 if stayed > 0 else 1.0
            stayed = 1
        else:
            a, under = middle, value
            above *= 0.5 if stayed < 0 else 1.0
            stayed = -1
        if min(b - a, abs(value)) < _NEAR:
            break
    return (middle if abs(value) < _NEAR else b), min(passes, abs(value)) < _LEAP


@njit(nogil=True, cache=True)
def leave(first, last, prism, fibres, farthest, place, found):
    """Write the places nearest to the rim from which rays first to last pass the prism by, and which have one.

    Rays are tried ever further from the rim; where that leads within the part, from every particle.
    """
    off, ahead = np.empty(3), np.empty(3)
    for number in range(first, last):
        low, step, within = 0.0, 1.0, False
        under = beyond(prism, fibres, number, low, off, ahead)
        high, above = low, under
        for every in range(2):
            if every and not within:
                break
            if every:
                low, under = 0.0, beyond(prism, fibres, number, 0.0, off, ahead)
            end = ceil(farthest) if every else farthest
            while True:
                within |= under == -inf
                high = low + 1.0 if every else min(step, end)
                above = beyond(prism, fibres, number, high, off, ahead)
                if above >= 0.0 or high >= end:
                    break
                low, under, step = high, above, 2.0 * step
            within |= above == -inf
            if above >= 0.0:
                break
        found[number] = above >= 0.0
        place[number] = high
        if not found[number]:
            continue
        # the first of some places between
        start, wide = low, high - low
        for k in range(1, _SHARES):
            here = start + wide * k / _SHARES
            value = beyond(prism, fibres, number, here, off, ahead)
            if value >= 0.0:
                high, above = here, value
                break
            low, under = here, value
        place[number], found[number] = settled(prism, fibres, number, (low, under), (high, above), off, ahead)


@njit(nogil=True, cache=True)
def look(first, last, prism, fibres, place, looks):
    """Write rays first to last at places (n,)."""
    for i in range(first, last):
        off, ahead = looks.point[i], looks.ahead[i]
        ray(fibres, i, place[i], off, ahead)
        for k in range(3):
            off[k] -= prism.origin[k]
        x, y = flat(prism, off)
        wx, wy = flat(prism, ahead)
        looks.length[i], looks.passed[i], _ = meet(prism.ring, x, y, wx, wy)
        looks.grazed[i], looks.reach[i] = graze(prism, off, ahead, fibres.sense[i])
        for k in range(3):
            off[k] += prism.origin[k]


@njit(nogil=True, cache=True)
def look_ahead(first, last, fibres, place, point, ahead):
    """Write the points and the tangents (n, 3) of rays first to last at places (n,)."""
    for i in range(first, last):
        ray(fibres, i, place[i], point[i], ahead[i])
