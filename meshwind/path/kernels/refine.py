"""From few particles to many: the coarse answer, resampled, is where the fine solve starts."""

import numpy as np

from meshwind.core.kernel import njit
from meshwind.path.kernels.coulomb import STUCK
from meshwind.path.kernels.state import state_of

ON_PARTICLE = 1e-9
"""Share of a segment within which a finer particle counts as lying on a coarse one."""


@njit(cache=True)
def refine(coarse, fine):
    """Resample a state of m particles to one of n evenly by index: positions, parameters, contacts and gaps.

    Parameters are cubic where four neighbours touch and linear elsewhere.  A particle between a touching and a lifted
    one is lifted, on their chord, its gap bounded from theirs: a gap changes by no more than the way.
    """
    X, uv, touching, gap = coarse.X, coarse.uv, coarse.touching, coarse.clear
    m, n = len(X), len(fine.X)
    for i in range(n):
        k, x = between(i, m, n)
        low, high = touching[k] or x == 1.0, touching[k + 1] or x == 0.0
        fine.touching[i] = low and high
        way = 0.0
        for a in range(3):
            way += (X[k + 1, a] - X[k, a]) ** 2
        way = np.sqrt(way)
        fine.clear[i] = 0.0 if fine.touching[i] else max(gap[k] - x * way, gap[k + 1] - (1.0 - x) * way)
        for a in range(3):
            fine.X[i, a] = (1.0 - x) * X[k, a] + x * X[k + 1, a]
        cubic = 0 < k < m - 2 and 0.0 < x < 1.0
        if cubic:
            cubic = touching[k - 1] and touching[k] and touching[k + 1] and touching[k + 2]
        for a in range(2):
            fine.uv[i, a] = (1.0 - x) * uv[k, a] + x * uv[k + 1, a]
            if cubic:
                y = 1.0 - x
                left = uv[k - 1, a] - 2.0 * uv[k, a] + uv[k + 1, a]
                right = uv[k, a] - 2.0 * uv[k + 1, a] + uv[k + 2, a]
                fine.uv[i, a] -= x * y * ((1.0 + y) * left + (1.0 + x) * right) / 6.0
        fine.uv[i, 1] = min(max(fine.uv[i, 1], 0.0), 1.0)
    fine.touching[0] = fine.touching[n - 1] = True


@njit(forceinline=True, cache=True)
def between(i, m, n):
    """Where among m particles number i of n lies: the one before it, and the share of the way to the next."""
    at = i * (m - 1.0) / (n - 1.0)
    k = min(int(at), m - 2)
    x = at - k
    if x < ON_PARTICLE:
        x = 0.0
    elif x > 1.0 - ON_PARTICLE:
        x = 1.0
    return k, x


@njit(cache=True)
def refine_grip(anchor, mode, fine_anchor, fine_mode):
    """Resample the grip on the starting curve: anchors linearly, modes from the nearest particle."""
    m, n = len(anchor), len(fine_anchor)
    for i in range(n):
        k, x = between(i, m, n)
        near = k if x < 0.5 else k + 1
        fine_anchor[i] = (1.0 - x) * anchor[k] + x * anchor[k + 1]
        fine_mode[i] = mode[near]
        if x > 0.0 and x < 1.0 and mode[k] != mode[k + 1] and (mode[k] == STUCK or mode[k + 1] == STUCK):
            fine_mode[i] = STUCK


@njit(nogil=True, cache=True)
def refine_all(first, last, coarse, fine):
    """Resample paths first to last of a batch to those of a finer one."""
    frames = np.empty((0, 6, 3))
    for p in range(first, last):
        refine(state_of(coarse, p, frames), state_of(fine, p, frames))
        refine_grip(coarse.anchor[p], coarse.mode[p], fine.anchor[p], fine.mode[p])
