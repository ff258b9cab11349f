"""Closing of cracks: edges that a vertex of a neighbour splits on one side only, and boundaries that nearly touch.

Only boundaries that face each other are joined, which the two rims of a thin wall do not.
"""

from itertools import chain

import numpy as np
from scipy.spatial import cKDTree

from meshwind.core.cast import Floats, Ints
from meshwind.core.vectors import unit
from meshwind.mesh.geometry.areas_and_volumes import edge_lengths
from meshwind.mesh.geometry.subdivide import subdivide
from meshwind.mesh.geometry.topology import components, edges
from meshwind.mesh.repair.weld import without_collapsed, without_duplicates

WIDEST = 1e-3
"""Largest width of a crack over the diagonal."""
_WIDEST_BY_EDGE = 0.1
"""Largest width of a crack over the edges at it."""
_OVERLAP = 1e-6
"""Largest distance of a vertex on the wrong side of the edge that it splits, over the diagonal."""
_SAME_DIRECTION = 0.9
"""Cosine above which two boundaries have the same direction, as the two rims of a wall have."""
_NEIGHBOURS = 16
"""Number of nearby vertices that are compared: twice as many as faces meet at most vertices."""
_LOOSE = 2
"""Boundary edges per face from which on the triangles are not connected, so that a search would take forever."""
_MAX_ROUNDS = 12
"""Maximum number of times that edges are split at hanging vertices."""


def close_cracks(vertices: Floats, faces: Ints) -> tuple[Floats, Ints, int, float]:
    """Join boundaries that face each other across a crack; also returns the number of vertices and the widest gap."""
    reach = WIDEST * float(np.linalg.norm(np.ptp(vertices, axis=0)))
    vertices, faces, joined, widest = _joined(vertices, faces, reach)
    count = joined
    for _ in range(_MAX_ROUNDS):
        edge, vertex, gap = _hanging(vertices, faces, reach)
        if len(edge) == 0:
            break
        points = np.concatenate([vertices, vertices[vertex]])
        split = subdivide(points, faces, edge, len(vertices))
        faces = without_collapsed(np.concatenate([np.arange(len(vertices)), vertex])[split])
        count, widest = count + len(edge), max(widest, float(gap.max()))
    return vertices, without_duplicates(faces) if count else faces, count, widest


def _open_edges(faces: Ints) -> tuple[Ints, Ints, Ints]:
    """Boundary edges: their lower and higher vertex, and the third corner of their face, (b,) each."""
    found = edges(faces)
    half = np.flatnonzero(found.count[found.of_face.ravel()] == 1)
    face, corner = half // 3, half % 3
    low, high = found.ends[found.of_face.ravel()[half]].T
    return low, high, faces[face, (corner + 2) % 3]


def _outward(vertices: Floats, low: Ints, high: Ints, apex: Ints) -> Floats:
    """Unit vectors (b, 3) perpendicular to boundary edges, in the plane of the face and away from it."""
    along = vertices[high] - vertices[low]
    out = vertices[low] - vertices[apex]
    out = out - along * (np.einsum("ij,ij->i", out, along) / np.einsum("ij,ij->i", along, along))[:, None]
    return unit(out)


def _at_vertices(count: int, low: Ints, high: Ints, out: Floats) -> Floats:
    """Unit vectors (n, 3) away from the surface at boundary vertices, 0 elsewhere."""
    both = np.concatenate([low, high])
    twice = np.concatenate([out, out])
    return unit(np.column_stack([np.bincount(both, twice[:, k], count) for k in range(3)]))


def _joined(vertices: Floats, faces: Ints, reach: float) -> tuple[Floats, Ints, int, float]:
    """Join boundary vertices that are close compared with their edges, at their mean."""
    low, high, apex = _open_edges(faces)
    rim = np.unique(np.concatenate([low, high]))
    if len(rim) == 0:
        return vertices, faces, 0, 0.0
    away = _at_vertices(len(vertices), low, high, _outward(vertices, low, high, apex))
    at_rim = np.zeros(len(vertices), dtype=bool)
    at_rim[rim] = True
    around = faces[at_rim[faces].any(axis=1)]
    length = edge_lengths(vertices, around)
    shortest = np.full(len(vertices), np.inf)
    for k in range(3):
        np.minimum.at(shortest, around[:, k], length[:, k])
        np.minimum.at(shortest, around[:, (k + 1) % 3], length[:, k])
    gap, near = cKDTree(vertices[rim]).query(vertices[rim], k=min(_NEIGHBOURS, len(rim)), distance_upper_bound=reach)
    first, column = np.nonzero(np.isfinite(gap) & (near != np.arange(len(rim))[:, None]))
    a, b, gap = rim[first], rim[near[first, column]], gap[first, column]
    good = gap < _WIDEST_BY_EDGE * np.minimum(shortest[a], shortest[b])
    good &= np.einsum("ij,ij->i", away[a], away[b]) < _SAME_DIRECTION
    a, b, gap = a[good], b[good], gap[good]
    if len(a) == 0:
        return vertices, faces, 0, 0.0
    group = components(len(vertices), a, b)
    size = np.bincount(group)
    kept, renumber = np.unique(group, return_index=True)[1], group
    points = vertices[kept].copy()
    moved = size > 1
    for k in range(3):
        points[moved, k] = (np.bincount(group, vertices[:, k]) / size)[moved]
    return points, without_collapsed(renumber[faces]), len(vertices) - len(size), float(gap.max())


def _hanging(vertices: Floats, faces: Ints, reach: float) -> tuple[Ints, Ints, Floats]:
    """Boundary edges (k, 2) that a vertex of another boundary splits, that vertex (k,), and its distance."""
    low, high, apex = _open_edges(faces)
    rim = np.unique(np.concatenate([low, high]))
    if not 0 < len(low) < _LOOSE * len(faces):
        return np.empty((0, 2), dtype=np.int64), np.empty(0, dtype=np.int64), np.empty(0)
    out = _outward(vertices, low, high, apex)
    away = _at_vertices(len(vertices), low, high, out)
    along = vertices[high] - vertices[low]
    length = np.linalg.norm(along, axis=1)
    found = cKDTree(vertices[rim]).query_ball_point(vertices[low] + 0.5 * along, 0.5 * length, return_sorted=True)
    edge = np.repeat(np.arange(len(low)), [len(row) for row in found])
    vertex = rim[np.fromiter(chain.from_iterable(found), dtype=np.int64, count=len(edge))]
    other = (vertex != low[edge]) & (vertex != high[edge]) & (vertex != apex[edge])
    edge, vertex = edge[other], vertex[other]
    to = vertices[vertex] - vertices[low[edge]]
    t = np.einsum("ij,ij->i", to, along[edge]) / length[edge] ** 2
    gap = np.linalg.norm(to - t[:, None] * along[edge], axis=1)
    good = (t > _WIDEST_BY_EDGE) & (t < 1 - _WIDEST_BY_EDGE) & (gap < np.minimum(reach, _WIDEST_BY_EDGE * length[edge]))
    good &= np.einsum("ij,ij->i", to, out[edge]) > -_OVERLAP / WIDEST * reach
    good &= np.einsum("ij,ij->i", away[vertex], out[edge]) < _SAME_DIRECTION
    edge, vertex, gap, t = edge[good], vertex[good], gap[good], t[good]
    order = np.lexsort((vertex, np.abs(t - 0.5), edge))
    one = order[np.unique(edge[order], return_index=True)[1]]
    return np.column_stack([low, high])[edge[one]], vertex[one], gap[one]
