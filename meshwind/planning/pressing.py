"""Where a winding by a number of revolutions presses on the surface: (6.1) to (6.3) at every point.

A straight line in the (u, v) plane (6.2) that turns n_rev times from end to end runs along (n_rev, 1).  The fibre
presses where its normal curvature bends towards the body.  Written out with the outward normal N,

    -(s_uu n^2 + 2 s_uv n + s_vv) . N >= 0,

which is (6.3) divided by its squared slope, with the 2 of the mixed term that the source leaves out and the sign of a
normal that points outward.  The two families wind by +n_rev and -n_rev, and both have to press.
"""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, frozen
from meshwind.core.vectors import TINY
from meshwind.surface.flatness import real_forms
from meshwind.surface.forms import Forms, area_elements
from meshwind.surface.grid import parameter_grid
from meshwind.surface.surface import Surface

Intervals = tuple[tuple[float, float], ...]
"""Intervals (low, high) of the number of revolutions."""
_MAX_SPANS = 128
"""Most spans each way that are sampled."""
_SITES = 0.5 + np.array([-1.0, 1.0]) / np.sqrt(12.0)
"""Where in a span a cubic spline's curvature is most exact: of fourth order, and of second order elsewhere."""
_FITTED, _EXACT = 1e-3, 1e-9
"""Curvature times the part's size that counts as flat, on a fitted surface (its noise) and on an analytic one."""
_SAME = 1e-9
"""Shares of the surface that differ by less are one: rounding of sums of areas."""


@dataclass(frozen=True)
class Pressing:
    """The intervals of n_rev in which both families press, at k points of the surface, and how common each n_rev is.

    uv (k, 2); low, high (k, 2): the intervals [low, high] of each point, two at most, in revolutions, high infinite
    where there is no end, low > high where there is no interval; weight (k,): the share of the area that it stands for.
    """

    uv: Floats
    low: Floats
    high: Floats
    weight: Floats

    def share(self, revolutions: Floats) -> Floats:
        """Share (m,) of the surface's area on which windings by numbers of revolutions (m,) press."""
        low, high, weight = self._closed()
        begun, ended = np.argsort(low), np.argsort(high)
        opened = np.concatenate([[0.0], np.cumsum(weight[begun])])
        closed = np.concatenate([[0.0], np.cumsum(weight[ended])])
        turns = np.asarray(revolutions, dtype=np.float64)
        first = np.searchsorted(low[begun], turns, side="right")
        return np.asarray(opened[first] - closed[np.searchsorted(high[ended], turns, side="left")])

    def most_common(self, least: float = 0.0, most: float = np.inf) -> Intervals:
        """The interval or intervals between `least` and `most` revolutions in which the largest share presses."""
        low, high, _ = self._closed()
        edges = np.unique(np.concatenate([[least, most], low, high]))
        edges = edges[(edges >= least) & (edges <= most)]
        if not len(edges):
            return ()
        # between two neighbouring edges nothing changes, and at an edge the share is that of whichever side is larger
        finite = np.where(np.isfinite(edges[1:]), edges[1:], edges[:-1] + 2.0)
        share = self.share(0.5 * (edges[:-1] + finite)) if len(edges) > 1 else np.zeros(0)
        at = self.share(edges[np.isfinite(edges)])
        largest = max(share.max(initial=0.0), at.max(initial=0.0))
        best = np.flatnonzero(share >= largest - _SAME)
        if not len(best):  # the largest share is that of single values
            return tuple((float(edges[k]), float(edges[k])) for k in np.flatnonzero(at >= largest - _SAME))
        runs = np.split(best, np.flatnonzero(np.diff(best) > 1) + 1)
        return tuple((float(edges[run[0]]), float(edges[run[-1] + 1])) for run in runs)

    def _closed(self) -> tuple[Floats, Floats, Floats]:
        """All intervals that are not empty, with their weights."""
        there = self.low <= self.high
        return self.low[there], self.high[there], np.repeat(self.weight[:, None], 2, axis=1)[there]


def pressing(surface: Surface, flat: float | None = None, uv: Floats | None = None) -> Pressing:
    """Find the intervals at uv (k, 2), or at two points per span each way.

    flat: curvature, over the part's size, down to which a hollow counts as none; by default that of a fit's noise, and
    nearly 0 on an analytic surface.  Deeper ones count as none where they are not real (see `real_forms`).
    """
    if flat is None:
        flat = _EXACT if surface.error is None else _FITTED
    if uv is None:
        u, v = (_sites(spans) for spans in surface.spans)
        uv = parameter_grid(u, v)
    frames = surface.frames(uv)
    area = area_elements(frames)
    low, high = intervals(real_forms(surface, uv, frames), flat / surface.size)
    return Pressing(frozen(np.array(uv)), frozen(low), frozen(high), frozen(area / max(float(area.sum()), TINY)))


def _sites(spans: int) -> Floats:
    """Parameters of the sites in all spans, or in _MAX_SPANS of them spread evenly."""
    many = min(spans, _MAX_SPANS)
    which = np.floor((np.arange(many) + 0.5) * spans / many)
    return np.asarray((which[:, None] + _SITES).ravel() / spans)


def intervals(forms: Forms, flat: float = 0.0) -> tuple[Floats, Floats]:
    """Ends low, high (k, 2) of the intervals of n_rev >= 0 in which +n_rev and -n_rev press, for forms at k points.

    flat: the normal curvature down to which, below 0, a fibre counts as pressing.
    """
    a, b, c = (second + flat * first for second, first in zip(forms.second, forms.first, strict=True))
    return _above_zero(a, np.abs(b), c)


def _above_zero(a: Floats, b: Floats, c: Floats) -> tuple[Floats, Floats]:
    """Where a n^2 - 2 b n + c >= 0 for n >= 0 and b >= 0: [0, near] and [far, infinity), or what there is of them."""
    root = b * b - a * c
    always = (root <= 0.0) & ((a > 0.0) | ((a == 0.0) & (c >= 0.0)))
    reach = b + np.sqrt(np.maximum(root, 0.0))  # without cancellation: the other root is c over it
    real = (root >= 0.0) & ~always & (reach > 0.0)
    near = np.divide(c, reach, out=np.full_like(a, -1.0), where=real)
    far = np.divide(reach, a, out=np.full_like(a, np.inf), where=real & (a > 0.0))
    has_far = real & (a > 0.0) & np.isfinite(far)
    low = np.stack([np.zeros_like(a), np.where(has_far, far, np.inf)], axis=1)
    high = np.stack([np.where(always, np.inf, near), np.where(has_far, np.inf, -1.0)], axis=1)
    joined = has_far & (near >= far)  # a double root: one interval
    high[joined, 0] = np.inf
    low[joined, 1], high[joined, 1] = np.inf, -1.0
    return low, high
