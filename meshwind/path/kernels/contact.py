"""Which particles touch the surface: lifting (5.1) and the springs that skip lifted particles (5.2)."""

import numpy as np
from numba import njit


@njit(inline="always", cache=True)
def pull(X, i, before, after, out):
    """Force on particle i from its nearest touching neighbours, per unit of spring: the row j of (5.2)."""
    a, b = 1.0 / (i - before), 1.0 / (after - i)
    for k in range(3):
        out[k] = a * (X[before, k] - X[i, k]) + b * (X[after, k] - X[i, k])


@njit(cache=True)
def link(touching, before, after):
    """Fill each touching particle's nearest touching neighbours; the two ends always touch."""
    n = len(touching)
    last = 0
    for i in range(1, n):
        if touching[i]:
            before[i] = last
            after[last] = i
            last = i


@njit(cache=True)
def lift(X, normal, touching, slack, deep, before, after):
    """Release every touching particle that its neighbours pull off the surface (Algorithm 1).

    The force is the weighted one of (5.2): with uneven gaps the unweighted test of Algorithm 1 has the wrong sign.
    With `deep`, one pass with backtracking, as in a convex hull scan, reaches the fixed point that the source finds
    by repeated sweeps; without, only particles that their present neighbours pull off are released.  A pull up to
    `slack` counts as none.  Returns how many were released.
    """
    link(touching, before, after)
    released = 0
    force = np.empty(3)
    i, n = after[0], len(touching)
    while i < n - 1:
        pull(X, i, before[i], after[i], force)
        p, q = before[i], after[i]
        i_next = q
        if force[0] * normal[i, 0] + force[1] * normal[i, 1] + force[2] * normal[i, 2] > slack:
            touching[i] = False
            released += 1
            if deep:
                after[p], before[q] = q, p
                i_next = p if p > 0 else q
        i = i_next
    if not deep:
        link(touching, before, after)
    return released
