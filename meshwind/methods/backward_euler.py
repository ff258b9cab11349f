"""Linearised backward Euler (4.16), damped (4.17), with the factored matrix kept over several steps (7.2).

The matrix is symmetric, positive definite and 2 x 2 block tridiagonal over the touching particles, so that a step
is O(n); with lifted particles its rows are those of (5.2).
"""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.kernel import njit
from meshwind.methods.chain import SOLVES
from meshwind.path.kernels.block_tridiagonal import SymmetricSystem, solve
from meshwind.surface.evaluate import SU


class System(NamedTuple):
    """The linear system of a step, kept with its factors, by contact.

    diagonal (n, 3), upper (n, 2, 2): the matrix; right, x (n, 2): right side and solution; inverse (n, 3): inverses of
    the pivots; held (n,): the held directions that the matrix was built with.
    """

    diagonal: Floats
    upper: Floats
    right: Floats
    x: Floats
    inverse: Floats
    held: Ints


@njit(cache=True)
def system_for(n):
    """Room for the system of n particles."""
    return System(
        np.empty((n, 3)),
        np.zeros((n, 2, 2)),
        np.empty((n, 2)),
        np.empty((n, 2)),
        np.empty((n, 3)),
        np.zeros(n, np.int64),
    )


@njit(cache=True)
def step(chain, physics, forces, count, refresh, system, move, tally):
    """New velocities and their moves; `refresh` builds and factors the matrix, otherwise the last one serves.

    Returns whether the matrix was positive definite: where it is not, the surface is singular.
    """
    V, h, right, x = chain.V, physics.step, system.right, system.x
    particle, held, metric, force = forces.particle, forces.held, forces.metric, forces.force
    for c in range(count):
        i = particle[c]
        a, b, d = metric[c, 0], metric[c, 1], metric[c, 2]
        right[c, 0] = a * V[i, 0] + b * V[i, 1] + h * physics.stiffness * force[c, 0]
        right[c, 1] = b * V[i, 0] + d * V[i, 1] + h * physics.stiffness * force[c, 1]
    tally[SOLVES] += 1
    if refresh:
        build(chain, physics, forces, count, system)
        matrix = SymmetricSystem(system.diagonal, system.upper, metric, right, x, system.inverse)
        if not solve(matrix, 0.0, count):
            return False
    else:
        solve_again(system, count)
    for c in range(count):
        i = particle[c]
        for a in range(2):
            V[i, a] = 0.0 if (held[c] >> a) & 1 else x[c, a]
            move[c, a] = h * V[i, a]
    return True


@njit(cache=True)
def held_otherwise(system, forces, count):
    """Note the held directions in the system; returns whether they have changed."""
    changed, former, held = False, system.held, forces.held
    for c in range(count):
        if former[c] != held[c]:
            former[c] = held[c]
            changed = True
    return changed


@njit(cache=True)
def build(chain, physics, forces, count, system):
    """The matrix J'((1 + h beta / m) I - h^2 K) J of (4.17) over the touching particles."""
    frames, before, after = chain.frames, chain.before, chain.after
    particle, held, metric, diagonal, upper = forces.particle, forces.held, forces.metric, system.diagonal, system.upper
    pull = physics.step * physics.step * physics.stiffness
    for c in range(count):
        i = particle[c]
        weight = 1.0 + physics.step * physics.damping + pull * (1.0 / (i - before[i]) + 1.0 / (after[i] - i))
        for k in range(3):
            diagonal[c, k] = weight * metric[c, k]
        if c == 0:
            continue
        p = before[i]
        for a in range(2):
            for b in range(2):
                dot = 0.0
                if not ((held[c - 1] >> a) & 1 or (held[c] >> b) & 1):
                    for k in range(3):
                        dot -= frames[p, SU + a, k] * frames[i, SU + b, k]
                upper[c - 1, a, b] = pull * dot / (i - p)


@njit(cache=True)
def solve_again(system, count):
    """Solve for another right side with the pivots' inverses that `block_tridiagonal.solve` left in the system."""
    upper, inverse, right, x = system.upper, system.inverse, system.right, system.x
    for j in range(count):
        x[j, 0], x[j, 1] = right[j, 0], right[j, 1]
        if j > 0:
            i = j - 1
            p = inverse[i, 0] * x[i, 0] + inverse[i, 1] * x[i, 1]
            q = inverse[i, 1] * x[i, 0] + inverse[i, 2] * x[i, 1]
            x[j, 0] -= upper[i, 0, 0] * p + upper[i, 1, 0] * q
            x[j, 1] -= upper[i, 0, 1] * p + upper[i, 1, 1] * q
    for j in range(count - 1, -1, -1):
        p, q = x[j, 0], x[j, 1]
        if j < count - 1:
            p -= upper[j, 0, 0] * x[j + 1, 0] + upper[j, 0, 1] * x[j + 1, 1]
            q -= upper[j, 1, 0] * x[j + 1, 0] + upper[j, 1, 1] * x[j + 1, 1]
        x[j, 0] = inverse[j, 0] * p + inverse[j, 1] * q
        x[j, 1] = inverse[j, 1] * p + inverse[j, 2] * q
