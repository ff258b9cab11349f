"""Compiled directions of fibres, by the surface's own directions along the part and around it."""

from math import asin, sqrt

import numpy as np

from meshwind.core.kernel import njit
from meshwind.core.vectors import TINY
from meshwind.surface.evaluate import SU, SV, tangents

ALONG, AROUND, ANGLE = range(3)
"""Columns of a heading: components of a direction along the part and around it, and its angle from along, to pi/2."""


@njit(forceinline=True, cache=True)
def rate(values, i, k):
    """Change of column k of values (n, m) from particle to particle at i, of second order where there are three."""
    last = len(values) - 1
    if 0 < i < last:
        return (values[i + 1, k] - values[i - 1, k]) / 2.0
    if last == 1:
        return values[1, k] - values[0, k]
    if i == 0:
        return -1.5 * values[0, k] + 2.0 * values[1, k] - 0.5 * values[2, k]
    return 1.5 * values[last, k] - 2.0 * values[last - 1, k] + 0.5 * values[last - 2, k]


@njit(forceinline=True, cache=True)
def heading(su, sv, way, out):
    """Write the heading (3,) of a direction (3,) where the surface has the tangents su and sv (3,)."""
    aa = su[0] * su[0] + su[1] * su[1] + su[2] * su[2]
    ab = su[0] * sv[0] + su[1] * sv[1] + su[2] * sv[2]
    wa = su[0] * way[0] + su[1] * way[1] + su[2] * way[2]
    # along the part is s_v without its share of s_u
    share = ab / max(aa, TINY)
    size = wl = 0.0
    for k in range(3):
        along = sv[k] - share * su[k]
        wl += along * way[k]
        size += along * along
    out[ALONG] = wl / max(sqrt(size), TINY)
    out[AROUND] = wa / max(sqrt(aa), TINY)
    whole = sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2])
    out[ANGLE] = asin(min(abs(out[AROUND]) / max(whole, TINY), 1.0))


@njit(nogil=True, cache=True)
def headings(first, last, spline, uv, points, touching, out):
    """Write the headings (p, n, 3) of paths first to last, with uv (p, n, 2), points (p, n, 3), touching (p, n).

    On the surface directions are taken by the parameters, as chords of many turns cut their corners; in the air from
    the fibre itself.
    """
    frame, way = np.empty((3, 3)), np.empty(3)
    for p in range(first, last):
        for i in range(uv.shape[1]):
            tangents(spline, uv[p, i, 0], uv[p, i, 1], frame)
            su, sv = frame[SU], frame[SV]
            if touching[p, i]:
                du, dv = rate(uv[p], i, 0), rate(uv[p], i, 1)
                for k in range(3):
                    way[k] = su[k] * du + sv[k] * dv
            else:
                for k in range(3):
                    way[k] = rate(points[p], i, k)
            heading(su, sv, way, out[p, i])
