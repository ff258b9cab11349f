"""Lifted particles: carried along by the touching ones, and landed where they meet the body (section 5.3)."""

import numpy as np

from meshwind.core.kernel import njit
from meshwind.core.vectors import TINY
from meshwind.path.kernels.state import EVALUATIONS, FEET, copy_lifted
from meshwind.surface.evaluate import S, unit_normal
from meshwind.surface.tree import nearest_foot

MAX_FOLLOWED = 200
"""Maximum number of steps in which a particle is followed around the body."""
SHORTEST_FOLLOWED = 1e-3
"""Shortest such step over the part's size: near the surface the gap alone would make them too many."""
SINK = 1e-12
"""A particle deeper than this times the part's size has landed."""


@njit(cache=True)
def carry_lifted(body, step, contacts, count, state, trial, counters):
    """Write into `trial` the lifted particles, so that none is inside the body.

    They are carried along by their two touching neighbours, which `trial` already holds, and drawn towards the
    chord; those that would sink land on their feet (section 5.3).
    """
    X, Y, station, index = state.X, trial.X, state.station, contacts.inner
    i = 0
    for c in range(count + 1):
        j = index[c] if c < count else len(X) - 1
        for m in range(i + 1, j):
            t = (station[m] - station[i]) / (station[j] - station[i])
            copy_lifted(state, trial, m)
            moved = 0.0
            for k in range(3):
                chord = (1.0 - t) * X[i, k] + t * X[j, k]
                carried = (1.0 - t) * (Y[i, k] - X[i, k]) + t * (Y[j, k] - X[j, k])
                shift = carried + step * (chord - X[m, k])
                Y[m, k] += shift
                moved += shift * shift
            trial.touching[m] = False
            trial.clear[m] = state.clear[m] - np.sqrt(moved)
            # the gap shrinks by no more than the particle moved: mostly no foot point is needed
            if trial.clear[m] <= 0.0:
                land(body, X, trial, m, counters)
        i = j


@njit(cache=True)
def land(body, X, trial, m, counters):
    """Find the foot of lifted particle m, which comes from X[m]; let it touch there if it has sunk (Algorithm 2).

    Else its gap is noted.  A particle whose foot is on a side that faces the other way may have gone through the
    body: its way is then followed, and it touches where it went in.
    """
    uv, normal = trial.uv, trial.normal
    facing = np.empty(3)
    for k in range(3):
        facing[k] = normal[m, k]
    u, v = uv[m, 0], uv[m, 1]
    height, gap = measure_gap(body, trial, m, counters)
    sunk = height < -SINK * body.size
    turned = 0.0
    for k in range(3):
        turned += facing[k] * normal[m, k]
    if not sunk and turned < 0.0:
        sunk = follow(body, X[m], u, v, trial, m, counters)
    trial.touching[m] = sunk
    trial.clear[m] = 0.0 if sunk else gap
    if sunk:
        for k in range(3):
            trial.X[m, k] = trial.frames[m, S, k]


@njit(cache=True)
def measure_gap(body, trial, m, counters):
    """Height of particle m over its nearest foot, along the normal there, and its distance from it."""
    Y, frames, normal = trial.X, trial.frames, trial.normal
    counters[FEET] += 1
    counters[EVALUATIONS] += nearest_foot(body, Y[m], trial.uv[m], frames[m])
    unit_normal(frames[m], normal[m])
    height = 0.0
    square = 0.0
    for k in range(3):
        r = Y[m, k] - frames[m, S, k]
        height += r * normal[m, k]
        square += r * r
    return height, np.sqrt(square)


@njit(cache=True)
def follow(body, start, u, v, trial, m, counters):
    """Follow particle m from `start`, whose foot is near (u, v), to where it is; whether it meets the body.

    Each step is as long as the gap, so that none leaps over a thin part.  Leaves the foot where it goes in, or that
    of its goal.
    """
    Y, uv = trial.X, trial.uv
    goal = np.empty(3)
    way = 0.0
    for k in range(3):
        goal[k] = Y[m, k]
        way += (goal[k] - start[k]) ** 2
    way = np.sqrt(way)
    goal_u, goal_v = uv[m, 0], uv[m, 1]
    uv[m, 0], uv[m, 1] = u, v
    t = 0.0
    met = False
    for _ in range(MAX_FOLLOWED):
        for k in range(3):
            Y[m, k] = start[k] + t * (goal[k] - start[k])
        height, gap = measure_gap(body, trial, m, counters)
        if height < -SINK * body.size:
            met = True
            break
        t += max(gap, SHORTEST_FOLLOWED * body.size) / max(way, TINY)
        if t >= 1.0:
            break
    for k in range(3):
        Y[m, k] = goal[k]
    if not met:
        uv[m, 0], uv[m, 1] = goal_u, goal_v
        measure_gap(body, trial, m, counters)
    return met


@njit(cache=True)
def sag(X, after, station):
    """Largest distance of a lifted particle from its place on the chord."""
    worst = 0.0
    i, n = 0, len(X)
    while i < n - 1:
        j = after[i]
        for m in range(i + 1, j):
            t = (station[m] - station[i]) / (station[j] - station[i])
            d = 0.0
            for k in range(3):
                d += (X[m, k] - (1.0 - t) * X[i, k] - t * X[j, k]) ** 2
            worst = max(worst, d)
        i = j
    return np.sqrt(worst)
