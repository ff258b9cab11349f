"""Direct solution of a net's normal equations, by one banded Cholesky factorisation."""

import numpy as np
from scipy.linalg import solveh_banded

from meshwind.core.cast import Floats, Ints
from meshwind.core.kernel import njit
from meshwind.surface.fitting.normal_equations import REACH


def band_width(nu: int, nv: int) -> int:
    """Width of the band of a net's matrix, its unknowns numbered along the direction that makes it narrower."""
    return 2 * REACH * nv + REACH + 1 if 2 * nv <= nu else REACH * nu + 2 * REACH + 1


def _fold(rows: int) -> Ints:
    """Numbers of the rows in the order 0, n-1, 1, n-2, ...: neighbours around the period differ by 2 at most."""
    number = np.empty(rows, dtype=np.int64)
    half = (rows + 1) // 2
    number[:half] = 2 * np.arange(half)
    number[half:] = 2 * np.arange(rows - half)[::-1] + 1
    return number


@njit(nogil=True, cache=True)
def _fill(stencil, number, band):
    """Write a stencil (nu, nv, 4, 7) into the lower band (unknowns, width); number (nu, nv) is that of an unknown."""
    nu, nv = number.shape
    for i in range(nu):
        for r in range(REACH + 1):
            far = (i + r) % nu
            for j in range(nv):
                here = number[i, j]
                for s in range(0 if r > 0 else REACH, 2 * REACH + 1):
                    if 0 <= j + s - REACH < nv:
                        there = number[far, j + s - REACH]
                        band[min(here, there), abs(here - there)] += stencil[i, j, r, s]


def solve_banded(stencil: Floats, right: Floats) -> Floats:
    """Solve for nets (nu, nv, m) by banded Cholesky factorisation, the periodic rows folded to keep the band.

    The unknowns are numbered along the direction that makes the band narrower; the cost is nu nv band^2.
    """
    nu, nv = right.shape[:2]
    fold, along, width = _fold(nu)[:, None], np.arange(nv), band_width(nu, nv)
    number = fold * nv + along if 2 * nv <= nu else along * nu + fold
    band = np.zeros((nu * nv, width))
    _fill(stencil, number, band)
    flat = np.empty((nu * nv, right.shape[2]), order="F")
    flat[number.ravel()] = right.reshape(nu * nv, -1)
    net = solveh_banded(band.T, flat, lower=True, overwrite_ab=True, overwrite_b=True, check_finite=False)
    return np.asarray(net[number])
