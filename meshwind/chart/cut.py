"""The cut from end to end, and which corners lie on its far side."""

import igl
import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import dijkstra

from meshwind.core.cast import Bools, Ints
from meshwind.mesh.geometry.annulus import Annulus
from meshwind.mesh.geometry.topology import edges


def seam(annulus: Annulus) -> Ints:
    """Vertices of a shortest edge path from the start rim to the end rim that touches each rim once."""
    ends, n = edges(annulus.faces).ends, len(annulus.vertices)
    length = np.linalg.norm(annulus.vertices[ends[:, 0]] - annulus.vertices[ends[:, 1]], axis=1)
    both = np.concatenate([ends, ends[:, ::-1]])
    # rows sorted by column, so that of equally short paths it is always the same one
    graph = sparse.csr_array((np.tile(length, 2), (both[:, 0], both[:, 1])), shape=(n, n))
    graph.sort_indices()
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
