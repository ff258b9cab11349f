"""Particles that move in space: their state, contacts, forces, and what is not in balance."""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Floats
from meshwind.core.kernel import njit
from meshwind.methods.chain import EVALUATIONS, FEET
from meshwind.surface.evaluate import S, unit_normal
from meshwind.surface.foot import foot
from meshwind.surface.tree import nearest_foot

OBLIQUE = 4.0
"""Squared distance over squared height from which a particle counts as beyond its foot: 60 degrees off the normal."""


class Strand(NamedTuple):
    """The particles and their state.

    X, V (n, 3): positions and velocities; uv (n, 2), frames (n, 6, 3), normal (n, 3): parameters, frames and outward
    unit normals of the feet; touching (n,): whether a particle is within the contact width; loose (n,): whether KKT has
    let go of it all the same; gap (n,): signed distance to the surface, for lifted particles a lower bound.
    """

    X: Floats
    V: Floats
    uv: Floats
    frames: Floats
    normal: Floats
    touching: Bools
    loose: Bools
    gap: Floats


@njit(cache=True)
def update_gaps(body, strand, step, width, tally):
    """Measure the gaps after a move of step * V; particles nearer than `width` touch.

    A touching particle's foot is followed from the last one; the foot of one that comes down to the surface is found
    with the search tree, and not before it can have arrived.
    """
    X, V, uv, frames, normal = strand.X, strand.V, strand.uv, strand.frames, strand.normal
    touching, gap = strand.touching, strand.gap
    for i in range(1, len(X) - 1):
        if touching[i]:
            tally[EVALUATIONS] += foot(body.spline, X[i], uv[i], frames[i])
        else:
            gap[i] -= step * np.sqrt(V[i, 0] ** 2 + V[i, 1] ** 2 + V[i, 2] ** 2)
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
        # square and height^2 differ by round-off alone, except at a rim, beyond which there is no body
        beyond = square > OBLIQUE * height * height and at_end(body.spline.periodic, uv[i])
        gap[i] = np.sqrt(square) if beyond else height
        touching[i] = gap[i] <= width


@njit(forceinline=True, cache=True)
def at_end(periodic, uv):
    """Whether a foot lies on a rim or an edge."""
    return uv[1] <= 0.0 or uv[1] >= 1.0 or (not periodic and (uv[0] <= 0.0 or uv[0] >= 1.0))


@njit(cache=True)
def spring_forces(X, out):
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
def kinetic_energy(V):
    """Kinetic energy over the mass."""
    total = 0.0
    for i in range(1, len(V) - 1):
        total += 0.5 * (V[i, 0] ** 2 + V[i, 1] ** 2 + V[i, 2] ** 2)
    return total


@njit(cache=True)
def move_by(X, V, step):
    """Move by step * V; return the longest move."""
    longest = 0.0
    for i in range(1, len(X) - 1):
        square = 0.0
        for k in range(3):
            X[i, k] += step * V[i, k]
            square += V[i, k] * V[i, k]
        longest = max(longest, square)
    return step * np.sqrt(longest)
