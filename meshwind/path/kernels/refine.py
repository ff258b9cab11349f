"""From few particles to many: the coarse answer, resampled, is where the fine solve starts."""

import numpy as np
from numba import njit


@njit(cache=True)
def refine(X, uv, touching, gap, X2, uv2, touching2, gap2):
    """Resample a path of m particles to n evenly by index.

    Parameters are cubic where four neighbours touch and linear elsewhere.  A particle between a touching and a lifted
    one is lifted, on their chord, its gap bounded from theirs: a gap changes by no more than the way.
    """
    m, n = len(X), len(X2)
    for i in range(n):
        k, x = between(i, m, n)
        low, high = touching[k] or x == 1.0, touching[k + 1] or x == 0.0
        touching2[i] = low and high
        way = 0.0
        for a in range(3):
            way += (X[k + 1, a] - X[k, a]) ** 2
        way = np.sqrt(way)
        gap2[i] = 0.0 if touching2[i] else max(gap[k] - x * way, gap[k + 1] - (1.0 - x) * way)
        for a in range(3):
            X2[i, a] = (1.0 - x) * X[k, a] + x * X[k + 1, a]
        cubic = 0 < k < m - 2 and 0.0 < x < 1.0
        if cubic:
            cubic = touching[k - 1] and touching[k] and touching[k + 1] and touching[k + 2]
        for a in range(2):
            uv2[i, a] = (1.0 - x) * uv[k, a] + x * uv[k + 1, a]
            if cubic:
                y = 1.0 - x
                left = uv[k - 1, a] - 2.0 * uv[k, a] + uv[k + 1, a]
                right = uv[k, a] - 2.0 * uv[k + 1, a] + uv[k + 2, a]
                uv2[i, a] -= x * y * ((1.0 + y) * left + (1.0 + x) * right) / 6.0
        uv2[i, 1] = min(max(uv2[i, 1], 0.0), 1.0)
    touching2[0] = touching2[n - 1] = True


@njit(inline="always", cache=True)
def between(i, m, n):
    """Where among m particles number i of n lies: the one before it, and the share of the way to the next."""
    at = i * (m - 1.0) / (n - 1.0)
    k = min(int(at), m - 2)
    x = at - k
    if x < 1e-9:
        x = 0.0
    elif x > 1.0 - 1e-9:
        x = 1.0
    return k, x


@njit(cache=True)
def refine_grip(place, mode, place2, mode2):
    """Resample the hold on the starting curve: places linearly, modes from the nearest particle."""
    m, n = len(place), len(place2)
    for i in range(n):
        k, x = between(i, m, n)
        near = k if x < 0.5 else k + 1
        place2[i] = (1.0 - x) * place[k] + x * place[k + 1]
        mode2[i] = mode[near]
        if x > 0.0 and x < 1.0 and mode[k] != mode[k + 1] and (mode[k] == 0 or mode[k + 1] == 0):
            mode2[i] = 0


@njit(nogil=True, cache=True)
def refine_all(first, last, X, uv, touching, gap, place, mode, X2, uv2, touching2, gap2, place2, mode2):
    """Resample paths first to last."""
    for p in range(first, last):
        refine(X[p], uv[p], touching[p], gap[p], X2[p], uv2[p], touching2[p], gap2[p])
        refine_grip(place[p], mode[p], place2[p], mode2[p])
