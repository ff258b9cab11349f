"""From few particles to many: the coarse answer, resampled, is where the fine solve starts."""

import numpy as np
from numba import njit


@njit(nogil=True, cache=True)
def refine_all(first, last, X, uv, touching, gap, place, mode, X2, uv2, touching2, gap2, place2, mode2):
    """Resample paths first to last evenly by index.

    Parameters are cubic where four neighbours touch and linear elsewhere.  A particle between a touching and a lifted
    one is lifted, on their chord, its gap bounded from theirs: a gap changes by no more than the way.  Places on the
    starting curve are linear, modes those of the nearest particle.
    """
    m, n = X.shape[1], X2.shape[1]
    for p in range(first, last):
        for i in range(n):
            at = i * (m - 1.0) / (n - 1.0)
            k = min(int(at), m - 2)
            x = at - k
            if x < 1e-9:
                x = 0.0
            elif x > 1.0 - 1e-9:
                x = 1.0
            near = k if x < 0.5 else k + 1
            low, high = touching[p, k] or x == 1.0, touching[p, k + 1] or x == 0.0
            touching2[p, i] = low and high
            way = 0.0
            for a in range(3):
                way += (X[p, k + 1, a] - X[p, k, a]) ** 2
            way = np.sqrt(way)
            gap2[p, i] = 0.0 if touching2[p, i] else max(gap[p, k] - x * way, gap[p, k + 1] - (1.0 - x) * way)
            place2[p, i] = (1.0 - x) * place[p, k] + x * place[p, k + 1]
            mode2[p, i] = mode[p, near]
            if x > 0.0 and x < 1.0 and mode[p, k] != mode[p, k + 1]:
                mode2[p, i] = 0 if mode[p, k] == 0 or mode[p, k + 1] == 0 else mode[p, near]
            for a in range(3):
                X2[p, i, a] = (1.0 - x) * X[p, k, a] + x * X[p, k + 1, a]
            cubic = 0 < k < m - 2 and 0.0 < x < 1.0
            if cubic:
                cubic = touching[p, k - 1] and touching[p, k] and touching[p, k + 1] and touching[p, k + 2]
            for a in range(2):
                uv2[p, i, a] = (1.0 - x) * uv[p, k, a] + x * uv[p, k + 1, a]
                if cubic:
                    y = 1.0 - x
                    left = uv[p, k - 1, a] - 2.0 * uv[p, k, a] + uv[p, k + 1, a]
                    right = uv[p, k, a] - 2.0 * uv[p, k + 1, a] + uv[p, k + 2, a]
                    uv2[p, i, a] -= x * y * ((1.0 + y) * left + (1.0 + x) * right) / 6.0
            uv2[p, i, 1] = min(max(uv2[p, i, 1], 0.0), 1.0)
        touching2[p, 0] = touching2[p, n - 1] = True
