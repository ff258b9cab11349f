"""Fewer vertices for nets that are only tried: a coarse net does not see more of them than a few a span."""

from dataclasses import replace

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.surface.fitting.samples import Facets, Samples, span_of

LEAST = 20_000
"""Vertices that are all taken."""
PER_SPAN = 6
"""Places across a span, each way, at each of which one vertex is taken."""
WORTH = 0.5
"""Share of the vertices that may be left at most, or they are not worth choosing."""


def thinned(samples: Samples, spans: tuple[int, int]) -> Samples:
    """One vertex at each of many places in each span of a net, which counts for all there; or all if these are few.

    Places are spread evenly, and the vertex nearest to the middle of each is taken: a net follows vertices that are
    thrown together by chance less well next to a rim, and the choice depends on no numbering.  All are taken where a
    triangle is wider than a span, for what is fitted between its corners.
    """
    count, grid = len(samples.points), (PER_SPAN * spans[0], PER_SPAN * spans[1])
    if count < LEAST or WORTH * count <= grid[0] * grid[1] or samples.across(spans).max() > 1:
        return samples
    every, off = _places(samples, grid)
    least = np.full(int(every.max()) + 1, np.inf)
    np.minimum.at(least, every, off)
    kept = np.flatnonzero(off == least[every])
    if len(kept) > WORTH * count:
        return samples
    place, alike = every[kept], np.bincount(every[kept])  # as many as are equally near share the weight
    weight = np.bincount(every, samples.weight)[place] / alike[place]
    points = samples.points[kept]
    return replace(
        samples, points=points, uv=samples.uv[kept], weight=weight, rim=samples.rim[kept],
        trusted=samples.trusted[kept], turns=samples.turns[:0], facets=Facets(points, samples.facets.faces[:0]),
    )  # fmt: skip


def _places(samples: Samples, grid: tuple[int, int]) -> tuple[Ints, Floats]:
    """Number (n,) of the place of each vertex, and its squared distance (n,) from the middle there.

    Vertices on the rims have places of their own, and so have those that trimming made.
    """
    i, j = span_of(samples.uv, grid)
    row = np.where(samples.rim, np.where(samples.uv[:, 1] < 0.5, grid[1], grid[1] + 1), j)
    across = samples.uv * grid - 0.5
    off = ((across - np.round(across)) ** 2).sum(axis=1)
    return np.asarray((samples.trusted * grid[0] + i) * (grid[1] + 2) + row), np.asarray(off)
