"""Compiled evaluation of a uniform bicubic B-spline: position and five derivatives on a fixed 4 x 4 stencil.

Both parameters run over [0, 1]; u outside it wraps where the spline is periodic, otherwise the end polynomial is
continued.
"""

from math import floor
from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import fill

DEGREE = 3
"""Degree of the polynomials in both directions."""
S, SU, SV, SUU, SUV, SVV = range(6)
"""Rows of a frame: position, first and second derivatives."""


class Spline(NamedTuple):
    """A surface as the kernels take it.

    net (spans_u + 3, spans_v + 3, 3): the control points, where the spline is periodic in u with the first three rows
    repeated at the end, so that no index wraps.
    """

    net: Floats
    periodic: bool


@njit(forceinline=True, cache=True)
def spans_of(net):
    """Number of spans in u and in v of a net."""
    return net.shape[0] - DEGREE, net.shape[1] - DEGREE


@njit(forceinline=True, cache=True)
def locate(t, spans, periodic):
    """Span index and local coordinate of parameter t."""
    if periodic:
        t -= floor(t)
    x = t * spans
    k = int(floor(x))
    k = min(max(k, 0), spans - 1)
    return k, x - k


@njit(nogil=True, forceinline=True, cache=True)
def basis(x):
    """The four cubic weights at local coordinate x of a span."""
    y = 1.0 - x
    return (
        y * y * y / 6.0,
        (4.0 - 6.0 * x * x + 3.0 * x * x * x) / 6.0,
        (4.0 - 6.0 * y * y + 3.0 * y * y * y) / 6.0,
        x * x * x / 6.0,
    )


@njit(nogil=True, forceinline=True, cache=True)
def slope(x, spans):
    """First derivatives of the weights by the parameter."""
    y = 1.0 - x
    return (
        -0.5 * y * y * spans,
        (1.5 * x * x - 2.0 * x) * spans,
        (-1.5 * y * y + 2.0 * y) * spans,
        0.5 * x * x * spans,
    )


@njit(nogil=True, forceinline=True, cache=True)
def bend(x, spans):
    """Second derivatives of the weights by the parameter."""
    square = float(spans) * spans
    return (1.0 - x) * square, (3.0 * x - 2.0) * square, (1.0 - 3.0 * x) * square, x * square


@njit(cache=True)
def frame(spline, u, v, out):
    """Write position and derivatives s, s_u, s_v, s_uu, s_uv, s_vv at (u, v) into out (6, 3)."""
    net = spline.net
    nu, nv = spans_of(net)
    i, x = locate(u, nu, spline.periodic)
    j, y = locate(v, nv, False)
    b, d, e = basis(x), slope(x, nu), bend(x, nu)
    c, f, g = basis(y), slope(y, nv), bend(y, nv)
    for k in range(3):
        s = su = sv = suu = suv = svv = 0.0
        for p in range(4):
            n0, n1, n2, n3 = net[i + p, j, k], net[i + p, j + 1, k], net[i + p, j + 2, k], net[i + p, j + 3, k]
            q = c[0] * n0 + c[1] * n1 + c[2] * n2 + c[3] * n3
            qv = f[0] * n0 + f[1] * n1 + f[2] * n2 + f[3] * n3
            qvv = g[0] * n0 + g[1] * n1 + g[2] * n2 + g[3] * n3
            s += b[p] * q
            su += d[p] * q
            suu += e[p] * q
            sv += b[p] * qv
            suv += d[p] * qv
            svv += b[p] * qvv
        out[S, k], out[SU, k], out[SV, k] = s, su, sv
        out[SUU, k], out[SUV, k], out[SVV, k] = suu, suv, svv


@njit(cache=True)
def tangents(spline, u, v, out):
    """Write s, s_u, s_v at (u, v) into the first rows of out: bit for bit those of `frame`, in 2/3 of the time."""
    net = spline.net
    nu, nv = spans_of(net)
    i, x = locate(u, nu, spline.periodic)
    j, y = locate(v, nv, False)
    b, d = basis(x), slope(x, nu)
    c, f = basis(y), slope(y, nv)
    for k in range(3):
        s = su = sv = 0.0
        for p in range(4):
            n0, n1, n2, n3 = net[i + p, j, k], net[i + p, j + 1, k], net[i + p, j + 2, k], net[i + p, j + 3, k]
            q = c[0] * n0 + c[1] * n1 + c[2] * n2 + c[3] * n3
            s += b[p] * q
            su += d[p] * q
            sv += b[p] * (f[0] * n0 + f[1] * n1 + f[2] * n2 + f[3] * n3)
        out[S, k], out[SU, k], out[SV, k] = s, su, sv


@njit(cache=True)
def position(spline, u, v, out):
    """Write the position alone into out (3,), in a third of the time of a frame."""
    net = spline.net
    nu, nv = spans_of(net)
    i, x = locate(u, nu, spline.periodic)
    j, y = locate(v, nv, False)
    b, c = basis(x), basis(y)
    for k in range(3):
        s = 0.0
        for p in range(4):
            n0, n1, n2, n3 = net[i + p, j, k], net[i + p, j + 1, k], net[i + p, j + 2, k], net[i + p, j + 3, k]
            s += b[p] * (c[0] * n0 + c[1] * n1 + c[2] * n2 + c[3] * n3)
        out[k] = s


@njit(forceinline=True, cache=True)
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
        fill(out, 0.0)
    return size


@njit(nogil=True, cache=True)
def frames(first, last, spline, uv, out):
    """Write the frames of rows first to last of uv (n, 2) into out (n, 6, 3)."""
    for i in range(first, last):
        frame(spline, uv[i, 0], uv[i, 1], out[i])


@njit(nogil=True, cache=True)
def positions(first, last, spline, uv, out):
    """Write the positions of rows first to last of uv (n, 2) into out (n, 3)."""
    for i in range(first, last):
        position(spline, uv[i, 0], uv[i, 1], out[i])
