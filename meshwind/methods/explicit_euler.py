"""Explicit Euler (4.10 to 4.12), and the same with the new velocity in the position, which is symplectic.

Undamped (4.10) has no stable step at all: each mode grows by sqrt(1 + (h omega)^2) a step, which is why the source
saw it explode.  Using the new velocity costs nothing and is stable below h = 2 / omega_max.
"""

from meshwind.core.kernel import njit
from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV


@njit(forceinline=True, cache=True)
def velocity_term(frame, u, v):
    """J' times the velocity term J-dot V of (4.4), as two numbers."""
    fu = fv = 0.0
    for k in range(3):
        a = frame[SUU, k] * u * u + 2.0 * frame[SUV, k] * u * v + frame[SVV, k] * v * v
        fu += a * frame[SU, k]
        fv += a * frame[SV, k]
    return fu, fv


@njit(cache=True)
def accelerate(chain, physics, forces, count, out):
    """Accelerations (count, 2) in the plane: (4.8) with damping (4.7), with `inertial` also the term J-dot V."""
    V, frames = chain.V, chain.frames
    particle, held, metric, force = forces.particle, forces.held, forces.metric, forces.force
    for c in range(count):
        i = particle[c]
        u, v = V[i, 0], V[i, 1]
        fu, fv = physics.stiffness * force[c, 0], physics.stiffness * force[c, 1]
        if physics.inertial:
            tu, tv = velocity_term(frames[i], u, v)
            fu -= 0.0 if held[c] & 1 else tu
            fv -= 0.0 if held[c] & 2 else tv
        a, b, d = metric[c, 0], metric[c, 1], metric[c, 2]
        det = a * d - b * b
        share = 1.0 / det if det > 0.0 else 0.0  # nothing moves where the surface is singular
        out[c, 0] = share * (d * fu - b * fv) - physics.damping * u
        out[c, 1] = share * (a * fv - b * fu) - physics.damping * v


@njit(cache=True)
def step(chain, physics, forces, count, symplectic, gain, move):
    """New velocities, and the moves they make: with the old ones (4.10) or, symplectic, with the new ones.

    gain (n, 2) is work space for the accelerations.
    """
    V, h, particle = chain.V, physics.step, forces.particle
    accelerate(chain, physics, forces, count, gain)
    for c in range(count):
        i = particle[c]
        for a in range(2):
            old = V[i, a]
            V[i, a] = old + h * gain[c, a]
            move[c, a] = h * (V[i, a] if symplectic else old)
