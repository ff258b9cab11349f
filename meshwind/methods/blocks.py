"""Direct solvers for chains in space: symmetric 3 x 3 blocks joined by -c I, and the same without blocks."""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.kernel import njit

XX, XY, XZ, YY, YZ, ZZ = range(6)
"""Entries of a symmetric block."""

SINGULAR = 1e-14
"""A pivot whose determinant is below this share of its diagonal's product has no digits left."""


class ChainMatrix(NamedTuple):
    """The matrix of a chain of n particles with fixed ends, and room for its factors.

    free: diagonal entry of a particle that nothing touches; coupling: neighbours are joined by minus this; diagonal
    (n, 6): symmetric blocks; pivots (n,): inverses of the pivots where no particle is touched, all blocks being free I;
    inverse (n, 6): inverses of the pivots otherwise; block (6,), vector (3,): work space.
    """

    free: float
    coupling: float
    diagonal: Floats
    pivots: Floats
    inverse: Floats
    block: Floats
    vector: Floats


@njit(cache=True)
def chain_matrix(n, step, stiffness, damping):
    """The matrix of n free particles by (7.2), M - h^2 K + h D over the mass, factored."""
    coupling = step * step * stiffness
    free = 1.0 + step * damping + 2.0 * coupling
    matrix = ChainMatrix(free, coupling, np.zeros((n, 6)), np.zeros(n), np.empty((n, 6)), np.empty(6), np.empty(3))
    last = 0.0
    for j in range(1, n - 1):
        last = 1.0 / (free - coupling * coupling * last)
        matrix.pivots[j] = last
    return matrix


@njit(forceinline=True, cache=True)
def project(n, out):
    """Remove a vector's component along the unit vector n."""
    dot = out[0] * n[0] + out[1] * n[1] + out[2] * n[2]
    for k in range(3):
        out[k] -= dot * n[k]


@njit(forceinline=True, cache=True)
def times(s, x, out):
    """Symmetric block s (6,) times x (3,)."""
    out[0] = s[XX] * x[0] + s[XY] * x[1] + s[XZ] * x[2]
    out[1] = s[XY] * x[0] + s[YY] * x[1] + s[YZ] * x[2]
    out[2] = s[XZ] * x[0] + s[YZ] * x[1] + s[ZZ] * x[2]


@njit(forceinline=True, cache=True)
def sandwich(n, s, y):
    """Replace s by P s P with P = I - n n', in place; y (3,) is work space."""
    times(s, n, y)
    dot = 0.5 * (y[0] * n[0] + y[1] * n[1] + y[2] * n[2])
    for k in range(3):
        y[k] -= dot * n[k]
    s[XX] -= 2.0 * n[0] * y[0]
    s[XY] -= n[0] * y[1] + n[1] * y[0]
    s[XZ] -= n[0] * y[2] + n[2] * y[0]
    s[YY] -= 2.0 * n[1] * y[1]
    s[YZ] -= n[1] * y[2] + n[2] * y[1]
    s[ZZ] -= 2.0 * n[2] * y[2]


@njit(forceinline=True, cache=True)
def invert(s, out):
    """Write the inverse of a symmetric block; returns whether its determinant is positive to working precision."""
    a, b, c = s[YY] * s[ZZ] - s[YZ] * s[YZ], s[XZ] * s[YZ] - s[XY] * s[ZZ], s[XY] * s[YZ] - s[XZ] * s[YY]
    det = s[XX] * a + s[XY] * b + s[XZ] * c
    if not det > SINGULAR * abs(s[XX] * s[YY] * s[ZZ]):
        return False
    scale = 1.0 / det
    out[XX], out[XY], out[XZ] = scale * a, scale * b, scale * c
    out[YY] = scale * (s[XX] * s[ZZ] - s[XZ] * s[XZ])
    out[YZ] = scale * (s[XY] * s[XZ] - s[XX] * s[YZ])
    out[ZZ] = scale * (s[XX] * s[YY] - s[XY] * s[XY])
    return True


@njit(forceinline=True, cache=True)
def project_between(i, j, normal, pinned, out):
    """Apply P_i, then P_j to a vector, where the particles are pinned."""
    if pinned[i]:
        project(normal[i], out)
    if pinned[j]:
        project(normal[j], out)


@njit(cache=True)
def solve(matrix, normal, pinned, x):
    """Solve for particles 1 to n - 2, in place of the right sides x (n, 3).

    Neighbours are joined by -coupling P_i P_{i+1}, where P = I - n n' at a pinned particle and I elsewhere.  Returns
    False at a singular pivot, where x is lost: a matrix that dominates its couplings has none, but stiffness of 1e14
    across a normal leaves no digits along it.
    """
    if not eliminate(matrix, normal, pinned, x):
        return False
    substitute(matrix, normal, pinned, x)
    return True


@njit(cache=True)
def eliminate(matrix, normal, pinned, x):
    """Eliminate each particle from its successor's equations; returns False at a singular pivot."""
    diagonal, inverse, coupling, s, y = matrix.diagonal, matrix.inverse, matrix.coupling, matrix.block, matrix.vector
    for j in range(1, len(x) - 1):
        for k in range(6):
            s[k] = diagonal[j, k]
        if j > 1:
            i = j - 1
            times(inverse[i], x[i], y)
            project_between(i, j, normal, pinned, y)
            for k in range(3):
                x[j, k] += coupling * y[k]
            t = inverse[j]
            for k in range(6):
                t[k] = inverse[i, k]
            if pinned[i]:
                sandwich(normal[i], t, y)
            if pinned[j]:
                sandwich(normal[j], t, y)
            for k in range(6):
                s[k] -= coupling * coupling * t[k]
        if not invert(s, inverse[j]):
            return False
    return True


@njit(cache=True)
def substitute(matrix, normal, pinned, x):
    """Find the solution from the last particle back to the first."""
    n, inverse, coupling, y = len(x), matrix.inverse, matrix.coupling, matrix.vector
    for j in range(n - 2, 0, -1):
        if j < n - 2:
            for k in range(3):
                y[k] = x[j + 1, k]
            project_between(j + 1, j, normal, pinned, y)
            for k in range(3):
                x[j, k] += coupling * y[k]
        for k in range(3):
            y[k] = x[j, k]
        times(inverse[j], y, x[j])


@njit(cache=True)
def solve_free(matrix, x):
    """Solve where no particle is touched, in place of the right sides x (n, 3)."""
    n = len(x)
    coupling, pivots = matrix.coupling, matrix.pivots
    for j in range(2, n - 1):
        for k in range(3):
            x[j, k] += coupling * pivots[j - 1] * x[j - 1, k]
    for j in range(n - 2, 0, -1):
        for k in range(3):
            if j < n - 2:
                x[j, k] += coupling * x[j + 1, k]
            x[j, k] *= pivots[j]
