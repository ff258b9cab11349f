"""The starting curve in the parametric plane, to which friction holds: its points and the nearest of them."""

import numpy as np

from meshwind.core.kernel import njit
from meshwind.core.vectors import TINY
from meshwind.path.kernels.geometry import combine, dot

MAX_STEPS = 12
"""Maximum number of Gauss-Newton steps to the nearest point: from a near guess it takes two to four."""
LONGEST_STEP = 4.0
"""Longest of them, in samples of the curve."""
CLOSE = 1e-12
"""Share of the curve's samples below which a step changes nothing."""


@njit(cache=True)
def curve_at(curve, s):
    """Point (u, v) and derivative by s of the Catmull-Rom spline through curve (m, 2), s in samples: third order."""
    m = len(curve)
    k = min(max(int(np.floor(s)), 0), m - 2)
    x = s - k
    u, du = catmull_rom(curve, k, m, 0, x)
    v, dv = catmull_rom(curve, k, m, 1, x)
    return u, v, du, dv


@njit(nogil=True, cache=True)
def sample_all(first, last, curves, out):
    """Write points of curves first to last, evenly by their samples, into out (p, n, 2)."""
    n = out.shape[1]
    for p in range(first, last):
        scale = (curves.shape[1] - 1.0) / (n - 1.0)
        for i in range(n):
            out[p, i, 0], out[p, i, 1], _, _ = curve_at(curves[p], scale * i)


@njit(forceinline=True, cache=True)
def catmull_rom(curve, k, m, a, x):
    """Coordinate a, and its derivative, at share x from sample k of m to the next."""
    p0, p1 = curve[k, a], curve[k + 1, a]
    if m == 2:
        return p0 + x * (p1 - p0), p1 - p0
    d0 = 0.5 * (p1 - curve[k - 1, a]) if k > 0 else -1.5 * p0 + 2.0 * p1 - 0.5 * curve[2, a]
    d1 = 0.5 * (curve[k + 2, a] - p0) if k < m - 2 else 1.5 * p1 - 2.0 * p0 + 0.5 * curve[m - 3, a]
    y, z = x * x, x * x * x
    value = (2 * z - 3 * y + 1) * p0 + (z - 2 * y + x) * d0 + (3 * y - 2 * z) * p1 + (z - y) * d1
    return value, (6 * y - 6 * x) * (p0 - p1) + (3 * y - 4 * x + 1) * d0 + (3 * y - 2 * x) * d1


@njit(cache=True)
def nearest_on(curve, s, u, v, su, sv):
    """The s whose point of the curve is nearest (u, v) in the metric there, from a guess."""
    for _ in range(MAX_STEPS):
        pu, pv, du, dv = curve_at(curve, s)
        c = combine(du, su, dv, sv)
        along, square = dot(c, combine(u - pu, su, v - pv, sv)), dot(c, c)
        step = min(max(along / max(square, TINY), -LONGEST_STEP), LONGEST_STEP)
        then = min(max(s + step, 0.0), len(curve) - 1.0)
        done = abs(then - s) <= CLOSE * len(curve)
        s = then
        if done:
            break
    return s


@njit(cache=True)
def offset_from(curve, s, u, v, su, sv):
    """Signed distance of (u, v) from the curve's point at s, positive to the curve's left.

    Both the way from the curve and the curve's tangent lie in the tangent plane: it is their area over the tangent's
    length.
    """
    pu, pv, du, dv = curve_at(curve, s)
    e, f, g = dot(su, su), dot(su, sv), dot(sv, sv)
    area = np.sqrt(max(e * g - f * f, 0.0)) * (du * (v - pv) - dv * (u - pu))
    return area / np.sqrt(max(e * du * du + 2.0 * f * du * dv + g * dv * dv, TINY))
