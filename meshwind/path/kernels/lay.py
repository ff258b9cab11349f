"""Frictionless paths from their starting curves, each by the cheapest way that does.

That is Newton's method on the surface alone or, where a path bridges or slips, nested iteration: the path is relaxed on
few particles first and then, from their answer, on more.
"""

import numpy as np

from meshwind.core.kernel import njit
from meshwind.path.kernels.certificate import DEEPEST, leaps, required_friction
from meshwind.path.kernels.glide import FEW, MAX_LAST_STEPS, MAX_STEPS, Factors, glide, resample, spread_along
from meshwind.path.kernels.mend import NOTICED, UNSEEN, any_wanting
from meshwind.path.kernels.refine import refine
from meshwind.path.kernels.rest import relax_and_certify, restore_contact, start_on_curve
from meshwind.path.kernels.state import CONVERGED, Limits, blank, energy, state_of
from meshwind.path.kernels.survey import blank_survey, rises, survey
from meshwind.surface.evaluate import S, unit_normal

FEWEST = 96
"""Least number of segments of the coarsest level, and as many per turn, where a path may bridge or slip."""


@njit(nogil=True, cache=True)
def solve_without_friction(first, last, body, limits, rough, batch):
    """Bring paths first to last of a batch to equilibrium from their starting curves; coarse levels to `rough` only.

    A path that does not converge has the status of the level where it failed, NEEDS_TREE where a tree is missing, and
    arrays that mean nothing.
    """
    n = batch.uv.shape[1]
    frames = np.empty((n, 6, 3))
    factors = Factors(np.empty((n, 3)), np.empty((n, 2, 2)), np.empty((n, 2)))
    for p in range(first, last):
        curve, state = batch.starts[p], state_of(batch, p, frames)
        required, counters = batch.required[p], batch.counters[p]
        residual, found = solve_on_surface(body, limits, rough, curve, state, factors, required, counters)
        status = CONVERGED
        if not found:
            residual, status = solve_nested(body, limits, rough, curve, state, required, counters)
        batch.residual[p], batch.status[p] = residual, status


@njit(cache=True)
def solve_on_surface(body, limits, rough, curve, state, factors, required, counters):
    """Solve from a starting curve (m, 2) into `state` on the surface; returns the residual and whether that does."""
    X, uv, frames, normal = state.X, state.uv, state.frames, state.normal
    spline, n = body.spline, len(uv)
    few = int(np.ceil(FEW * max(1.0, turn_of(curve)))) + 1
    steps = MAX_STEPS
    if 2 * few < n:
        coarse = np.empty((few, 2))
        spread_along(spline, curve, coarse, frames[:few], counters)
        first = Limits(limits.pull_off, rough, steps)
        residual, found = glide(spline, first, coarse, frames[:few], factors, counters)
        if not found:
            return residual, False
        resample(coarse, uv)
        steps = MAX_LAST_STEPS
    else:
        spread_along(spline, curve, uv, frames, counters)
    second = Limits(limits.pull_off, limits.tolerance, steps)
    residual, found = glide(spline, second, uv, frames, factors, counters)
    if not found:
        return residual, False
    for i in range(n):
        unit_normal(frames[i], normal[i])
        for k in range(3):
            X[i, k] = frames[i, S, k]
    spacing = energy(X)[1] / (n - 1)
    if leaps(state, spline.periodic):
        return residual, False
    if rises(body, state, NOTICED * spacing, counters):
        heights = blank_survey(n)
        deep = survey(body, state, UNSEEN * spacing, heights, counters)
        if deep > DEEPEST * spacing or any_wanting(heights, spacing):
            return residual, False
    for i in range(1, n - 1):
        required[i] = required_friction(X, normal, i)
    return residual, True


@njit(forceinline=True, cache=True)
def solve_nested(body, limits, rough, curve, state, required, counters):
    """Relax a path from its starting curve (m, 2) on ever more particles; the finest level is `state`."""
    n = len(state.X)
    level = halvings(curve, n)
    coarse_limits = Limits(limits.pull_off, rough, limits.iterations)
    low = blank(((n - 1) >> level) + 1) if level else state
    start_on_curve(body.spline, curve, low, counters)
    residual, status = np.inf, CONVERGED
    while status == CONVERGED:
        which = coarse_limits if level else limits
        residual, status = relax_and_certify(body, which, level == 0, low, required, counters)
        if level == 0:
            break
        level -= 1
        high = blank(((n - 1) >> level) + 1) if level else state
        refine(low, high)
        if status == CONVERGED:
            restore_contact(body, high, counters)
        low = high
    return residual, status


@njit(nogil=True, cache=True)
def turn_of(curve):
    """Turns of u along a curve (m, 2), to and fro."""
    turn = 0.0
    for i in range(len(curve) - 1):
        turn += abs(curve[i + 1, 0] - curve[i, 0])
    return turn


@njit(nogil=True, cache=True)
def halvings(curve, n):
    """How often n particles can be halved so that enough are left for the turn of a curve (m, 2)."""
    fewest = int(FEWEST * max(1.0, turn_of(curve)))
    count = 0
    while (n - 1) >> (count + 1) >= fewest:
        count += 1
    return count
