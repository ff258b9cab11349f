"""Fit a net to the facets: to their integral, on nets refined until the mesh itself is the larger error.

The facets of a decimated mesh straddle the part; a net that follows them, finer than the vertices lie, is as true as
they are.  Where the vertices lie on the part but too far apart to hold a net, curved triangles through them are truer
than the flat ones; a smooth surface tells, for it comes several times closer to those that are right.  The normal
equations are those of an integral and are solved in linear time.
"""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.threads import parallel_for
from meshwind.surface.evaluate import DEGREE
from meshwind.surface.fitting import normal_equations
from meshwind.surface.fitting.conjugate_gradients import solve_iteratively
from meshwind.surface.fitting.evidence import Neighbourhoods, sagitta
from meshwind.surface.fitting.quadrature import FacetPoints, facet_points
from meshwind.surface.fitting.samples import CLOSE, Samples
from meshwind.surface.foot import near_feet
from meshwind.surface.surface import Surface

SMOOTHING = 1e-4
"""Bending energy against data at the net's own wave length: it holds what the facets leave free, and no more."""
SHARE = 0.3
"""A net that leaves no more of the facets' mean distances than this share of their own error is fine enough."""
ENOUGH = 4e-5
"""Rms distance over the part's size that is left of no facets' fit: no mesh shows that its part is known better."""
LEVEL, IDLE_NETS = 0.97, 3
"""A net that lowers the noise found by less than this resolves nothing more; so many in a row end the refinement."""
MOST_PER_VERTEX, MOST_CURVED, MOST = 12.0, 1.0, 150_000
"""Most control points per vertex, on flat facets and on curved ones, which say no more than their corners; in all."""
FEWEST = 1e-2
"""The coarsest net that is tried, over the finest: coarser ones cost as much of the facets' time and tell nothing."""
COMPARED, CURVED = 0.6, 0.4
"""Control points per vertex at which curved triangles and flat ones are compared; and how much less of the curved
than of the flat ones a net must leave there.  On sampled parts it leaves 0.15 to 0.27, on decimated ones from 0.59."""
RESOLVING = 20
"""Fewest spans around of a net that is compared: coarser ones leave more of a circle than its facets do."""
ROUNDS = 2
"""Refits of a net, its points moved to their feet between them."""
ROUGHLY = 1e-3
"""Tolerance of the solutions for random right sides, of which only a mean is wanted."""
PROBES = 3
"""Random right sides that measure how much of the vertices' noise a net leaves (Hutchinson 1990)."""


@dataclass(frozen=True)
class FacetFit:
    """One net's fit to the facets, with the samples at their feet on it.

    curved: whether to curved triangles; left: rms distance of the facets from the surface; means: that of the facets'
    mean distances; passed: the share of the amplitude of a noise of the vertices that the net does not follow.
    """

    surface: Surface
    samples: Samples
    points: FacetPoints
    curved: bool
    left: float
    means: float
    passed: float

    @property
    def noise(self) -> float:
        """Noise of the vertices, were all that is left of the facets noise."""
        return self.left / max(self.passed, 1e-3)


def fit_facets(
    samples: Samples,
    nets: list[tuple[int, int]],
    lengths: tuple[float, float],
    near: Neighbourhoods,
    tolerance: float,
    *,
    flat: bool,
) -> FacetFit:
    """The coarsest net that leaves little of the facets against what they are worth, or the finest that is allowed.

    flat: whether the facets are known to be truer than curved triangles through their corners.  Refinement also ends
    where it no longer lowers the noise that the net leaves: then all but noise is resolved.
    """
    curved = not flat and _curves(samples, nets, lengths)
    first, *finer = _within(nets, (MOST_CURVED if curved else MOST_PER_VERTEX) * len(samples.points))
    fitted = _fit(samples, first, lengths, curved)
    noise, idle = fitted.noise, 0
    size = float(np.linalg.norm(np.ptp(samples.points, axis=0)))
    enough = tolerance if curved else max(tolerance, ENOUGH * size)
    for spans in finer:
        own = 0.0 if curved else sagitta(fitted.surface, fitted.samples, fitted.points, near)
        if fitted.means <= SHARE * own or fitted.left <= enough or idle >= IDLE_NETS:
            break
        fitted = _fit(samples, spans, lengths, curved)
        idle = idle + 1 if fitted.noise > LEVEL * noise else 0
        noise = min(noise, fitted.noise)
    return fitted


def _within(nets: list[tuple[int, int]], most: float) -> list[tuple[int, int]]:
    """The nets with up to so many control points that are worth a try, at least one."""
    most = min(most, MOST)
    return [net for net in nets if FEWEST * most <= _size(net) <= most] or [nets[0]]


def _curves(samples: Samples, nets: list[tuple[int, int]], lengths: tuple[float, float]) -> bool:
    """Whether a smooth surface comes much closer to curved triangles through the vertices than to the flat ones."""
    fine = [net for net in nets if net[0] >= RESOLVING]
    spans = min(fine, key=lambda net: abs(np.log(_size(net) / (COMPARED * len(samples.points)))))
    flat, bent = (_fit(samples, spans, lengths, curved) for curved in (False, True))
    return bent.left < CURVED * flat.left


def _size(spans: tuple[int, int]) -> int:
    return spans[0] * (spans[1] + DEGREE)


def _fit(samples: Samples, spans: tuple[int, int], lengths: tuple[float, float], curved: bool) -> FacetFit:
    nu, nv = spans[0], spans[1] + DEGREE
    points = facet_points(samples, spans)
    data = points.curved(samples) if curved else points.between(samples.points)
    uv, weight = points.places(samples.uv), points.area / points.area.sum()
    bending = normal_equations.bending(spans, lengths, SMOOTHING / (lengths[0] * lengths[1]))
    noise = points.between(np.random.default_rng(0).standard_normal((len(samples.points), PROBES)))
    distance, net = np.empty(len(uv)), None
    for k in range(ROUNDS):
        stencil, right = bending.copy(), np.zeros((nu, nv, 3))
        normal_equations.accumulate(uv, data, weight, *spans, stencil, right)
        if k == 0:  # how much of a noise a net follows hardly depends on where the feet are
            probe = np.zeros((nu, nv, PROBES))
            normal_equations.accumulate(uv, noise, weight, *spans, np.zeros_like(stencil), probe)
            passed = _passed(noise, Surface(solve_iteratively(stencil, probe, tolerance=ROUGHLY)).points(uv), weight)
        net = solve_iteratively(stencil, right, net)
        surface = Surface(net)
        parallel_for(near_feet, len(uv), 6000, surface.net, data, CLOSE, uv, distance)
    off = ((data - surface.points(uv)) * surface.normals(uv)).sum(axis=1)
    means = points.per_facet(off, len(samples.facets.faces))
    area = np.bincount(points.facet, weight, len(means))
    moved, _ = samples.corrected(surface)
    left = float(np.sqrt((weight * distance**2).sum()))
    return FacetFit(surface, moved, points, curved, left, float(np.sqrt((area * means**2).sum())), passed)


def _passed(noise: Floats, answer: Floats, weight: Floats) -> float:
    """The share of the amplitude of a noise that a fit does not follow."""
    return float(np.sqrt((weight[:, None] * (noise - answer) ** 2).sum() / (weight[:, None] * noise**2).sum()))
