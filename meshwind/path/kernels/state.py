"""The state of one path while it comes to rest: a tuple of arrays, so that kernels pass it on whole.

A state is (X, uv, frames, normal, touching, clear): positions (n, 3); parameters (n, 2) of the particle or of its
foot; surface frames (n, 6, 3) and outward normals (n, 3) there; whether the particle touches (n,); and for the
lifted ones a lower bound of the gap (n,).  Copies run in plain loops: they compile ten times as fast as slices.
"""

import numpy as np
from numba import njit

from meshwind.surface.evaluate import S, frame, unit_normal


@njit(cache=True)
def blank(n):
    """A state of n particles, all touching somewhere; their normals, not yet known, are zero."""
    return (
        np.empty((n, 3)),
        np.empty((n, 2)),
        np.empty((n, 6, 3)),
        np.zeros((n, 3)),
        np.ones(n, np.bool_),
        np.zeros(n),
    )


@njit(cache=True)
def copy(source, target):
    """Copy a state into another."""
    for i in range(len(source[0])):
        copy_particle(source, target, i)


@njit(cache=True)
def copy_particle(source, target, i):
    """Copy particle i of a state into another."""
    for k in range(3):
        target[0][i, k] = source[0][i, k]
        target[3][i, k] = source[3][i, k]
        for row in range(6):
            target[2][i, row, k] = source[2][i, row, k]
    target[1][i, 0], target[1][i, 1] = source[1][i, 0], source[1][i, 1]
    target[4][i] = source[4][i]
    target[5][i] = source[5][i]


@njit(cache=True)
def copy_lifted(source, target, i):
    """Copy lifted particle i of a state into another, but for its frame: whoever wants that asks for the foot."""
    for k in range(3):
        target[0][i, k] = source[0][i, k]
        target[3][i, k] = source[3][i, k]
    target[1][i, 0], target[1][i, 1] = source[1][i, 0], source[1][i, 1]
    target[4][i] = source[4][i]
    target[5][i] = source[5][i]


@njit(cache=True)
def touch_down(spline, state, i, u, v):
    """Put particle i on the surface at (u, v)."""
    X, uv, frames, normal, touching, clear = state
    uv[i, 0], uv[i, 1] = u, v
    frame(spline, u, v, frames[i])
    unit_normal(frames[i], normal[i])
    for k in range(3):
        X[i, k] = frames[i, S, k]
    touching[i] = True
    clear[i] = 0.0


@njit(cache=True)
def place(spline, state):
    """Put every particle on the surface at its own parameters."""
    uv = state[1]
    for i in range(len(uv)):
        touch_down(spline, state, i, uv[i, 0], uv[i, 1])


@njit(inline="always", cache=True)
def distance(X, i, j):
    """Distance of two particles."""
    return np.sqrt((X[i, 0] - X[j, 0]) ** 2 + (X[i, 1] - X[j, 1]) ** 2 + (X[i, 2] - X[j, 2]) ** 2)


@njit(cache=True)
def energy(X):
    """The springs' energy 1/2 sum |P_{i+1} - P_i|^2 (4.1), and the length."""
    total = 0.0
    length = 0.0
    for i in range(len(X) - 1):
        d = distance(X, i + 1, i)
        total += d * d
        length += d
    return 0.5 * total, length
