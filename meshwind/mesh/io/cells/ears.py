"""Polygons cut by ears: corner after corner is taken off, the best shaped triangle first."""

import numpy as np

from meshwind.core.kernel import njit

_THIN = 1e-9
"""Shape of a triangle, twice its area by the sum of its squared sides, up to which it has no area."""
_NEAR = 1e-7
"""Distance from an ear's new side, by its length, at which a corner counts as on it; unless nothing else is left."""


@njit(forceinline=True, cache=True)
def _turn(flat, a, b, c):
    """Twice the area of a triangle, negative if it runs clockwise."""
    return (flat[b, 0] - flat[a, 0]) * (flat[c, 1] - flat[a, 1]) - (flat[b, 1] - flat[a, 1]) * (flat[c, 0] - flat[a, 0])


@njit(cache=True, nogil=True)
def _shape(flat, a, b, c):
    """Twice the area of a triangle by the sum of its squared sides: 0.29 if it is equilateral."""
    sides = (
        (flat[b, 0] - flat[a, 0]) ** 2 + (flat[b, 1] - flat[a, 1]) ** 2
        + (flat[c, 0] - flat[b, 0]) ** 2 + (flat[c, 1] - flat[b, 1]) ** 2
        + (flat[a, 0] - flat[c, 0]) ** 2 + (flat[a, 1] - flat[c, 1]) ** 2
    )  # fmt: skip
    return _turn(flat, a, b, c) / sides if sides > 0.0 else 0.0


@njit(forceinline=True, cache=True)
def _same(flat, a, b):
    return flat[a, 0] == flat[b, 0] and flat[a, 1] == flat[b, 1]


@njit(cache=True, nogil=True)
def _blocker(flat, ring, reflex, near, ear):
    """A corner for which an ear cannot be cut, -1 if there is none.

    It lies in the ear or on its new side.  One at the ear's tip, where the polygon touches itself, is in the way if the
    polygon goes on from there into the ear; at the new side's ends that would need a further corner inside.
    ring (2, k): the corners before and after each; reflex: corners to be tried, their number first; near: how far
    from the new side they may be.
    """
    a, b, c = ring[0, ear], ear, ring[1, ear]
    least = -near * ((flat[c, 0] - flat[a, 0]) ** 2 + (flat[c, 1] - flat[a, 1]) ** 2)
    for at in range(1, reflex[0] + 1):
        v = reflex[at]
        if ring[0, v] < 0 or v in (a, b, c) or _same(flat, v, a) or _same(flat, v, c):
            continue
        if _same(flat, v, b):
            for other in (ring[0, v], ring[1, v]):
                if _turn(flat, a, b, other) > 0.0 and _turn(flat, b, c, other) > 0.0:
                    return v
        elif _turn(flat, a, b, v) >= 0.0 and _turn(flat, b, c, v) >= 0.0 and _turn(flat, c, a, v) >= least:
            return v
    return -1


@njit(cache=True, nogil=True)
def _next_ear(flat, ring, reflex, shape, blocked, near):
    """The best shaped corner that can be cut, -1 if there is none; for the arguments see `_blocker`."""
    count = 0
    for at in range(1, reflex[0] + 1):  # those that were cut, or are no longer reflex, leave the list
        v = reflex[at]
        if ring[0, v] >= 0 and shape[v] <= _THIN:
            count += 1
            reflex[count] = v
    reflex[0] = count
    while True:
        best, best_shape = -1, _THIN
        for v in range(len(shape)):
            if ring[0, v] < 0:
                continue
            if shape[v] > best_shape and (blocked[v] < 0 or ring[0, blocked[v]] < 0):
                best, best_shape = v, shape[v]
        if best < 0:
            return -1
        blocked[best] = _blocker(flat, ring, reflex, near, best)
        if blocked[best] < 0:
            return best


@njit(cache=True, nogil=True)
def _flattest(ring, shape):
    """A corner whose ear has no area, -1 if there is none."""
    for v in range(len(shape)):
        if ring[0, v] >= 0 and abs(shape[v]) <= _THIN:
            return v
    return -1


@njit(cache=True, nogil=True)
def _cut(flat, triangles):
    """Write the triangles (k - 2, 3) of a counterclockwise polygon; False if it crosses itself."""
    size = len(flat)
    ring = np.empty((2, size), dtype=np.int64)
    shape = np.empty(size)
    reflex = np.zeros(3 * size + 1, dtype=np.int64)
    for v in range(size):
        ring[0, v], ring[1, v] = (v - 1) % size, (v + 1) % size
        shape[v] = _shape(flat, ring[0, v], v, ring[1, v])
        reflex[v + 1] = v
    reflex[0] = size
    blocked = np.full(size, -1)
    last = 0
    for step in range(size - 3):
        ear = _next_ear(flat, ring, reflex, shape, blocked, _NEAR)
        if ear < 0:  # what touched the polygon from within may have been cut
            blocked[:] = -1
            ear = _next_ear(flat, ring, reflex, shape, blocked, 0.0)
        if ear < 0:
            ear = _flattest(ring, shape)
        if ear < 0:
            return False
        a, c = ring[0, ear], ring[1, ear]
        triangles[step, 0], triangles[step, 1], triangles[step, 2] = a, ear, c
        ring[1, a], ring[0, c], ring[0, ear] = c, a, -1
        for v in (a, c):
            was = shape[v]
            shape[v] = _shape(flat, ring[0, v], v, ring[1, v])
            blocked[v] = -1
            if was > _THIN and shape[v] <= _THIN:
                reflex[0] += 1
                reflex[reflex[0]] = v
        last = a
    a, c = ring[0, last], ring[1, last]
    triangles[size - 3, 0], triangles[size - 3, 1], triangles[size - 3, 2] = a, last, c
    return _shape(flat, a, last, c) >= -_THIN


@njit(cache=True, nogil=True)
def cut_by_ears(flat, first, triangles, start):
    """Cut counterclockwise polygons, with the corners flat[first[p] : first[p + 1]] (n, 2).

    Writes the triangles of p from start[p] on, by the places of corners in their polygon, and returns which polygons
    cross themselves, so that their triangles are of no use.
    """
    crossed = np.zeros(len(start), dtype=np.bool_)
    for p in range(len(start)):
        size = first[p + 1] - first[p]
        crossed[p] = not _cut(flat[first[p] : first[p + 1]], triangles[start[p] : start[p] + size - 2])
    return crossed
