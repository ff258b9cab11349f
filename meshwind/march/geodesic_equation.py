"""The right-hand side of the forward solver and one step of it: the geodesic equations by arc length.

The unknowns are y = (u, v, p, q) with p = du/ds and q = dv/ds (3.22).  A fibre that friction holds leaves the
geodesic sideways by its geodesic curvature kg; with constant slip kg = slip * kn, the bound of (3.12) used to the full.
"""

import numpy as np
from scipy.integrate import DOP853

from meshwind.core.kernel import njit
from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV, frame, unit_normal

STAGES = DOP853.n_stages
A, B, E3, E5 = (np.ascontiguousarray(table) for table in (DOP853.A, DOP853.B, DOP853.E3, DOP853.E5))
"""Hairer's Dormand-Prince pair of order 8 with its error estimates of order 5 and 3, as SciPy gives it."""
NORMAL = 6
"""Row of the outward normal in a work frame (7, 3)."""


@njit(cache=True)
def rates(spline, slip, y, at, out):
    """Write dy/ds (4,) of (3.22) into out; return (normal curvature, speed |p s_u + q s_v|).

    The normal curvature is positive where the surface presses against the fibre.  A positive slip turns the fibre
    to its left as seen from outside.  All of it scales with the speed as a curve does that is run through faster,
    so that round-off in the speed does not bend the path.  Where s_u and s_v do not span a plane all is NaN.
    """
    frame(spline, y[0], y[1], at)
    area = unit_normal(at, at[NORMAL])
    if not area > 0.0:
        out[:] = np.nan
        return np.nan, np.nan
    p, q = y[2], y[3]
    ee = ff = gg = along_u = along_v = outward = 0.0
    for k in range(3):
        su, sv = at[SU, k], at[SV, k]
        bend = at[SUU, k] * p * p + 2.0 * at[SUV, k] * p * q + at[SVV, k] * q * q
        ee += su * su
        ff += su * sv
        gg += sv * sv
        along_u += bend * su
        along_v += bend * sv
        outward += bend * at[NORMAL, k]
    speed = np.sqrt(ee * p * p + 2.0 * ff * p * q + gg * q * q)
    press = -outward  # normal curvature times speed^2
    side = slip * max(press, 0.0) / (speed * area) if speed > 0.0 else 0.0  # no contact, no friction
    square = area * area
    # Christoffel's symbols (3.21), summed over the derivatives; the source's lack a factor s_u or s_v here and there
    out[0], out[1] = p, q
    out[2] = -(gg * along_u - ff * along_v) / square - side * (ff * p + gg * q)
    out[3] = -(ee * along_v - ff * along_u) / square + side * (ee * p + ff * q)
    return press / (speed * speed) if speed > 0.0 else np.nan, speed


@njit(cache=True)
def runge_kutta_4(spline, slip, y, h, at, K, end):
    """The source's step (section 3.3): classic RK4 from y by h into end (4,); K[0] holds the rates at y."""
    for stage in range(1, 4):
        share = h if stage == 3 else 0.5 * h
        for k in range(4):
            end[k] = y[k] + share * K[stage - 1, k]
        rates(spline, slip, end, at, K[stage])
    for k in range(4):
        end[k] = y[k] + h / 6.0 * (K[0, k] + 2.0 * K[1, k] + 2.0 * K[2, k] + K[3, k])
    return 3


@njit(cache=True)
def dormand_prince_8(spline, slip, y, h, at, K, end):
    """A step of order 8 from y by h into end (4,); K[0] holds the rates at y."""
    for stage in range(1, STAGES):
        for k in range(4):
            total = 0.0
            for m in range(stage):
                total += A[stage, m] * K[m, k]
            end[k] = y[k] + h * total
        rates(spline, slip, end, at, K[stage])
    for k in range(4):
        total = 0.0
        for m in range(STAGES):
            total += B[m] * K[m, k]
        end[k] = y[k] + h * total
    return STAGES - 1


@njit(cache=True)
def local_error(h, size, at, K):
    """Error of a Dormand-Prince step: of the position over the part's size and of the direction (radians)."""
    ee = ff = gg = 0.0
    for k in range(3):
        ee += at[SU, k] * at[SU, k]
        ff += at[SU, k] * at[SV, k]
        gg += at[SV, k] * at[SV, k]
    square5 = square3 = 0.0
    for c in range(0, 4, 2):  # (u, v), then (p, q), both measured in space
        scale = 1.0 / (size * size) if c == 0 else 1.0
        a5 = b5 = a3 = b3 = 0.0
        for m in range(STAGES):
            a5 += E5[m] * K[m, c]
            b5 += E5[m] * K[m, c + 1]
            a3 += E3[m] * K[m, c]
            b3 += E3[m] * K[m, c + 1]
        square5 += scale * (ee * a5 * a5 + 2.0 * ff * a5 * b5 + gg * b5 * b5)
        square3 += scale * (ee * a3 * a3 + 2.0 * ff * a3 * b3 + gg * b3 * b3)
    if square5 == 0.0:
        return 0.0
    return abs(h) * square5 / np.sqrt(square5 + 0.01 * square3)
