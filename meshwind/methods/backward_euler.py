"""Linearised backward Euler (4.16), damped (4.17), with the factored matrix kept over several steps (section 7.2).

The matrix is symmetric, positive definite and 2 x 2 block tridiagonal over the touching particles, so that a step
is O(n); with lifted particles its rows are those of (5.2).
"""

from numba import njit

from meshwind.methods.chain import SOLVES
from meshwind.path.kernels.block_tridiagonal import solve
from meshwind.surface.evaluate import SU


@njit(cache=True)
def step(chain, physics, contacts, before, after, count, forces, refresh, system, move, tally):
    """New velocities and their moves; `refresh` builds and factors the matrix, otherwise the last one serves.

    system is (diagonal, upper, right, x, inverse), work space that keeps the factors.  Returns whether the matrix
    was positive definite: where it is not, the surface is singular.
    """
    V, h = chain[2], physics.step
    bits, metric, force, press = forces
    diagonal, upper, right, x, inverse = system
    for c in range(count):
        i = contacts[c]
        a, b, d = metric[c, 0], metric[c, 1], metric[c, 2]
        right[c, 0] = a * V[i, 0] + b * V[i, 1] + h * physics.stiff * force[c, 0]
        right[c, 1] = b * V[i, 0] + d * V[i, 1] + h * physics.stiff * force[c, 1]
    tally[SOLVES] += 1
    if refresh:
        build(chain, physics, contacts, before, after, count, bits, metric, diagonal, upper)
        if not solve(diagonal, upper, metric, 0.0, right, count, x, inverse):
            return False
    else:
        again(upper, inverse, right, count, x)
    for c in range(count):
        i = contacts[c]
        for a in range(2):
            V[i, a] = 0.0 if (bits[c] >> a) & 1 else x[c, a]
            move[c, a] = h * V[i, a]
    return True


@njit(cache=True)
def repinned(bits, pinned, count):
    """Note which directions the rims hold in `pinned`; returns whether that has changed."""
    changed = False
    for c in range(count):
        if pinned[c] != bits[c]:
            pinned[c] = bits[c]
            changed = True
    return changed


@njit(cache=True)
def build(chain, physics, contacts, before, after, count, bits, metric, diagonal, upper):
    """The matrix J'((1 + h beta / m) I - h^2 K) J of (4.17) over the touching particles."""
    frames = chain[3]
    pull = physics.step * physics.step * physics.stiff
    for c in range(count):
        i = contacts[c]
        weight = 1.0 + physics.step * physics.damp + pull * (1.0 / (i - before[i]) + 1.0 / (after[i] - i))
        for k in range(3):
            diagonal[c, k] = weight * metric[c, k]
        if c == 0:
            continue
        p = before[i]
        for a in range(2):
            for b in range(2):
                dot = 0.0
                if not ((bits[c - 1] >> a) & 1 or (bits[c] >> b) & 1):
                    for k in range(3):
                        dot -= frames[p, SU + a, k] * frames[i, SU + b, k]
                upper[c - 1, a, b] = pull * dot / (i - p)


@njit(cache=True)
def again(upper, inverse, right, count, x):
    """Solve once more with the pivots' inverses that `block_tridiagonal.solve` left in `inverse`."""
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
