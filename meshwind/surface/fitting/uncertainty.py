"""How far a fitted surface may lie off the true part, from place to place: its own error, found from its data.

What the data leave is gathered span by span and smoothed over the reach of a control point: where the part's
curvature jumps, a spline swings about its data, and there they lie off it.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from meshwind.core.cast import Bools, Floats, frozen
from meshwind.core.vectors import TINY
from meshwind.surface.fitting.evidence import FACETS, rms_away_from_creases, straddling
from meshwind.surface.fitting.facet_fit import FacetFit
from meshwind.surface.fitting.neighbours import Neighbourhoods
from meshwind.surface.fitting.quadrature import FacetPoints, facet_points, heights
from meshwind.surface.fitting.samples import Samples
from meshwind.surface.fitting.vertex_fit import VertexFit
from meshwind.surface.surface import Surface

_CUT_OFF = 4.0
"""Standard deviations at which a Gaussian is cut off."""
REACH = 2.0
"""Least spans over which what the data leave is smoothed: a control point moves the surface two spans either way."""
COVER = 3.0
"""The stated uncertainty over the rms of what is left: 99 in 100 places of vessels whose curvature jumps lie within."""
FLOOR = 0.1
"""Least local uncertainty over that of the whole: a few data may lie well by chance."""
PULL = 1e-3
"""Weight of the whole's mean against a usual span's data."""


@dataclass(frozen=True)
class Doubt:
    """What is known of a surface's own error: table (rows, columns) over u and v, a length in each span.

    data: what led the fit, "vertices" or "facets"; noise: rms noise of the vertices; sagitta: rms distance of the
    facets from the part where they straddle it.
    """

    data: str
    table: Floats
    noise: float
    sagitta: float


def of_vertices(fitted: VertexFit, near: Neighbourhoods, *, noisy: bool) -> Doubt:
    """What the vertices leave, where they led; if that is noise, what remains of it in the surface."""
    surface, samples = fitted.surface, fitted.samples
    off = samples.heights(surface)
    trusted = samples.trusted.astype(np.float64)
    square = off**2 / max(1.0 - fitted.kept, 1e-3)
    if noisy:  # a fit keeps a share of it, and next to none of it is left of the mean of many vertices
        square = fitted.kept * square + near.mean(near.mean(off)) ** 2
    table = _table(surface.spans, samples.uv, trusted * square, trusted)
    own = _sagitta(surface, samples, near)
    return Doubt("vertices", table, fitted.noise, own)


def of_facets(fitted: FacetFit, near: Neighbourhoods, *, straddle: bool) -> Doubt:
    """What the facets leave and how far they straddle the part, where they led.

    straddle: whether they are known to straddle it.  Otherwise the part may pass through the vertices, and lie on one
    side of the surface wherever these do.
    """
    surface, samples, points = fitted.surface, fitted.samples, fitted.points
    reach = max(REACH, float(np.sqrt(np.prod(surface.spans) / len(samples.points))))
    own = fitted.own_error(near)
    if fitted.straddle is not None:
        own = np.maximum(own, fitted.straddle)
    square = fitted.off**2 + own[points.facet] ** 2
    table = _table(surface.spans, fitted.uv, points.area * square, points.area, reach)
    stands = samples.heights(surface)
    noise = float(np.sqrt(np.mean(stands[samples.trusted] ** 2)))
    if not straddle:
        trusted = samples.trusted.astype(np.float64)
        aside = stands if fitted.curved else near.mean(near.mean(stands))
        table = frozen(np.hypot(table, _table(surface.spans, samples.uv, trusted * aside**2, trusted, reach)))
    if fitted.curved:
        return Doubt("curved facets", table, noise, _sagitta(surface, samples, near))
    return Doubt("facets", table, noise, rms_away_from_creases(own[points.facet], points, samples))


def _some_facets(samples: Samples, spans: tuple[int, int]) -> tuple[FacetPoints, Bools]:
    """Points on facets spread over the mesh and on all about them, and which points (k,) are on the former."""
    faces = samples.facets.faces
    middle = np.zeros(len(faces), dtype=bool)
    middle[:: len(faces) // FACETS + 1] = True
    corner = np.zeros(len(samples.points), dtype=bool)
    corner[faces[middle]] = True
    points = facet_points(samples, spans, np.flatnonzero(corner[faces].any(axis=1)))
    return points, middle[points.facet]


def _sagitta(surface: Surface, samples: Samples, near: Neighbourhoods) -> float:
    """How far flat facets lie off the part where they straddle it, were a surface the part: rms away from creases."""
    points, counted = _some_facets(samples, surface.spans)
    uv, chord = points.places(samples.uv), points.between(surface.points(samples.uv))
    _, height = heights(surface, uv, chord, chord)
    off = straddling(height, points, near)
    return rms_away_from_creases(off[counted], points.where(counted), samples)


def _table(spans: tuple[int, int], uv: Floats, square: Floats, weight: Floats, reach: float = REACH) -> Floats:
    """Uncertainty in the spans of a net from weighted squared distances (k,) of data at places uv (k, 2)."""
    rows, columns = spans
    i = np.floor((uv[:, 0] - np.floor(uv[:, 0])) * rows).astype(np.int64) % rows
    j = np.clip((uv[:, 1] * columns).astype(np.int64), 0, columns - 1)
    cell = i * columns + j
    total = np.asarray(np.bincount(cell, square, rows * columns), dtype=np.float64).reshape(spans)
    count = np.asarray(np.bincount(cell, weight, rows * columns), dtype=np.float64).reshape(spans)
    mean, usual = float(total.sum() / max(count.sum(), TINY)), max(float(count.mean()), TINY)
    # a slight pull to the mean of the whole, for spans that hold next to no data
    total, count = _smooth(total, reach) + PULL * mean * usual, _smooth(count, reach) + PULL * usual
    return frozen(COVER * np.sqrt(np.maximum(total / count, FLOOR**2 * mean)))


def _smooth(table: Floats, reach: float) -> Floats:
    return _blurred(_blurred(table, reach, "wrap").T, reach, "edge").T


def _blurred(table: Floats, reach: float, beyond: Literal["wrap", "edge"]) -> Floats:
    """Means down the columns, weighted by a Gaussian; beyond: what the table has past its ends.

    To the last bit those of SciPy's `gaussian_filter1d`, which takes longer to import than a small part to fit.
    """
    wide = int(_CUT_OFF * reach + 0.5)
    weight = np.exp(-0.5 / reach**2 * np.arange(-wide, wide + 1) ** 2)
    weight = weight / weight.sum()
    padded = np.pad(table, ((wide, wide), (0, 0)), beyond)
    count = len(table)
    total = padded[wide : wide + count] * weight[wide]
    for k in range(wide):  # from the ends to the middle, as the sums of SciPy go
        total += (padded[k : k + count] + padded[2 * wide - k : 2 * wide - k + count]) * weight[k]
    return total
