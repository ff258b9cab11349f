"""Rays against a search tree of triangles: the triangle that each meets first, and how far away it is."""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.kernel import njit
from meshwind.core.threads import parallel_for
from meshwind.mesh.geometry.facet_tree import LEAF, FacetTree, meets

_BLOCK = 500
"""Fewest rays that are worth a thread."""
DEEPEST = 64
"""Most nodes of a tree that are still to be looked at: one a level and one more."""
_WIDER = 1e-9
"""Share by which triangles count as wider, so that no ray slips through between two of them."""


def cast(tree: FacetTree, start: Floats, ray: Floats, least: float) -> tuple[Ints, Floats]:
    """The face (k,) that each ray from `start` along the unit vectors `ray` (k, 3) meets first, and its distance (k,).

    Faces nearer than `least` are passed through, as that of the start is; where nothing is met, -1 and infinity.
    """
    met = _Met(np.empty(len(start), np.int64), np.empty(len(start)))
    parallel_for(_cast, len(start), _BLOCK, boxes_of(tree), _Rays(frozen(start), frozen(ray), least), met)
    return met.face, met.distance


class Boxes(NamedTuple):
    """The arrays of a FacetTree, as kernels take them."""

    corners: Floats
    numbers: Ints
    boxes: Floats


def boxes_of(tree: FacetTree) -> Boxes:
    """A tree for kernels."""
    return Boxes(tree.corners, tree.numbers, tree.boxes)


class _Rays(NamedTuple):
    """Starts (k, 3) and unit vectors (k, 3) of rays, and the distance within which they meet nothing."""

    start: Floats
    ray: Floats
    least: float


class _Met(NamedTuple):
    """The face (k,) that each ray meets first and its distance (k,), to be filled in."""

    face: Ints
    distance: Floats


@njit(forceinline=True, cache=True)
def _enters(boxes: Floats, box: int, x: float, y: float, z: float, ax: float, ay: float, az: float) -> float:
    """Distance at which the ray enters a box (Kay and Kajiya 1986), infinity where it misses; a: 1 over its vector."""
    if boxes[box, 0] > boxes[box, 3]:  # a node without triangles
        return np.inf
    a, b = (boxes[box, 0] - x) * ax, (boxes[box, 3] - x) * ax
    low, high = min(a, b), max(a, b)
    a, b = (boxes[box, 1] - y) * ay, (boxes[box, 4] - y) * ay
    low, high = max(low, min(a, b)), min(high, max(a, b))
    a, b = (boxes[box, 2] - z) * az, (boxes[box, 5] - z) * az
    low, high = max(low, min(a, b)), min(high, max(a, b))
    # a billionth wider, so that round-off loses no flat box
    return low if high >= 0.0 and low <= high + 1e-9 * abs(high) else np.inf


@njit(forceinline=True, cache=True)
def _inverse(d: float) -> float:
    """1 over a component of the ray, finite so that 0 times it is a number."""
    return 1.0 / d if abs(d) > 1e-100 else 1e100


@njit(nogil=True, cache=True)
def _cast(first: int, last: int, tree: Boxes, rays: _Rays, met: _Met) -> None:
    """The faces that the rays first to last meet first."""
    stack, far = np.empty(DEEPEST, np.int64), np.empty(DEEPEST)
    for i in range(first, last):
        found, reach = first_met(tree, rays.start[i], rays.ray[i], rays.least, stack, far)
        met.face[i] = tree.numbers[found] if found >= 0 else -1
        met.distance[i] = reach


@njit(nogil=True, cache=True)
def first_met(tree: Boxes, start: Floats, ray: Floats, least: float, stack: Ints, far: Floats) -> tuple[int, float]:
    """The triangle, by its place in the tree, that a ray meets first beyond `least`, and its distance; -1 and infinity.

    stack, far (DEEPEST,) are for the tree's nodes that are still to be looked at.
    """
    corners, numbers, boxes = tree.corners, tree.numbers, tree.boxes
    leaves = len(boxes) // 2
    x, y, z, dx, dy, dz = start[0], start[1], start[2], ray[0], ray[1], ray[2]
    ax, ay, az = _inverse(dx), _inverse(dy), _inverse(dz)
    found, reach = -1, np.inf
    stack[0], far[0], size = 1, 0.0, 1
    while size > 0:
        size -= 1
        box = stack[size]
        if far[size] >= reach:
            continue
        if box >= leaves:
            for m in range((box - leaves) * LEAF, min((box - leaves + 1) * LEAF, len(corners))):
                t = meets(corners[m], x, y, z, dx, dy, dz, _WIDER)
                if least < t < reach or (found >= 0 and t == reach and numbers[m] < numbers[found]):
                    reach, found = t, m
            continue
        one, two = _enters(boxes, 2 * box, x, y, z, ax, ay, az), _enters(boxes, 2 * box + 1, x, y, z, ax, ay, az)
        # the nearer half last, so that it is looked at first
        swap = 1 if one < two else 0
        if max(one, two) < reach:
            stack[size], far[size] = 2 * box + swap, max(one, two)
            size += 1
        if min(one, two) < reach:
            stack[size], far[size] = 2 * box + 1 - swap, min(one, two)
            size += 1
    return found, reach
