"""Fit a net to the facets: to their integral, on nets refined until the mesh itself is the larger error.

The facets of a decimated mesh straddle the part; a net that follows them, finer than the vertices lie, is as true as
they are.  Where the vertices lie on the part but too far apart to hold a net, curved triangles through them are truer
than the flat ones: a smooth surface comes several times closer to those that are right.  The normal equations are those
of an integral and are solved in linear time.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.threads import parallel_for
from meshwind.surface.evaluate import DEGREE
from meshwind.surface.fitting import normal_equations
from meshwind.surface.fitting.evidence import rms, rms_away_from_creases, straddling
from meshwind.surface.fitting.linear_systems import solve
from meshwind.surface.fitting.neighbours import Neighbourhoods
from meshwind.surface.fitting.normal_equations import control_points
from meshwind.surface.fitting.quadrature import FacetPoints, facet_points, heights
from meshwind.surface.fitting.resample import resampled
from meshwind.surface.fitting.samples import CLOSE, Facets, Samples
from meshwind.surface.foot import near_feet
from meshwind.surface.surface import Surface

SMOOTHING = 1e-4
"""Bending energy against data at the net's own wave length: it holds what the facets leave free, and no more."""
SHARE, ROUGH_SHARE = 0.3, 0.36
"""A net that leaves no more of the facets' mean distances than this share of their own error is fine enough; it is
worth a correction of the points, which lowers what is left by up to a fifth, below the second share."""
STEADY = 0.1
"""Nor is a net refined that leaves less than this share of their error as a net shows it that does not follow them."""
ENOUGH = 4e-5
"""Rms distance over the part's size that is left of no facets' fit: no mesh shows that its part is known better."""
LEVEL, IDLE_NETS = 0.97, 3
"""A net that lowers the noise found by less than this resolves nothing more; so many in a row end the refinement."""
MOST_PER_VERTEX, MOST_CURVED, MOST = 24.0, 2.0, 150_000
"""Most control points per vertex, on flat facets and on curved ones, which say no more than their corners; in all."""
FEWEST = 1e-2
"""The coarsest net that is tried, over the finest: coarser ones cost as much of the facets' time and show nothing."""
EXACT, ROUGHLY = 1e-7, 1e-3
"""Tolerances of the solutions: for the points, and for a random right side, of which only a mean is wanted."""
COMPARED, CURVED = 0.6, 0.4
"""Control points per vertex at which curved triangles and flat ones are compared; and how much less of the curved
than of the flat ones a net must leave there.  On sampled parts it leaves 0.15 to 0.27, on decimated ones from 0.59."""
PROBED = 20_000
"""Points at which a random noise is compared with what a net follows of it."""
SMOOTHED, MUCH = 2, 0.45
"""Rings of neighbours over which the two are compared, and the share of the facets on which the curved ones must come
closer: sampled parts with creases and fillets show 0.49 to 0.86, decimated ones up to 0.41."""
RESOLVING = 20
"""Fewest spans around of a net that is compared: coarser ones leave more of a circle than its facets do."""


@dataclass(frozen=True)
class FacetFit:
    """One net's fit to the facets.

    points, data (k, 3): points on the flat facets, and those, on flat or curved ones, that are fitted; curved: whether
    the data lie on curved facets; uv (k, 2): where each of the data is on the surface; passed: the share of the
    amplitude of a noise of the vertices that the net does not follow; straddle (m,): how far the facets lie off the
    part, found from a net that does not resolve them.
    """

    surface: Surface
    samples: Samples
    points: FacetPoints
    curved: bool
    data: Floats
    uv: Floats
    passed: float
    straddle: Floats | None = None

    @cached_property
    def _heights(self) -> tuple[Floats, Floats]:
        feet = Facets(self.surface.points(self.samples.uv), self.samples.facets.faces)
        return heights(self.surface, self.uv, self.data, self.points.on(feet, curved=self.curved))

    @property
    def off(self) -> Floats:
        """Heights (k,) of the data over the surface."""
        return self._heights[0]

    def straddling(self, near: Neighbourhoods) -> Floats:
        """How far the data (k,) would lie off the part, were the surface the part: on flat facets if they straddle it.

        The heights of the surface over its own flat or curved triangles, whose corners are the feet of the vertices.
        """
        height = self._heights[1]
        return height if self.curved else straddling(height, self.points, near)

    def own_error(self, near: Neighbourhoods) -> Floats:
        """Rms (m,) of `straddling` on each of the facets."""
        square = self.points.per_facet(self.straddling(near) ** 2, len(self.samples.facets.faces))
        return np.asarray(np.sqrt(square))

    @property
    def left(self) -> float:
        """Rms distance of the data from the surface."""
        return rms(self.off, self.points.area)

    @property
    def vertex_noise(self) -> float:
        """Noise of the vertices, were all that is left of the facets noise."""
        return self.left / max(self.passed, 1e-3)


@dataclass(frozen=True)
class FacetFitter:
    """Fits of nets to the facets of samples; lengths: of the part around and from end to end."""

    samples: Samples
    lengths: tuple[float, float]

    @cached_property
    def _noise(self) -> Floats:
        return np.random.default_rng(0).standard_normal((len(self.samples.points), 1))

    def fit(self, spans: tuple[int, int], before: FacetFit | None = None, *, curved: bool) -> FacetFit:
        """Fit one net, the points where the chart has them; before: a coarser fit to start from."""
        samples = self.samples
        points = facet_points(samples, spans)
        data = points.on(samples.facets, curved=curved)
        uv, noise = points.places(samples.uv), points.between(self._noise)
        net = self._solve(spans, points, uv, np.concatenate([data, noise], axis=1), before.surface if before else None)
        few = slice(None, None, len(uv) // PROBED + 1)
        answer = Surface(np.ascontiguousarray(net[..., 3:].repeat(3, axis=2))).points(uv[few])[:, 0]
        passed = float(np.sqrt(np.mean((noise[few, 0] - answer) ** 2) / np.mean(noise[few] ** 2)))
        return FacetFit(Surface(np.ascontiguousarray(net[..., :3])), samples, points, curved, data, uv, passed)

    def corrected(self, fitted: FacetFit) -> FacetFit:
        """The same net fitted again with the points at their feet on it."""
        uv, distance = fitted.uv.copy(), np.empty(len(fitted.uv))
        parallel_for(near_feet, len(uv), 6000, fitted.surface.net, fitted.data, CLOSE, uv, distance)
        surface = Surface(self._solve(fitted.surface.spans, fitted.points, uv, fitted.data, fitted.surface))
        samples, _ = fitted.samples.corrected(surface)
        return replace(fitted, surface=surface, samples=samples, uv=uv)

    def compared(self, nets: list[tuple[int, int]], near: Neighbourhoods, *, flat: bool) -> FacetFit:
        """A fit to curved facets if a smooth surface comes much closer to these than to flat ones on much of the part.

        Its net smooths the facets.  flat: do not compare, and take the flat ones.
        """
        spans = self._near(COMPARED, [net for net in nets if net[0] >= RESOLVING])
        fitted = self.fit(spans, curved=False)
        if flat:
            return fitted
        bent = self.fit(spans, fitted, curved=True)
        faces = len(self.samples.facets.faces)
        left = []
        for each in (fitted, bent):
            square = each.points.per_facet(each.off**2, faces)
            for _ in range(SMOOTHED):
                square = near.facet_mean(square)
            left.append(square)
        closer = (left[1] < CURVED**2 * left[0]).mean()
        return bent if closer > MUCH else fitted

    def smoothing(self, nets: list[tuple[int, int]], fitted: FacetFit) -> FacetFit:
        """A fit whose net does not resolve the facets: the given one, or if its net is too fine another one."""
        spans = self._near(COMPARED, nets)
        return (
            fitted
            if control_points(spans) >= control_points(fitted.surface.spans)
            else self.fit(spans, curved=fitted.curved)
        )

    def _near(self, per_vertex: float, nets: list[tuple[int, int]]) -> tuple[int, int]:
        """The net that comes next to so many control points per vertex, of those that are not too large."""
        wanted = per_vertex * len(self.samples.points)
        return min(
            (net for net in nets if control_points(net) <= MOST),
            key=lambda net: abs(np.log(control_points(net) / wanted)),
        )

    def _solve(
        self, spans: tuple[int, int], points: FacetPoints, uv: Floats, values: Floats, before: Surface | None
    ) -> Floats:
        weight = points.area / points.area.sum()
        stencil = normal_equations.bending(spans, self.lengths, SMOOTHING / (self.lengths[0] * self.lengths[1]))
        right = np.zeros((spans[0], spans[1] + DEGREE, values.shape[1]))
        normal_equations.accumulate(uv, values, weight, stencil, right)
        start = np.zeros_like(right)
        if before is not None:
            start[..., :3] = resampled(before, spans)
        return solve(stencil, right, np.repeat([EXACT, ROUGHLY], [3, values.shape[1] - 3]), start)


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
    fitter, count = FacetFitter(samples, lengths), len(samples.points)
    fitted = fitter.compared(nets, near, flat=flat)
    smooth = fitter.smoothing(nets, fitted)
    limits = _Limits(tolerance, max(tolerance, ENOUGH * samples.size), near, smooth.own_error(near))
    within = _within(nets, (MOST_CURVED if fitted.curved else MOST_PER_VERTEX) * count)
    size = control_points(fitted.surface.spans)
    finer = [net for net in within if control_points(net) > size]
    if limits.fine_enough(fitted):  # so may a coarser one be
        first, *finer = [*(net for net in within if control_points(net) < size), fitted.surface.spans]
        fitted = fitter.fit(first, curved=fitted.curved) if finer else fitted
    noise, idle = fitted.vertex_noise, 0
    for spans in finer:
        if limits.fine_enough(fitted):
            corrected = fitter.corrected(fitted)
            if limits.met(corrected):
                return replace(corrected, straddle=limits.straddle)
        fitted = fitter.fit(spans, fitted, curved=fitted.curved)
        idle = idle + 1 if fitted.vertex_noise > LEVEL * noise else 0
        noise = min(noise, fitted.vertex_noise)
        if idle >= IDLE_NETS:
            break
    return replace(fitter.corrected(fitted), straddle=limits.straddle)


@dataclass(frozen=True)
class _Limits:
    """When a fit is fine enough: on curved facets at the tolerance, on flat ones at a share of their own error.

    enough: rms distance of flat facets that need not be bettered, a length; straddle (m,): how far the facets lie off
    the part, found from a net that does not resolve them.
    """

    tolerance: float
    enough: float
    near: Neighbourhoods
    straddle: Floats

    def fine_enough(self, fitted: FacetFit) -> bool:
        """Whether a fit whose points are where the chart has them is worth a correction."""
        return self._met(fitted, ROUGH_SHARE)

    def met(self, fitted: FacetFit) -> bool:
        """Whether a fit leaves little of the facets against what they are worth."""
        return self._met(fitted, SHARE)

    def _met(self, fitted: FacetFit, share: float) -> bool:
        if fitted.curved:
            return fitted.left <= self.tolerance
        points = fitted.points
        own, steady = (
            rms_away_from_creases(each, points, fitted.samples)
            for each in (fitted.straddling(self.near), self.straddle[points.facet])
        )
        means = points.per_facet(fitted.off, len(self.straddle))
        return fitted.left <= self.enough or rms(means[points.facet], points.area) <= max(share * own, STEADY * steady)


def _within(nets: list[tuple[int, int]], most: float) -> list[tuple[int, int]]:
    """The nets with up to so many control points that are worth a try, at least one."""
    most = min(most, MOST)
    return [net for net in nets if FEWEST * most <= control_points(net) <= most] or [nets[0]]
