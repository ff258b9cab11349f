"""The classical fourth-order Runge-Kutta method (section 4.2); its limit is 2.83 / omega_max undamped."""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.kernel import njit
from meshwind.methods.chain import EVALUATIONS, Forces, forces_for, gather, put_on_surface
from meshwind.methods.explicit_euler import accelerate


class Stages(NamedTuple):
    """Work space of a step.

    forces: those of the current stage; uv, V (n, 2): the state before the step; gain (n, 2): the weighted sum of the
    accelerations; slope (n, 2): those of the current stage; each by contact.
    """

    forces: Forces
    uv: Floats
    V: Floats
    gain: Floats
    slope: Floats


@njit(cache=True)
def stages_for(n):
    """Work space of a step for n particles."""
    return Stages(forces_for(n), np.empty((n, 2)), np.empty((n, 2)), np.empty((n, 2)), np.empty((n, 2)))


@njit(cache=True)
def step(spline, chain, physics, forces, count, stages, move, tally):
    """New velocities and moves by four stages; which particles touch is kept within the step.

    forces: those before the step.  Leaves the positions at the last stage.
    """
    uv, V, particle = chain.uv, chain.V, forces.particle
    uv0, V0, gain, slope = stages.uv, stages.V, stages.gain, stages.slope
    h = physics.step
    for c in range(count):
        i = particle[c]
        for a in range(2):
            uv0[c, a], V0[c, a] = uv[i, a], V[i, a]
            gain[c, a] = move[c, a] = 0.0
    accelerate(chain, physics, forces, count, slope)
    for s in range(4):
        weight = h / 6.0 if s in (0, 3) else h / 3.0
        reach = h if s == 2 else 0.5 * h
        for c in range(count):
            i = particle[c]
            for a in range(2):
                move[c, a] += weight * V[i, a]
                gain[c, a] += weight * slope[c, a]
                uv[i, a] = uv0[c, a] + reach * V[i, a]
                V[i, a] = V0[c, a] + reach * slope[c, a]
        if s < 3:
            put_on_surface(spline, chain, particle, count, physics.inertial)
            gather(chain, spline.periodic, 0.0, stages.forces)
            accelerate(chain, physics, stages.forces, count, slope)
    for c in range(count):
        i = particle[c]
        for a in range(2):
            uv[i, a], V[i, a] = uv0[c, a], V0[c, a] + gain[c, a]
    tally[EVALUATIONS] += 3 * count
