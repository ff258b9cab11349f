"""The cut from end to end, and which corners lie on its far side."""

import igl
import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import dijkstra

from meshwind.cast import Bools, Ints
from meshwind.mandrel.annulus import Annulus


def seam(annulus: Annulus) -> Ints:
    """Vertices of a shortest edge path from the start rim to the end rim that touches each rim once."""
    V, F, n = annulus.vertices, annulus.faces, len(annulus.vertices)
    i, j = (
        np.concatenate([F, np.roll(F, -1, axis=1)], axis=0).ravel(),
        np.concatenate([np.roll(F, -1, axis=1), F]).ravel(),
    )
    pairs = np.unique(np.stack([i, j], axis=1), axis=0)
    length = np.linalg.norm(V[pairs[:, 0]] - V[pairs[:, 1]], axis=1)
    graph = sparse.csr_array((length, (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    distance, previous, _ = dijkstra(graph, indices=annulus.rims[0], return_predecessors=True, min_only=True)
    path = [int(annulus.rims[1][np.argmin(distance[annulus.rims[1]])])]
    while previous[path[-1]] >= 0:
        path.append(int(previous[path[-1]]))
    return np.array(path[::-1], dtype=np.int64)


def far_side(annulus: Annulus, path: Ints) -> Bools:
    """Corners (m, 3) at seam vertices whose triangle lies to the left of the seam, where u has gained a turn."""
    faces = annulus.faces
    first, second = faces, np.roll(faces, -1, axis=1)
    step = np.full(len(annulus.vertices), -1, dtype=np.int64)
    step[path[:-1]] = path[1:]
    forward, backward = step[first] == second, step[second] == first
    _, cut_faces, _ = igl.cut_mesh(annulus.vertices, faces, (forward | backward).astype(np.int64))
    touches = forward | np.roll(forward, 1, axis=1)
    return np.isin(cut_faces, cut_faces[touches])
