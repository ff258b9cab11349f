"""Topology of a triangle mesh: edges, connected patches, boundary loops, Euler characteristic."""

from dataclasses import dataclass

import igl
import numpy as np

from meshwind.core.cast import Ints, frozen
from meshwind.mesh.geometry import halfedges


@dataclass(frozen=True)
class Edges:
    """Undirected edges of a mesh.

    ends (e, 2), the lower index first; of_face (m, 3) the edge from each corner to the next; count (e,) of the faces
    at each edge; halves (e, 2) the first two half-edges at each edge, -1 if there is only one.  Half-edge 3 f + k runs
    from corner k of face f to the next.
    """

    ends: Ints
    of_face: Ints
    count: Ints
    halves: Ints

    def pairs(self) -> tuple[Ints, Ints]:
        """The two half-edges of each edge with exactly two faces."""
        first, second = self.halves[self.count == 2].T
        return first, second

    def open(self) -> Ints:
        """Half-edges (b,) on the boundary, in the order of their faces."""
        return np.sort(self.halves[self.count == 1, 0])


def edges(faces: Ints) -> Edges:
    """Find the edges of faces (m, 3).

    Each step of repair and opening asks for those of the faces that the step before has left, mostly the same ones:
    the last table is kept, as to compare the faces takes a fortieth of the time.
    """
    for those, found in _last:
        if np.array_equal(those, faces):
            return found
    plain = _plain(faces)
    ends, of_half, count, halves = halfedges.edge_table(plain, int(faces.max(initial=-1)) + 1)
    found = Edges(frozen(ends), frozen(of_half.reshape(-1, 3)), frozen(count), frozen(halves))
    _last[:] = [(plain.copy(), found)]
    return found


_last: list[tuple[Ints, Edges]] = []
"""The faces of which edges were found last, as they were then, and these; at most one pair."""


def _plain(indices: Ints) -> Ints:
    """The type of array that the kernels are compiled for: read-only, 64 bits."""
    return frozen(np.asarray(indices, dtype=np.int64))


def components(count: int, first: Ints, second: Ints) -> Ints:
    """Label (count,) of the connected component of each node in the graph with links first-second."""
    return halfedges.linked(count, _plain(first), _plain(second))


def patches(faces: Ints, found: Edges | None = None) -> Ints:
    """Label (m,) of the patch of each face; patches are connected across edges with exactly two faces."""
    found = edges(faces) if found is None else found
    first, second = found.pairs()
    return components(len(faces), first // 3, second // 3)


def boundary(faces: Ints) -> Ints:
    """Directed boundary edges (b, 2) of a manifold mesh, in the orientation of their faces."""
    half = edges(faces).open()
    return np.column_stack([faces.ravel()[half], np.roll(faces, -1, axis=1).ravel()[half]])


def loops(faces: Ints) -> list[Ints]:
    """Boundary loops of a manifold, oriented mesh as arrays of vertices, in the orientation of their faces.

    Each starts with its lowest index, and the loops are ordered by it.
    """
    open_edges = boundary(faces)
    if len(open_edges) == 0:
        return []
    tails, heads = open_edges.T
    following = np.full(int(faces.max()) + 1, -1)
    following[tails] = heads
    if not np.array_equal(np.sort(tails), np.unique(heads)):
        return _touching(faces, following)
    nodes, starts = halfedges.rings(_plain(following))
    return np.split(nodes, starts[1:])


def _touching(faces: Ints, following: Ints) -> list[Ints]:
    """Boundary loops of which some touch at a vertex."""
    rings = []
    for ring in igl.boundary_loop_all(faces):
        loop = np.asarray(ring, dtype=np.int64)
        if following[loop[0]] != loop[1]:
            loop = loop[::-1]
        rings.append(np.roll(loop, -int(np.argmin(loop))))
    return sorted(rings, key=lambda loop: int(loop[0]))


def euler(faces: Ints) -> int:
    """Euler characteristic: vertices in use - edges + faces."""
    used = int(np.count_nonzero(np.bincount(faces.ravel())))
    return used - len(edges(faces).ends) + len(faces)


def compact(used: Ints, size: int) -> tuple[Ints, Ints]:
    """Sorted indices in use, and the new index (size,) of each old one, -1 if it is not in use."""
    mark = np.zeros(size, dtype=bool)
    mark[used] = True
    keep = np.flatnonzero(mark)
    renumber = np.full(size, -1, dtype=np.int64)
    renumber[keep] = np.arange(len(keep))
    return keep, renumber
