"""Compiled loops over half-edges: sorting, linking and walking them in linear time.

Half-edge 3 f + k runs from corner k of face f to the next.  NumPy's sorts take five to ten times as long, and every
step of the repair needs the edges.
"""

import numpy as np

from meshwind.core.cast import Ints
from meshwind.core.kernel import njit


@njit(nogil=True, cache=True)
def edge_table(faces: Ints, size: int) -> tuple[Ints, Ints, Ints, Ints]:
    """Edges of faces (m, 3) with indices below `size`, ordered by their lower, then by their higher vertex.

    Returns ends (e, 2), the edge (3 m,) of each half-edge, the number (e,) of half-edges at each edge, and the first
    two of these (e, 2), -1 if there is only one.  Two stable counting sorts take the same time if many faces share a
    vertex.
    """
    count = 3 * len(faces)
    low, high = np.empty(count, np.int64), np.empty(count, np.int64)
    from_low, from_high = np.zeros(size + 1, np.int64), np.zeros(size + 1, np.int64)
    for h in range(count):
        a, b = faces[h // 3, h % 3], faces[h // 3, (h + 1) % 3]
        low[h], high[h] = min(a, b), max(a, b)
        from_low[low[h] + 1] += 1
        from_high[high[h] + 1] += 1
    for i in range(size):
        from_low[i + 1] += from_low[i]
        from_high[i + 1] += from_high[i]
    by_high, order = np.empty(count, np.int64), np.empty(count, np.int64)
    for h in range(count):
        by_high[from_high[high[h]]] = h
        from_high[high[h]] += 1
    for k in range(count):
        h = by_high[k]
        order[from_low[low[h]]] = h
        from_low[low[h]] += 1
    ends, halves = np.empty((count, 2), np.int64), np.full((count, 2), -1, np.int64)
    of_half, faces_at = np.empty(count, np.int64), np.zeros(count, np.int64)
    edge = -1
    for k in range(count):
        h = order[k]
        if edge < 0 or low[h] != ends[edge, 0] or high[h] != ends[edge, 1]:
            edge += 1
            ends[edge, 0], ends[edge, 1] = low[h], high[h]
        if faces_at[edge] < 2:
            halves[edge, faces_at[edge]] = h
        faces_at[edge] += 1
        of_half[h] = edge
    edge += 1
    return ends[:edge].copy(), of_half, faces_at[:edge].copy(), halves[:edge].copy()


@njit(forceinline=True, cache=True)
def root(parent: Ints, node: int) -> int:
    """Root of the tree that a node is in, by the parents (n,) of nodes; halves the way there."""
    while parent[node] != node:
        parent[node] = parent[parent[node]]
        node = parent[node]
    return node


@njit(nogil=True, cache=True)
def linked(count: int, first: Ints, second: Ints) -> Ints:
    """Label (count,) of the component of each node under the links first-second, in the order of first nodes."""
    parent = np.arange(count)
    for k in range(len(first)):
        a, b = root(parent, first[k]), root(parent, second[k])
        # the lower node is the root, so that one pass in ascending order labels all
        if a < b:
            parent[b] = a
        else:
            parent[a] = b
    labels = 0
    for i in range(count):
        if parent[i] == i:
            parent[i] = labels
            labels += 1
        else:
            parent[i] = parent[parent[i]]
    return parent


@njit(nogil=True, cache=True)
def rings(following: Ints) -> tuple[Ints, Ints]:
    """Cycles of the nodes i with following[i] >= 0, each from its lowest node: all nodes, and the starts of cycles.

    Every node must have a successor of its own.
    """
    seen = following < 0
    nodes, starts = np.empty(len(seen) - seen.sum(), np.int64), np.zeros(len(seen) + 1, np.int64)
    count = cycles = 0
    for i in range(len(following)):
        if seen[i]:
            continue
        starts[cycles] = count
        cycles += 1
        k = i
        while not seen[k]:
            seen[k] = True
            nodes[count] = k
            count += 1
            k = following[k]
    return nodes, starts[:cycles].copy()
