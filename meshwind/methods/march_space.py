"""The time loop of the schemes in space, compiled whole: nothing is allocated once it runs but a tree query's stack."""

from typing import NamedTuple

import numpy as np
from numba import njit

from meshwind.methods import kkt, penalty
from meshwind.methods.blocks import factor, room
from meshwind.methods.chain import CONVERGED, DIVERGED, GROWTH, STEPS, STOPPED, TINY, link, mean_angle, sag, stretch
from meshwind.methods.collide import drift, feel, kinetic_energy, unbalanced

PENALTY, KKT = range(2)


class Contact(NamedTuple):
    """What a run does: scheme, steps, tolerance, contact width, penalty k_PF over mass, share of a gap taken back."""

    scheme: int
    steps: int
    tolerance: float
    width: float
    push: float
    stabilisation: float


@njit(nogil=True, cache=True)
def march(body, rules, physics, strand, history, tally):
    """Step the strand from rest; returns (residual, length, status), the arguments as for `march.march`."""
    X, W, uv, frames, normal, touching, gap = strand
    scheme, steps, tolerance, width, push, stabilisation = rules
    n, h = len(X), physics.step
    before, after = np.zeros(n, np.int64), np.zeros(n, np.int64)
    none, loose, pressed = np.zeros(n, np.bool_), np.zeros(n, np.bool_), np.ones(n, np.bool_)
    force, right, pivots, system = np.zeros((n, 3)), np.zeros((n, 3)), np.zeros(n), room(n)
    coupling = h * h * physics.stiff
    factor(1.0 + h * physics.damp + 2.0 * coupling, coupling, pivots)
    energy, length = stretch(X)
    bound = GROWTH * (physics.stiff * energy + (0.5 * n * push * width if scheme == PENALTY else 0.0))
    feel(body, strand, 0.0, width, tally)
    longest, status = np.inf, STOPPED
    for k in range(steps + 1):
        energy, length = stretch(X)
        for i in range(n):
            pressed[i] = touching[i] and not loose[i]
        link(pressed, before, after)
        residual = max(unbalanced(X, normal, before, after), sag(X, after)) * (n - 1) / max(length, TINY)
        if len(history) > 0:
            history[k, 0], history[k, 1], history[k, 2] = length, residual, mean_angle(X, normal, pressed)
        if residual <= tolerance and longest <= tolerance * length:
            status = CONVERGED
        if status == CONVERGED or k == steps:
            break
        well = True
        if scheme == KKT:
            kkt.step(strand, physics, stabilisation, system, pivots, force, right, loose, tally)
        else:
            well = penalty.step(strand, physics, width, push, none, system, force, tally)
        if not well or not kinetic_energy(W) + physics.stiff * energy <= bound:
            status = DIVERGED
            break
        longest = drift(X, W, h)
        feel(body, strand, h, width, tally)
        tally[STEPS] += 1
    for i in range(n):
        touching[i] = pressed[i] or i in (0, n - 1)
    return residual, length, status
