"""Distances between neighbouring paths of a family (Fig. 6.3)."""

from dataclasses import dataclass

import numpy as np
from numba import njit

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.path.paths import Paths


@dataclass(frozen=True)
class Neighbours:
    """The m pairs of neighbours, next to each other at the start rim, of both families.

    first, second (m,): paths; family (m,); distance (m, n): of each particle of `first` to the fibre of `second`, in
    the mesh's units, 0 where that has ended before it comes abreast; largest (m,): the gap of each pair, either way.
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
    there = _one_way(paths, first, second)
    largest = np.maximum(there.max(axis=1, initial=0.0), _one_way(paths, second, first).max(axis=1, initial=0.0))
    return Neighbours(*map(frozen, (first, second, paths.family[first], there, largest)))


def apart(paths: Paths, first: Ints, second: Ints) -> Floats:
    """Largest distance (m,) between each path in `first` and its partner in `second`, either way."""
    there, back = _one_way(paths, first, second), _one_way(paths, second, first)
    return np.maximum(there.max(axis=1, initial=0.0), back.max(axis=1, initial=0.0))


def _one_way(paths: Paths, first: Ints, second: Ints) -> Floats:
    out = np.empty((len(first), paths.gap.shape[1]))
    _distances(paths.points, first.astype(np.int64), second.astype(np.int64), out)
    return out


def _ring(paths: Paths, family: int) -> tuple[Ints, Ints]:
    """Each path of a family and the next around the start rim; none where there is but one."""
    mine = np.flatnonzero(paths.family == family)
    if len(mine) < 2:
        return mine[:0], mine[:0]
    # by the start alone two paths from one pin could change places: the end decides between them
    order = np.lexsort((paths.uv[mine, -1, 0] - paths.uv[mine, 0, 0], np.mod(paths.uv[mine, 0, 0] + 1e-12, 1.0)))
    mine = mine[order]
    return mine, np.roll(mine, -1)


@njit(cache=True)
def _distances(points, first, second, out):
    """Distance of each particle of path first[m] to the polyline second[m], found by walking along it."""
    n = points.shape[1]
    for m in range(len(first)):
        line = points[second[m]]
        near = 0
        for k in range(n):
            point = points[first[m], k]
            if k == 0:  # the whole line once: the walk needs the right place to start from
                best = np.inf
                for j in range(n):
                    far = _squared(point, line[j])
                    if far < best:
                        best, near = far, j
            else:
                near = _walk(point, line, near)
            least = _squared(point, line[near])
            if (near == 0 and _past(point, line[0], line[1])) or (near == n - 1 and _past(point, line[-1], line[-2])):
                least = 0.0
            for j in (near - 1, near):
                if 0 <= j < n - 1 and least > 0.0:
                    least = min(least, _to_segment(point, line[j], line[j + 1]))
            out[m, k] = np.sqrt(least)


@njit(inline="always", cache=True)
def _squared(a, b):
    return (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2


@njit(cache=True)
def _past(point, end, before):
    """Whether a point lies beyond the end of a line, where nothing is between them."""
    along = 0.0
    for d in range(3):
        along += (point[d] - end[d]) * (before[d] - end[d])
    return along < 0.0


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
