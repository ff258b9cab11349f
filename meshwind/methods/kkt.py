"""The KKT method: springs in space with bilateral contact constraints, dropped where they would pull (7.2 to 7.9).

(7.8) should read G M^-1 G' lambda = G M^-1 f, which is dense.  The same velocities and multipliers come from (7.7)
in O(n) on the constraints' null space: P M P v = P f with P = I - n n' at each contact, a block tridiagonal system.
"""

from meshwind.core.kernel import njit
from meshwind.methods.blocks import XX, YY, ZZ, solve, solve_free
from meshwind.methods.chain import SOLVES
from meshwind.methods.strand import spring_forces


@njit(cache=True)
def step(strand, physics, stabilisation, work, tally):
    """New velocities of the strand; contacts whose multiplier would pull inwards are let go.

    stabilisation: share of a contact's gap that a step takes back, as n . v = -stabilisation gap / h in (7.3).
    Multipliers of the wrong sign are set to 0 and the velocities found again by (7.9), with the others as they are.
    """
    V, normal, touching, gap = strand.V, strand.normal, strand.touching, strand.gap
    n, h, force, right = len(V), physics.step, work.force, work.right
    spring_forces(strand.X, force)
    for i in range(1, n - 1):
        for k in range(3):
            right[i, k] = V[i, k] + h * physics.stiffness * force[i, k]
    back = -stabilisation / h
    set_up(strand, back, work)
    tally[SOLVES] += 1
    solve(work.matrix, normal, touching, V)
    for i in range(1, n - 1):
        if touching[i]:
            for k in range(3):
                V[i, k] += back * gap[i] * normal[i, k]
    if release(strand, work):
        tally[SOLVES] += 1
        for i in range(1, n - 1):
            for k in range(3):
                V[i, k] = right[i, k]
        solve_free(work.matrix, V)


@njit(cache=True)
def set_up(strand, back, work):
    """The diagonal, and the right side P (f - M b) in place of the velocities.

    b are the prescribed velocities along the normals: `back` times the gap.
    """
    V, normal, touching, gap = strand.V, strand.normal, strand.touching, strand.gap
    n, right, diagonal, free, coupling = (
        len(V),
        work.right,
        work.matrix.diagonal,
        work.matrix.free,
        work.matrix.coupling,
    )
    for i in range(1, n - 1):
        diagonal[i, XX] = diagonal[i, YY] = diagonal[i, ZZ] = free
        for k in range(3):
            V[i, k] = right[i, k]
            for j in (i - 1, i + 1):
                if touching[j] and 0 < j < n - 1:
                    V[i, k] += coupling * back * gap[j] * normal[j, k]
        if touching[i]:
            dot = V[i, 0] * normal[i, 0] + V[i, 1] * normal[i, 1] + V[i, 2] * normal[i, 2]
            for k in range(3):
                V[i, k] -= dot * normal[i, k]


@njit(cache=True)
def release(strand, work):
    """Subtract the constraint forces that push, and no others, from `work.right` (7.9); returns whether any would pull.

    The multiplier is lambda = n . (f - M v); contacts where it is positive become loose.
    """
    V, normal, touching, loose = strand.V, strand.normal, strand.touching, strand.loose
    n, right, free, coupling = len(V), work.right, work.matrix.free, work.matrix.coupling
    pulled = False
    for i in range(1, n - 1):
        loose[i] = False
        if not touching[i]:
            continue
        multiplier = 0.0
        for k in range(3):
            beside = (V[i - 1, k] if i > 1 else 0.0) + (V[i + 1, k] if i < n - 2 else 0.0)
            multiplier += normal[i, k] * (right[i, k] - free * V[i, k] + coupling * beside)
        if multiplier > 0.0:
            loose[i] = True
            pulled = True
        else:
            for k in range(3):
                right[i, k] -= multiplier * normal[i, k]
    return pulled
