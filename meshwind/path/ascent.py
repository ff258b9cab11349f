"""From an answer with few particles to one with many, rung by rung, for each path by itself."""

import numpy as np
from numba import njit

from meshwind.path.refine import refine
from meshwind.path.relax import CONVERGED, settle, take_up
from meshwind.path.state import blank


@njit(nogil=True, cache=True)
def ascend_all(
    first, last, net, periodic, tree, size, pull_off, rough, tolerance, limit, rungs,
    X, uv, touching, gap, X2, uv2, normal2, touching2, gap2, slip2, residual, status, tallies,
):  # fmt: skip
    """Take frictionless paths first to last from their answers X, uv, touching, gap up the `rungs` (numbers of
    particles), balanced to `rough` below the last and to `tolerance` on it; the last rung writes the other arrays.

    A path that fails on a rung keeps the status of that rung, and its other arrays mean nothing.
    """
    n = rungs[-1]
    for p in range(first, last):
        low = X[p], uv[p], touching[p], gap[p]
        for m in rungs:
            state = blank(m) if m < n else (X2[p], uv2[p], np.empty((n, 6, 3)), normal2[p], touching2[p], gap2[p])
            refine(low[0], low[1], low[2], low[3], state[0], state[1], state[4], state[5])
            take_up(net, periodic, tree, size, state, tallies[p])
            residual[p], status[p] = settle(
                net, periodic, tree, size, pull_off, tolerance if m == n else rough, limit, m == n, state,
                slip2[p], tallies[p],
            )  # fmt: skip
            if status[p] != CONVERGED:
                break
            low = state[0], state[1], state[4], state[5]
