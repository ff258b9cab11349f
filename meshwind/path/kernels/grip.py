"""The grip of a fibre on its starting curve: where each particle belongs on it, and how far it has slipped from it."""

import numpy as np

from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import copy_row, fill
from meshwind.core.vectors import TINY
from meshwind.path.kernels.coulomb import HELD, ON_CURVE, STUCK, slipping
from meshwind.path.kernels.geometry import derivative
from meshwind.path.kernels.starting_curve import curve_at, nearest_on, offset_from
from meshwind.path.kernels.state import EVALUATIONS, copy_particle, distance, put_on_surface
from meshwind.surface.evaluate import SU, SV

ROUNDS = 2
"""Rounds of spacing particles evenly: the second leaves an error of the order of the first's squared."""


@njit(cache=True)
def move_with_grip(rough, step, fibre, trial, work, count, counters):
    """Write into `trial` the touching particles moved by a share of Newton's step.

    A stuck one moves along the starting curve, a slipping one freely; one that comes to the curve sticks to it.
    """
    spline, size, curve = rough.body.spline, rough.body.size, fibre.curve
    uv, mode, anchor = fibre.state.uv, fibre.grip.mode, fibre.grip.anchor
    moved, grip = trial.state, trial.grip
    inner, ways, mu, move = work.contacts.inner, work.balance.ways, work.balance.mu, work.system.x
    last = len(uv) - 1
    copy_particle(fibre.state, moved, 0)
    copy_particle(fibre.state, moved, last)
    copy_grip(fibre.grip, grip)
    for c in range(count):
        i = inner[c]
        if mode[i] == STUCK:
            _, _, du, dv = curve_at(curve, anchor[i])
            rate = np.sqrt((du * du + dv * dv) / max(ways[i, 0, 0] ** 2 + ways[i, 0, 1] ** 2, TINY))
            s = min(max(anchor[i] + step * move[c, 0] / max(rate, TINY), 0.0), len(curve) - 1.0)
            put_on_curve(spline, curve, s, moved, i)
            grip.anchor[i] = s
            continue
        u = uv[i, 0] + step * (move[c, 0] * ways[i, 0, 0] + move[c, 1] * ways[i, 1, 0])
        v = uv[i, 1] + step * (move[c, 0] * ways[i, 0, 1] + move[c, 1] * ways[i, 1, 1])
        v = min(max(v, 0.0), 1.0)
        if not spline.periodic:
            u = min(max(u, 0.0), 1.0)
        put_on_surface(spline, moved, i, u, v)
        s, d = locate(curve, anchor[i], moved, i, size)
        if mode[i] != HELD and mu[i] > 0.0 and d * mode[i] >= 0.0:  # back on the curve, or across it
            grip.mode[i] = np.int8(STUCK)
            put_on_curve(spline, curve, s, moved, i)
            d = 0.0
            counters[EVALUATIONS] += 1
        grip.anchor[i], grip.offset[i] = s, d
    counters[EVALUATIONS] += count


@njit(cache=True)
def copy_grip(source, target):
    """Copy a grip into another."""
    for i in range(len(source.mode)):
        target.anchor[i], target.offset[i], target.mode[i] = source.anchor[i], source.offset[i], source.mode[i]


@njit(cache=True)
def put_on_curve(spline, curve, s, state, i):
    """Put particle i on the surface at s of the starting curve."""
    u, v, _, _ = curve_at(curve, s)
    put_on_surface(spline, state, i, u, v)


@njit(cache=True)
def locate(curve, s, state, i, size):
    """Anchor of particle i on the starting curve, from a guess s, and its signed distance from there."""
    u, v = state.uv[i, 0], state.uv[i, 1]
    su, sv = derivative(state.frames, i, SU), derivative(state.frames, i, SV)
    s = nearest_on(curve, s, u, v, su, sv)
    d = offset_from(curve, s, u, v, su, sv)
    return s, d if abs(d) > ON_CURVE * size else 0.0


@njit(cache=True)
def hold_where_it_lies(fibre, i, size):
    """Find the anchor of particle i, and its mode: stuck if it lies on the curve, slipping to its side of it if not."""
    grip = fibre.grip
    grip.anchor[i], grip.offset[i] = locate(fibre.curve, grip.anchor[i], fibre.state, i, size)
    grip.mode[i] = np.int8(STUCK) if grip.offset[i] == 0.0 else slipping(grip.offset[i])


@njit(cache=True)
def hold_all(fibre, size):
    """Find the anchors and modes of all particles anew."""
    grip, touching = fibre.grip, fibre.state.touching
    n = len(touching)
    scale = (len(fibre.curve) - 1.0) / (n - 1.0)
    for i in range(n):
        grip.anchor[i], grip.offset[i], grip.mode[i] = scale * i, 0.0, np.int8(STUCK)
        if 0 < i < n - 1 and touching[i]:
            hold_where_it_lies(fibre, i, size)


@njit(cache=True)
def restore_grip(spline, fibre, size, counters):
    """Complete a grip whose anchors and modes are known: stuck particles go to their anchors, others are located."""
    touching, offset, mode = fibre.state.touching, fibre.grip.offset, fibre.grip.mode
    offset[0] = offset[-1] = 0.0
    for i in range(1, len(touching) - 1):
        offset[i] = 0.0
        if not touching[i]:
            mode[i] = STUCK
            continue
        if mode[i] != STUCK:
            hold_where_it_lies(fibre, i, size)
        if mode[i] == STUCK:
            put_on_curve(spline, fibre.curve, fibre.grip.anchor[i], fibre.state, i)
            counters[EVALUATIONS] += 1
            offset[i] = 0.0


@njit(cache=True)
def attach_to_curve(spline, fibre, counters):
    """Stick all particles to the starting curve, evenly by length in space."""
    X, curve, anchor = fibre.state.X, fibre.curve, fibre.grip.anchor
    n = len(X)
    fill(fibre.grip.mode, STUCK)
    fill(fibre.grip.offset, 0.0)
    for i in range(n):
        anchor[i] = (len(curve) - 1.0) * i / (n - 1)
    for _ in range(ROUNDS):
        for i in range(n):
            put_on_curve(spline, curve, anchor[i], fibre.state, i)
        s = np.zeros(n)
        for i in range(1, n):
            s[i] = s[i - 1] + distance(X, i - 1, i)
        copy_row(np.interp(np.linspace(0.0, s[n - 1], n), s, anchor), anchor)
    for i in range(n):
        put_on_curve(spline, curve, anchor[i], fibre.state, i)
    counters[EVALUATIONS] += (ROUNDS + 1) * n


@njit(cache=True)
def hold_landed(fibre, trial, size):
    """Give particles that have landed in `trial` an anchor between those of their neighbours, and a mode."""
    anchor, last = trial.grip.anchor, len(trial.curve) - 1
    for i in range(1, len(anchor) - 1):
        if trial.state.touching[i] and not fibre.state.touching[i]:
            anchor[i] = min(max(0.5 * (anchor[i - 1] + anchor[i + 1]), 0.0), last)
            hold_where_it_lies(trial, i, size)
