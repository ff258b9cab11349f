"""Points spread evenly over the facets: the integral over the polyhedron that a net is fitted to."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import copy_table, fill_table
from meshwind.core.threads import parallel_for
from meshwind.core.vectors import TINY
from meshwind.surface.evaluate import SU, SV, S, frame
from meshwind.surface.fitting import point_normal
from meshwind.surface.fitting.samples import Facets, Samples
from meshwind.surface.surface import Surface

FEWEST, WIDEST = 2, 8.0
"""Least number of pieces that the edge of a facet is divided into, and the spans that a facet may cross undivided: each
gets one more piece than the spans that it crosses, and larger ones are halved across their longest edge first."""
DEPTH = 48
"""Most halvings on the way to a part of a facet."""


@dataclass(frozen=True)
class FacetPoints:
    """Points on the facets: facet (k,), barycentric shares of its corners (k, 3), and the area (k,) of each point.

    corners (k, 3) are the vertices at the facet's corners; turns (k, 3) the turns of u by which they lie off their
    vertices' places in the plane.
    """

    facet: Ints
    corners: Ints
    share: Floats
    turns: Floats
    area: Floats

    def between(self, values: Floats) -> Floats:
        """Values (n, d) at the vertices, linear over the facets, at the points: (k, d)."""
        out = np.empty((len(self.facet), values.shape[1]))
        parallel_for(_between, len(out), 20_000, self.corners, self.share, values, out)
        return out

    def places(self, uv: Floats) -> Floats:
        """The points' places in the plane (k, 2) from the vertices' (n, 2)."""
        out = self.between(uv)
        out[:, 0] += (self.share * self.turns).sum(axis=1)
        return out

    def on(self, facets: Facets, *, curved: bool) -> Floats:
        """The points (k, 3) on facets, or on curved point-normal triangles with their corners, flat at creases."""
        if not curved:
            return self.between(facets.points)
        return point_normal.curved(self.facet, self.corners, self.share, facets.points, facets.tangent_normals)

    def where(self, chosen: Bools) -> "FacetPoints":
        """The chosen ones (k,) of the points."""
        return FacetPoints(
            self.facet[chosen], self.corners[chosen], self.share[chosen], self.turns[chosen], self.area[chosen]
        )

    def per_facet(self, values: Floats, faces: int) -> Floats:
        """Means (m,) over each of the facets of values (k,) at the points."""
        total = np.bincount(self.facet, self.area * values, faces)
        return np.asarray(total / np.maximum(np.bincount(self.facet, self.area, faces), TINY))


def facet_points(samples: Samples, spans: tuple[int, int], chosen: Ints | None = None) -> FacetPoints:
    """Points on the facets of a mesh, or on chosen ones, several for each span of a net that a facet crosses."""
    chosen = np.arange(len(samples.facets.faces)) if chosen is None else chosen
    faces = samples.facets.faces[chosen]
    count = np.empty(len(faces), dtype=np.int64)
    corners = samples.corner_uv(chosen) * spans
    parallel_for(_count, len(faces), 10_000, corners, count)
    first = np.zeros(len(faces) + 1, dtype=np.int64)
    np.cumsum(count, out=first[1:])
    share, area = np.empty((first[-1], 3)), np.empty(first[-1])
    parallel_for(_fill, len(faces), 10_000, corners, first, share, area)
    facet = np.repeat(chosen, count)
    area *= samples.facets.areas[facet]
    return FacetPoints(facet, samples.facets.faces[facet], share, samples.turns[facet].astype(np.float64), area)


def heights(surface: Surface, uv: Floats, above: Floats, below: Floats) -> tuple[Floats, Floats]:
    """Along the surface's normals at uv (k, 2): heights (k,) of points `above` over it, of it over those `below`."""
    high, low = np.empty(len(uv)), np.empty(len(uv))
    parallel_for(_heights, len(uv), 5000, surface.spline, uv, above, below, high, low)
    return high, low


@njit(nogil=True, cache=True)
def _heights(first, last, spline, uv, above, below, high, low):
    """Write the heights at places first to last."""
    at, normal = np.empty((6, 3)), np.empty(3)
    for n in range(first, last):
        frame(spline, uv[n, 0], uv[n, 1], at)
        for k in range(3):
            i, j = (k + 1) % 3, (k + 2) % 3
            normal[k] = at[SU, i] * at[SV, j] - at[SU, j] * at[SV, i]
        size = max(np.sqrt(normal[0] ** 2 + normal[1] ** 2 + normal[2] ** 2), TINY)
        up = down = 0.0
        for k in range(3):
            up += (above[n, k] - at[S, k]) * normal[k]
            down += (at[S, k] - below[n, k]) * normal[k]
        high[n], low[n] = up / size, down / size


@njit(nogil=True, cache=True)
def _count(first, last, corners, count):
    """Write the numbers of the points on facets first to last."""
    share, area, stack = np.empty((0, 3)), np.empty(0), np.empty((DEPTH + 1, 3, 3))
    for m in range(first, last):
        count[m] = _points(corners[m], stack, 0, share, area)


@njit(nogil=True, cache=True)
def _fill(first, last, corners, start, share, area):
    """Write the points on facets first to last as shares of their corners, and their shares of the facets' areas."""
    stack = np.empty((DEPTH + 1, 3, 3))
    for m in range(first, last):
        _points(corners[m], stack, start[m], share, area)


@njit(nogil=True, cache=True)
def _points(corners, stack, at, share, area):
    """Divide a facet into parts that cross few spans, and write their points from number `at` on; their number.

    corners (3, 2) are in spans of the net.  Only counts where `share` has no rows.  stack holds corners (3, 3) of
    parts, as shares of the facet's.
    """
    depths, count = np.zeros(DEPTH + 1, dtype=np.int64), 0
    fill_table(stack[0], 0.0)
    for c in range(3):
        stack[0, c, c] = 1.0
    top = 0
    while top >= 0:
        depth, part = depths[top], stack[top].copy()
        at_corners = part @ corners
        widest, longest, edge = 0.0, -1.0, 0
        for c in range(3):
            du = at_corners[(c + 1) % 3, 0] - at_corners[c, 0]
            dv = at_corners[(c + 1) % 3, 1] - at_corners[c, 1]
            widest = max(widest, abs(du), abs(dv))
            if du * du + dv * dv > longest:
                longest, edge = du * du + dv * dv, c
        if widest > WIDEST and depth < DEPTH:
            after = (edge + 1) % 3
            copy_table(part, stack[top + 1])
            for c in range(3):
                stack[top, edge, c] = stack[top + 1, after, c] = 0.5 * (part[edge, c] + part[after, c])
            depths[top], depths[top + 1] = depth + 1, depth + 1
            top += 1
            continue
        top -= 1
        n = max(int(np.ceil(widest)) + 1, FEWEST)
        if len(share):
            here = slice(at + count, at + count + n**2)
            _lattice(part, n, 0.5**depth / n**2, share[here], area[here])
        count += n**2
    return count


@njit(nogil=True, cache=True)
def _lattice(part, n, each, share, area):
    """Write the centres of the n^2 like parts of a triangle, as shares of the facet's corners, and their area."""
    k = 0
    for i in range(n):
        for j in range(n - i):
            for turned in range(2 if i + j < n - 1 else 1):
                offset = (1 + turned) / 3.0
                a, b = (i + offset) / n, (j + offset) / n
                for c in range(3):
                    share[k, c] = a * part[0, c] + b * part[1, c] + (1.0 - a - b) * part[2, c]
                area[k] = each
                k += 1


@njit(nogil=True, cache=True)
def _between(first, last, corners, share, values, out):
    """Interpolate values at the corners at points first to last."""
    for k in range(first, last):
        for d in range(values.shape[1]):
            total = 0.0
            for c in range(3):
                total += share[k, c] * values[corners[k, c], d]
            out[k, d] = total
