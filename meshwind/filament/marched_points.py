"""Compiled: points evenly along marched fibres, and what is known of the surface there."""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.kernel import njit
from meshwind.march.geodesic_equation import rates
from meshwind.path.kernels.heading import ANGLE, heading, rate
from meshwind.surface.evaluate import SU, SV, S, tangents, unit_normal


class Rows(NamedTuple):
    """Rows of p marched fibres, one after the other.

    first (p + 1,): the first row of each; at (n, 5): arc length, u, v and their rates; bend (n, 3): second derivatives
    of u and v by arc length, and normal curvature; slip (p,): as the fibres were marched.
    """

    first: Ints
    at: Floats
    bend: Floats
    slip: Floats


class Way(NamedTuple):
    """Where a stretch lies on paths, from lengths `begin` to `end` (p,), which of these are the last ones, and how.

    backwards: whether it is run through from its last row to its first; whole (p,): turns that are taken off u; low,
    high: v of the surface where that of the rows is 0 and 1.
    """

    begin: Floats
    end: Floats
    last: bool
    backwards: bool
    whole: Floats
    low: float
    high: float


@njit(nogil=True, cache=True)
def curvatures(first, last, spline, rows):
    """Write the second derivatives and the normal curvature of fibres first to last."""
    at, y, out = np.empty((7, 3)), np.empty(4), np.empty(4)
    for fibre in range(first, last):
        for i in range(rows.first[fibre], rows.first[fibre + 1]):
            y[:] = rows.at[i, 1:]
            rows.bend[i, 2] = rates(spline, rows.slip[fibre], y, at, out)[0]
            rows.bend[i, :2] = out[2:]


@njit(cache=True)
def quintic(h, a, b, x):
    """Value at a share x of a way of length h, from values with two derivatives at both its ends."""
    da, dda, db, ddb = h * a[1], h * h * a[2], h * b[1], h * h * b[2]
    rise = b[0] - a[0] - da - 0.5 * dda
    slope, bend = db - da - dda, ddb - dda
    found = 6.0 * rise - 3.0 * slope + 0.5 * bend
    found = found * x - 15.0 * rise + 7.0 * slope - bend
    found = found * x + 10.0 * rise - 4.0 * slope + 0.5 * bend
    return ((found * x + 0.5 * dda) * x + da) * x + a[0]


@njit(nogil=True, cache=True)
def spread(first, last, rows, way, wanted, uv, slip):
    """Write uv (p, n, 2) and the slip (p, n) of fibres first to last at lengths `wanted` (p, n) that are on a stretch.

    Between two rows lies one polynomial piece of the surface, so that u and v there are smooth.
    """
    for fibre in range(first, last):
        low, many = rows.first[fibre], rows.first[fibre + 1] - rows.first[fibre]
        length, sign = rows.at[low + many - 1, 0], -1.0 if way.backwards else 1.0
        begin, stop, step = (low + many - 1, low, -1) if way.backwards else (low, low + many - 1, 1)
        k = begin
        for i in range(wanted.shape[1]):
            if wanted[fibre, i] < way.begin[fibre] or (wanted[fibre, i] >= way.end[fibre] and not way.last):
                continue
            s = wanted[fibre, i] - way.begin[fibre]
            if way.backwards:
                s = length - s
            while k + step != stop and sign * (rows.at[k + step, 0] - s) <= 0.0:
                k += step
            h = abs(rows.at[k + step, 0] - rows.at[k, 0])
            x = min(max(abs(s - rows.at[k, 0]) / h, 0.0), 1.0) if h > 0.0 else 0.0
            for c in range(2):
                a = rows.at[k, 1 + c], sign * rows.at[k, 3 + c], rows.bend[k, c]
                b = rows.at[k + step, 1 + c], sign * rows.at[k + step, 3 + c], rows.bend[k + step, c]
                uv[fibre, i, c] = quintic(h, a, b, x)
            slip[fibre, i] = abs(rows.slip[fibre])
            # the ends are as they were marched
            at = begin if i == 0 else stop if i == wanted.shape[1] - 1 else -1
            if at >= 0:
                uv[fibre, i, 0], uv[fibre, i, 1] = rows.at[at, 1], rows.at[at, 2]
            uv[fibre, i, 0] -= way.whole[fibre]
            uv[fibre, i, 1] = way.low + (way.high - way.low) * uv[fibre, i, 1]


@njit(nogil=True, cache=True)
def places(first, last, spline, uv, points, normal, angle):
    """Write points and outward unit normals (p, n, 3) at uv (p, n, 2) of fibres first to last.

    angle (p, n): room for their winding angle as well, as `winding_angle` has it, or of no size.
    """
    frame, way, out = np.empty((3, 3)), np.empty(3), np.empty(3)
    for fibre in range(first, last):
        for i in range(uv.shape[1]):
            tangents(spline, uv[fibre, i, 0], uv[fibre, i, 1], frame)
            points[fibre, i] = frame[S]
            unit_normal(frame, normal[fibre, i])
            if angle.size > 0:
                du, dv = rate(uv[fibre], i, 0), rate(uv[fibre], i, 1)
                for k in range(3):
                    way[k] = frame[SU, k] * du + frame[SV, k] * dv
                heading(frame[SU], frame[SV], way, out)
                angle[fibre, i] = out[ANGLE]
