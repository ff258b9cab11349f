"""The time loop of the on-surface schemes, compiled whole: nothing is allocated once it runs."""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Floats
from meshwind.core.kernel import njit
from meshwind.methods import backward_euler, explicit_euler, runge_kutta
from meshwind.methods.backward_euler import System, system_for
from meshwind.methods.chain import (
    ANGLE,
    CONVERGED,
    DIVERGED,
    EVALUATIONS,
    GROWTH,
    LENGTH,
    RESIDUAL,
    STEPS,
    STOPPED,
    TINY,
    Forces,
    energy_and_length,
    forces_for,
    gather,
    link,
    mean_angle,
    move_contacts,
    put_on_surface,
    slow_by_friction,
)
from meshwind.methods.lifting import PULL, update_touching
from meshwind.methods.runge_kutta import Stages, stages_for
from meshwind.path.kernels.landing import sag

EXPLICIT, SYMPLECTIC, RUNGE_KUTTA, BACKWARD = range(4)


class SurfaceRules(NamedTuple):
    """What a run on the surface does.

    scheme: one of the numbers above; steps: maximum number of steps; tolerance: of the residual; reuse: steps that a
    factored matrix serves; lifting: whether particles leave the surface; weighted: by the force of (5.2) rather than
    by Algorithm 1's test.
    """

    scheme: int
    steps: int
    tolerance: float
    reuse: int
    lifting: bool
    weighted: bool


class SurfaceWork(NamedTuple):
    """Arrays that a run fills again in every step: move (n, 2) by contact, former (n,) the touching set before."""

    forces: Forces
    system: System
    stages: Stages
    move: Floats
    former: Bools


@njit(cache=True)
def surface_work(n):
    """Work space of a run of n particles."""
    return SurfaceWork(forces_for(n), system_for(n), stages_for(n), np.zeros((n, 2)), np.empty(n, np.bool_))


@njit(cache=True)
def advance(spline, scheme, physics, chain, work, count, refresh, tally):
    """New velocities and moves of the contacts by one step; returns False where the system could not be solved."""
    if scheme == BACKWARD:
        return backward_euler.step(chain, physics, work.forces, count, refresh, work.system, work.move, tally)
    if scheme == RUNGE_KUTTA:
        runge_kutta.step(spline, chain, physics, work.forces, count, work.stages, work.move, tally)
    else:
        explicit_euler.step(chain, physics, work.forces, count, scheme == SYMPLECTIC, work.stages.slope, work.move)
    return True


@njit(nogil=True, cache=True)
def run_on_surface(spline, rules, physics, chain, history, tally):
    """Step the chain from rest at its parameters; returns (residual, length, status).

    history (steps + 1, 3) or (0, 3) takes length, residual and mean angle of every state.
    """
    n, friction = len(chain.X), physics.friction
    work, station = surface_work(n), np.arange(n) * 1.0
    forces = work.forces
    put_on_surface(spline, chain, np.arange(n), n, physics.inertial)
    tally[EVALUATIONS] += n
    link(chain.touching, chain.before, chain.after)
    energy, length = energy_and_length(chain.X)
    bound = GROWTH * physics.stiffness * energy
    if rules.lifting:
        update_touching(spline, chain, rules.weighted, PULL * length / (n - 1), work.former, tally)
    changed, resting, age = True, False, rules.reuse
    for k in range(rules.steps + 1):
        energy, length = energy_and_length(chain.X)
        count, worst = gather(chain, spline.periodic, friction, forces)
        off_chord = sag(chain.X, chain.after, station) if rules.lifting else 0.0
        residual = max(worst, off_chord) * (n - 1) / max(length, TINY)
        if len(history) > 0:
            history[k, LENGTH], history[k, RESIDUAL] = length, residual
            history[k, ANGLE] = mean_angle(chain.X, chain.normal, chain.touching)
        if not changed and (resting or (friction == 0.0 and residual <= rules.tolerance)):
            return residual, length, CONVERGED
        if k == rules.steps:
            return residual, length, STOPPED
        refresh = False
        if rules.scheme == BACKWARD:
            refresh = changed or age >= rules.reuse or backward_euler.held_otherwise(work.system, forces, count)
            age = 1 if refresh else age + 1
        solved = advance(spline, rules.scheme, physics, chain, work, count, refresh, tally)
        kinetic = slow_by_friction(chain, physics, forces, count, work.move)
        if not solved or not kinetic + physics.stiffness * energy <= bound:
            put_on_surface(spline, chain, forces.particle, count, physics.inertial)
            return residual, length, DIVERGED
        longest = move_contacts(spline, chain, forces.particle, count, work.move, physics.inertial)
        tally[EVALUATIONS] += count
        tally[STEPS] += 1
        changed = rules.lifting and update_touching(
            spline, chain, rules.weighted, PULL * length / (n - 1), work.former, tally
        )
        resting = friction > 0.0 and longest == 0.0 and kinetic == 0.0
    return residual, length, STOPPED
