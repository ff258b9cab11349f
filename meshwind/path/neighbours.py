"""Distances between neighbouring paths of a family (Fig. 6.3)."""

from dataclasses import dataclass

import numpy as np
from numba import njit

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.path.paths import Paths

_SEAM = 1e-12
"""Starts closer than this to the seam from below, in turns, are on it, but for round-off."""


@dataclass(frozen=True)
class Neighbours:
    """The m pairs of paths of a family that are next to each other at the start rim.

    first, second (m,): paths; family (m,); distance (m, n): of each particle of `first` to the polyline of `second`, in
    the mesh's units, 0 where the particle lies beyond its ends; largest (m,): the larger of the largest distances from
    `first` to `second` and back.
    """

    first: Ints
    second: Ints
    family: Ints
    distance: Floats
    largest: Floats


def neighbours(paths: Paths) -> Neighbours:
    """Measure from each path to the next of its family around the start rim, and from the last to the first."""
    pairs = [_ring(paths, family) for family in (1, -1)]
    first, second = (np.concatenate(side).astype(np.int64) for side in zip(*pairs, strict=True))
    there, back = _one_way(paths, first, second), _one_way(paths, second, first)
    return Neighbours(*map(frozen, (first, second, paths.family[first], there, _larger(there, back))))


def apart(paths: Paths, first: Ints, second: Ints) -> Floats:
    """Largest distance (m,) between each path in `first` and its partner in `second`, either way."""
    return _larger(_one_way(paths, first, second), _one_way(paths, second, first))


def _larger(there: Floats, back: Floats) -> Floats:
    """The largest distance (m,) of both ways (m, n)."""
    return np.maximum(there.max(axis=1, initial=0.0), back.max(axis=1, initial=0.0))


def _one_way(paths: Paths, first: Ints, second: Ints) -> Floats:
    """Distances (m, n) of the particles of paths `first` to the polylines of paths `second`."""
    out = np.empty((len(first), paths.gap.shape[1]))
    _distances(paths.points, first.astype(np.int64), second.astype(np.int64), out)
    return out


def _ring(paths: Paths, family: int) -> tuple[Ints, Ints]:
    """Each path of a family and the next around the start rim; none where there is only one."""
    mine = np.flatnonzero(paths.family == family)
    if len(mine) < 2:
        return mine[:0], mine[:0]
    # by the start alone two paths from one pin could change places: the end decides between them
    order = np.lexsort((paths.uv[mine, -1, 0] - paths.uv[mine, 0, 0], np.mod(paths.uv[mine, 0, 0] + _SEAM, 1.0)))
    mine = mine[order]
    return mine, np.roll(mine, -1)


@njit(cache=True)
def _distances(points, first, second, out):
    """Write the distance of each particle of path first[m] to the polyline second[m], found by walking along it."""
    for m in range(len(first)):
        line = points[second[m]]
        near = 0
        for k in range(points.shape[1]):
            point = points[first[m], k]
            near = _nearest(point, line) if k == 0 else _walk(point, line, near)
            out[m, k] = _to_line(point, line, near)


@njit(inline="always", cache=True)
def _squared(a, b):
    """Squared distance of two points."""
    return (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2


@njit(cache=True)
def _nearest(point, line):
    """The vertex of a line nearest to a point, by a look at all of them."""
    best, near = np.inf, 0
    for j in range(len(line)):
        far = _squared(point, line[j])
        if far < best:
            best, near = far, j
    return near


@njit(cache=True)
def _walk(point, line, near):
    """The next local nearest vertex of a line from vertex `near`."""
    n = len(line)
    best = _squared(point, line[near])
    for step in (1, -1):
        j = near + step
        while 0 <= j < n:
            far = _squared(point, line[j])
            if far > best:
                break
            best, near = far, j
            j += step
    return near


@njit(cache=True)
def _to_line(point, line, near):
    """Distance of a point to a line whose vertex `near` is the nearest; 0 for a point beyond an end."""
    n = len(line)
    if (near == 0 and _beyond(point, line[0], line[1])) or (near == n - 1 and _beyond(point, line[-1], line[-2])):
        return 0.0
    least = _squared(point, line[near])
    for j in (near - 1, near):
        if 0 <= j < n - 1:
            least = min(least, _to_segment(point, line[j], line[j + 1]))
    return np.sqrt(least)


@njit(cache=True)
def _beyond(point, end, before):
    """Whether a point lies beyond the end of a line, where nothing is between them."""
    along = 0.0
    for d in range(3):
        along += (point[d] - end[d]) * (before[d] - end[d])
    return along < 0.0


@njit(cache=True)
def _to_segment(point, a, b):
    """Squared distance of a point to a segment."""
    square = _squared(a, b)
    t = 0.0
    if square > 0.0:
        for d in range(3):
            t += (point[d] - a[d]) * (b[d] - a[d])
        t = min(max(t / square, 0.0), 1.0)
    total = 0.0
    for d in range(3):
        total += (point[d] - a[d] - t * (b[d] - a[d])) ** 2
    return total
