"""Fit the smooth surface to a chart: to the vertices of a sampled part, to the facets of a decimated one.

Which of the two, and how far off they are, is found from the mesh itself (`evidence`).
"""

from __future__ import annotations

from dataclasses import replace
from numbers import Real

import numpy as np
from threadpoolctl import ThreadpoolController

from meshwind.chart.chart import Chart, speeds
from meshwind.core.defaults import FIT_TOLERANCE
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import shortened
from meshwind.surface.fitting.certify import certify
from meshwind.surface.fitting.evidence import noisy, standing, vertices_lead
from meshwind.surface.fitting.facet_fit import fit_facets
from meshwind.surface.fitting.neighbours import Neighbourhoods
from meshwind.surface.fitting.samples import Samples
from meshwind.surface.fitting.uncertainty import of_facets, of_vertices
from meshwind.surface.fitting.vertex_fit import fit_vertices
from meshwind.surface.surface import Surface

COARSEST, LEAST, LEVELS = 8, 4, 18
"""Spans of the coarsest net in u, least number of spans in v, and number of nets."""
SLENDER = 16.0
"""Largest ratio of spans in v and in u, either way round; beyond it spans are no longer square."""


def fit(chart: Chart, tolerance: float = FIT_TOLERANCE) -> Surface:
    """Fit a bicubic surface to a flattened mesh.

    The control net is the coarsest one that meets the tolerance or that leaves little against what the mesh itself
    leaves open.  Vertices are fitted where they were sampled from a smooth part, noise or none; the facets where a
    mesh was decimated, or where vertices alone do not hold a net; which of them led is `Surface.error.data`.

    Parameters
    ----------
    chart : Chart
        Flattened mesh, from `flatten`.
    tolerance : float, default 1e-5
        Largest distance of a vertex from the surface, over the diagonal of the mesh's bounding box.

    Returns
    -------
    Surface
        Surface in the mesh's units, periodic in u, with the error of the fit in both directions as `Surface.error` and
        how far it may lie off the true part as `Surface.uncertainty`.  It may miss the tolerance where the mesh does
        not support a finer net.

    Raises
    ------
    BadInputError
        If `chart` is not a Chart or `tolerance` is not above 0.

    Examples
    --------
    >>> import meshwind as mw
    >>> chart = mw.flatten(mw.annulus(mw.read("data/elbow.obj")))
    >>> surface = mw.fit(chart, tolerance=1e-4)
    >>> surface.error.to_surface_max <= 1e-4 * surface.error.diagonal
    True
    """
    if not isinstance(chart, Chart):
        raise BadInputError(f"fit takes a Chart, not {type(chart).__name__}; make one with flatten(annulus)")
    if not (isinstance(tolerance, Real) and tolerance > 0):
        raise BadInputError(
            f"tolerance is {shortened(repr(tolerance))}; give a share of the diagonal above 0, such as 1e-5"
        )
    annulus = chart.annulus
    limit = tolerance * float(np.linalg.norm(np.ptp(annulus.vertices, axis=0)))
    samples, lengths = Samples.of(chart), _lengths(chart)
    nets, near = _nets(lengths), Neighbourhoods(samples)
    # one thread of BLAS: the bands are narrow, more threads cost up to ten times as much and blur the last bits
    with ThreadpoolController().limit(limits=1, user_api="blas"):
        led = fit_vertices(samples, nets, lengths, near, limit)
        found = None if led.largest <= limit else standing(led.surface, led.samples, near)
        if found is None or vertices_lead(led, found):
            surface, samples = led.surface, led.samples
            doubt = of_vertices(led, near, noisy=found is not None and noisy(led, found))
        else:
            followed = fit_facets(samples, nets, lengths, near, limit, flat=found.decimated)
            surface, samples = followed.surface, followed.samples
            doubt = of_facets(followed, near, straddle=found.decimated)
    error = replace(certify(surface, samples), data=doubt.data, noise=doubt.noise, sagitta=doubt.sagitta)
    return Surface(surface.control_points + samples.middle, True, error, doubt.table)


def _lengths(chart: Chart) -> tuple[float, float]:
    """Mean lengths on the part: once around in u, and from end to end in v."""
    area, s_u, s_v = speeds(chart.annulus, chart.corner_uv)
    return float(np.average(s_u, weights=area)), float(np.average(s_v, weights=area))


def _nets(lengths: tuple[float, float]) -> list[tuple[int, int]]:
    """Spans of nets with square spans on the part, each with about twice the control points of the one before."""
    aspect = min(max(lengths[1] / lengths[0], 1 / SLENDER), SLENDER)
    sizes = [int(np.ceil(COARSEST * 2 ** (k / 2))) for k in range(LEVELS)]
    return [(size, max(LEAST, round(size * aspect))) for size in sizes]
