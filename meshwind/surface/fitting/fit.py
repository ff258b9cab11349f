"""Fit the smooth surface to a chart: least squares on the vertices with parameter correction (Hoschek)."""

from dataclasses import dataclass, replace

import numpy as np
from threadpoolctl import ThreadpoolController

from meshwind.chart.chart import Chart, speeds
from meshwind.core.defaults import FIT_TOLERANCE
from meshwind.core.errors import BadInputError
from meshwind.surface.evaluate import DEGREE
from meshwind.surface.fitting import normal_equations
from meshwind.surface.fitting.certify import certify, to_mesh
from meshwind.surface.fitting.noise import roughness
from meshwind.surface.fitting.samples import Samples
from meshwind.surface.surface import Surface

ROUNDS = 4
"""Number of fits of one net, the vertices' parameters moved to their feet in between; the error settles in 3 or 4."""
SMOOTHING = 1e-4
"""Weight of the bending energy against the data at the net's own wave length.

Small beside the spline's error, which is of the same order.
"""
GAIN = 0.95
"""A finer net must reduce the expected error below this share of the best so far, or the mesh supports no finer one."""
SUPPORT, FACET_SUPPORT = 0.5, 2.0
"""Maximum number of control points per vertex: on the vertices alone, and with points on the facets between them."""
ROUGH = 2.0
"""An error above this multiple of the mesh's own roughness is not noise."""
NEAR = 1e-3
"""Largest distance over the diagonal at which the vertices alone determine the next net."""
MAX_IDLE_NETS = 2
"""Maximum number of finer nets in a row without that gain; one alone may be chance."""
COARSEST, LEAST, LEVELS = 8, 4, 18
"""Spans of the coarsest net in u, least number of spans in v, and number of nets."""
SLENDER = 16.0
"""Largest ratio of spans in v and in u, either way round; beyond it spans are no longer square."""
FREEDOM = 1e-3
"""Least share of the data's degrees of freedom that a net leaves, so that the expected error stays finite."""


@dataclass(frozen=True)
class _Fitted:
    """The fit of one net: the surface, the samples at their feet, and the trusted vertices' distances.

    rms and largest are of these distances; expected is the rms distance to be expected of vertices that were not fitted
    (generalised cross-validation, Craven and Wahba 1979): it grows where a net follows noise.
    """

    surface: Surface
    samples: Samples
    rms: float
    expected: float
    largest: float

    def both_ways(self) -> float:
        """The larger rms distance: vertices to surface, or surface to facets."""
        return max(self.rms, float(np.sqrt(np.mean(to_mesh(self.surface, self.samples)[0] ** 2))))


def fit(chart: Chart, tolerance: float = FIT_TOLERANCE) -> Surface:
    """Fit a bicubic surface to a flattened mesh.

    The control net is the coarsest one that meets the tolerance or that the mesh supports.  The vertices are fitted,
    not samples of the facets: vertices lie on the true part, facets do not.

    Parameters
    ----------
    chart : Chart
        Flattened mesh, from `flatten`.
    tolerance : float, default 1e-5
        Largest distance of a vertex from the surface, over the diagonal of the mesh's bounding box.

    Returns
    -------
    Surface
        Surface in the mesh's units, periodic in u, with the error of the fit in both directions as `Surface.error`.  It
        may miss the tolerance where the mesh does not support a finer net.

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
    if not tolerance > 0:
        raise BadInputError(f"tolerance is {tolerance}; give a share of the diagonal above 0, such as 1e-5")
    annulus = chart.annulus
    diagonal = float(np.linalg.norm(np.ptp(annulus.vertices, axis=0)))
    samples = Samples.of(chart)
    lengths = _lengths(chart)
    coarsest, *finer = _nets(lengths)
    count = len(annulus.vertices)
    # one thread of BLAS: the bands are narrow, more threads cost up to ten times as much and blur the last bits
    with ThreadpoolController().limit(limits=1, user_api="blas"):
        fitted = _fit(samples, coarsest, lengths)
        idle = 0
        for spans in finer:
            size = spans[0] * (spans[1] + DEGREE)
            smooth = size <= SUPPORT * count and idle < MAX_IDLE_NETS
            if fitted.largest <= tolerance * diagonal or not smooth:
                break
            trial = _fit(fitted.samples, spans, lengths)
            idle = 0 if trial.expected < GAIN * fitted.expected else idle + 1
            if trial.expected < fitted.expected:
                fitted = trial
        if fitted.largest > tolerance * diagonal and fitted.rms > ROUGH * roughness(samples.points):
            fitted = _follow_facets(fitted, finer, lengths, count)
    error = certify(fitted.surface, fitted.samples)
    return Surface(fitted.surface.control_points + samples.middle, True, error)


def _lengths(chart: Chart) -> tuple[float, float]:
    """Mean lengths on the part: once around in u, and from end to end in v."""
    area, s_u, s_v = speeds(chart.annulus, chart.corner_uv)
    return float(np.average(s_u, weights=area)), float(np.average(s_v, weights=area))


def _follow_facets(fitted: _Fitted, finer: list[tuple[int, int]], lengths: tuple[float, float], count: int) -> _Fitted:
    """Refine past what the vertices alone support, with points between them, while surface and facets come nearer.

    For a mesh that is neither smooth nor noisy: creases and long flat triangles, as CAD programs write them.
    """
    best, idle = fitted.both_ways(), 0
    for spans in finer:
        size = spans[0] * (spans[1] + DEGREE)
        if size <= fitted.surface.control_points.size / 3:
            continue
        if size > FACET_SUPPORT * count or idle == MAX_IDLE_NETS:
            break
        trial = _fit(fitted.samples, spans, lengths)
        found = trial.both_ways()
        idle = 0 if found < GAIN * best else idle + 1
        if found < best:
            fitted, best = trial, found
    return fitted


def _nets(lengths: tuple[float, float]) -> list[tuple[int, int]]:
    """Spans of nets with square spans on the part, each with about twice the control points of the one before."""
    aspect = min(max(lengths[1] / lengths[0], 1 / SLENDER), SLENDER)
    sizes = [int(np.ceil(COARSEST * 2 ** (k / 2))) for k in range(LEVELS)]
    return [(size, max(LEAST, round(size * aspect))) for size in sizes]


def _fit(samples: Samples, spans: tuple[int, int], lengths: tuple[float, float]) -> _Fitted:
    """Fit one net in several rounds, moving the samples to their feet in between."""
    nu, nv = spans[0], spans[1] + 3
    bending = normal_equations.thin_plate(*spans, *lengths)
    pitch = lengths[0] / spans[0], lengths[1] / spans[1]
    density = samples.weight.sum() / (lengths[0] * lengths[1])
    bending *= SMOOTHING * density * (pitch[0] * pitch[1]) ** 2 / (2 * np.pi) ** 4
    surface = None
    for _ in range(ROUNDS):
        if surface is not None:
            samples, _ = samples.corrected(surface)
        stencil, right = bending.copy(), np.zeros((nu, nv, 3))
        normal_equations.accumulate(samples.uv, samples.points, samples.weight, *spans, stencil, right)
        inner, points, weight = samples.between(spans)
        normal_equations.accumulate(inner, points, weight, *spans, stencil, right)
        surface = Surface(normal_equations.solve(stencil, right))
    assert surface is not None  # ROUNDS >= 1
    samples, distance = samples.corrected(surface)
    distance = distance[samples.trusted]
    rms = float(np.sqrt(np.mean(distance**2)))
    expected = rms / max(1.0 - nu * nv / len(distance), FREEDOM)
    largest = float(distance.max())
    size = float(np.linalg.norm(np.ptp(samples.points, axis=0)))
    return _Fitted(surface, replace(samples, near=largest <= NEAR * size), rms, expected, largest)
