"""The chain of particles and springs in the parametric plane: what every on-surface scheme computes in a step.

Kernels take arrays out of a record before a loop, not in it: a field read in the loop counts references to its array
there, which makes whole runs up to 45 % slower.
"""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.kernel import njit
from meshwind.path.kernels.contact import held
from meshwind.surface.evaluate import SU, SV, S, frame, tangents, unit_normal

EVALUATIONS, FEET, SOLVES, STEPS = range(4)
"""Entries of a run's counters."""

LENGTH, RESIDUAL, ANGLE = range(3)
"""Columns of a run's history."""

CONVERGED, STOPPED, DIVERGED = range(3)
"""As in `meshwind.methods.motion.Ending`."""

GROWTH = 100.0
"""A run diverges once its energy exceeds this times the initial one: no true motion of springs gains any."""

TINY = 1e-300
"""Keeps quotients finite, such as those by the length of a closed fibre that has shrunk to a point."""


class Physics(NamedTuple):
    """What the particles obey.

    step: time step h; stiffness: spring constant over mass K/m; damping: damping over mass beta/m; friction:
    coefficient mu; inertial: whether the velocity term J-dot V of (4.10) is kept.
    """

    step: float
    stiffness: float
    damping: float
    friction: float
    inertial: bool


class Chain(NamedTuple):
    """The particles and their state.

    X (n, 3): positions; uv (n, 2): parameters of the particles or of their feet; V (n, 2): velocities in the parametric
    plane; frames (n, 6, 3), of which s, s_u, s_v are kept, with `inertial` the second derivatives too; normal (n, 3):
    outward unit normals; touching (n,): whether a particle touches the surface; clearance (n,): a lower bound of a
    lifted particle's gap; before, after (n,): the nearest touching neighbours, as `link` finds them.
    """

    X: Floats
    uv: Floats
    V: Floats
    frames: Floats
    normal: Floats
    touching: Bools
    clearance: Floats
    before: Ints
    after: Ints


def chain_at_rest(uv: Floats) -> Chain:
    """A chain without velocity whose particles all touch at parameters uv (n, 2); `put_on_surface` places them."""
    n = len(uv)
    return Chain(
        X=np.empty((n, 3)),
        uv=uv,
        V=np.zeros((n, 2)),
        frames=np.empty((n, 6, 3)),
        normal=np.empty((n, 3)),
        touching=np.ones(n, np.bool_),
        clearance=np.zeros(n),
        before=np.zeros(n, np.int64),
        after=np.zeros(n, np.int64),
    )


class Forces(NamedTuple):
    """Forces on the touching particles, per unit of spring constant; each array is filled by contact.

    particle (n,): index of the contact's particle; held (n,): bits of the directions in which it is held at a rim or an
    edge; metric (n, 3): J'J as uu, uv, vv; force (n, 2): J'F; press (n,): F . n.
    """

    particle: Ints
    held: Ints
    metric: Floats
    force: Floats
    press: Floats


@njit(cache=True)
def forces_for(n):
    """Work space for the forces on n particles."""
    return Forces(np.empty(n, np.int64), np.zeros(n, np.int64), np.empty((n, 3)), np.empty((n, 2)), np.empty(n))


@njit(cache=True)
def put_on_surface(spline, chain, particles, count, curvature):
    """Put the first `count` of `particles` on the surface at their parameters.

    With `curvature` their frames include the second derivatives.
    """
    X, uv, frames, normal = chain.X, chain.uv, chain.frames, chain.normal
    for c in range(count):
        i = particles[c]
        if curvature:
            frame(spline, uv[i, 0], uv[i, 1], frames[i])
        else:
            tangents(spline, uv[i, 0], uv[i, 1], frames[i])
        unit_normal(frames[i], normal[i])
        for k in range(3):
            X[i, k] = frames[i, S, k]


@njit(cache=True)
def link(touching, before, after):
    """Fill in each touching particle's nearest touching neighbours; the two ends always count as touching."""
    n = len(touching)
    last = 0
    for i in range(1, n):
        if touching[i] or i == n - 1:
            before[i] = last
            after[last] = i
            last = i


@njit(cache=True)
def gather(chain, periodic, friction, forces):
    """Fill in the forces (4.1, with lifted particles 5.2) on the touching particles.

    Forces and velocities in a held direction become 0.  Returns the number of contacts and the largest tangential force
    beyond what friction holds.
    """
    X, uv, V, frames, normal = chain.X, chain.uv, chain.V, chain.frames, chain.normal
    before, after, particle, fixed = chain.before, chain.after, forces.particle, forces.held
    metric, force, press = forces.metric, forces.force, forces.press
    n = len(X)
    count = 0
    worst = 0.0
    i = after[0]
    while i < n - 1:
        p, q = before[i], after[i]
        a, b = 1.0 / (i - p), 1.0 / (q - i)
        fu = fv = fn = guu = guv = gvv = 0.0
        for k in range(3):
            f = a * (X[p, k] - X[i, k]) + b * (X[q, k] - X[i, k])
            su, sv = frames[i, SU, k], frames[i, SV, k]
            fu += f * su
            fv += f * sv
            fn += f * normal[i, k]
            guu += su * su
            guv += su * sv
            gvv += sv * sv
        bits = held(uv, i, periodic, fu, fv)
        if bits:
            guv = 0.0
            if bits & 1:
                fu = V[i, 0] = 0.0
            if bits & 2:
                fv = V[i, 1] = 0.0
        particle[count], fixed[count], press[count] = i, bits, fn
        metric[count, 0], metric[count, 1], metric[count, 2] = guu, guv, gvv
        force[count, 0], force[count, 1] = fu, fv
        det = guu * gvv - guv * guv
        if det > 0.0:
            square = max(fu * fu * gvv - 2.0 * fu * fv * guv + fv * fv * guu, 0.0) / det
            worst = max(worst, np.sqrt(square) - friction * abs(fn))
        count += 1
        i = q
    return count, worst


@njit(cache=True)
def slow_by_friction(chain, physics, forces, count, move):
    """Scale each velocity and move by friction (4.19); return the kinetic energy over the mass."""
    V, particle, metric, press = chain.V, forces.particle, forces.metric, forces.press
    kinetic = 0.0
    for c in range(count):
        i = particle[c]
        square = metric[c, 0] * V[i, 0] ** 2 + 2.0 * metric[c, 1] * V[i, 0] * V[i, 1] + metric[c, 2] * V[i, 1] ** 2
        if physics.friction > 0.0:
            speed = np.sqrt(max(square, 0.0))
            loss = physics.step * physics.friction * physics.stiffness * abs(press[c])
            share = 1.0 - loss / speed if speed > loss else 0.0
            for a in range(2):
                V[i, a] *= share
                move[c, a] *= share
            square *= share * share
        kinetic += 0.5 * square
    return kinetic


@njit(cache=True)
def move_contacts(spline, chain, particles, count, move, curvature):
    """Move the contacts by `move` (count, 2), stopping them at rims and edges; return the longest move in the plane."""
    uv, V = chain.uv, chain.V
    longest = 0.0
    for c in range(count):
        i = particles[c]
        longest = max(longest, abs(move[c, 0]), abs(move[c, 1]))
        for a in range(2):
            x = uv[i, a] + move[c, a]
            if (a == 1 or not spline.periodic) and not 0.0 <= x <= 1.0:
                x = min(max(x, 0.0), 1.0)
                V[i, a] = 0.0
            uv[i, a] = x
    put_on_surface(spline, chain, particles, count, curvature)
    return longest


@njit(cache=True)
def energy_and_length(X):
    """The springs' energy 1/2 sum |P_{i+1} - P_i|^2 over K, and the polyline's length."""
    energy = 0.0
    length = 0.0
    for i in range(len(X) - 1):
        square = 0.0
        for k in range(3):
            square += (X[i + 1, k] - X[i, k]) ** 2
        energy += 0.5 * square
        length += np.sqrt(square)
    return energy, length


@njit(cache=True)
def mean_angle(X, normal, touching):
    """Mean angle between the normals of curve and surface (3.15) over the touching particles, radians."""
    total = 0.0
    count = 0
    for i in range(1, len(X) - 1):
        if not touching[i]:
            continue
        along = span = whole = press = 0.0
        for k in range(3):
            bend = X[i + 1, k] - 2.0 * X[i, k] + X[i - 1, k]
            chord = X[i + 1, k] - X[i - 1, k]
            along += bend * chord
            span += chord * chord
            whole += bend * bend
            press += bend * normal[i, k]
        side = max(whole - press * press - along * along / max(span, TINY), 0.0)
        total += np.arctan2(np.sqrt(side), abs(press))
        count += 1
    return total / max(count, 1)
