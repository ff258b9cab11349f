"""Compiled search for the meetings of two sets of segments on the rectangle that is periodic in u."""

from math import ceil, floor

import numpy as np
from numba import njit

from meshwind.core.cast import Floats, Ints

REACH = 1e-9
"""How far past its ends a segment still meets another, in its own lengths; the doubles are merged later."""


@njit(inline="always", cache=True)
def _columns(low: float, high: float, count: int) -> tuple[int, int]:
    """First column and number of columns that [low, high] covers; columns repeat with period 1."""
    first = floor((low - REACH) * count)
    return first, min(floor((high + REACH) * count) - first + 1, count)


@njit(inline="always", cache=True)
def _rows(low: float, high: float, count: int) -> tuple[int, int]:
    """First and last row that [low, high] covers, clipped to the grid."""
    first, last = floor((low - REACH) * count), floor((high + REACH) * count)
    return min(max(first, 0), count - 1), min(max(last, 0), count - 1)


@njit(cache=True)
def _bins(segments: Floats, nu: int, nv: int) -> tuple[Ints, Ints]:
    """Row starts (nu * nv + 1) and segment numbers of every cell that a segment's bounding box touches."""
    starts = np.zeros(nu * nv + 1, np.int64)
    members = np.empty(0, np.int64)
    for filling in range(2):  # count first, then fill from the back
        for k in range(len(segments)):
            u0, v0, u1, v1 = segments[k, 0], segments[k, 1], segments[k, 2], segments[k, 3]
            first, width = _columns(min(u0, u1), max(u0, u1), nu)
            low, high = _rows(min(v0, v1), max(v0, v1), nv)
            for i in range(first, first + width):
                for j in range(low, high + 1):
                    cell = (i % nu) * nv + j
                    if filling:
                        starts[cell] -= 1
                        members[starts[cell]] = k
                    else:
                        starts[cell] += 1
        if not filling:
            starts = np.cumsum(starts)
            members = np.empty(starts[-1], np.int64)
    return starts, members


@njit(inline="always", cache=True)
def _meet(a: Floats, b: Floats, turn: float) -> tuple[float, float, float]:
    """Fractions along a and along b (moved by `turn`) where they meet, and d_a x d_b; 0 where they do not."""
    du, dv, eu, ev = a[2] - a[0], a[3] - a[1], b[2] - b[0], b[3] - b[1]
    cross = du * ev - dv * eu
    if abs(cross) <= 1e-14 * np.hypot(du, dv) * np.hypot(eu, ev):
        return 0.0, 0.0, 0.0
    wu, wv = b[0] + turn - a[0], b[1] - a[1]
    s, r = (wu * ev - wv * eu) / cross, (wu * dv - wv * du) / cross
    if s < -REACH or s > 1.0 + REACH or r < -REACH or r > 1.0 + REACH:
        return 0.0, 0.0, 0.0
    return s, r, cross


@njit(cache=True)
def meetings(a: Floats, b: Floats, nu: int, nv: int) -> tuple[Ints, Ints, Floats, Floats, Floats]:
    """Every meeting of a segment of a (m, 4) with one of b (k, 4), rows u0, v0, u1, v1, modulo turns.

    Returns the segments' numbers, the fractions along them and the sign of d_a x d_b.  The cells (nu x nv)
    should be about a segment wide: then the cost is that of the meetings themselves.
    """
    starts, members = _bins(b, nu, nv)
    seen = np.full(len(b), -1)
    capacity, found = 1024, 0
    pairs, where = np.empty((capacity, 2), np.int64), np.empty((capacity, 3))
    for k in range(len(a)):
        low_u, high_u = min(a[k, 0], a[k, 2]), max(a[k, 0], a[k, 2])
        first, width = _columns(low_u, high_u, nu)
        low, high = _rows(min(a[k, 1], a[k, 3]), max(a[k, 1], a[k, 3]), nv)
        for i in range(first, first + width):
            for j in range(low, high + 1):
                cell = (i % nu) * nv + j
                for m in members[starts[cell] : starts[cell + 1]]:
                    if seen[m] == k:  # met already in another cell that both touch
                        continue
                    seen[m] = k
                    turn = ceil(low_u - max(b[m, 0], b[m, 2]) - REACH)
                    last = floor(high_u - min(b[m, 0], b[m, 2]) + REACH)
                    while turn <= last:
                        s, r, cross = _meet(a[k], b[m], float(turn))
                        if cross != 0.0:
                            if found == capacity:
                                pairs = np.concatenate((pairs, np.empty_like(pairs)))
                                where = np.concatenate((where, np.empty_like(where)))
                                capacity *= 2
                            pairs[found, 0], pairs[found, 1] = k, m
                            where[found, 0], where[found, 1], where[found, 2] = s, r, np.sign(cross)
                            found += 1
                        turn += 1
    return pairs[:found, 0], pairs[:found, 1], where[:found, 0], where[:found, 1], where[:found, 2]
