"""Fewer vertices for nets that are only tried: a coarse net does not see more of them than a few a span."""

from dataclasses import replace

import numpy as np

from meshwind.core.cast import Ints
from meshwind.surface.fitting.samples import Facets, Samples, span_of

PER_SPAN = 6
"""Places across a span, each way, at each of which one vertex is kept."""
WORTH = 0.5
"""Share of the vertices that may be left at most, or they are not worth choosing."""


def thinned(samples: Samples, spans: tuple[int, int]) -> Samples:
    """One vertex at each of many places in each span of a net, which counts for all there; or all if these are few.

    Places are spread evenly, for a net follows vertices that are thrown together by chance less well next to a rim; the
    vertex of each is a random one, as a fixed choice would take one row of a regular mesh.  All are kept where a
    triangle is wider than a span, for what is fitted between its corners.
    """
    count = len(samples.points)
    if WORTH * count <= PER_SPAN**2 * spans[0] * spans[1] or samples.across(spans).max() > 1:
        return samples
    place = _places(samples, (PER_SPAN * spans[0], PER_SPAN * spans[1]))
    order = np.random.default_rng(0).permutation(count)
    chosen = np.full(int(place.max()) + 1, -1)
    chosen[place[order]] = order
    kept = np.sort(chosen[chosen >= 0])
    if len(kept) > WORTH * count:
        return samples
    weight = np.bincount(place, samples.weight)[place[kept]]
    points = samples.points[kept]
    return replace(
        samples, points=points, uv=samples.uv[kept], weight=weight, rim=samples.rim[kept],
        trusted=samples.trusted[kept], turns=samples.turns[:0], facets=Facets(points, samples.facets.faces[:0]),
    )  # fmt: skip


def _places(samples: Samples, grid: tuple[int, int]) -> Ints:
    """Number (n,) of the place of each vertex: those on the rims have places of their own, so have those of cuts."""
    i, j = span_of(samples.uv, grid)
    row = np.where(samples.rim, np.where(samples.uv[:, 1] < 0.5, grid[1], grid[1] + 1), j)
    return np.asarray((samples.trusted * grid[0] + i) * (grid[1] + 2) + row)
