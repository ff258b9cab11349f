"""The faces of a planar graph, traced from the order of the half-edges around each node."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from meshwind.core.cast import Bools, Floats, Ints


def trace(tail: Ints, angle: Floats, outer: Bools) -> list[Ints] | None:
    """Polygons to the left of the half-edges, grouped by size: arrays (m, 3), (m, 4), ... of node indices.

    Half-edges (h,) come in twin pairs 2e, 2e + 1; angle is that of leaving the tail; outer marks half-edges
    whose face is the void.  Faces of two edges, where two fibres meet twice with nothing between, vanish.
    None where a face touches itself, that is where the graph is no mesh.
    """
    following = _following(tail, angle)
    count = len(tail)
    links = coo_array((np.ones(count), (np.arange(count), following)), shape=(count, count))
    _, face = connected_components(links, directed=False)
    void = np.zeros(count, dtype=bool)
    void[face[outer]] = True
    if not np.array_equal(void[face], outer):
        return None
    first, size = np.unique(face, return_index=True, return_counts=True)[1:]
    first, size = first[~void[face[first]]], size[~void[face[first]]]
    polygons = []
    for n in np.unique(size):
        corner, edge = np.empty((int((size == n).sum()), n), dtype=np.int64), first[size == n]
        for k in range(n):
            corner[:, k] = tail[edge]
            edge = following[edge]
        if (np.diff(np.sort(corner, axis=1), axis=1) == 0).any() or n < 2:
            return None
        if n > 2:
            polygons.append(corner)
    return polygons


def _following(tail: Ints, angle: Floats) -> Ints:
    """The half-edge that follows each around the face to its left: clockwise next to its twin at its head."""
    order = np.lexsort((np.mod(angle, 2.0 * np.pi), tail))
    place = np.empty(len(order), dtype=np.int64)
    place[order] = np.arange(len(order))
    degree = np.bincount(tail)
    start = np.cumsum(degree) - degree
    twin = np.arange(len(tail)) ^ 1
    node = tail[twin]
    return np.asarray(order[start[node] + (place[twin] - start[node] - 1) % degree[node]])
