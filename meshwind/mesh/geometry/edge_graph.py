"""The edges of a mesh as a graph, for the shortest ways along them."""

import numpy as np
from scipy import sparse

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.geometry.topology import edges


def edge_graph(vertices: Floats, faces: Ints) -> sparse.csr_array:
    """Lengths of the edges between vertices as a symmetric matrix (n, n).

    Its rows are sorted by column, so that the same one of equally short ways is found each time.
    """
    ends, count = edges(faces).ends, len(vertices)
    length = np.linalg.norm(vertices[ends[:, 0]] - vertices[ends[:, 1]], axis=1)
    both = np.concatenate([ends, ends[:, ::-1]])
    graph = sparse.csr_array((np.tile(length, 2), (both[:, 0], both[:, 1])), shape=(count, count))
    graph.sort_indices()
    return graph
