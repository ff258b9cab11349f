"""What the data of a fit are worth: how far vertices and facets lie off the true part, as far as the mesh shows it.

A mesh whose vertices were sampled from a smooth part has them on it and its facets off by their sagitta.  A decimated
mesh has it the other way round: its facets straddle the part, and its vertices stand out of it by a share of the
local sagitta, which their distances from a smooth surface through them give away.  On a noisy scan both are off at
random.
"""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.vectors import TINY
from meshwind.surface.fitting.neighbours import ALIKE, Neighbourhoods, alike
from meshwind.surface.fitting.quadrature import FacetPoints, facet_points, heights
from meshwind.surface.fitting.samples import Samples
from meshwind.surface.fitting.vertex_fit import VertexFit
from meshwind.surface.surface import Surface

STANDING_OUT, SURE = 0.16, 4.0
"""Rank correlation between how far vertices stand out and their local sagitta, and its statistic t, that only
decimation leaves: meshes sampled from parts, creased or not, show up to 0.14, decimated ones 0.19 and more."""
BARE, ACROSS = 0.02, 2
"""A net whose facets cross more than so many spans over this share of the area is not held by vertices there."""
STRAY = 0.01
"""Share of the area over which a surface may lie further off the facets than twice their own sagitta."""
FACETS = 50_000
"""Facets, about, that stand for all of a larger mesh: shares and means over them are true to a per cent."""
RESOLVED = 0.1
"""Vertices that a net predicts to this share of the mesh's own elevation are resolved by it, whatever their noise."""


@dataclass(frozen=True)
class Standing:
    """How the vertices stand to a surface that was fitted to them.

    elevation: rms height of a vertex over the mean of its neighbours, on the surface; correlation and t: by rank, of
    the vertices' distances from the surface and that height, both less their neighbours' means; alike: correlation
    between a vertex's distance and the mean of its neighbours', none for noise and much for a shape not followed.
    """

    elevation: float
    correlation: float
    t: float
    alike: float

    @property
    def decimated(self) -> bool:
        """Whether the vertices stand out of the part as only decimation leaves them."""
        return self.correlation > STANDING_OUT and self.t > SURE


def vertices_lead(fitted: VertexFit, found: Standing) -> bool:
    """Whether the vertices, noisy or not, are truer than the facets, and hold the net that was fitted to them."""
    if found.decimated or strays(fitted):
        return False
    settled = fitted.settled and found.alike < ALIKE
    if settled and fitted.expected > found.elevation:  # facets show nothing but noise
        return True
    resolved = settled or fitted.expected < RESOLVED * found.elevation
    return resolved and not bare(fitted.samples, fitted.surface.spans)


def noisy(fitted: VertexFit, found: Standing) -> bool:
    """Whether what a net leaves of the vertices is noise, rather than what is left of a shape that is resolved."""
    return fitted.settled and found.alike < ALIKE and fitted.expected > RESOLVED * found.elevation


def standing(surface: Surface, samples: Samples, near: Neighbourhoods) -> Standing:
    """How the inner vertices of the part stand to a surface on whose feet they are."""
    inner = samples.trusted & ~samples.rim
    feet, normals = surface.points(samples.uv), surface.normals(samples.uv)
    off = samples.heights(surface)
    elevation = ((feet - near.mean(feet)) * normals).sum(axis=1)
    rough, uneven = (off - near.mean(off))[inner], (elevation - near.mean(elevation))[inner]
    correlation = rank_correlation(rough, uneven)
    height = float(np.sqrt(np.mean(elevation[inner] ** 2))) if inner.any() else 0.0
    return Standing(height, correlation, correlation * float(np.sqrt(max(inner.sum(), 1))), alike(off, samples, near))


def rank_correlation(a: Floats, b: Floats) -> float:
    """Spearman's correlation of two series (n,), which a few large values do not decide; 0 for fewer than two."""
    if len(a) < 2:
        return 0.0
    ranks = [np.argsort(np.argsort(values)) - 0.5 * (len(values) - 1) for values in (a, b)]
    return float((ranks[0] * ranks[1]).sum() / (ranks[0] ** 2).sum())


def strays(fitted: VertexFit) -> bool:
    """Whether a surface leaves the facets, somewhere, by more than their corners' normals and noise account for."""
    surface, samples = fitted.surface, fitted.samples
    every, normals = samples.facets.faces, samples.facets.normals
    chosen = np.arange(0, len(every), len(every) // FACETS + 1)
    faces, area = every[chosen], samples.facets.areas[chosen]
    allowed = np.zeros(len(faces))
    for k in range(3):
        i, j = faces[:, k], faces[:, (k + 1) % 3]
        angle = np.arccos(np.clip((normals[i] * normals[j]).sum(axis=1), -1.0, 1.0))
        allowed = np.maximum(allowed, np.linalg.norm(samples.points[i] - samples.points[j], axis=1) * angle / 8.0)
    points = facet_points(samples, (1, 1), chosen)
    uv = points.places(samples.uv)
    flat = points.between(samples.points)
    off = np.sqrt(points.per_facet(heights(surface, uv, flat, flat)[0] ** 2, len(every))[chosen])
    return bool(area[off > 2.0 * allowed + 0.1 * np.median(allowed) + 3.0 * fitted.noise].sum() > STRAY * area.sum())


def bare(samples: Samples, spans: tuple[int, int]) -> bool:
    """Whether a net lies free of vertices over more of the part than can be bridged from the vertices about it."""
    area = samples.facets.areas
    return bool(area[samples.across(spans) > ACROSS].sum() > BARE * area.sum())


def straddling(height: Floats, points: FacetPoints, near: Neighbourhoods) -> Floats:
    """How far points on facets (k,) would lie off the part where facets straddle it, were a surface the part.

    height (k,) is that of the surface over its own triangles; the mean about each triangle is taken off.
    """
    level = near.facet_mean(points.per_facet(height, len(near.samples.facets.faces)))
    return np.asarray(height - level[points.facet])


def rms(values: Floats, weight: Floats) -> float:
    """Weighted root mean square of values (k,)."""
    return float(np.sqrt((weight * values**2).sum() / max(weight.sum(), TINY)))


def rms_away_from_creases(values: Floats, points: FacetPoints, samples: Samples) -> float:
    """Rms of values (k,) at points on facets none of whose corners lies at a crease; 0 if there are none."""
    chosen, of = np.unique(points.facet, return_inverse=True)
    return rms(values, points.area * samples.facets.smooth_at(chosen)[of])
