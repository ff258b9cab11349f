"""The KKT method: springs in space with bilateral contact constraints, dropped where they would pull (7.2 to 7.9).

(7.8) should read G M^-1 G' lambda = G M^-1 f, which is dense.  The same velocities and multipliers come from (7.7)
in O(n) on the constraints' null space: P M P w = P f with P = I - n n' at each contact, a block tridiagonal system.
"""

from numba import njit

from meshwind.methods.blocks import XX, YY, ZZ, solve, solve_free
from meshwind.methods.chain import SOLVES
from meshwind.methods.collide import pulls


@njit(cache=True)
def step(strand, physics, stabilisation, system, pivots, force, right, loose, tally):
    """New velocities of the strand; contacts whose multiplier would pull inwards are let go.

    stabilisation: share of a contact's gap that a step takes back, as n . v = -stabilisation gap / h in (7.3).
    Multipliers of the wrong sign are set to 0 and the velocities found again by (7.9), with the others as they are.
    """
    X, W, uv, frames, normal, touching, gap = strand
    diagonal, inverse, work = system
    n, h = len(X), physics.step
    coupling = h * h * physics.stiff
    free = 1.0 + h * physics.damp + 2.0 * coupling
    pulls(X, force)
    for i in range(1, n - 1):
        diagonal[i, XX] = diagonal[i, YY] = diagonal[i, ZZ] = free
        for k in range(3):
            right[i, k] = W[i, k] + h * physics.stiff * force[i, k]
    back = -stabilisation / h
    for i in range(1, n - 1):  # right side P (f - M b), b the velocities along the normals that are prescribed
        for k in range(3):
            W[i, k] = right[i, k]
            for j in (i - 1, i + 1):
                if touching[j] and 0 < j < n - 1:
                    W[i, k] += coupling * back * gap[j] * normal[j, k]
        if touching[i]:
            dot = W[i, 0] * normal[i, 0] + W[i, 1] * normal[i, 1] + W[i, 2] * normal[i, 2]
            for k in range(3):
                W[i, k] -= dot * normal[i, k]
    tally[SOLVES] += 1
    solve(diagonal, coupling, normal, touching, W, inverse, work)
    for i in range(1, n - 1):
        if touching[i]:
            for k in range(3):
                W[i, k] += back * gap[i] * normal[i, k]
    if release(strand, free, coupling, right, loose):
        tally[SOLVES] += 1
        for i in range(1, n - 1):
            for k in range(3):
                W[i, k] = right[i, k]
        solve_free(coupling, pivots, W)


@njit(cache=True)
def release(strand, free, coupling, right, loose):
    """Take the constraint forces that push, and no others, off `right` (7.9); returns whether any would pull.

    The multiplier is lambda = n . (f - M v); contacts where it is positive are `loose` (n,).
    """
    X, W, uv, frames, normal, touching, gap = strand
    n = len(X)
    pulled = False
    for i in range(1, n - 1):
        loose[i] = False
        if not touching[i]:
            continue
        multiplier = 0.0
        for k in range(3):
            beside = (W[i - 1, k] if i > 1 else 0.0) + (W[i + 1, k] if i < n - 2 else 0.0)
            multiplier += normal[i, k] * (right[i, k] - free * W[i, k] + coupling * beside)
        if multiplier > 0.0:
            loose[i] = True
            pulled = True
        else:
            for k in range(3):
                right[i, k] -= multiplier * normal[i, k]
    return pulled
