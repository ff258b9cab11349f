"""How far the peaks of a field on a mesh rise over the saddle to a higher one: a compiled loop over its vertices."""

import numpy as np

from meshwind.core.cast import Ints
from meshwind.core.kernel import njit
from meshwind.mesh.geometry.halfedges import root


@njit(nogil=True, cache=True)
def saddles(order: Ints, above: Ints, starts: Ints, neighbours: Ints) -> Ints:
    """Vertex (n,) at which the rise that begins at each vertex meets a higher one; -1 where none begins, or it is last.

    order (n,): vertices from the highest to the lowest; above (n,): a vertex of the same peak, which is the highest of
    it and its own, such as the first of a plateau; the neighbours of vertex i are neighbours[starts[i]:starts[i + 1]].
    """
    count = len(order)
    parent = above.copy()
    place = np.empty(count, np.int64)
    for k in range(count):
        place[order[k]] = k
    met = np.full(count, -1)
    for k in range(count):
        here = order[k]
        for j in range(starts[here], starts[here + 1]):
            if place[neighbours[j]] > k:
                continue
            a, b = root(parent, here), root(parent, neighbours[j])
            if a == b:
                continue
            # the higher one is the root, so that each root is its peak
            if place[a] > place[b]:
                a, b = b, a
            parent[b] = a
            met[b] = here
    return met
