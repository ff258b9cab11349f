"""Compiled evaluation of a uniform bicubic B-spline: position and five derivatives on a fixed 4 x 4 stencil.

Kernels take `net`, the control points padded in the periodic direction so that no index wraps: shape
(spans_u + 3, spans_v + 3, 3).  Both parameters run over [0, 1]; u outside it wraps when `periodic`, otherwise
the end polynomial is continued.
"""

from math import floor

import numpy as np
from numba import njit

S, SU, SV, SUU, SUV, SVV = range(6)
"""Rows of a frame: position, first and second derivatives."""


@njit(inline="always", cache=True)
def locate(t, spans, periodic):
    """Span index and local coordinate of parameter t."""
    if periodic:
        t -= floor(t)
    x = t * spans
    k = int(floor(x))
    k = min(max(k, 0), spans - 1)
    return k, x - k


@njit(cache=True)
def frame(net, periodic, u, v, out):
    """Write position and derivatives s, s_u, s_v, s_uu, s_uv, s_vv at (u, v) into out (6, 3)."""
    nu, nv = net.shape[0] - 3, net.shape[1] - 3
    i, x = locate(u, nu, periodic)
    j, y = locate(v, nv, False)
    x1, y1 = 1.0 - x, 1.0 - y
    b = (
        x1 * x1 * x1 / 6.0,
        (4.0 - 6.0 * x * x + 3.0 * x * x * x) / 6.0,
        (4.0 - 6.0 * x1 * x1 + 3.0 * x1 * x1 * x1) / 6.0,
        x * x * x / 6.0,
    )
    d = (
        -0.5 * x1 * x1 * nu,
        (1.5 * x * x - 2.0 * x) * nu,
        (-1.5 * x1 * x1 + 2.0 * x1) * nu,
        0.5 * x * x * nu,
    )
    nn = float(nu) * nu
    e = (x1 * nn, (3.0 * x - 2.0) * nn, (3.0 * x1 - 2.0) * nn, x * nn)
    c = (
        y1 * y1 * y1 / 6.0,
        (4.0 - 6.0 * y * y + 3.0 * y * y * y) / 6.0,
        (4.0 - 6.0 * y1 * y1 + 3.0 * y1 * y1 * y1) / 6.0,
        y * y * y / 6.0,
    )
    f = (
        -0.5 * y1 * y1 * nv,
        (1.5 * y * y - 2.0 * y) * nv,
        (-1.5 * y1 * y1 + 2.0 * y1) * nv,
        0.5 * y * y * nv,
    )
    mm = float(nv) * nv
    g = (y1 * mm, (3.0 * y - 2.0) * mm, (3.0 * y1 - 2.0) * mm, y * mm)
    for k in range(3):
        s = su = sv = suu = suv = svv = 0.0
        for p in range(4):
            n0, n1, n2, n3 = (
                net[i + p, j, k],
                net[i + p, j + 1, k],
                net[i + p, j + 2, k],
                net[i + p, j + 3, k],
            )
            q = c[0] * n0 + c[1] * n1 + c[2] * n2 + c[3] * n3
            qv = f[0] * n0 + f[1] * n1 + f[2] * n2 + f[3] * n3
            qvv = g[0] * n0 + g[1] * n1 + g[2] * n2 + g[3] * n3
            s += b[p] * q
            su += d[p] * q
            suu += e[p] * q
            sv += b[p] * qv
            suv += d[p] * qv
            svv += b[p] * qvv
        out[0, k] = s
        out[1, k] = su
        out[2, k] = sv
        out[3, k] = suu
        out[4, k] = suv
        out[5, k] = svv


@njit(cache=True)
def position(net, periodic, u, v, out):
    """Write the position alone into out (3,): a third of a frame's cost."""
    nu, nv = net.shape[0] - 3, net.shape[1] - 3
    i, x = locate(u, nu, periodic)
    j, y = locate(v, nv, False)
    x1, y1 = 1.0 - x, 1.0 - y
    b = (
        x1 * x1 * x1 / 6.0,
        (4.0 - 6.0 * x * x + 3.0 * x * x * x) / 6.0,
        (4.0 - 6.0 * x1 * x1 + 3.0 * x1 * x1 * x1) / 6.0,
        x * x * x / 6.0,
    )
    c = (
        y1 * y1 * y1 / 6.0,
        (4.0 - 6.0 * y * y + 3.0 * y * y * y) / 6.0,
        (4.0 - 6.0 * y1 * y1 + 3.0 * y1 * y1 * y1) / 6.0,
        y * y * y / 6.0,
    )
    for k in range(3):
        s = 0.0
        for p in range(4):
            s += b[p] * (
                c[0] * net[i + p, j, k]
                + c[1] * net[i + p, j + 1, k]
                + c[2] * net[i + p, j + 2, k]
                + c[3] * net[i + p, j + 3, k]
            )
        out[k] = s


@njit(inline="always", cache=True)
def unit_normal(frame, out):
    """Write the outward unit normal s_u x s_v of a frame into out (3,); return |s_u x s_v|."""
    a, b = frame[1], frame[2]
    x = a[1] * b[2] - a[2] * b[1]
    y = a[2] * b[0] - a[0] * b[2]
    z = a[0] * b[1] - a[1] * b[0]
    size = np.sqrt(x * x + y * y + z * z)
    if size > 0.0:
        out[0], out[1], out[2] = x / size, y / size, z / size
    else:
        out[:] = 0.0
    return size


@njit(nogil=True, cache=True)
def frames(first, last, net, periodic, uv, out):
    """Write the frames of rows first to last of uv (n, 2) into out (n, 6, 3)."""
    for i in range(first, last):
        frame(net, periodic, uv[i, 0], uv[i, 1], out[i])
