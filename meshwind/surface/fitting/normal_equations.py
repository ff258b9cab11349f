"""Normal equations of a bicubic net that is fitted by least squares: data on the 4 x 4 stencil, a thin-plate term."""

from math import floor

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.kernel import njit
from meshwind.core.threads import parallel_for
from meshwind.surface.evaluate import basis

REACH = 3
"""Largest number of rows or columns between two control points that share a span."""
PARTS, LARGE = 4, 100_000
"""Parts that large data are divided into, which are summed at the same time, and their least number."""


def control_points(spans: tuple[int, int]) -> int:
    """Number of control points of a net with so many spans, periodic in u."""
    return spans[0] * (spans[1] + REACH)


def accumulate(uv: Floats, values: Floats, weight: Floats, stencil: Floats, right: Floats) -> None:
    """Add weighted data to the normal matrix's stencil (nu, nv, 4, 7) and right sides (nu, nv, m) of a net.

    uv (k, 2) are the data's places, values (k, m) what the net is to be there, weight (k,) what each counts.
    stencil[i, j, r, s] couples control point (i, j) to (i + r, j + s - 3).  The matrix is symmetric: only the half
    ahead is kept, that is s >= 3 where r is 0; the other entries have no meaning.
    """
    if len(uv) < LARGE:
        _accumulate(uv, values, weight, stencil, right)
        return
    # as many parts on any number of threads, so that the sums are the same to the last bit
    stencils, rights = np.zeros((PARTS, *stencil.shape)), np.zeros((PARTS, *right.shape))
    parallel_for(_accumulate_parts, PARTS, 1, uv, values, weight, stencils, rights)
    stencil += stencils.sum(axis=0)
    right += rights.sum(axis=0)


@njit(nogil=True, cache=True)
def _accumulate(uv, points, weight, stencil, right):
    """Add data to a stencil and right sides."""
    spans_u, spans_v = right.shape[0], right.shape[1] - REACH
    # flat and unsigned, so that no index can be negative: a third of the time
    flat, sums, one, row_of = stencil.reshape(-1), right.reshape(-1), np.uint64(1), np.uint64(2 * REACH + 1)
    sides = points.shape[1]
    for n in range(len(uv)):
        x = (uv[n, 0] - floor(uv[n, 0])) * spans_u
        y = uv[n, 1] * spans_v
        i, j = min(int(x), spans_u - 1), min(max(int(floor(y)), 0), spans_v - 1)
        b, c = basis(x - i), basis(y - j)
        for p in range(4):
            first = (i + p) % spans_u * (spans_v + REACH) + j
            for q in range(4):
                w = weight[n] * b[p] * c[q]
                at = np.uint64(sides * (first + q))
                for k in range(sides):
                    sums[at] += w * points[n, k]
                    at += one
                row = np.uint64((first + q) * (REACH + 1) * (2 * REACH + 1) + REACH - q)
                for r in range(p, 4):
                    at, share = row, w * b[r]
                    for s in range(4):
                        flat[at] += share * c[s]
                        at += one
                    row += row_of


@njit(nogil=True, cache=True)
def _accumulate_parts(first, last, uv, points, weight, stencils, rights):
    """Add parts first to last of the data each to its own sums."""
    for part in range(first, last):
        a, b = part * len(uv) // len(rights), (part + 1) * len(uv) // len(rights)
        _accumulate(uv[a:b], points[a:b], weight[a:b], stencils[part], rights[part])


def _gram(order: int) -> Floats:
    """Integrals over [0, 1] of the products of the basis functions' derivatives, (4, 4)."""
    nodes, weights = np.polynomial.legendre.leggauss(4)
    x = 0.5 * (nodes + 1)
    y = 1 - x
    basis = [
        np.stack([y**3 / 6, (4 - 6 * x**2 + 3 * x**3) / 6, (4 - 6 * y**2 + 3 * y**3) / 6, x**3 / 6]),
        np.stack([-(y**2) / 2, 1.5 * x**2 - 2 * x, -1.5 * y**2 + 2 * y, x**2 / 2]),
        np.stack([y, 3 * x - 2, 3 * y - 2, x]),
    ][order]
    return np.asarray((basis * (0.5 * weights)) @ basis.T)


_GRAMS = [_gram(order) for order in range(3)]


def gram_bands(spans: int, periodic: bool, order: int = 0) -> Floats:
    """The 1-D Gram matrix in parameter units as rows of 7 (offset -3 to 3), (n, 7)."""
    n = spans if periodic else spans + REACH
    out = np.zeros((n, 2 * REACH + 1))
    gram = _GRAMS[order] * float(spans) ** (2 * order - 1)
    for p in range(4):
        rows = (np.arange(spans) + p) % n
        out[rows, REACH - p : 2 * REACH + 1 - p] += gram[p]
    return out


def thin_plate(spans_u: int, spans_v: int, length_u: float, length_v: float) -> Floats:
    """Stencil (nu, nv, 4, 7) of the bending energy of a net that measures length_u by length_v on the part."""
    u = [gram_bands(spans_u, True, order)[:, REACH:] for order in range(3)]
    v = [gram_bands(spans_v, False, order) for order in range(3)]
    out = np.zeros((spans_u, spans_v + REACH, REACH + 1, 2 * REACH + 1))
    for a, b, factor in ((2, 0, 1.0), (1, 1, 2.0), (0, 2, 1.0)):
        scale = factor * length_u ** (1 - 2 * a) * length_v ** (1 - 2 * b)
        out += (scale * u[a])[:, None, :, None] * v[b][None, :, None, :]
    return out


def bending(spans: tuple[int, int], lengths: tuple[float, float], weight: float) -> Floats:
    """`thin_plate` with the weight at which it counts, at the net's own wave length, as data of that density do."""
    pitch = lengths[0] / spans[0] * lengths[1] / spans[1]
    return thin_plate(*spans, *lengths) * (weight * pitch**2 / (2 * np.pi) ** 4)
