"""Fit the smooth surface to a chart: least squares on the vertices with parameter correction (Hoschek)."""

from dataclasses import dataclass, replace

import igl
import numpy as np
from threadpoolctl import ThreadpoolController

from meshwind.cast import Bools, Floats
from meshwind.chart.chart import Chart
from meshwind.surface import normal_equations
from meshwind.surface.foot import feet
from meshwind.surface.infill import infill
from meshwind.surface.surface import FitError, Surface
from meshwind.threads import spread

ROUNDS = 4
"""Refits after moving every vertex's parameters to its foot; the error settles in 3 or 4."""
SMOOTHING = 1e-4
"""Bending energy against data at the net's own wave length: small beside the spline's error, of the same order."""
GAIN = 0.95
"""A finer net must bring the expected error below this share of the best so far, or the mesh supports no finer."""
PATIENCE = 2
"""So many finer nets in a row without that gain end the search: one alone may be bad luck."""
COARSEST = 8
INFILL = 0.05
"""Weight of a point between vertices against a vertex: enough to hold a span that has nothing else."""


@dataclass(frozen=True)
class _Samples:
    """The mesh's vertices about the part's middle, where they lie in the plane, and how far they count."""

    points: Floats
    uv: Floats
    weight: Floats
    rim: Bools
    trusted: Bools
    chart: Chart

    def between(self, spans: tuple[int, int]) -> tuple[Floats, Floats]:
        """Points between vertices for a net of so many spans: (k, 2) in the plane, (k, 3) about the middle."""
        faces = self.chart.annulus.faces
        turns = np.round(self.chart.corner_uv[..., 0] - self.chart.uv[faces][..., 0])
        corners = self.uv[faces]
        corners[..., 0] += turns
        uv, points = infill(self.chart.annulus, corners, spans)
        return uv, points + (self.points[0] - self.chart.annulus.vertices[0])


@dataclass(frozen=True)
class _Fitted:
    """One net's fit: the surface, the samples at their feet, and the trusted vertices' distances.

    expected is the rms distance to be expected of vertices that were not fitted (generalised cross-validation,
    Craven and Wahba 1979): it grows where a net follows noise.
    """

    surface: Surface
    samples: _Samples
    expected: float
    largest: float


def fit(chart: Chart, tolerance: float = 1e-5) -> Surface:
    """Fit a bicubic surface with the coarsest control net that meets `tolerance` or that the mesh supports.

    tolerance: largest distance of a vertex to the surface over the diagonal of the mesh.  The vertices are
    fitted, not samples of the facets: vertices lie on the true part, facets do not.  The surface carries its
    error both ways in `Surface.error`, in the mesh's units.
    """
    annulus = chart.annulus
    middle = annulus.vertices.mean(axis=0)
    diagonal = float(np.linalg.norm(np.ptp(annulus.vertices, axis=0)))
    rim = np.zeros(len(annulus.vertices), dtype=bool)
    rim[np.concatenate(annulus.rims)] = True
    samples = _Samples(
        annulus.vertices - middle,
        chart.uv.copy(),
        np.where(annulus.trusted, 1.0, 0.1),
        rim,
        np.asarray(annulus.trusted),
        chart,
    )
    lengths = _lengths(chart)
    best, *finer = _ladder(lengths, len(annulus.vertices))
    # one thread of BLAS: the bands are narrow, more threads cost up to ten times as much and blur the last bits
    with ThreadpoolController().limit(limits=1, user_api="blas"):
        fitted = _fit(samples, best, lengths)
        idle = 0
        for spans in finer:
            if fitted.largest <= tolerance * diagonal or idle == PATIENCE:
                break
            trial = _fit(fitted.samples, spans, lengths)
            idle = 0 if trial.expected < GAIN * fitted.expected else idle + 1
            if trial.expected < fitted.expected:
                fitted = trial
    certificate = _certify(fitted.surface, fitted.samples, chart, middle)
    return Surface(fitted.surface.control_points + middle, True, certificate)


def _lengths(chart: Chart) -> tuple[float, float]:
    """Mean length on the part of a turn of u and of v from end to end."""
    P = chart.annulus.vertices[chart.annulus.faces]
    a, b = (chart.corner_uv[:, k] - chart.corner_uv[:, 0] for k in (1, 2))
    p, q = (P[:, k] - P[:, 0] for k in (1, 2))
    det = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    s_u = np.linalg.norm(b[:, 1:] * p - a[:, 1:] * q, axis=1)
    s_v = np.linalg.norm(a[:, :1] * q - b[:, :1] * p, axis=1)
    return float(s_u.sum() / det.sum()), float(s_v.sum() / det.sum())


def _ladder(lengths: tuple[float, float], vertices: int) -> list[tuple[int, int]]:
    """Nets with square spans on the part, each with about twice the control points of the one before."""
    rungs: list[tuple[int, int]] = []
    size = COARSEST
    across = min(max(lengths[1] / lengths[0], 1 / 16), 16.0)
    while True:
        spans = size, max(4, round(size * across))
        if rungs and spans[0] * (spans[1] + 3) > vertices / 2:
            return rungs
        rungs.append(spans)
        size = int(np.ceil(size * np.sqrt(2)))


def _fit(samples: _Samples, spans: tuple[int, int], lengths: tuple[float, float]) -> _Fitted:
    """Fit one net, correcting the samples' parameters between the rounds."""
    nu, nv = spans[0], spans[1] + 3
    bending = normal_equations.thin_plate(*spans, *lengths)
    pitch = lengths[0] / spans[0], lengths[1] / spans[1]
    density = samples.weight.sum() / (lengths[0] * lengths[1])
    bending *= SMOOTHING * density * (pitch[0] * pitch[1]) ** 2 / (2 * np.pi) ** 4
    uv = samples.uv
    surface = None
    for _ in range(ROUNDS):
        if surface is not None:
            uv, _ = _correct(surface, samples, uv)
            samples = replace(samples, uv=uv)
        stencil, right = bending.copy(), np.zeros((nu, nv, 3))
        normal_equations.accumulate(uv, samples.points, samples.weight, *spans, stencil, right)
        inner, points = samples.between(spans)
        normal_equations.accumulate(inner, points, np.full(len(inner), INFILL), *spans, stencil, right)
        surface = Surface(normal_equations.solve(stencil, right))
    assert surface is not None  # ROUNDS >= 1
    uv, distance = _correct(surface, samples, uv)
    distance = distance[samples.trusted]
    spared = 1.0 - nu * nv / len(distance)
    expected = float(np.sqrt(np.mean(distance**2))) / max(spared, 1e-3)
    return _Fitted(surface, replace(samples, uv=uv), expected, float(distance.max()))


def _correct(surface: Surface, samples: _Samples, uv: Floats) -> tuple[Floats, Floats]:
    """Move every vertex's parameters to its foot, on a rim along the rim; returns (uv, distances)."""
    moved = uv.copy()
    frames = np.empty((len(uv), 6, 3))
    spread(feet, len(moved), 500, surface.net, True, samples.points, moved, frames)
    rim = samples.rim
    moved[rim, 1] = uv[rim, 1]
    at = surface.frames(uv[rim])
    miss = samples.points[rim] - at[:, 0]
    moved[rim, 0] = uv[rim, 0] + (miss * at[:, 1]).sum(axis=1) / (at[:, 1] ** 2).sum(axis=1)
    frames[rim] = surface.frames(moved[rim])
    return moved, np.asarray(np.linalg.norm(samples.points - frames[:, 0], axis=1))


def _certify(surface: Surface, samples: _Samples, chart: Chart, middle: Floats) -> FitError:
    """Distances both ways: vertices to the surface, a dense sample of the surface to the facets."""
    _, distance = _correct(surface, samples, samples.uv)
    distance = distance[samples.trusted]
    counts = [min(4 * n, 256) for n in surface.spans]
    u, v = np.meshgrid(np.arange(counts[0]) / counts[0], np.linspace(0, 1, counts[1] + 1), indexing="ij")
    points = surface.points(np.stack([u.ravel(), v.ravel()], axis=1))
    annulus = chart.annulus
    squared, _, _ = igl.point_mesh_squared_distance(points, annulus.vertices - middle, annulus.faces)
    return FitError(
        to_surface_rms=float(np.sqrt(np.mean(distance**2))),
        to_surface_max=float(distance.max()),
        to_mesh_rms=float(np.sqrt(squared.mean())),
        to_mesh_max=float(np.sqrt(squared.max())),
        diagonal=annulus.mesh.diagonal,
    )
