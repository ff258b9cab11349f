"""The length of a fibre from its particles: fourth order where the polyline's is second.

The chord c of an arc of curvature k is shorter than it by c^3 k^2 / 24.  The fibre in equilibrium is the shortest, or
all but, so that its length forgives the particles' own error, which is of second order: what is left is of the fourth.
A bridge is straight from where it truly leaves the surface, between particles, to where it comes back.
"""

import numpy as np
from numba import njit

from meshwind.core.cast import Bools, Floats
from meshwind.core.threads import parallel_for
from meshwind.core.vectors import TINY
from meshwind.path.kernels.state import distance
from meshwind.path.kernels.touchdown import touchdown
from meshwind.surface.surface import Surface


@njit(cache=True)
def bend(X, i):
    """Curvature of the fibre at particle i, squared, from the turn of its chords."""
    before, after = max(distance(X, i, i - 1), TINY), max(distance(X, i + 1, i), TINY)
    square = 0.0
    for k in range(3):
        square += ((X[i + 1, k] - X[i, k]) / after - (X[i, k] - X[i - 1, k]) / before) ** 2
    return 4.0 * square / (before + after) ** 2


@njit(cache=True)
def run_length(X, first, last):
    """Length of the fibre on the surface from particle `first` to `last`, all of which touch."""
    total = 0.0
    for i in range(first, last):
        chord = distance(X, i, i + 1)
        # curvature is known inside the run, and taken from its neighbour at the run's ends
        a, b = max(i, first + 1), min(i + 1, last - 1)
        k2 = 0.5 * (bend(X, a) + bend(X, b)) if last - first > 1 else 0.0
        total += chord * (1.0 + chord * chord * k2 / 24.0)
    return total


def fibre_lengths(surface: Surface, points: Floats, uv: Floats, touching: Bools) -> Floats:
    """Lengths (p,) of fibres with particles points (p, n, 3), at or above uv (p, n, 2), in the surface's units."""
    length = np.empty(len(points))
    parallel_for(lengths_all, len(points), 8, surface.spline, points, uv, touching, length)
    return length


@njit(nogil=True, cache=True)
def lengths_all(first, last, spline, X, uv, touching, length):
    """Write the lengths (p,) of fibres first to last with particles X (p, n, 3)."""
    n = X.shape[1]
    frames = np.empty((6, 3))
    where, here, there = np.empty(2), np.empty(3), np.empty(3)
    for p in range(first, last):
        total = 0.0
        i = 0
        while i < n - 1:
            j = i
            while j < n - 1 and touching[p, j + 1]:
                j += 1
            total += run_length(X[p], i, j)
            if j == n - 1:
                break
            i = j + 1
            while i < n - 1 and not touching[p, i]:
                i += 1
            total += touchdown(spline, X[p], uv[p], j, i, frames, where, here)
            total += touchdown(spline, X[p], uv[p], i, j, frames, where, there)
            square = 0.0
            for k in range(3):
                square += (there[k] - here[k]) ** 2
            total += np.sqrt(square)
        length[p] = total
