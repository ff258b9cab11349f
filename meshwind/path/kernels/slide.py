"""The slide of a fibre under friction from its starting curve to rest, by increments of time.

An overdamped fibre of constant tension moves across itself at the rate |kg| - mu kn, and not at all where that is
negative (3.12).  Each increment is one implicit step: equilibrium under friction that acts from where the fibre lay
before, with a force that resists the slip over the length of the increment.  Where the fibre comes to rest depends on
how it got there: a particle that has slid one way may be drawn back later, or be held where it stopped.
"""

import numpy as np
from numba import njit

from meshwind.core.vectors import TINY
from meshwind.path.kernels.coulomb import STUCK, Fibre, Grip, RoughBody
from meshwind.path.kernels.grip import attach_to_curve, hold_where_it_lies
from meshwind.path.kernels.relax_with_friction import relax_with_friction
from meshwind.path.kernels.state import NEEDS_TREE, STALLED, Limits, blank, copy, energy, state_of

FIRST, GROWTH = 1e-3, 1.6
"""Length of the first increment, in units of the fibre's length squared over its tension's mobility, and the factor
from each to the next: waves die out in the order of their lengths, each in a time of its length squared."""
LATE = 0.1
"""Time from which on a fibre that moves little is at rest: its longest wave dies out in this time."""
AT_REST = 2e-6
"""Largest move within an increment, over the fibre's length, of a fibre at rest."""
FIRM = 2.0
"""Friction that all but holds the fibre to its starting curve while it lifts off hollows."""
SAME = 3e-4
"""Distance, over the length, up to which friction from an earlier curve leads to the same place of rest."""
ROUNDS, BALANCE = 16, 1e-6
"""Maximum number of iterations of an increment before a shorter one is tried, and the unbalanced force it leaves."""
MOST = 120
"""Maximum number of increments."""
SHORTER, SHORTEST = 0.3, 1e-7
"""Factor of an increment that fails, and the shortest that is tried."""


@njit(nogil=True, cache=True)
def slide_all(first, last, rough, limits, batch, held, own):
    """Let paths first to last of a batch slide from their starting curves to rest.

    Writes to held (p, n, 2) the curve that friction holds each to from then on, and to own (p,) whether that is the
    starting curve itself; anchors are in samples of that curve.
    """
    n = batch.uv.shape[1]
    frames, offset = np.zeros((n, 6, 3)), np.zeros(n)
    lain = np.empty((MOST + 1, n, 2))
    for p in range(first, last):
        start, counters = batch.starts[p], batch.counters[p]
        state, grip = state_of(batch, p, frames), Grip(batch.anchor[p], offset, batch.mode[p])
        attach_to_curve(rough.body.spline, Fibre(state, grip, start), counters)
        residual, status, steps = slide(rough, limits, state, grip, start, lain, counters)
        own[p], held[p] = False, lain[steps]
        if status not in (NEEDS_TREE, STALLED):
            residual, status, k = settle(rough, limits, state, grip, start, lain, steps, counters)
            own[p] = k == 0
            held[p] = lain[k]
        batch.residual[p], batch.status[p] = residual, status


@njit(cache=True)
def slide(rough, limits, state, grip, start, lain, counters):
    """Let a fibre that is attached to its starting curve slide to rest, in place.

    Returns (residual, status, steps); lain (m, n, 2): where it lay at first and after each step.
    """
    n = len(state.X)
    before = blank(n)
    curve = start
    rough_limits = Limits(limits.pull_off, max(limits.tolerance, BALANCE), ROUNDS)
    time, steps = FIRST, 0
    lain[0] = state.uv
    residual, status = np.inf, STALLED
    for _ in range(MOST):
        copy(state, before)
        pace = 1.0 / (time * (n - 1) ** 2)
        now = RoughBody(rough.body, rough.friction, pace)
        residual, status = relax_with_friction(now, rough_limits, Fibre(state, grip, curve), counters)
        if status == NEEDS_TREE:
            break
        if status == STALLED:
            copy(before, state)
            time *= SHORTER
            if time < SHORTEST:
                break
            if steps == 0:  # hollows are bridged in no time: first of all, on a curve that friction holds
                grip.mode[:] = np.int8(STUCK)
                grip.offset[:] = 0.0
                for i in range(n):
                    grip.anchor[i] = (len(curve) - 1.0) * i / (n - 1.0)
                firm = RoughBody(rough.body, np.full((1, 1), FIRM), 0.0)
                residual, status = relax_with_friction(firm, limits, Fibre(state, grip, curve), counters)
                if status == NEEDS_TREE:
                    break
                steps += 1
                lain[steps] = state.uv
        else:
            steps += 1
            lain[steps] = state.uv
            if time > LATE and largest_move(state.X, before.X) <= AT_REST * energy(state.X)[1]:
                break
            time *= GROWTH
        curve = lain[steps]
        for i in range(n):
            grip.anchor[i], grip.offset[i], grip.mode[i] = i, 0.0, np.int8(STUCK)
    return residual, status, steps


@njit(cache=True)
def settle(rough, limits, state, grip, start, lain, steps, counters):
    """Balance a fibre at rest to the last, with friction from the earliest curve from which it slid one way only.

    Returns (residual, status, k), k being the number of that curve among `lain`, 0 for the starting curve.
    """
    n = len(state.X)
    rest = blank(n)
    copy(state, rest)
    length = energy(rest.X)[1]
    still = RoughBody(rough.body, rough.friction, 0.0)
    residual, status = np.inf, STALLED
    k = 0
    while True:
        curve = start if k == 0 else lain[k]
        if k > 0:
            copy(rest, state)
        scale = (len(curve) - 1.0) / (n - 1.0)
        for i in range(n):
            grip.anchor[i], grip.offset[i] = scale * i, 0.0
            grip.mode[i] = np.int8(STUCK)
            if 0 < i < n - 1 and state.touching[i]:
                hold_where_it_lies(Fibre(state, grip, curve), i, rough.body.size)
        residual, status = relax_with_friction(still, limits, Fibre(state, grip, curve), counters)
        if status == NEEDS_TREE or k == steps:
            break
        if status != STALLED and largest_move(state.X, rest.X) <= SAME * length:
            break
        k = min(max(k + 1, (k + steps + 1) // 2), steps)
    return residual, status, k


@njit(cache=True)
def largest_move(X, before):
    """Largest distance between the particles of two states, across the fibre."""
    most = 0.0
    n = len(X)
    for i in range(1, n - 1):
        square = along = size = 0.0
        for k in range(3):
            way = X[i + 1, k] - X[i - 1, k]
            size += way * way
            along += way * (X[i, k] - before[i, k])
            square += (X[i, k] - before[i, k]) ** 2
        most = max(most, square - along * along / max(size, TINY))
    return np.sqrt(most)
