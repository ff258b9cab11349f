"""The classical fourth-order Runge-Kutta method (section 4.2); its limit is 2.83 / omega_max undamped."""

from numba import njit

from meshwind.methods.chain import EVALUATIONS, gather, place
from meshwind.methods.explicit_euler import accelerate


@njit(cache=True)
def step(spline, chain, physics, contacts, before, after, count, forces, inertial, stage, move, tally):
    """New velocities and moves by four stages; which particles touch is kept within the step.

    stage is (forces, contacts, uv, V, gain, slope): work space for the stages' forces, the state before, the sum of
    the accelerations and the last ones, each by contact.  Leaves positions at the last stage.
    """
    uv, V = chain[1], chain[2]
    now, passed, uv0, V0, gain, slope = stage
    h = physics.step
    for c in range(count):
        i = contacts[c]
        for a in range(2):
            uv0[c, a], V0[c, a] = uv[i, a], V[i, a]
            gain[c, a] = move[c, a] = 0.0
    accelerate(chain, physics, contacts, count, forces, inertial, slope)
    for s in range(4):
        weight = h / 6.0 if s in (0, 3) else h / 3.0
        reach = h if s == 2 else 0.5 * h
        for c in range(count):
            i = contacts[c]
            for a in range(2):
                move[c, a] += weight * V[i, a]
                gain[c, a] += weight * slope[c, a]
                uv[i, a] = uv0[c, a] + reach * V[i, a]
                V[i, a] = V0[c, a] + reach * slope[c, a]
        if s < 3:
            place(spline, chain, contacts, count, inertial)
            gather(chain, spline.periodic, 0.0, passed, before, after, now)
            accelerate(chain, physics, contacts, count, now, inertial, slope)
    for c in range(count):
        i = contacts[c]
        for a in range(2):
            uv[i, a], V[i, a] = uv0[c, a], V0[c, a] + gain[c, a]
    tally[EVALUATIONS] += 3 * count
