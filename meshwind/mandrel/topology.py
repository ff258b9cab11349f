"""Edges, patches and boundary loops of a triangle mesh: what does not depend on where its vertices lie."""

from dataclasses import dataclass

import igl
import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from meshwind.cast import Ints


@dataclass(frozen=True)
class Edges:
    """Undirected edges of a mesh.

    ends (e, 2), the lower index first; of_face (m, 3) the edge from each corner to the next; count (e,) the
    faces at each edge.
    """

    ends: Ints
    of_face: Ints
    count: Ints


def edges(faces: Ints) -> Edges:
    """Find the edges of faces (m, 3)."""
    tails, heads = faces, np.roll(faces, -1, axis=1)
    span = int(faces.max(initial=0)) + 1
    keys = np.minimum(tails, heads) * span + np.maximum(tails, heads)
    unique, of_face, count = np.unique(keys, return_inverse=True, return_counts=True)
    return Edges(np.column_stack([unique // span, unique % span]), of_face.reshape(-1, 3), count)


def pairs(of_face: Ints, chosen: Ints) -> tuple[Ints, Ints]:
    """Half-edges (3 f + k runs from corner k of face f to the next) that meet at the chosen two-faced edges."""
    order = np.argsort(of_face.ravel(), kind="stable")
    sorted_edges = of_face.ravel()[order]
    first = np.searchsorted(sorted_edges, chosen)
    return order[first], order[first + 1]


def components(count: int, first: Ints, second: Ints) -> Ints:
    """Label (count,) of the connected component of each node in the graph of the links first-second."""
    links = coo_array((np.ones(len(first), dtype=np.int8), (first, second)), shape=(count, count))
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int64)


def patches(faces: Ints, found: Edges | None = None) -> Ints:
    """Label (m,) of the patch of each face: faces are linked across edges that just two of them share."""
    found = edges(faces) if found is None else found
    first, second = pairs(found.of_face, np.flatnonzero(found.count == 2))
    return components(len(faces), first // 3, second // 3)


def boundary(faces: Ints) -> Ints:
    """Directed boundary edges (b, 2) of a manifold mesh, in the sense of their faces."""
    found = edges(faces)
    half = np.flatnonzero(found.count[found.of_face.ravel()] == 1)
    return np.column_stack([faces.ravel()[half], np.roll(faces, -1, axis=1).ravel()[half]])


def loops(faces: Ints) -> list[Ints]:
    """Boundary loops of a manifold, oriented mesh as rings of vertices, in the sense of their faces.

    Each starts at its lowest index, and so do the loops among themselves.
    """
    open_edges = boundary(faces)
    if len(open_edges) == 0:
        return []
    following = np.full(int(faces.max()) + 1, -1)
    following[open_edges[:, 0]] = open_edges[:, 1]
    rings = []
    for ring in igl.boundary_loop_all(faces):
        loop = np.asarray(ring, dtype=np.int64)
        if following[loop[0]] != loop[1]:
            loop = loop[::-1]
        rings.append(np.roll(loop, -int(np.argmin(loop))))
    return sorted(rings, key=lambda loop: int(loop[0]))


def euler(faces: Ints) -> int:
    """Euler characteristic: vertices in use, less edges, plus faces."""
    return len(np.unique(faces)) - len(edges(faces).ends) + len(faces)


def compact(used: Ints, size: int) -> tuple[Ints, Ints]:
    """Sorted indices in use, and the new index (size,) of each old one, -1 where it is not in use."""
    mark = np.zeros(size, dtype=bool)
    mark[used] = True
    keep = np.flatnonzero(mark)
    renumber = np.full(size, -1, dtype=np.int64)
    renumber[keep] = np.arange(len(keep))
    return keep, renumber
