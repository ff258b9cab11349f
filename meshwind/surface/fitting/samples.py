"""The mesh's vertices as data for a fit: positions in space, and parameters that are corrected in every round."""

from dataclasses import dataclass, replace
from functools import cached_property

import igl
import numpy as np

from meshwind.chart.chart import Chart
from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.threads import parallel_for
from meshwind.mesh.geometry.facet_tree import FacetTree
from meshwind.surface.fitting.infill import ANGLE, Int8s, infill, spans_across
from meshwind.surface.fitting.point_normal import tangent_normals
from meshwind.surface.fitting.rim_points import WEIGHT, rim_points
from meshwind.surface.foot import near_feet
from meshwind.surface.surface import Surface

CUT_WEIGHT = 0.1
"""Weight of a vertex that trimming made, against 1 for a vertex of the part."""
CLOSE = 1e-5
"""Longest last step of a foot search in the plane; the error that it leaves is of the order of its square."""
SPARSE, NEAR_CUT, DENSE = 0.05, 5e-3, 5e-5
"""Weights of a point between vertices.

SPARSE is enough to determine a span that has no other data.  NEAR_CUT is for the spans next to a cut, where the
vertices that trimming made are few and have little weight.  DENSE is for spans surrounded by spans with vertices of the
part, where the point's own error (second order next to a rim, whose normals are one-sided) would show in the surface.
At openings of 14 to 18 mm in the sample bottle NEAR_CUT keeps the surface within 0.024 mm of the true part, where DENSE
lets it swing by up to 0.1 mm between vertices that it follows to 0.004 mm.
"""
CUT_REACH = 2
"""Number of spans from a cut over which NEAR_CUT applies."""


@dataclass(frozen=True)
class Facets:
    """Triangles (m, 3) between points (n, 3), with a search tree and normals that are computed on first use."""

    points: Floats
    faces: Ints

    @cached_property
    def normals(self) -> Floats:
        """Unit normals (n, 3) at the points, faces weighted by their angles there."""
        return np.asarray(igl.per_vertex_normals(self.points, self.faces, ANGLE))

    @cached_property
    def areas(self) -> Floats:
        """Areas (m,)."""
        return np.asarray(igl.doublearea(self.points, self.faces) / 2)

    @property
    def tangent_normals(self) -> Floats:
        """Normals (m, 3, 3) at the corners of curved triangles."""
        return self._tangent[0]

    @property
    def smooth(self) -> Bools:
        """Which triangles (m,) have no corner at a crease."""
        return self._tangent[1]

    def smooth_at(self, chosen: Ints) -> Bools:
        """Which of the chosen triangles (k,) have no corner at a crease: those of all are kept, those of a few not."""
        if len(chosen) == len(self.faces) or "_tangent" in self.__dict__:
            return np.asarray(self.smooth[chosen])
        corners = self.faces[chosen]
        return tangent_normals(self.points[corners], self.normals[corners])[1]

    @cached_property
    def _tangent(self) -> tuple[Floats, Bools]:
        return tangent_normals(self.points[self.faces], self.normals[self.faces])

    def distances(self, points: Floats) -> Floats:
        """Distances (k,) of points (k, 3) to the nearest triangle."""
        return self._tree.distances(points)

    @cached_property
    def _tree(self) -> FacetTree:
        return FacetTree.of(self.points, self.faces)


@dataclass(frozen=True)
class Samples:
    """Vertices about the part's middle (n, 3), their parameters (n, 2), and their weights (n,).

    rim, trusted (n,): whether a vertex lies on a rim, and whether it is one of the part's own; turns (m, 3): the turns
    of u by which the corners of a triangle differ from its vertices' parameters; facets: the triangles between points.
    """

    points: Floats
    uv: Floats
    weight: Floats
    rim: Bools
    trusted: Bools
    middle: Floats
    chart: Chart
    turns: Int8s
    facets: Facets
    near: bool = False
    """Whether the last net came near everywhere: only then do the vertices alone determine the next one."""

    @staticmethod
    def of(chart: Chart) -> "Samples":
        """All vertices of a chart's annulus, at their parameters on the chart."""
        annulus = chart.annulus
        middle = annulus.vertices.mean(axis=0)
        rim = np.zeros(len(annulus.vertices), dtype=bool)
        rim[np.concatenate(annulus.rims)] = True
        weight = np.where(annulus.trusted, 1.0, CUT_WEIGHT)
        points = annulus.vertices - middle
        turns = np.round(chart.corner_uv[..., 0] - chart.uv[annulus.faces, 0]).astype(np.int8)
        facets = Facets(points, annulus.faces)
        return Samples(points, np.array(chart.uv), weight, rim, annulus.trusted, middle, chart, turns, facets)

    @cached_property
    def size(self) -> float:
        """Diagonal of the vertices' bounding box."""
        return float(np.linalg.norm(np.ptp(self.points, axis=0)))

    def corner_uv(self, chosen: Ints | slice = slice(None)) -> Floats:
        """Parameters (k, 3, 2) of the corners of all triangles, or of the chosen ones: connected across the seam."""
        corners = self.uv[self.facets.faces[chosen]]
        corners[..., 0] += self.turns[chosen]
        return corners

    def across(self, spans: tuple[int, int]) -> Int8s:
        """Widths (m,) of the triangles in spans of a net."""
        faces = self.facets.faces
        across = np.empty(len(faces), dtype=np.int8)
        parallel_for(spans_across, len(across), 20_000, faces, self.uv, self.turns, spans, across)
        return across

    def heights(self, surface: Surface) -> Floats:
        """Heights (n,) of the vertices over a surface, along its normals at their parameters."""
        return np.asarray(((self.points - surface.points(self.uv)) * surface.normals(self.uv)).sum(axis=1))

    def between(self, spans: tuple[int, int]) -> tuple[Floats, Floats, Floats]:
        """Points between vertices for a net with so many spans: uv (k, 2), positions (k, 3) and weights (k,)."""
        across = self.across(spans)
        coarse = np.flatnonzero(across > 1)
        if not len(coarse):
            return np.zeros((0, 2)), np.zeros((0, 3)), np.zeros(0)
        chosen = self.facets.faces[coarse]
        corners = self.corner_uv(coarse)
        uv, points = infill(self.points[chosen], self.facets.normals[chosen], corners, across[coarse])
        on, rims = self._rim_points(spans[0])
        weight = np.append(self._infill_weights(uv, spans), np.full(len(on), WEIGHT))
        return np.concatenate([uv, on]), np.concatenate([points, rims]), weight

    def _rim_points(self, around: int) -> tuple[Floats, Floats]:
        """Points (k, 2) and (k, 3) on the rims that are the part's own, once the net is near."""
        none = np.zeros((0, 2)), np.zeros((0, 3))
        own = [rim for rim in self.chart.annulus.rims if self.near and self.trusted[rim].all()]
        found = [none, *[rim_points(self.uv[rim], self.points[rim], around) for rim in own]]
        return np.concatenate([uv for uv, _ in found]), np.concatenate([points for _, points in found])

    def _infill_weights(self, uv: Floats, spans: tuple[int, int]) -> Floats:
        """Weights (k,) of points at uv (k, 2) between vertices: low where all spans around them contain vertices."""
        if not self.near:
            return np.full(len(uv), SPARSE)
        filled = np.zeros(spans, dtype=bool)
        filled[span_of(self.uv, spans)] = True
        cut = np.zeros(spans, dtype=bool)
        cut[span_of(self.uv[~self.trusted], spans)] = True
        for _ in range(CUT_REACH):
            cut = ~_inner(~cut)
        span = span_of(uv, spans)
        return np.where(_inner(filled)[span], np.where(cut[span], NEAR_CUT, DENSE), SPARSE)

    def corrected(self, surface: Surface) -> tuple["Samples", Floats]:
        """The samples with every vertex at its foot, on a rim the foot on that rim; and the distances (n,)."""
        moved, distance = self.uv.copy(), np.empty(len(self.uv))
        parallel_for(near_feet, len(moved), 6000, surface.net, self.points, CLOSE, moved, distance)
        rim = np.flatnonzero(self.rim)
        moved[rim, 1] = self.uv[rim, 1]
        at = surface.frames(self.uv[rim])
        miss = self.points[rim] - at[:, 0]
        moved[rim, 0] = self.uv[rim, 0] + (miss * at[:, 1]).sum(axis=1) / (at[:, 1] ** 2).sum(axis=1)
        distance[rim] = np.linalg.norm(self.points[rim] - surface.points(moved[rim]), axis=1)
        return replace(self, uv=moved), distance


def _inner(spans: Bools) -> Bools:
    """The marked spans (nu, nv) that only marked ones surround; beyond the rims all count as marked."""
    wide = np.pad(spans, ((0, 0), (1, 1)), constant_values=True)
    wide = wide[:, :-2] & wide[:, 1:-1] & wide[:, 2:]
    return np.asarray(wide & np.roll(wide, 1, axis=0) & np.roll(wide, -1, axis=0))


def span_of(uv: Floats, spans: tuple[int, int]) -> tuple[Ints, Ints]:
    """Indices of the spans that points (n, 2) lie in."""
    index = np.floor(uv * spans).astype(np.int64)
    return index[:, 0] % spans[0], np.clip(index[:, 1], 0, spans[1] - 1)
