"""Subdivision of faces at new vertices on their edges, without hanging nodes."""

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.geometry.topology import edges


def crossing(faces: Ints, side: Ints) -> Ints:
    """Edges (k, 2) that cross a level; side (n,) of each vertex is -1, 0 on the level itself, or +1."""
    ends = edges(faces).ends
    return np.asarray(ends[side[ends[:, 0]] * side[ends[:, 1]] < 0])


def subdivide(vertices: Floats, faces: Ints, cut: Ints, first: int) -> Ints:
    """Faces after edge cut[i] (k, 2), the lower index first, has been split at the new vertex first + i.

    `vertices` includes the new ones; a quadrangle is cut along its shorter diagonal.
    """
    fresh = _new_vertex(faces, cut, first)
    marked = fresh >= 0
    count = marked.sum(axis=1)
    one = _turned(faces, fresh, count == 1, marked.argmax(axis=1))
    two = _turned(faces, fresh, count == 2, marked.argmin(axis=1))
    three = _turned(faces, fresh, count == 3, np.zeros(len(faces), dtype=np.int64))
    return np.concatenate([faces[count == 0], _halves(*one), _thirds(vertices, *two), _quarters(*three)])


def _new_vertex(faces: Ints, cut: Ints, first: int) -> Ints:
    """New vertex (m, 3) on the edge from each corner to the next, -1 if it is not cut."""
    following = np.roll(faces, -1, axis=1)
    span = int(faces.max(initial=0)) + 1
    keys = np.minimum(faces, following) * span + np.maximum(faces, following)
    wanted = cut[:, 0] * span + cut[:, 1]
    order = np.argsort(wanted)
    position = np.searchsorted(wanted[order], keys)
    inside = position < len(order)
    position = np.where(inside, position, 0)
    if len(order) == 0:
        return np.full(faces.shape, -1, dtype=np.int64)
    hit = inside & (wanted[order][position] == keys)
    return np.where(hit, first + order[position], -1)


def _turned(faces: Ints, fresh: Ints, chosen: np.ndarray, start: Ints) -> tuple[Ints, Ints]:
    """The chosen faces and their new vertices, rotated so that corner `start` comes first."""
    turn = (start[chosen][:, None] + np.arange(3)) % 3
    return np.take_along_axis(faces[chosen], turn, 1), np.take_along_axis(fresh[chosen], turn, 1)


def _halves(faces: Ints, fresh: Ints) -> Ints:
    """Two faces for each face whose first edge is cut."""
    (a, b, c), x = faces.T, fresh[:, 0]
    return np.concatenate([np.column_stack([a, x, c]), np.column_stack([x, b, c])])


def _thirds(vertices: Floats, faces: Ints, fresh: Ints) -> Ints:
    """Three faces for each face of which all edges but the first are cut: a corner and a quadrangle."""
    (a, b, c), (_, x, y) = faces.T, fresh.T
    straight = np.linalg.norm(vertices[a] - vertices[x], axis=1) <= np.linalg.norm(vertices[b] - vertices[y], axis=1)
    return np.concatenate([
        np.column_stack([c, y, x]),
        np.column_stack([a, b, np.where(straight, x, y)]),
        np.column_stack([np.where(straight, a, b), x, y]),
    ])  # fmt: skip


def _quarters(faces: Ints, fresh: Ints) -> Ints:
    """Four faces for each face whose edges are all cut."""
    (a, b, c), (x, y, z) = faces.T, fresh.T
    return np.concatenate([np.column_stack(rows) for rows in ((a, x, z), (x, b, y), (z, y, c), (x, y, z))])
