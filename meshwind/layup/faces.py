"""The faces of a planar graph: traced from the order of the half-edges around each node, split into quads."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from meshwind.core.cast import Floats, Ints
from meshwind.layup.graph import Graph, HalfEdges


def trace(graph: Graph) -> list[Ints] | None:
    """Polygons to the left of the half-edges, grouped by size: arrays (m, 3), (m, 4), ... of node indices.

    Faces of two edges, where two fibres meet twice with nothing between, are left out.  None where a face touches
    itself, that is where the graph is no mesh.
    """
    following = _following(graph.edges)
    tail, outer, count = graph.edges.tail, graph.outer, len(graph.edges)
    links = coo_array((np.ones(count), (np.arange(count), following)), shape=(count, count))
    _, face = connected_components(links, directed=False)
    outside = np.zeros(count, dtype=bool)
    outside[face[outer]] = True
    if not np.array_equal(outside[face], outer):
        return None
    first, size = np.unique(face, return_index=True, return_counts=True)[1:]
    inside = ~outside[face[first]]
    first, size = first[inside], size[inside]
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


def _following(edges: HalfEdges) -> Ints:
    """The half-edge that follows each around the face to its left: clockwise next to its twin at its head."""
    tail = edges.tail
    order = np.lexsort((np.mod(edges.angle, 2.0 * np.pi), tail))
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    degree = np.bincount(tail)
    start = np.cumsum(degree) - degree
    twin = np.arange(len(tail)) ^ 1
    node = tail[twin]
    return np.asarray(order[start[node] + (rank[twin] - start[node] - 1) % degree[node]])


def split(polygons: list[Ints], points: Floats) -> tuple[Ints, Ints]:
    """Quads (q, 4) and triangles (t, 3) that fill polygons (m, n), each with n >= 3 corners.

    A pentagon gives a quad and a triangle, cut where the quad comes out best; larger ones give a fan.
    """
    quads, triangles = [np.zeros((0, 4), dtype=np.int64)], [np.zeros((0, 3), dtype=np.int64)]
    for polygon in polygons:
        n = polygon.shape[1]
        if n == 4:
            quads.append(polygon)
        elif n == 5:
            best = _best_start(polygon, points)
            polygon = np.take_along_axis(polygon, (best[:, None] + np.arange(5)) % 5, axis=1)
            quads.append(polygon[:, :4])
            triangles.append(polygon[:, [0, 3, 4]])
        else:
            triangles.extend(polygon[:, [0, k, k + 1]] for k in range(1, n - 1))
    return np.concatenate(quads), np.concatenate(triangles)


def _best_start(pentagons: Ints, points: Floats) -> Ints:
    """Where to start each pentagon so that its first four corners make the squarest quad."""
    quality = [_squareness(points[np.roll(pentagons, -k, axis=1)[:, :4]]) for k in range(5)]
    return np.asarray(np.argmax(quality, axis=0))


def _squareness(corners: Floats) -> Floats:
    """Smallest sine of the corner angles of quads (m, 4, 3), signed by the quad's own normal."""
    ahead = np.roll(corners, -1, axis=1) - corners
    behind = np.roll(corners, 1, axis=1) - corners
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    sine = (np.cross(ahead, behind) * normal[:, None]).sum(axis=2)
    scale = np.linalg.norm(ahead, axis=2) * np.linalg.norm(behind, axis=2)
    scale *= np.linalg.norm(normal, axis=1, keepdims=True)
    return np.asarray(np.divide(sine, scale, out=np.full_like(sine, -1.0), where=scale > 0).min(axis=1))
