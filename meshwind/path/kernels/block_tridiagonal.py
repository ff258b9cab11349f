"""2 x 2 block tridiagonal systems: O(n) by block elimination, with a test of definiteness on the way."""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.kernel import njit

DEFINITE = 1e-11
"""A pivot whose determinant is below this share of its block's diagonal product counts as singular."""


class SymmetricSystem(NamedTuple):
    """(H + shift M) x = right, symmetric.

    diagonal (n, 3) holds each block's (uu, uv, vv) of H; upper (n, 2, 2) couples block j to j + 1; metric (n, 3) are
    the blocks of M, the surface's first fundamental form at each particle; right, x (n, 2); inverse (n, 3) is left with
    the pivots' inverses.
    """

    diagonal: Floats
    upper: Floats
    metric: Floats
    right: Floats
    x: Floats
    inverse: Floats


class GeneralSystem(NamedTuple):
    """(A + shift I) x = right, where A need not be symmetric.

    lower, diagonal, upper (n, 2, 2): row block j couples to j - 1, j, j + 1; right, x (n, 2); carry (n, 2, 2) is work
    space.
    """

    lower: Floats
    diagonal: Floats
    upper: Floats
    right: Floats
    x: Floats
    carry: Floats


@njit(cache=True)
def symmetric_system(n):
    """Room for a symmetric system of n blocks."""
    return SymmetricSystem(
        np.empty((n, 3)), np.empty((n, 2, 2)), np.empty((n, 3)), np.empty((n, 2)), np.empty((n, 2)), np.empty((n, 3))
    )


@njit(cache=True)
def general_system(n):
    """Room for a general system of n blocks."""
    return GeneralSystem(
        np.empty((n, 2, 2)), np.empty((n, 2, 2)), np.empty((n, 2, 2)),
        np.empty((n, 2)), np.empty((n, 2)), np.empty((n, 2, 2)),
    )  # fmt: skip


@njit(cache=True)
def solve(system, shift, count):
    """Solve a symmetric system for its first `count` blocks; returns whether the matrix is positive definite.

    x is meaningful only where True is returned; the factorisation stops at the first bad pivot.
    """
    diagonal, upper, metric = system.diagonal, system.upper, system.metric
    right, x, inverse = system.right, system.x, system.inverse
    for j in range(count):
        a = diagonal[j, 0] + shift * metric[j, 0]
        b = diagonal[j, 1] + shift * metric[j, 1]
        c = diagonal[j, 2] + shift * metric[j, 2]
        bound = DEFINITE * abs(a * c)
        x[j, 0], x[j, 1] = right[j, 0], right[j, 1]
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
            x[j, 0] -= m00 * x[i, 0] + m10 * x[i, 1]
            x[j, 1] -= m01 * x[i, 0] + m11 * x[i, 1]
        det = a * c - b * b
        if not (a > 0.0 and det > bound):
            return False
        inverse[j, 0], inverse[j, 1], inverse[j, 2] = c / det, -b / det, a / det
    for j in range(count - 1, -1, -1):
        p, q = x[j, 0], x[j, 1]
        if j < count - 1:
            p -= upper[j, 0, 0] * x[j + 1, 0] + upper[j, 0, 1] * x[j + 1, 1]
            q -= upper[j, 1, 0] * x[j + 1, 0] + upper[j, 1, 1] * x[j + 1, 1]
        x[j, 0] = inverse[j, 0] * p + inverse[j, 1] * q
        x[j, 1] = inverse[j, 1] * p + inverse[j, 2] * q
    return True


@njit(cache=True)
def solve_general(system, shift, count):
    """Solve a general system for its first `count` blocks; returns False at a singular pivot, where x is lost."""
    lower, diagonal, upper = system.lower, system.diagonal, system.upper
    right, x, carry = system.right, system.x, system.carry
    for j in range(count):
        a, b = diagonal[j, 0, 0] + shift, diagonal[j, 0, 1]
        c, d = diagonal[j, 1, 0], diagonal[j, 1, 1] + shift
        r, s = right[j, 0], right[j, 1]
        scale = abs(a * d) + abs(b * c)
        if j > 0:
            w, low = carry[j - 1], lower[j]
            a -= low[0, 0] * w[0, 0] + low[0, 1] * w[1, 0]
            b -= low[0, 0] * w[0, 1] + low[0, 1] * w[1, 1]
            c -= low[1, 0] * w[0, 0] + low[1, 1] * w[1, 0]
            d -= low[1, 0] * w[0, 1] + low[1, 1] * w[1, 1]
            r -= low[0, 0] * x[j - 1, 0] + low[0, 1] * x[j - 1, 1]
            s -= low[1, 0] * x[j - 1, 0] + low[1, 1] * x[j - 1, 1]
        det = a * d - b * c
        if abs(det) <= DEFINITE * scale:
            return False
        x[j, 0], x[j, 1] = (d * r - b * s) / det, (a * s - c * r) / det
        up = upper[j]
        carry[j, 0, 0], carry[j, 0, 1] = (d * up[0, 0] - b * up[1, 0]) / det, (d * up[0, 1] - b * up[1, 1]) / det
        carry[j, 1, 0], carry[j, 1, 1] = (a * up[1, 0] - c * up[0, 0]) / det, (a * up[1, 1] - c * up[0, 1]) / det
    for j in range(count - 2, -1, -1):
        w = carry[j]
        x[j, 0] -= w[0, 0] * x[j + 1, 0] + w[0, 1] * x[j + 1, 1]
        x[j, 1] -= w[1, 0] * x[j + 1, 0] + w[1, 1] * x[j + 1, 1]
    return True
