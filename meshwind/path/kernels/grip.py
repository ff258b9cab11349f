"""The hold of a fibre on its starting curve: where each particle belongs on it, and how far it has slipped from it."""

import numpy as np
from numba import njit

from meshwind.path.kernels.coulomb import HELD, STUCK, curve_at, nearest_on
from meshwind.path.kernels.newton import EVALUATIONS
from meshwind.path.kernels.state import copy_particle, touch_down
from meshwind.surface.evaluate import SU, SV

SETTLE = 1e-12
"""Round-off of a lateral distance over the part's size: nearer to the starting curve counts as on it."""


@njit(cache=True)
def slide(spline, step, move, contacts, count, curve, balance, state, grip, trial, after_grip, size, tally):
    """Write into `trial` the touching particles moved by step * move: along the curve if stuck, freely if slipping."""
    uv = state[1]
    place, offset, mode = grip
    place_t, offset_t, mode_t = after_grip
    ways, load = balance[3], balance[4]
    last = len(uv) - 1
    copy_particle(state, trial, 0)
    copy_particle(state, trial, last)
    for i in range(last + 1):
        place_t[i], offset_t[i], mode_t[i] = place[i], offset[i], mode[i]
    for c in range(count):
        i = contacts[c]
        if mode[i] == STUCK:
            _, _, du, dv = curve_at(curve, place[i])
            rate = np.sqrt((du * du + dv * dv) / max(ways[i, 0, 0] ** 2 + ways[i, 0, 1] ** 2, 1e-300))
            place_t[i] = min(max(place[i] + step * move[c, 0] / max(rate, 1e-300), 0.0), len(curve) - 1.0)
            u, v, _, _ = curve_at(curve, place_t[i])
            touch_down(spline, trial, i, u, v)
            continue
        u = uv[i, 0] + step * (move[c, 0] * ways[i, 0, 0] + move[c, 1] * ways[i, 1, 0])
        v = uv[i, 1] + step * (move[c, 0] * ways[i, 0, 1] + move[c, 1] * ways[i, 1, 1])
        v = min(max(v, 0.0), 1.0)
        if not spline.periodic:
            u = min(max(u, 0.0), 1.0)
        touch_down(spline, trial, i, u, v)
        locate(curve, i, trial, after_grip, size)
        if mode[i] != HELD and load[i, 3] > 0.0 and offset_t[i] * mode[i] >= 0.0:  # back on the curve, or across it
            mode_t[i] = np.int8(STUCK)
            u, v, _, _ = curve_at(curve, place_t[i])
            touch_down(spline, trial, i, u, v)
            offset_t[i] = 0.0
            tally[EVALUATIONS] += 1
    tally[EVALUATIONS] += count


@njit(cache=True)
def locate(curve, i, state, grip, size):
    """Place of particle i along the starting curve, and its signed distance from it, positive to the left."""
    uv, frames = state[1], state[2]
    place, offset, mode = grip
    place[i] = nearest_on(curve, place[i], uv[i, 0], uv[i, 1], frames[i])
    u, v, du, dv = curve_at(curve, place[i])
    # both the way from the curve and the curve's tangent lie in the tangent plane: their area over the tangent's length
    e = f = g = 0.0
    for k in range(3):
        su, sv = frames[i, SU, k], frames[i, SV, k]
        e, f, g = e + su * su, f + su * sv, g + sv * sv
    area = np.sqrt(max(e * g - f * f, 0.0)) * (du * (uv[i, 1] - v) - dv * (uv[i, 0] - u))
    d = area / np.sqrt(max(e * du * du + 2.0 * f * du * dv + g * dv * dv, 1e-300))
    offset[i] = d if abs(d) > SETTLE * size else 0.0


@njit(cache=True)
def take_hold(spline, curve, state, grip, size, tally):
    """Complete the grip of a state: stuck particles go to their place, slipping ones measure their way from it."""
    X, uv, frames, normal, touching, clear = state
    place, offset, mode = grip
    offset[0] = offset[-1] = 0.0
    for i in range(1, len(X) - 1):
        offset[i] = 0.0
        if not touching[i]:
            mode[i] = STUCK
            continue
        if mode[i] != STUCK:
            locate(curve, i, state, grip, size)
            mode[i] = np.int8(STUCK if offset[i] == 0.0 else (-1 if offset[i] > 0.0 else 1))
        if mode[i] == STUCK:
            u, v, _, _ = curve_at(curve, place[i])
            touch_down(spline, state, i, u, v)
            tally[EVALUATIONS] += 1
            offset[i] = 0.0


@njit(cache=True)
def space_along(spline, curve, state, place):
    """Put the particles on the starting curve, evenly by length in space."""
    X = state[0]
    n = len(X)
    for i in range(n):
        place[i] = (len(curve) - 1.0) * i / (n - 1)
    for _ in range(2):
        for i in range(n):
            u, v, _, _ = curve_at(curve, place[i])
            touch_down(spline, state, i, u, v)
        s = np.zeros(n)
        for i in range(1, n):
            s[i] = s[i - 1] + np.sqrt(((X[i] - X[i - 1]) ** 2).sum())
        place[:] = np.interp(np.linspace(0.0, s[n - 1], n), s, place)
    for i in range(n):
        u, v, _, _ = curve_at(curve, place[i])
        touch_down(spline, state, i, u, v)
