"""Direct solvers for chains in space: symmetric 3 x 3 blocks joined by -c I, and the same without blocks."""

import numpy as np
from numba import njit

XX, XY, XZ, YY, YZ, ZZ = range(6)
"""Places of a symmetric block's entries."""

SINGULAR = 1e-14
"""A pivot whose determinant is below this share of its diagonal's product has no digits left."""


@njit(inline="always", cache=True)
def project(n, out):
    """Take the part along the unit vector n out of a vector."""
    dot = out[0] * n[0] + out[1] * n[1] + out[2] * n[2]
    for k in range(3):
        out[k] -= dot * n[k]


@njit(inline="always", cache=True)
def times(s, x, out):
    """Symmetric block s (6,) times x (3,)."""
    out[0] = s[XX] * x[0] + s[XY] * x[1] + s[XZ] * x[2]
    out[1] = s[XY] * x[0] + s[YY] * x[1] + s[YZ] * x[2]
    out[2] = s[XZ] * x[0] + s[YZ] * x[1] + s[ZZ] * x[2]


@njit(inline="always", cache=True)
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


@njit(inline="always", cache=True)
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


@njit(cache=True)
def solve(diagonal, coupling, normal, pinned, x, inverse, work):
    """Solve for particles 1 to n - 2, in place of the right sides x (n, 3).

    diagonal (n, 6); neighbours are joined by -coupling P_i P_{i+1}, where P = I - n n' at a pinned particle and I
    elsewhere.  inverse (n, 6) and work (2, 6) are work space.  Returns False at a singular pivot, where x is lost: a
    matrix that dominates its couplings has none, but stiffness of 1e14 across a normal leaves no digits along it.
    """
    n = len(x)
    s, y = work[0], work[1]
    for j in range(1, n - 1):
        for k in range(6):
            s[k] = diagonal[j, k]
        if j > 1:
            i = j - 1
            times(inverse[i], x[i], y)
            if pinned[i]:
                project(normal[i], y)
            if pinned[j]:
                project(normal[j], y)
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
    for j in range(n - 2, 0, -1):
        if j < n - 2:
            for k in range(3):
                y[k] = x[j + 1, k]
            if pinned[j + 1]:
                project(normal[j + 1], y)
            if pinned[j]:
                project(normal[j], y)
            for k in range(3):
                x[j, k] += coupling * y[k]
        for k in range(3):
            y[k] = x[j, k]
        times(inverse[j], y, x[j])
    return True


@njit(cache=True)
def factor(diagonal, coupling, pivots):
    """Pivots' inverses of the scalar matrix with `diagonal` and -coupling beside it; free particles 1 to n - 2."""
    last = 0.0
    for j in range(1, len(pivots) - 1):
        last = 1.0 / (diagonal - coupling * coupling * last)
        pivots[j] = last


@njit(cache=True)
def solve_free(coupling, pivots, x):
    """Solve with the factors of `factor` in place of the right sides x (n, 3)."""
    n = len(x)
    for j in range(2, n - 1):
        for k in range(3):
            x[j, k] += coupling * pivots[j - 1] * x[j - 1, k]
    for j in range(n - 2, 0, -1):
        for k in range(3):
            if j < n - 2:
                x[j, k] += coupling * x[j + 1, k]
            x[j, k] *= pivots[j]


@njit(cache=True)
def room(n):
    """Work space of `solve`: diagonal, inverse, work."""
    return np.zeros((n, 6)), np.empty((n, 6)), np.empty((2, 6))
