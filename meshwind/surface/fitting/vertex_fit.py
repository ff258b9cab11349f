"""Fit a net to the vertices: least squares with parameter correction (Hoschek), on nets refined while they predict.

How many control points the vertices support is found by generalised cross-validation (Craven and Wahba 1979) with the
effective degrees of freedom: the share of a random noise that a fit keeps.
"""

from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.cast import Floats
from meshwind.surface.evaluate import DEGREE
from meshwind.surface.fitting import normal_equations
from meshwind.surface.fitting.linear_systems import solve
from meshwind.surface.fitting.neighbours import ALIKE, Neighbourhoods, alike
from meshwind.surface.fitting.resample import resampled
from meshwind.surface.fitting.samples import Samples
from meshwind.surface.fitting.thinning import thinned
from meshwind.surface.surface import Surface

ROUNDS, PASSING, MANY = 4, 2, 10_000
"""Fits of a net, before each of which every vertex's parameters are moved to its foot: the error settles in 3 or 4.
Nets of more than so many vertices that are only passed through have fewer."""
NEARLY, NEARLY_BY_FEW = 3.0, 6.0
"""A net that misses the tolerance by less than this factor is fitted again to see whether it meets it then.  One that
was fitted to few of the vertices misses twice as much at a rim."""
SMOOTHING = 1e-4
"""Bending energy against data at the net's own wave length: small beside the spline's error, of the same order."""
GAIN = 0.95
"""A finer net must bring the expected error below this share of the best so far, or the mesh supports no finer."""
SLOW, SLOW_NETS = 0.65, 3
"""Gain of a finer net that is slow (a crease allows 0.7, smooth parts 0.25), and how many such nets in a row end the
search, where what is left is no noise."""
FLAT = 0.9
"""A finer net that leaves more than this share of the least noise so far resolves nothing more: what a part's smooth
shape leaves falls by more from net to net, and by 0.7 along a crease."""
SETTLED = 1
"""So many finer nets that resolve nothing more show that what is left is noise, where it looks like noise."""
SUPPORT = 0.5
"""Most control points per vertex where vertices alone are followed."""
NEAR = 1e-3
"""Of the part's size: a net that is further off somewhere than this is not yet held by vertices alone."""
IDLE_NETS = 2
"""So many finer nets in a row without that gain end the search: one alone may be bad luck."""
EXACT, ROUGHLY = 1e-10, 1e-3
"""Tolerances of the solutions: for the vertices, and for random right sides, of which only a mean is wanted."""
PROBES = 3
"""Random right sides that measure how much of a noise a net keeps (Hutchinson 1990)."""


@dataclass(frozen=True)
class VertexFit:
    """One net's fit to the vertices: the surface about the samples' middle, the samples at their feet, distances.

    rms, largest: distances of the trusted vertices from the surface; kept: the share of a noise's energy that the fit
    keeps; settled: whether finer nets leave the same noise, so that all else is resolved.
    """

    surface: Surface
    samples: Samples
    rms: float
    largest: float
    kept: float
    settled: bool = False

    @property
    def expected(self) -> float:
        """Rms distance to be expected of vertices that were not fitted: it grows where a net follows noise."""
        return self.rms / max(1.0 - self.kept, 1e-3)

    @property
    def noise(self) -> float:
        """Rms noise of the vertices, were all that is left of them noise."""
        return self.rms / float(np.sqrt(max(1.0 - self.kept, 1e-3)))


def fit_vertices(
    samples: Samples,
    nets: list[tuple[int, int]],
    lengths: tuple[float, float],
    near: Neighbourhoods,
    tolerance: float,
) -> VertexFit:
    """The net of least expected error, or the coarsest that meets the tolerance, a length.

    nets: spans in u and v, from coarse to fine; lengths: of the part around and from end to end.  Where finer nets gain
    little though neighbouring vertices miss the surface alike, vertices alone do not hold it, and the search ends.
    """
    best, *finer = nets
    rounds = PASSING if len(samples.points) > MANY else ROUNDS
    fitted = _fit(thinned(samples, best), best, lengths, rounds)
    noise, idle, level, slow, final = fitted.noise, 0, 0, 0, rounds == ROUNDS
    for spans in finer:
        nearly = NEARLY if _is_whole(fitted, samples) else NEARLY_BY_FEW
        if not final and fitted.largest <= nearly * tolerance:
            fitted, final = _refit(fitted, samples, lengths), True
        if fitted.largest <= tolerance:
            return fitted
        if normal_equations.control_points(spans) > SUPPORT * len(samples.points) or idle >= IDLE_NETS:
            break
        trial = _fit(_passed(fitted, samples, spans), spans, lengths, rounds, fitted.surface)
        slow = slow + 1 if trial.expected > SLOW * fitted.expected else 0
        if slow >= SLOW_NETS:
            whole = trial if _is_whole(trial, samples) else _refit(trial, samples, lengths)
            if alike(whole.samples.heights(whole.surface), whole.samples, near) > ALIKE:
                return whole
        level = level + 1 if trial.noise > FLAT * noise else 0
        noise = min(noise, trial.noise)
        idle = 0 if trial.expected < GAIN * fitted.expected else idle + 1
        if trial.expected < fitted.expected:
            fitted, final = trial, rounds == ROUNDS
    fitted = fitted if final else _refit(fitted, samples, lengths)
    return replace(fitted, settled=level >= SETTLED)


def _is_whole(fitted: VertexFit, samples: Samples) -> bool:
    """Whether all vertices were fitted."""
    return len(fitted.samples.points) == len(samples.points)


def _passed(fitted: VertexFit, samples: Samples, spans: tuple[int, int]) -> Samples:
    """What a finer net is fitted to: as many of all vertices as it needs, at their feet on the net before."""
    if _is_whole(fitted, samples):
        samples = fitted.samples
    few = thinned(samples, spans)
    return few if few is fitted.samples else few.corrected(fitted.surface)[0]


def _refit(fitted: VertexFit, samples: Samples, lengths: tuple[float, float]) -> VertexFit:
    """The same net fitted again, to all vertices."""
    samples = fitted.samples if _is_whole(fitted, samples) else samples.corrected(fitted.surface)[0]
    return _fit(samples, fitted.surface.spans, lengths, ROUNDS, fitted.surface)


def _fit(
    samples: Samples, spans: tuple[int, int], lengths: tuple[float, float], rounds: int, before: Surface | None = None
) -> VertexFit:
    """Fit one net, correcting the samples' parameters between the rounds; before: a surface to start from."""
    density = samples.weight.sum() / (lengths[0] * lengths[1])
    bending = normal_equations.bending(spans, lengths, SMOOTHING * density)
    start = None if before is None else resampled(before, spans)
    for _ in range(rounds - 1):
        surface = Surface(solve(*_equations(samples, spans, bending), np.full(3, EXACT), start))
        samples, _ = samples.corrected(surface)
        start = surface.control_points
    noise = np.random.default_rng(0).standard_normal((len(samples.points), PROBES))
    stencil, right = _equations(samples, spans, bending, noise)
    start = None if start is None else np.concatenate([start, np.zeros((*start.shape[:2], PROBES))], axis=2)
    net = solve(stencil, right, np.repeat([EXACT, ROUGHLY], [3, PROBES]), start)
    kept = _share_kept(noise, Surface(net[..., 3:]).points(samples.uv), samples.weight)
    surface = Surface(net[..., :3])
    samples, distance = samples.corrected(surface)
    distance = distance[samples.trusted]
    largest = float(distance.max())
    near = largest <= NEAR * samples.size
    rms = float(np.sqrt(np.average(distance**2, weights=samples.weight[samples.trusted])))
    return VertexFit(surface, replace(samples, near=near), rms, largest, kept)


def _equations(
    samples: Samples, spans: tuple[int, int], bending: Floats, noise: Floats | None = None
) -> tuple[Floats, Floats]:
    """Stencil and right sides of a net's normal equations: the vertices, points between them, and the bending energy.

    noise (n, m): of m more right sides, for values at the vertices, none between them.
    """
    values = samples.points if noise is None else np.concatenate([samples.points, noise], axis=1)
    stencil, right = bending.copy(), np.zeros((spans[0], spans[1] + DEGREE, values.shape[1]))
    normal_equations.accumulate(samples.uv, values, samples.weight, stencil, right)
    inner, points, weight = samples.between(spans)
    if len(inner):
        between = np.concatenate([points, np.zeros((len(points), values.shape[1] - 3))], axis=1)
        normal_equations.accumulate(inner, between, weight, stencil, right)
    return stencil, right


def _share_kept(noise: Floats, answer: Floats, weight: Floats) -> float:
    """The share of a noise's energy that a fit keeps: its effective degrees of freedom over the data."""
    return float((weight[:, None] * noise * answer).sum() / (weight[:, None] * noise**2).sum())
