"""The paths of a batch that stay on the surface and need no friction, each from few particles to many."""

import numpy as np
from numba import njit

from meshwind.path.certificate import needed_slip, unresolved
from meshwind.path.glide import FEW, LAST_STEPS, STEPS, glide, refine, spread_along
from meshwind.path.relax import CONVERGED, LIFTED
from meshwind.surface.evaluate import S, unit_normal


@njit(nogil=True, cache=True)
def glide_all(
    first, last, net, periodic, pull_off, tolerance, starts, X, uv, normal, touching, gap, slip, residual, status,
    tallies,
):  # fmt: skip
    """Bring paths first to last to rest from their starting curves (p, m, 2), if it is as simple as that.

    A path that is not has the status LIFTED, and arrays that mean nothing.
    """
    n = uv.shape[1]
    frames = np.empty((n, 6, 3))
    system = np.empty((n, 3)), np.empty((n, 2, 2)), np.empty((n, 2))
    for p in range(first, last):
        few = segments(starts[p]) + 1
        at_rest = True
        if 2 * few < n:
            rough = np.empty((few, 2))
            spread_along(net, periodic, starts[p], rough, frames[:few], tallies[p])
            residual[p], at_rest = glide(
                net, periodic, pull_off, tolerance, STEPS, rough, frames[:few], system, tallies[p]
            )
            if at_rest:
                refine(rough, uv[p])
        else:
            spread_along(net, periodic, starts[p], uv[p], frames, tallies[p])
        if at_rest:
            steps = LAST_STEPS if 2 * few < n else STEPS
            residual[p], at_rest = glide(
                net, periodic, pull_off, tolerance, steps, uv[p], frames, system, tallies[p]
            )
        status[p] = LIFTED
        if not at_rest:
            continue
        for i in range(n):
            unit_normal(frames[i], normal[p, i])
            for k in range(3):
                X[p, i, k] = frames[i, S, k]
        state = (X[p], uv[p], frames, normal[p], touching[p], gap[p])
        if not unresolved(state, periodic):
            status[p] = CONVERGED
            for i in range(1, n - 1):
                slip[p, i] = needed_slip(X[p], normal[p], i)


@njit(cache=True)
def segments(curve):
    """Segments of the first solve: FEW a turn."""
    turn = 0.0
    for i in range(len(curve) - 1):
        turn += abs(curve[i + 1, 0] - curve[i, 0])
    return int(np.ceil(FEW * max(1.0, turn)))
