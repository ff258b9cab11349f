"""Which loops of a surface go round a handle, and the shortest of them.

A tree of edges and a tree of faces across the other edges leave two edges a handle (tree-cotree decomposition, Eppstein
2003).  The faces' tree carries to each edge a word, so that the words of the edges of any closed loop add up, bit by
bit, to its class: 0 for a loop that bounds a piece of the surface, anything else for one that goes round a handle.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.sparse import csgraph

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.kernel import njit
from meshwind.mesh.geometry.topology import Edges, edges, loops

_BITS = 62
"""Generators that have a bit of their own; more get random words, of which few add up to 0."""


@dataclass(frozen=True)
class Handles:
    """A connected surface (m, 3) whose rims are closed by fans; vertices from `real` up are the middles of those.

    words (e,) of its edges; genus: number of handles.
    """

    found: Edges
    words: Ints
    genus: int
    real: int

    @staticmethod
    def of(vertices: Floats, faces: Ints) -> "Handles":
        """The classes of the loops on a manifold, oriented surface in one piece."""
        closed = _closed(faces, len(vertices))
        found = edges(closed)
        tree = _vertex_tree(found)
        parent, order = _face_tree(found, tree)
        crossed = np.zeros(len(found.ends), dtype=bool)
        crossed[parent[parent >= 0]] = True
        left = np.flatnonzero(~tree & ~crossed)
        words = np.zeros(len(found.ends), dtype=np.int64)
        words[left] = _generators(len(left))
        _carry(frozen(found.of_face), frozen(parent), frozen(order), words)
        return Handles(found, words, len(left) // 2, len(vertices))

    def sources(self) -> Ints:
        """Vertices (s,) of which every loop round a handle has at least one."""
        ends = np.unique(self.found.ends[self.words != 0])
        return ends[ends < self.real]


def _closed(faces: Ints, first: int) -> Ints:
    """The faces with each rim closed by a fan to a new vertex."""
    fans = []
    for number, rim in enumerate(loops(faces)):
        fans.append(np.column_stack([np.roll(rim, -1), rim, np.full(len(rim), first + number)]))
    return np.concatenate([faces, *fans])


def _generators(count: int) -> Ints:
    """A word for each generator."""
    words = np.random.default_rng(0).integers(1, 1 << 62, count)
    words[:_BITS] = 1 << np.arange(min(count, _BITS))
    return words


def _vertex_tree(found: Edges) -> np.ndarray:
    """Mask (e,) of the edges of a spanning tree of the vertices, by breadth."""
    (i, j), count = found.ends.T, len(found.ends)
    size = int(found.ends.max()) + 1
    graph = sparse.csr_array((np.arange(1, count + 1), (i, j)), shape=(size, size))
    root = int(i[0])
    order, previous = csgraph.breadth_first_order(graph, root, directed=False)
    child = order[1:]
    ends = np.sort(np.column_stack([child, previous[child]]), axis=1).astype(np.int64)
    tree = np.zeros(count, dtype=bool)
    tree[np.searchsorted(i * size + j, ends[:, 0] * size + ends[:, 1])] = True
    return tree


def _face_tree(found: Edges, barred: np.ndarray) -> tuple[Ints, Ints]:
    """The edge (m,) to each face's parent in a spanning tree that crosses no barred edge; the faces from its root."""
    free = np.flatnonzero(~barred)
    one, two = found.halves[free].T // 3
    count = len(found.of_face)
    # several free edges between two faces, as about a vertex of two faces: the first of them counts
    pair = np.minimum(one, two) * count + np.maximum(one, two)
    single, index = np.unique(pair, return_index=True)
    graph = sparse.csr_array((index + 1, (single // count, single % count)), shape=(count, count))
    order, previous = csgraph.breadth_first_order(graph, 0, directed=False)
    child = order[1:]
    parent = np.full(count, -1, dtype=np.int64)
    key = np.minimum(child, previous[child]).astype(np.int64) * count + np.maximum(child, previous[child])
    parent[child] = free[index[np.searchsorted(single, key)]]
    return parent, order.astype(np.int64)


@njit(nogil=True, cache=True)
def _carry(of_face: Ints, parent: Ints, order: Ints, words: Ints) -> None:
    """Give the edges of the faces' tree their words, from the leaves: those of a face add up to 0."""
    for k in range(len(order) - 1, 0, -1):
        face = order[k]
        word = 0
        for c in range(3):
            if of_face[face, c] != parent[face]:
                word ^= words[of_face[face, c]]
        words[parent[face]] = word


class Links(NamedTuple):
    """The vertices' neighbours: those of vertex i are ends[first[i]:first[i + 1]], with lengths and words."""

    first: Ints
    ends: Ints
    length: Floats
    words: Ints

    @staticmethod
    def of(vertices: Floats, handles: Handles) -> "Links":
        """The links along edges between the surface's own vertices."""
        real = (handles.found.ends < handles.real).all(axis=1)
        (i, j), words = handles.found.ends[real].T, handles.words[real]
        length = np.linalg.norm(vertices[i] - vertices[j], axis=1)
        tail, head = np.r_[i, j], np.r_[j, i]
        order = np.argsort(tail, kind="stable")
        first = np.zeros(len(vertices) + 1, dtype=np.int64)
        np.cumsum(np.bincount(tail, minlength=len(vertices)), out=first[1:])
        return Links(frozen(first), frozen(head[order]), frozen(np.r_[length, length][order]),
                     frozen(np.r_[words, words][order]))  # fmt: skip


class _Search(NamedTuple):
    """State of Dijkstra's method at each vertex: distance, vertex before, sum of the words so far, 1 if settled."""

    away: Floats
    previous: Ints
    sums: Ints
    settled: Ints


def shortest(links: Links, sources: Ints, limit: float, keep: bool) -> tuple[Floats, list[Ints]]:
    """The shortest loop round a handle through each source (s,), with its length: infinite where it is above the limit.

    Without `keep`, only loops shorter than those before are looked for.
    """
    count = len(links.first) - 1
    length = np.full(len(sources), np.inf)
    search = _Search(np.full(count, np.inf), np.full(count, -1), np.zeros(count, np.int64), np.zeros(count, np.int8))
    found = []
    best = limit
    for k, source in enumerate(sources):
        length[k], a, b = _round(links, int(source), limit if keep else best, search)
        best = min(best, float(length[k]))
        found.append(_loop(search.previous, a, b) if np.isfinite(length[k]) else np.empty(0, dtype=np.int64))
        _forget(links, int(source), search)
    return length, found


def _loop(previous: Ints, a: int, b: int) -> Ints:
    """The loop along the tree from a to where its branch meets that of b, and back along the edge from b to a."""
    one, two = [a], [b]
    while previous[one[-1]] >= 0:
        one.append(int(previous[one[-1]]))
    while previous[two[-1]] >= 0:
        two.append(int(previous[two[-1]]))
    while len(one) > 1 and len(two) > 1 and one[-2] == two[-2]:
        one.pop()
        two.pop()
    return np.array(one + two[-2::-1], dtype=np.int64)


@njit(nogil=True, cache=True)
def _round(links: Links, source: int, limit: float, search: _Search) -> tuple[float, int, int]:
    """The shortest loop of class other than 0 through the source, if within the limit, and the edge that closes it.

    Dijkstra's method; an edge between two settled vertices closes a loop whose class is the sum of its words.
    """
    first, ends, length, words = links.first, links.ends, links.length, links.words
    away, previous, sums, settled = search.away, search.previous, search.sums, search.settled
    best, one, two = np.inf, -1, -1
    keys, nodes = [0.0], [source]
    away[source] = 0.0
    while len(keys) > 0:
        distance, node = keys[0], nodes[0]
        _pop(keys, nodes)
        if settled[node]:
            continue
        if 2.0 * distance > min(limit, best):
            break
        settled[node] = 1
        for k in range(first[node], first[node + 1]):
            other = ends[k]
            if settled[other]:
                total = distance + away[other] + length[k]
                if total < best and total <= limit and sums[node] ^ sums[other] ^ words[k] != 0:
                    best, one, two = total, node, other
            elif distance + length[k] < away[other]:
                away[other] = distance + length[k]
                previous[other] = node
                sums[other] = sums[node] ^ words[k]
                _push(keys, nodes, away[other], other)
    return best, one, two


@njit(nogil=True, cache=True)
def _forget(links: Links, source: int, search: _Search) -> None:
    """Set what a search has touched back to what it was."""
    first, ends = links.first, links.ends
    away, previous, sums, settled = search.away, search.previous, search.sums, search.settled
    stack = [source]
    away[source] = np.inf
    while len(stack) > 0:
        node = stack.pop()
        previous[node], sums[node], was = -1, 0, settled[node]
        settled[node] = 0
        if not was:
            continue
        for k in range(first[node], first[node + 1]):
            if away[ends[k]] < np.inf:
                away[ends[k]] = np.inf
                stack.append(ends[k])


@njit(nogil=True, cache=True)
def _push(keys: list[float], nodes: list[int], key: float, node: int) -> None:
    """Add to a binary heap."""
    keys.append(key)
    nodes.append(node)
    k = len(keys) - 1
    while k > 0 and keys[(k - 1) // 2] > keys[k]:
        up = (k - 1) // 2
        keys[k], keys[up] = keys[up], keys[k]
        nodes[k], nodes[up] = nodes[up], nodes[k]
        k = up


@njit(nogil=True, cache=True)
def _pop(keys: list[float], nodes: list[int]) -> None:
    """Drop the least of a binary heap."""
    key, node = keys.pop(), nodes.pop()
    if len(keys) == 0:
        return
    k = 0
    while True:
        down = 2 * k + 1
        if down >= len(keys):
            break
        if down + 1 < len(keys) and keys[down + 1] < keys[down]:
            down += 1
        if keys[down] >= key:
            break
        keys[k], nodes[k] = keys[down], nodes[down]
        k = down
    keys[k], nodes[k] = key, node
