"""Symmetric 2 x 2 block tridiagonal systems, factored with a shift wherever a pivot is not positive."""

import numpy as np
from numba import njit


@njit(cache=True)
def solve(diagonal, upper, metric, right, count):
    """Solve H x = right for the first `count` blocks, in place: `right` (n, 2) becomes x.

    diagonal (n, 3) holds each block's (uu, uv, vv); upper (n, 2, 2) couples block j to j + 1; metric (n, 3) is
    the surface's first fundamental form, in which a pivot's eigenvalues are measured.  A pivot with an
    eigenvalue below 1e-8 of its scale is lifted to the eigenvalue's magnitude (at least that bound), so the
    matrix that is solved is positive definite and x is a descent direction of the energy whose gradient is
    -right.  Returns the number of lifted pivots: 0 means that H itself is positive definite.
    """
    lifted = 0
    inverse = np.empty((count, 3))
    for j in range(count):
        a, b, c = diagonal[j, 0], diagonal[j, 1], diagonal[j, 2]
        if j > 0:
            i = j - 1
            pa, pb, pc = inverse[i, 0], inverse[i, 1], inverse[i, 2]
            w = upper[i]
            m00 = pa * w[0, 0] + pb * w[1, 0]
            m10 = pb * w[0, 0] + pc * w[1, 0]
            m01 = pa * w[0, 1] + pb * w[1, 1]
            m11 = pb * w[0, 1] + pc * w[1, 1]
            a -= w[0, 0] * m00 + w[1, 0] * m10
            b -= w[0, 0] * m01 + w[1, 0] * m11
            c -= w[0, 1] * m01 + w[1, 1] * m11
            right[j, 0] -= m00 * right[i, 0] + m10 * right[i, 1]
            right[j, 1] -= m01 * right[i, 0] + m11 * right[i, 1]
        # eigenvalues in the metric: with G = L L', those of L^-1 P L^-T
        g00 = np.sqrt(metric[j, 0])
        g10 = metric[j, 1] / g00
        g11 = np.sqrt(max(metric[j, 2] - g10 * g10, 1e-300))
        e = a / metric[j, 0]
        f = (b - g10 * a / g00) / (g00 * g11)
        h = (c - 2.0 * g10 * b / g00 + g10 * g10 * a / metric[j, 0]) / (g11 * g11)
        mean, half = 0.5 * (e + h), np.sqrt(0.25 * (e - h) ** 2 + f * f)
        low, high = mean - half, mean + half
        floor = 1e-8 * max(abs(low), abs(high)) + 1e-300
        if low < floor:
            lifted += 1
            t = 0.5 * np.arctan2(2.0 * f, e - h)
            cs, sn = np.cos(t), np.sin(t)
            big = max(abs(high), floor)
            small = max(abs(low), floor)
            e = big * cs * cs + small * sn * sn
            h = big * sn * sn + small * cs * cs
            f = (big - small) * cs * sn
            a = e * metric[j, 0]
            b = g00 * (g10 * e + g11 * f)
            c = g10 * g10 * e + 2.0 * g10 * g11 * f + g11 * g11 * h
        det = a * c - b * b
        inverse[j, 0], inverse[j, 1], inverse[j, 2] = c / det, -b / det, a / det
    for j in range(count - 1, -1, -1):
        x, y = right[j, 0], right[j, 1]
        if j < count - 1:
            x -= upper[j, 0, 0] * right[j + 1, 0] + upper[j, 0, 1] * right[j + 1, 1]
            y -= upper[j, 1, 0] * right[j + 1, 0] + upper[j, 1, 1] * right[j + 1, 1]
        right[j, 0] = inverse[j, 0] * x + inverse[j, 1] * y
        right[j, 1] = inverse[j, 1] * x + inverse[j, 2] * y
    return lifted
