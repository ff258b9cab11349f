"""The planar graph of a winding: its nodes are crossings and the paths' ends, its edges run along paths and rims."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.layup.crossings import SHARED, Crossings
from meshwind.path.paths import Paths


@dataclass(frozen=True)
class HalfEdges:
    """Half-edges (h,) in twin pairs 2e, 2e + 1: the node that each leaves, and at which angle in the (u, v) plane."""

    tail: Ints
    angle: Floats

    def __len__(self) -> int:
        return len(self.tail)

    @staticmethod
    def of(here: Ints, there: Ints, forward: Floats, backward: Floats) -> "HalfEdges":
        """Edges (e,) from `here` to `there`, which leave them at the angles `forward` and `backward`."""
        return HalfEdges(np.stack([here, there], axis=1).ravel(), np.stack([forward, backward], axis=1).ravel())

    @staticmethod
    def joined(parts: "list[HalfEdges]") -> "HalfEdges":
        """All half-edges of the parts, in their order."""
        return HalfEdges(np.concatenate([each.tail for each in parts]), np.concatenate([each.angle for each in parts]))


@dataclass(frozen=True)
class Graph:
    """Half-edges between nodes, and which of them bound no face.

    Nodes are the used crossings (`crossing` are their numbers), then those of the start rim, then those of the end rim;
    each rim node stands for one path (`rim_path`).  outer (h,): the face to the left is outside of the part.
    """

    edges: HalfEdges
    outer: Bools
    crossing: Ints
    rim_path: tuple[Ints, Ints]

    @staticmethod
    def of(paths: Paths, crossings: Crossings, kept: Bools) -> "Graph":
        """The graph of the kept paths (p,) and their crossings."""
        used = np.flatnonzero(kept[crossings.path_a] & kept[crossings.path_b])
        numbers = np.flatnonzero(kept)
        rims = [_rim(paths.uv[numbers, end, 0]) for end in (0, -1)]
        first = len(used) + np.array([0, len(rims[0].path)])
        ends = [rim.node + start for rim, start in zip(rims, first, strict=True)]
        strands = _strand_edges(paths, crossings, used, numbers, ends)
        loops = [_loop_edges(len(rim.path), int(start)) for rim, start in zip(rims, first, strict=True)]
        edges = HalfEdges.joined([strands, *loops])
        outer = np.zeros(len(edges), dtype=bool)
        start, end = len(strands), len(strands) + len(loops[0])
        outer[start + 1 : end : 2] = True  # against u on the start rim, along u on the end rim: outside is to the left
        outer[end::2] = True
        return Graph(edges, outer, used, (numbers[rims[0].path], numbers[rims[1].path]))

    def nodes(self, paths: Paths, crossings: Crossings) -> tuple[Floats, Floats, Bools]:
        """Points (k, 3), uv (k, 2) and on_surface (k,) of the nodes."""
        start, end = self.rim_path
        points = [crossings.points[self.crossing], paths.points[start, 0], paths.points[end, -1]]
        uv = np.concatenate([crossings.uv[self.crossing], paths.uv[start, 0], paths.uv[end, -1]])
        uv[:, 0] -= np.floor(uv[:, 0])
        rim = np.ones(len(start) + len(end), dtype=bool)
        return np.concatenate(points), uv, np.concatenate([crossings.on_surface[self.crossing], rim])


@dataclass(frozen=True)
class _Rim:
    """Nodes of a rim, numbered by growing u modulo 1: that of each path end, and one path end of each node."""

    node: Ints
    path: Ints


def _rim(u: Floats) -> _Rim:
    """The nodes of a rim from the u of the path ends on it; ends closer than SHARED are one node."""
    u = u - np.floor(u)
    order = np.argsort(u, kind="stable")
    gap = np.diff(u[order], append=u[order[:1]] + 1.0)  # to the next end, around the rim
    new = np.roll(gap > SHARED, 1)
    node = np.empty(len(u), dtype=np.int64)
    node[order] = (np.cumsum(new) - 1) % max(int(new.sum()), 1)
    return _Rim(node, order[new])


def _loop_edges(count: int, first: int) -> HalfEdges:
    """Half-edges between consecutive nodes of a rim: along u at angle 0, back at pi."""
    here = first + np.arange(count)
    return HalfEdges.of(here, np.roll(here, -1), np.zeros(count), np.full(count, np.pi))


def _strand_edges(paths: Paths, crossings: Crossings, used: Ints, numbers: Ints, ends: list[Ints]) -> HalfEdges:
    """Half-edges between consecutive nodes along each of the numbered paths, which starts and ends at nodes `ends`."""
    step = np.diff(paths.uv[numbers], axis=1)
    leave = np.arctan2(step[:, 0, 1], step[:, 0, 0])
    arrive = np.arctan2(-step[:, -1, 1], -step[:, -1, 0])
    # at a crossing only the order around the node matters: a runs along 0, b to its left or its right
    sideways = 0.5 * np.pi * crossings.sense[used]
    node = np.arange(len(used))
    last = paths.uv.shape[1] - 1
    path = np.concatenate([numbers, crossings.path_a[used], crossings.path_b[used], numbers])
    t = np.concatenate(
        [np.full(len(numbers), -1.0), crossings.t_a[used], crossings.t_b[used], np.full(len(numbers), last + 1.0)]
    )
    nodes = np.concatenate([ends[0], node, node, ends[1]])
    forward = np.concatenate([leave, np.zeros(len(used)), sideways, leave])
    backward = np.concatenate([arrive, np.full(len(used), np.pi), sideways + np.pi, arrive])
    order = np.lexsort((t, path))
    along = np.flatnonzero(np.diff(path[order]) == 0)
    here, there = order[along], order[along + 1]
    return HalfEdges.of(nodes[here], nodes[there], forward[here], backward[there])
