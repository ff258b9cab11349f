"""The quad mesh on the crossings: a planar graph on the annulus and its faces."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.layup.crossings import SHARED, Crossings, own_crossings
from meshwind.layup.faces import trace
from meshwind.layup.polygons import split
from meshwind.path.paths import Paths

_ON_RIM = 1e-9
"""Closer to v=0 or v=1 than this a particle is on the rim."""


@dataclass(frozen=True)
class QuadMesh:
    """An annulus of quads, with triangles at the rims; corners run counterclockwise seen from outside.

    points (k, 3); uv (k, 2) with u in [0, 1); quads (q, 4) and triangles (t, 3) indices of points; on_surface
    (k,); left_out holds the paths that could not take part, because they run along a rim or cross their own
    family; note says why there are no faces, and points are but the ends of the paths, or is "".
    """

    points: Floats
    uv: Floats
    quads: Ints
    triangles: Ints
    on_surface: Bools
    left_out: tuple[int, ...] = ()
    note: str = ""

    @property
    def euler(self) -> int:
        """Vertices - edges + faces: 0 for an annulus."""
        edges, _ = edge_counts(self.quads, self.triangles)
        used = np.unique(np.concatenate([self.quads.ravel(), self.triangles.ravel()]))
        return len(used) - len(edges) + len(self.quads) + len(self.triangles)


def edge_counts(quads: Ints, triangles: Ints) -> tuple[Ints, Ints]:
    """The mesh's undirected edges (e, 2) and how many faces share each (e,)."""
    sides = [np.stack([f, np.roll(f, -1, axis=1)], axis=-1).reshape(-1, 2) for f in (quads, triangles)]
    ends = np.sort(np.concatenate(sides), axis=1)
    most = int(ends.max(initial=0)) + 1
    # one number an edge: np.unique over rows takes five times as long
    keys, counts = np.unique(ends[:, 0] * most + ends[:, 1], return_counts=True)
    return np.stack(np.divmod(keys, most), axis=1), counts


def quads(paths: Paths, crossings: Crossings) -> QuadMesh:
    """Mesh the part by its crossings, over the paths that `crossings` compared.

    The result is a manifold annulus, or has no face and a `note` that says why.
    """
    kept = crossings.compared & _spans_the_part(paths)
    kept &= ~_cross_their_own(paths, kept)
    left_out = tuple(np.flatnonzero(crossings.compared & ~kept).tolist())
    if not all((kept & (paths.family == family)).any() for family in (1, -1)):
        return _empty(paths, left_out, "no path of one family runs clear from rim to rim: use fewer revolutions")
    graph = _Graph.of(paths, crossings, kept)
    if not len(graph.crossing):
        return _empty(paths, left_out, "the two families never cross: use more revolutions")
    polygons = trace(graph.tail, graph.angle, graph.outer)
    if polygons is None:
        return _empty(paths, left_out, "the fibres do not divide the part into cells: use more paths per family")
    points, uv, on_surface = graph.nodes(paths, crossings)
    fours, threes = split(polygons, points)
    mesh = QuadMesh(frozen(points), frozen(uv), frozen(fours), frozen(threes), frozen(on_surface), left_out)
    if mesh.euler != 0 or edge_counts(fours, threes)[1].max(initial=0) > 2:
        return _empty(paths, left_out, "the fibres' cells do not join to a manifold: use more paths per family")
    return mesh


def _empty(paths: Paths, left_out: tuple[int, ...], note: str) -> QuadMesh:
    points, uv = (each[:, [0, -1]].reshape(-1, each.shape[2]) for each in (paths.points, paths.uv))
    uv = uv - np.floor(uv) * [1.0, 0.0]
    fours, threes = (frozen(np.zeros((0, n), dtype=np.int64)) for n in (4, 3))
    on_surface = frozen(np.ones(len(points), dtype=bool))
    return QuadMesh(frozen(points), frozen(uv), fours, threes, on_surface, left_out, note)


def _spans_the_part(paths: Paths) -> Bools:
    """True for paths that start on v=0, end on v=1 and touch neither rim between."""
    v = paths.uv[..., 1]
    inner = v[:, 1:-1]
    clear = ((inner > _ON_RIM) & (inner < 1.0 - _ON_RIM)).all(axis=1)
    return np.asarray(clear & (v[:, 0] < _ON_RIM) & (v[:, -1] > 1.0 - _ON_RIM))


def _cross_their_own(paths: Paths, kept: Bools) -> Bools:
    """The fewest paths, picked greedily, without which no path crosses itself or its own family."""
    pairs = own_crossings(paths, kept)
    pairs = np.unique(pairs, axis=0)
    out = np.zeros(len(paths), dtype=bool)
    while len(pairs):
        worst = np.bincount(pairs.ravel()).argmax()
        out[worst] = True
        pairs = pairs[(pairs != worst).all(axis=1)]
    return out


@dataclass(frozen=True)
class _Graph:
    """Half-edges in twin pairs (2e, 2e + 1): node and angle that each leaves, and which bound no face.

    Nodes are the used crossings, then the start rim's, then the end rim's; each rim node stands for one path.
    """

    tail: Ints
    angle: Floats
    outer: Bools
    crossing: Ints
    rim_path: tuple[Ints, Ints]

    @staticmethod
    def of(paths: Paths, crossings: Crossings, kept: Bools) -> "_Graph":
        used = np.flatnonzero(kept[crossings.path_a] & kept[crossings.path_b])
        kin = np.flatnonzero(kept)
        rims = [_rim(paths.uv[kin, end, 0]) for end in (0, -1)]
        first = len(used) + np.array([0, len(rims[0][1])])
        strands = _strand_edges(paths, crossings, used, kin, [rims[0][0] + first[0], rims[1][0] + first[1]])
        loops = [_loop_edges(len(rim[1]), int(start)) for rim, start in zip(rims, first, strict=True)]
        tail, angle = (np.concatenate(part) for part in zip(strands, *loops, strict=True))
        outer = np.zeros(len(tail), dtype=bool)
        start, end = len(strands[0]), len(strands[0]) + len(loops[0][0])
        outer[start + 1 : end : 2] = True  # against u on the start rim, along u on the end rim: the void is left
        outer[end::2] = True
        return _Graph(tail, angle, outer, used, (kin[rims[0][1]], kin[rims[1][1]]))

    def nodes(self, paths: Paths, crossings: Crossings) -> tuple[Floats, Floats, Bools]:
        """Points (k, 3), uv (k, 2) and on_surface (k,) of the nodes."""
        start, end = self.rim_path
        points = [crossings.points[self.crossing], paths.points[start, 0], paths.points[end, -1]]
        uv = np.concatenate([crossings.uv[self.crossing], paths.uv[start, 0], paths.uv[end, -1]])
        uv[:, 0] -= np.floor(uv[:, 0])
        rim = np.ones(len(start) + len(end), dtype=bool)
        return np.concatenate(points), uv, np.concatenate([crossings.on_surface[self.crossing], rim])


def _rim(u: Floats) -> tuple[Ints, Ints]:
    """Rim node of each path end, numbered by growing u modulo 1, and one path end of each node."""
    u = u - np.floor(u)
    order = np.argsort(u, kind="stable")
    gap = np.diff(u[order], append=u[order[:1]] + 1.0)  # to the next end, around the rim
    new = np.roll(gap > SHARED, 1)
    node = np.empty(len(u), dtype=np.int64)
    node[order] = (np.cumsum(new) - 1) % max(int(new.sum()), 1)
    return node, order[new]


def _loop_edges(count: int, first: int) -> tuple[Ints, Floats]:
    """Half-edges between consecutive nodes of a rim: along u at angle 0, back at pi."""
    here = first + np.arange(count)
    there = np.roll(here, -1)
    return _pairs(here, there, np.zeros(count), np.full(count, np.pi))


def _strand_edges(paths: Paths, crossings: Crossings, used: Ints, kin: Ints, ends: list[Ints]) -> tuple[Ints, Floats]:
    """Half-edges between consecutive nodes along each path, with their angles in the (u, v) plane."""
    step = np.diff(paths.uv[kin], axis=1)
    leave = np.arctan2(step[:, 0, 1], step[:, 0, 0])
    arrive = np.arctan2(-step[:, -1, 1], -step[:, -1, 0])
    # At a crossing only the order around the node matters: a runs along 0, b to its left or its right.
    sideways = 0.5 * np.pi * crossings.sense[used]
    node = np.arange(len(used))
    last = paths.uv.shape[1] - 1
    path = np.concatenate([kin, crossings.path_a[used], crossings.path_b[used], kin])
    t = np.concatenate(
        [np.full(len(kin), -1.0), crossings.t_a[used], crossings.t_b[used], np.full(len(kin), last + 1.0)]
    )
    nodes = np.concatenate([ends[0], node, node, ends[1]])
    forward = np.concatenate([leave, np.zeros(len(used)), sideways, leave])
    backward = np.concatenate([arrive, np.full(len(used), np.pi), sideways + np.pi, arrive])
    order = np.lexsort((t, path))
    along = np.flatnonzero(np.diff(path[order]) == 0)
    here, there = order[along], order[along + 1]
    return _pairs(nodes[here], nodes[there], forward[here], backward[there])


def _pairs(here: Ints, there: Ints, forward: Floats, backward: Floats) -> tuple[Ints, Floats]:
    """Interleave edges with their twins: node and angle that each half-edge leaves."""
    return np.stack([here, there], axis=1).ravel(), np.stack([forward, backward], axis=1).ravel()
