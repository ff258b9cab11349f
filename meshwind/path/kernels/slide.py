"""The slide of a fibre under friction from its starting curve to rest, by increments of time.

An overdamped fibre of constant tension moves across itself at the rate |kg| - mu kn, and not at all where that is
negative (3.12).  Each increment is one implicit step: equilibrium under friction that acts from where the fibre lay
before, with a force that resists the slip over the length of the increment.  Where the fibre comes to rest depends on
how it got there: a particle that has slid one way may be drawn back later, or be held where it stopped.
"""

import numpy as np
from numba import njit

from meshwind.path.kernels.coulomb import STUCK, Fibre, Grip, RoughBody
from meshwind.path.kernels.grip import attach_to_curve
from meshwind.path.kernels.relax_with_friction import relax_with_friction
from meshwind.path.kernels.state import NEEDS_TREE, STALLED, blank, copy, energy, state_of

FIRST, GROWTH = 1e-3, 1.6
"""Length of the first increment, in units of the fibre's length squared over its tension's mobility, and the factor
from each to the next: waves die out in the order of their lengths, each in a time of its length squared."""
LATE = 0.1
"""Time from which on a fibre that moves little is at rest: its longest wave dies out in this time."""
AT_REST = 2e-6
"""Largest move within an increment, over the fibre's length, of a fibre at rest."""
MOST = 60
"""Maximum number of increments."""
SHORTER, SHORTEST = 0.25, 1e-6
"""Factor of an increment that fails, and the shortest that is tried."""


@njit(nogil=True, cache=True)
def slide_all(first, last, rough, limits, batch, rest):
    """Let paths first to last of a batch slide from their starting curves; writes where they lie in (u, v) to `rest`.

    rest (p, n, 2) is the curve to which friction holds the fibre at rest.
    """
    n = batch.uv.shape[1]
    frames, offset = np.zeros((n, 6, 3)), np.zeros(n)
    for p in range(first, last):
        state, grip = state_of(batch, p, frames), Grip(batch.anchor[p], offset, batch.mode[p])
        attach_to_curve(rough.body.spline, Fibre(state, grip, batch.starts[p]), batch.counters[p])
        residual, status = slide(rough, limits, state, grip, batch.starts[p], rest[p], batch.counters[p])
        batch.residual[p], batch.status[p] = residual, status


@njit(cache=True)
def slide(rough, limits, state, grip, start, rest, counters):
    """Let a fibre that is attached to its starting curve slide to rest, in place; returns (residual, status)."""
    n = len(state.X)
    before = blank(n)
    curve = start
    time = FIRST
    residual, status = np.inf, STALLED
    for _ in range(MOST):
        copy(state, before)
        pace = 1.0 / (time * (n - 1) ** 2)
        residual, status = relax_with_friction(
            RoughBody(rough.body, rough.friction, pace), limits, Fibre(state, grip, curve), counters
        )
        if status == NEEDS_TREE:
            return residual, status
        if status == STALLED:
            copy(before, state)
            time *= SHORTER
            if time < SHORTEST:
                break
        reached = largest_move(state.X, before.X)
        for i in range(n):
            rest[i, 0], rest[i, 1] = state.uv[i, 0], state.uv[i, 1]
            grip.anchor[i], grip.offset[i], grip.mode[i] = i, 0.0, np.int8(STUCK)
        curve = rest
        if status != STALLED:
            if time > LATE and reached <= AT_REST * energy(state.X)[1]:
                break
            time *= GROWTH
    return relax_with_friction(RoughBody(rough.body, rough.friction, 0.0), limits, Fibre(state, grip, rest), counters)


@njit(cache=True)
def largest_move(X, before):
    """Largest distance between the particles of two states."""
    most = 0.0
    for i in range(len(X)):
        square = 0.0
        for k in range(3):
            square += (X[i, k] - before[i, k]) ** 2
        most = max(most, square)
    return np.sqrt(most)
