"""The quad mesh on the crossings, and how well shaped its quads are."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.core.geometry import Block, Geometric
from meshwind.core.vectors import TINY, unit
from meshwind.layup.crossings import Crossings
from meshwind.layup.faces import split, trace
from meshwind.layup.graph import Graph
from meshwind.path.paths import Paths

_ON_RIM = 1e-9
"""Closer to v=0 or v=1 than this a particle is on the rim."""


@dataclass(frozen=True)
class QuadMesh(Geometric):
    """An annulus of quads, with triangles at the rims; corners run counterclockwise seen from outside.

    points (k, 3); uv (k, 2) with u in [0, 1); quads (q, 4) and triangles (t, 3) indices of points; on_surface
    (k,); left_out: the paths that could not take part, because they run along a rim or cross their own family;
    note: why there are no faces, and points are but the ends of the paths, or "".
    """

    points: Floats
    uv: Floats
    quads: Ints
    triangles: Ints
    on_surface: Bools
    left_out: tuple[int, ...] = ()
    note: str = ""

    __repr__ = brief

    @property
    def block(self) -> Block:
        """The faces, with the fields of quads.vtu."""
        data = {"uv": self.uv, "on_surface": self.on_surface}
        return Block(self.points, quads=self.quads, triangles=self.triangles, point_data=data)

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
    # one number per edge: np.unique over rows takes five times as long
    keys, counts = np.unique(ends[:, 0] * most + ends[:, 1], return_counts=True)
    return np.stack(np.divmod(keys, most), axis=1), counts


def quads(paths: Paths, crossings: Crossings) -> QuadMesh:
    """Mesh the part by its crossings, over the paths that `crossings` compared.

    The result is a manifold annulus, or has no face and a `note` that says why.
    """
    kept = crossings.compared & _spans_the_part(paths)
    kept &= ~_cross_their_own(crossings.own, kept)
    left_out = tuple(np.flatnonzero(crossings.compared & ~kept).tolist())
    if not all((kept & (paths.family == family)).any() for family in (1, -1)):
        return _empty(paths, left_out, "no path of one family runs clear from rim to rim: use fewer revolutions")
    graph = Graph.of(paths, crossings, kept)
    if not len(graph.crossing):
        return _empty(paths, left_out, "the two families never cross: use more revolutions")
    polygons = trace(graph)
    if polygons is None:
        return _empty(paths, left_out, "the fibres do not divide the part into cells: use more paths per family")
    points, uv, on_surface = graph.nodes(paths, crossings)
    fours, threes = split(polygons, points)
    mesh = QuadMesh(frozen(points), frozen(uv), frozen(fours), frozen(threes), frozen(on_surface), left_out)
    if mesh.euler != 0 or edge_counts(fours, threes)[1].max(initial=0) > 2:
        return _empty(paths, left_out, "the fibres' cells do not join to a manifold: use more paths per family")
    return mesh


def _empty(paths: Paths, left_out: tuple[int, ...], note: str) -> QuadMesh:
    """A mesh without faces, whose points are the ends of the paths."""
    points, uv = (each[:, [0, -1]].reshape(-1, each.shape[2]) for each in (paths.points, paths.uv))
    uv = uv - np.floor(uv) * [1.0, 0.0]
    fours, threes = (frozen(np.zeros((0, n), dtype=np.int64)) for n in (4, 3))
    on_surface = frozen(np.ones(len(points), dtype=bool))
    return QuadMesh(frozen(points), frozen(uv), fours, threes, on_surface, left_out, note)


def _spans_the_part(paths: Paths) -> Bools:
    """Whether each path starts on v=0, ends on v=1 and touches neither rim between."""
    v = paths.uv[..., 1]
    inner = v[:, 1:-1]
    clear = ((inner > _ON_RIM) & (inner < 1.0 - _ON_RIM)).all(axis=1)
    return np.asarray(clear & (v[:, 0] < _ON_RIM) & (v[:, -1] > 1.0 - _ON_RIM))


def _cross_their_own(pairs: Ints, kept: Bools) -> Bools:
    """The fewest of the kept paths, picked greedily, without which none crosses itself or its own family."""
    pairs = np.unique(pairs[kept[pairs].all(axis=1)], axis=0)
    out = np.zeros(len(kept), dtype=bool)
    while len(pairs):
        worst = np.bincount(pairs.ravel()).argmax()
        out[worst] = True
        pairs = pairs[(pairs != worst).all(axis=1)]
    return out


@dataclass(frozen=True)
class QuadQuality:
    """Shape of q quads.

    jacobian (q,): the scaled Jacobian, the smallest sine of a corner by the quad's own normal: 1 for a rectangle, 0 or
    less where it is not convex; aspect (q,): longest over shortest side; warp (q,): distance between the diagonals over
    the mean side, 0 for a plane quad; inner (q,): no side on a rim; convex (q,).
    """

    jacobian: Floats
    aspect: Floats
    warp: Floats
    inner: Bools
    convex: Bools

    __repr__ = brief

    @property
    def convex_share(self) -> float:
        """Share of the inner quads that are convex; 1 where there is none."""
        return float(self.convex[self.inner].mean()) if self.inner.any() else 1.0


def quad_quality(mesh: QuadMesh) -> QuadQuality:
    """Measure every quad of a mesh."""
    corners = mesh.points[mesh.quads]
    ahead = np.roll(corners, -1, axis=1) - corners
    behind = np.roll(corners, 1, axis=1) - corners
    side = np.linalg.norm(ahead, axis=2)
    normal = unit(np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]))
    sine = (np.cross(ahead, behind) * normal[:, None]).sum(axis=2)
    sine /= np.maximum(side * np.roll(side, 1, axis=1), TINY)
    jacobian = sine.min(axis=1, initial=1.0)
    aspect = side.max(axis=1, initial=0.0) / np.maximum(side.min(axis=1, initial=np.inf), TINY)
    warp = np.abs(((corners[:, 1] - corners[:, 0]) * normal).sum(axis=1)) / np.maximum(side.mean(axis=1), TINY)
    on_rim = np.isin(mesh.uv[:, 1], (0.0, 1.0))[mesh.quads]
    inner = ~(on_rim & np.roll(on_rim, 1, axis=1)).any(axis=1)
    return QuadQuality(*map(frozen, (jacobian, aspect, warp, inner, jacobian > 0.0)))
