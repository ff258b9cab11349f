"""Contact of particles that move in space: feet, signed gaps, forces, and what is out of balance.

A strand is (X, W, uv, frames, normal, touching, gap): positions and velocities (n, 3); parameters (n, 2), frames
(n, 6, 3) and outward normals (n, 3) of the feet; whether a particle counts as touching (n,); and its signed gap
(n,), for lifted ones a lower bound.
"""

import numpy as np
from numba import njit

from meshwind.methods.chain import EVALUATIONS, FEET
from meshwind.surface.evaluate import S, unit_normal
from meshwind.surface.foot import foot
from meshwind.surface.tree import nearest_foot


@njit(cache=True)
def feel(body, strand, step, width, tally):
    """Measure the gaps after a move of step * W; particles nearer than `width` touch.

    A touching particle's foot is followed from the last one; one that comes down from the air is found with the
    search tree, and not before it can have arrived.
    """
    X, W, uv, frames, normal, touching, gap = strand
    for i in range(1, len(X) - 1):
        if touching[i]:
            tally[EVALUATIONS] += foot(body.spline, X[i], uv[i], frames[i])
        else:
            gap[i] -= step * np.sqrt(W[i, 0] ** 2 + W[i, 1] ** 2 + W[i, 2] ** 2)
            if gap[i] > width:
                continue
            tally[EVALUATIONS] += nearest_foot(body, X[i], uv[i], frames[i])
        tally[FEET] += 1
        unit_normal(frames[i], normal[i])
        height = square = 0.0
        for k in range(3):
            r = X[i, k] - frames[i, S, k]
            height += r * normal[i, k]
            square += r * r
        # beside the foot there is nothing but round-off, except at a rim, beyond which there is no body
        beyond = square > 4.0 * height * height and outermost(body.spline.periodic, uv[i])
        gap[i] = np.sqrt(square) if beyond else height
        touching[i] = gap[i] <= width


@njit(inline="always", cache=True)
def outermost(periodic, at):
    """Whether a foot lies on a rim or an edge."""
    return at[1] <= 0.0 or at[1] >= 1.0 or (not periodic and (at[0] <= 0.0 or at[0] >= 1.0))


@njit(cache=True)
def pulls(X, out):
    """Force of each particle's two springs (4.1), per unit of spring constant."""
    for i in range(1, len(X) - 1):
        for k in range(3):
            out[i, k] = X[i - 1, k] - 2.0 * X[i, k] + X[i + 1, k]


@njit(cache=True)
def unbalanced(X, normal, before, after):
    """Largest tangential force on a touching particle from its touching neighbours (5.2)."""
    worst = 0.0
    n = len(X)
    i = after[0]
    while i < n - 1:
        p, q = before[i], after[i]
        a, b = 1.0 / (i - p), 1.0 / (q - i)
        press = square = 0.0
        for k in range(3):
            press += (a * (X[p, k] - X[i, k]) + b * (X[q, k] - X[i, k])) * normal[i, k]
        for k in range(3):  # not |F|^2 - (F . n)^2, whose round-off is a hundred times the tolerance
            square += (a * (X[p, k] - X[i, k]) + b * (X[q, k] - X[i, k]) - press * normal[i, k]) ** 2
        worst = max(worst, square)
        i = q
    return np.sqrt(worst)


@njit(cache=True)
def kinetic_energy(W):
    """Kinetic energy over the mass."""
    total = 0.0
    for i in range(1, len(W) - 1):
        total += 0.5 * (W[i, 0] ** 2 + W[i, 1] ** 2 + W[i, 2] ** 2)
    return total


@njit(cache=True)
def drift(X, W, step):
    """Move by step * W; return the longest move."""
    longest = 0.0
    for i in range(1, len(X) - 1):
        square = 0.0
        for k in range(3):
            X[i, k] += step * W[i, k]
            square += W[i, k] * W[i, k]
        longest = max(longest, square)
    return step * np.sqrt(longest)
