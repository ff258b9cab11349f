"""Frictionless paths from their starting curves, each by the cheapest way that does: gliding on the surface, else
bridging, on few particles first and then, from their answer, on more."""

import numpy as np
from numba import njit

from meshwind.path.kernels.certificate import needed_slip, unresolved
from meshwind.path.kernels.glide import FEW, LAST_STEPS, STEPS, glide, resample, spread_along
from meshwind.path.kernels.refine import refine
from meshwind.path.kernels.relax import CONVERGED, begin, settle, take_up
from meshwind.path.kernels.state import blank
from meshwind.surface.evaluate import S, unit_normal

FEWEST = 96
"""Segments of the lowest rung, at least, and as many a turn, where a path may bridge or slip."""


@njit(nogil=True, cache=True)
def lay_all(
    first, last, body, pull_off, rough, tolerance, limit, starts,
    X, uv, normal, touching, gap, slip, residual, status, tallies,
):  # fmt: skip
    """Bring paths first to last to rest from their starting curves (p, m, 2); below the last rung to `rough` only.

    A path that does not come to rest has the status of the rung where it failed, LIFTED where a tree is missing, and
    arrays that mean nothing.
    """
    n = uv.shape[1]
    frames = np.empty((n, 6, 3))
    system = np.empty((n, 3)), np.empty((n, 2, 2)), np.empty((n, 2))
    for p in range(first, last):
        state = (X[p], uv[p], frames, normal[p], touching[p], gap[p])
        residual[p], at_rest = on_surface(
            body.spline, pull_off, tolerance, starts[p], state, system, slip[p], tallies[p]
        )
        status[p] = CONVERGED
        if not at_rest:
            residual[p], status[p] = by_rungs(
                body, pull_off, rough, tolerance, limit, starts[p], state, slip[p], tallies[p]
            )


@njit(cache=True)
def on_surface(spline, pull_off, tolerance, curve, state, system, slip, tally):
    """Glide from a starting curve (m, 2) into `state`; returns the residual and whether it is as simple as that."""
    X, uv, frames, normal, touching, clear = state
    n = len(uv)
    few = int(np.ceil(FEW * max(1.0, turn_of(curve)))) + 1
    steps = STEPS
    if 2 * few < n:
        rough = np.empty((few, 2))
        spread_along(spline, curve, rough, frames[:few], tally)
        residual, at_rest = glide(spline, pull_off, tolerance, STEPS, rough, frames[:few], system, tally)
        if not at_rest:
            return residual, False
        resample(rough, uv)
        steps = LAST_STEPS
    else:
        spread_along(spline, curve, uv, frames, tally)
    residual, at_rest = glide(spline, pull_off, tolerance, steps, uv, frames, system, tally)
    if not at_rest:
        return residual, False
    for i in range(n):
        unit_normal(frames[i], normal[i])
        for k in range(3):
            X[i, k] = frames[i, S, k]
    if unresolved(state, spline.periodic):
        return residual, False
    for i in range(1, n - 1):
        slip[i] = needed_slip(X, normal, i)
    return residual, True


@njit(cache=True)
def by_rungs(body, pull_off, rough, tolerance, limit, curve, state, slip, tally):
    """Relax a path from its starting curve (m, 2) on ever more particles; the last rung is `state`."""
    n = len(state[0])
    level = halvings(curve, n)
    low = blank(((n - 1) >> level) + 1) if level else state
    begin(body.spline, curve, low, tally)
    residual, status = np.inf, CONVERGED
    while status == CONVERGED:
        residual, status = settle(body, pull_off, rough if level else tolerance, limit, level == 0, low, slip, tally)
        if level == 0:
            break
        level -= 1
        high = blank(((n - 1) >> level) + 1) if level else state
        refine(low[0], low[1], low[4], low[5], high[0], high[1], high[4], high[5])
        if status == CONVERGED:
            take_up(body, high, tally)
        low = high
    return residual, status


@njit(cache=True)
def turn_of(curve):
    """Turns of u along a curve (m, 2), to and fro."""
    turn = 0.0
    for i in range(len(curve) - 1):
        turn += abs(curve[i + 1, 0] - curve[i, 0])
    return turn


@njit(cache=True)
def halvings(curve, n):
    """How often n particles can be halved so that enough are left for the turn of a curve (m, 2)."""
    fewest = int(FEWEST * max(1.0, turn_of(curve)))
    count = 0
    while (n - 1) >> (count + 1) >= fewest:
        count += 1
    return count
