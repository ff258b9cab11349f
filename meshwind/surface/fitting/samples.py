"""The mesh's vertices as data for a fit: where they lie in space and, corrected round by round, in the plane."""

from dataclasses import dataclass, replace
from functools import cached_property

import igl
import numpy as np

from meshwind.chart.chart import Chart
from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.threads import spread
from meshwind.mesh.geometry.facet_tree import FacetTree
from meshwind.surface.fitting.infill import ANGLE, Int8s, infill, spans_across
from meshwind.surface.foot import near_feet
from meshwind.surface.surface import Surface

LOOSE = 0.1
"""Weight of a vertex that trimming made, against one of the part's own."""
CLOSE = 1e-5
"""Of the plane: a foot's last step is at most so long, and what it leaves is of the order of its square."""
INFILL, FAIR, SLIGHT = 0.05, 5e-3, 5e-5
"""Weight of a point between vertices: enough to hold a span that has nothing else; next to a cut, where the vertices
that trimming made are few and count for little; and among spans that all hold vertices of the part, where its own error
(second order next to a rim, whose normals are one-sided) would show in the surface.

At openings of 14 to 18 mm in the sample bottle FAIR keeps the surface within 0.024 mm of the true part, where SLIGHT
let it swing by up to 0.1 mm between vertices that it followed to 0.004 mm.
"""
NEXT = 2
"""Spans that a cut makes itself felt over."""


@dataclass(frozen=True)
class Facets:
    """The triangles (m, 3) between points (n, 3), with a search tree and normals made on first use."""

    points: Floats
    faces: Ints

    @cached_property
    def normals(self) -> Floats:
        """Unit normals (n, 3) at the points, faces weighted by their angles there."""
        return np.asarray(igl.per_vertex_normals(self.points, self.faces, ANGLE))

    def distances(self, points: Floats) -> Floats:
        """Distances (k,) of points (k, 3) to the nearest triangle."""
        return self._tree.distances(points)

    @cached_property
    def _tree(self) -> FacetTree:
        return FacetTree.of(self.points, self.faces)


@dataclass(frozen=True)
class Samples:
    """Vertices about the part's middle (n, 3), their place in the plane (n, 2), and how far they count (n,).

    turns (m, 3) are the turns of u by which the corners of a triangle lie off their vertices' places; facets finds
    the nearest facet.
    """

    points: Floats
    uv: Floats
    weight: Floats
    rim: Bools
    trusted: Bools
    middle: Floats
    chart: Chart
    turns: Int8s
    facets: "Facets"
    near: bool = False
    """Whether the last net came near everywhere: only then can vertices be left to hold the next one alone."""

    @staticmethod
    def of(chart: Chart) -> "Samples":
        """All vertices of a chart's annulus, at their places on the chart."""
        annulus = chart.annulus
        middle = annulus.vertices.mean(axis=0)
        rim = np.zeros(len(annulus.vertices), dtype=bool)
        rim[np.concatenate(annulus.rims)] = True
        weight = np.where(annulus.trusted, 1.0, LOOSE)
        points = annulus.vertices - middle
        turns = np.round(chart.corner_uv[..., 0] - chart.uv[annulus.faces, 0]).astype(np.int8)
        facets = Facets(points, annulus.faces)
        return Samples(points, np.array(chart.uv), weight, rim, annulus.trusted, middle, chart, turns, facets)

    def between(self, spans: tuple[int, int]) -> tuple[Floats, Floats, Floats]:
        """Points between vertices for a net: in the plane (k, 2), about the middle (k, 3), weights (k,)."""
        annulus = self.chart.annulus
        across = np.empty(len(annulus.faces), dtype=np.int8)
        spread(spans_across, len(across), 20_000, annulus.faces, self.uv, self.turns, spans, across)
        coarse = np.flatnonzero(across > 1)
        if not len(coarse):
            return np.zeros((0, 2)), np.zeros((0, 3)), np.zeros(0)
        corners = self.uv[annulus.faces[coarse]]
        corners[..., 0] += self.turns[coarse]
        chosen = annulus.faces[coarse]
        uv, points = infill(self.points[chosen], self.facets.normals[chosen], corners, across[coarse])
        return uv, points, self._hold(uv, spans)

    def _hold(self, uv: Floats, spans: tuple[int, int]) -> Floats:
        """How far points (k, 2) between vertices count: little where all spans about them hold vertices."""
        if not self.near:
            return np.full(len(uv), INFILL)
        held = np.zeros(spans, dtype=bool)
        held[_span(self.uv, spans)] = True
        cut = np.zeros(spans, dtype=bool)
        cut[_span(self.uv[~self.trusted], spans)] = True
        for _ in range(NEXT):
            cut = ~_inner(~cut)
        there = _span(uv, spans)
        return np.where(_inner(held)[there], np.where(cut[there], FAIR, SLIGHT), INFILL)

    def corrected(self, surface: Surface) -> tuple["Samples", Floats]:
        """Every vertex moved to its foot in the plane, on a rim along the rim; and the distances (n,)."""
        moved, distance = self.uv.copy(), np.empty(len(self.uv))
        spread(near_feet, len(moved), 6000, surface.net, self.points, CLOSE, moved, distance)
        rim = np.flatnonzero(self.rim)
        moved[rim, 1] = self.uv[rim, 1]
        at = surface.frames(self.uv[rim])
        miss = self.points[rim] - at[:, 0]
        moved[rim, 0] = self.uv[rim, 0] + (miss * at[:, 1]).sum(axis=1) / (at[:, 1] ** 2).sum(axis=1)
        distance[rim] = np.linalg.norm(self.points[rim] - surface.points(moved[rim]), axis=1)
        return replace(self, uv=moved), distance


def _inner(spans: Bools) -> Bools:
    """Those of the marked spans (nu, nv) that have only marked ones about them; nothing lies beyond the rims."""
    wide = np.pad(spans, ((0, 0), (1, 1)), constant_values=True)
    wide = wide[:, :-2] & wide[:, 1:-1] & wide[:, 2:]
    return np.asarray(wide & np.roll(wide, 1, axis=0) & np.roll(wide, -1, axis=0))


def _span(uv: Floats, spans: tuple[int, int]) -> tuple[Ints, Ints]:
    """Indices of the span that each of the points (n, 2) lies in."""
    index = np.floor(uv * spans).astype(np.int64)
    return index[:, 0] % spans[0], np.clip(index[:, 1], 0, spans[1] - 1)
