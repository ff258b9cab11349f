"""Least squares for a bicubic net: data on the fixed 4 x 4 stencil, a thin-plate term, one banded factorisation."""

from math import floor

import numpy as np
from numba import njit
from scipy.linalg import solveh_banded

from meshwind.cast import Floats, Ints
from meshwind.surface.evaluate import basis

REACH = 3
"""Two control points interact when they are at most this many rows and columns apart."""


@njit(cache=True)
def accumulate(uv, points, weight, spans_u, spans_v, stencil, right):
    """Add every weighted sample to the normal matrix's stencil (nu, nv, 7, 7) and right side (nu, nv, 3)."""
    for n in range(len(uv)):
        x = (uv[n, 0] - floor(uv[n, 0])) * spans_u
        y = uv[n, 1] * spans_v
        i, j = min(int(x), spans_u - 1), min(max(int(floor(y)), 0), spans_v - 1)
        b, c = basis(x - i), basis(y - j)
        for p in range(4):
            row = (i + p) % spans_u
            for q in range(4):
                w = weight[n] * b[p] * c[q]
                for k in range(3):
                    right[row, j + q, k] += w * points[n, k]
                for r in range(4):
                    for s in range(4):
                        stencil[row, j + q, r - p + 3, s - q + 3] += w * b[r] * c[s]


def _gram(spans: int, order: int) -> Floats:
    """Integrals over one span of the products of the basis functions' derivatives, (4, 4), in parameter units."""
    nodes, weights = np.polynomial.legendre.leggauss(4)
    x = 0.5 * (nodes + 1)
    y = 1 - x
    basis = [
        np.stack([y**3 / 6, (4 - 6 * x**2 + 3 * x**3) / 6, (4 - 6 * y**2 + 3 * y**3) / 6, x**3 / 6]),
        np.stack([-(y**2) / 2, 1.5 * x**2 - 2 * x, -1.5 * y**2 + 2 * y, x**2 / 2]) * spans,
        np.stack([y, 3 * x - 2, 3 * y - 2, x]) * spans**2,
    ][order]
    return np.asarray((basis * (0.5 * weights / spans)) @ basis.T)


def _bands(spans: int, order: int, periodic: bool) -> Floats:
    """The 1-D Gram matrix as rows of 7 (offset -3 to 3), (n, 7)."""
    n = spans if periodic else spans + REACH
    out = np.zeros((n, 2 * REACH + 1))
    gram = _gram(spans, order)
    for p in range(4):
        rows = (np.arange(spans) + p) % n
        for r in range(4):
            out[rows, r - p + REACH] += gram[p, r]
    return out


def thin_plate(spans_u: int, spans_v: int, length_u: float, length_v: float) -> Floats:
    """Stencil (nu, nv, 7, 7) of the bending energy of a net that measures length_u by length_v on the part."""
    u = [_bands(spans_u, order, True) for order in range(3)]
    v = [_bands(spans_v, order, False) for order in range(3)]
    out = np.zeros((spans_u, spans_v + REACH, 7, 7))
    for a, b, factor in ((2, 0, 1.0), (1, 1, 2.0), (0, 2, 1.0)):
        scale = factor * length_u ** (1 - 2 * a) * length_v ** (1 - 2 * b)
        out += scale * u[a][:, None, :, None] * v[b][None, :, None, :]
    return out


def _fold(rows: int) -> Ints:
    """Order of periodic rows 0, n-1, 1, n-2, ... in which neighbours around the ring stay within 2 places."""
    place = np.empty(rows, dtype=np.int64)
    half = (rows + 1) // 2
    place[:half] = 2 * np.arange(half)
    place[half:] = 2 * np.arange(rows - half)[::-1] + 1
    return place


def solve(stencil: Floats, right: Floats) -> Floats:
    """Solve for the net (nu, nv, 3): banded Cholesky with the rows folded so that the period keeps a band.

    The band runs over whichever direction makes it narrower; cost nu nv band^2.
    """
    nu, nv = right.shape[:2]
    du, dv = np.meshgrid(np.arange(-REACH, REACH + 1), np.arange(-REACH, REACH + 1), indexing="ij")
    i, j = np.meshgrid(np.arange(nu), np.arange(nv), indexing="ij")
    far_u, far_v = (i[..., None, None] + du) % nu, j[..., None, None] + dv
    inside = (far_v >= 0) & (far_v < nv)
    fold = _fold(nu)
    if 2 * nv <= nu:
        here, there = fold[i] * nv + j, fold[far_u] * nv + far_v
    else:
        here, there = j * nu + fold[i], far_v * nu + fold[far_u]
    row = np.broadcast_to(here[..., None, None], there.shape)[inside]
    column = there[inside]
    lower = row >= column
    row, column, value = row[lower], column[lower], stencil[inside][lower]
    width = int((row - column).max()) + 1
    size = nu * nv
    band = np.bincount((row - column) * size + column, value, width * size).reshape(width, size)
    flat = np.empty((size, 3))
    flat[here.ravel()] = right.reshape(-1, 3)
    return np.asarray(
        solveh_banded(band, flat, lower=True, overwrite_ab=True, check_finite=False)[here.ravel()]
    ).reshape(nu, nv, 3)
