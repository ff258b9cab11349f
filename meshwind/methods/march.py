"""The time loop of the on-surface schemes, compiled whole: nothing is allocated once it runs."""

from typing import NamedTuple

import numpy as np
from numba import njit

from meshwind.methods import backward_euler, explicit_euler, runge_kutta
from meshwind.methods.chain import (
    CONVERGED,
    DIVERGED,
    EVALUATIONS,
    GROWTH,
    STEPS,
    STOPPED,
    TINY,
    carry,
    gather,
    link,
    mean_angle,
    place,
    rub,
    sag,
    stretch,
)
from meshwind.methods.lifting import PULL, contact

EXPLICIT, SYMPLECTIC, RUNGE_KUTTA, BACKWARD = range(4)


class Rules(NamedTuple):
    """What a run does: scheme, steps, tolerance, steps a factored matrix serves, J-dot V, lifting, its weights."""

    scheme: int
    steps: int
    tolerance: float
    reuse: int
    inertial: bool
    lifting: bool
    weighted: bool


@njit(cache=True)
def forces_for(n):
    """Work space of `chain.gather`."""
    return np.zeros(n, np.int64), np.empty((n, 3)), np.empty((n, 2)), np.empty(n)


@njit(cache=True)
def stages_for(n):
    """Work space of `runge_kutta.step`; the last array serves explicit Euler too."""
    return forces_for(n), np.empty(n, np.int64), np.empty((n, 2)), np.empty((n, 2)), np.empty((n, 2)), np.empty((n, 2))


@njit(nogil=True, cache=True)
def march(spline, rules, physics, chain, history, tally):
    """Step the chain from rest at its parameters; returns (residual, length, status).

    history (steps + 1, 3) or (0, 3) takes length, residual and mean angle of every state.
    """
    X, uv, V, frames, normal, touching, clear = chain
    scheme, steps, tolerance, reuse, inertial, lifting, weighted = rules
    friction = physics.friction
    n = len(X)
    contacts, before, after = np.empty(n, np.int64), np.zeros(n, np.int64), np.zeros(n, np.int64)
    forces, kept, move = forces_for(n), np.empty(n, np.bool_), np.zeros((n, 2))
    bits, metric, force, press = forces
    system = np.empty((n, 3)), np.zeros((n, 2, 2)), np.empty((n, 2)), np.empty((n, 2)), np.empty((n, 3))
    stage = stages_for(n)
    place(spline, chain, np.arange(n), n, inertial)
    tally[EVALUATIONS] += n
    link(touching, before, after)
    energy, length = stretch(X)
    bound = GROWTH * physics.stiff * energy
    if lifting:
        contact(spline, chain, weighted, PULL * length / (n - 1), before, after, kept, tally)
    changed, resting, age = True, False, reuse
    pinned = np.zeros(n, np.int64)
    for k in range(steps + 1):
        energy, length = stretch(X)
        count, worst = gather(chain, spline.periodic, friction, contacts, before, after, forces)
        residual = max(worst, sag(X, after) if lifting else 0.0) * (n - 1) / max(length, TINY)
        if len(history) > 0:
            history[k, 0], history[k, 1], history[k, 2] = length, residual, mean_angle(X, normal, touching)
        if not changed and (resting or (friction == 0.0 and residual <= tolerance)):
            return residual, length, CONVERGED
        if k == steps:
            return residual, length, STOPPED
        well = True
        if scheme == BACKWARD:
            refresh = changed or age >= reuse or backward_euler.repinned(bits, pinned, count)
            age = 1 if refresh else age + 1
            well = backward_euler.step(
                chain, physics, contacts, before, after, count, forces, refresh, system, move, tally
            )
        elif scheme == RUNGE_KUTTA:
            runge_kutta.step(
                spline, chain, physics, contacts, before, after, count, forces, inertial, stage, move, tally
            )
        else:
            explicit_euler.step(
                chain, physics, contacts, count, forces, inertial, scheme == SYMPLECTIC, stage[-1], move
            )
        kinetic = rub(chain, physics, contacts, count, metric, press, move)
        if not well or not kinetic + physics.stiff * energy <= bound:
            place(spline, chain, contacts, count, inertial)
            return residual, length, DIVERGED
        longest = carry(spline, chain, contacts, count, move, inertial)
        tally[EVALUATIONS] += count
        tally[STEPS] += 1
        changed = lifting and contact(spline, chain, weighted, PULL * length / (n - 1), before, after, kept, tally)
        resting = friction > 0.0 and longest == 0.0 and kinetic == 0.0
    return residual, length, STOPPED
