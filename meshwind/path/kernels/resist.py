"""What resists a fibre's slip within an increment of time: Coulomb's friction, and what makes a slip take time.

A particle that moves by d across where the fibre lay is resisted by mu N and by pace d: the increment minimises
E + sum mu N |d| + pace d^2 / 2 with N held, so that each of its steps can be judged by its energy.
"""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import fill
from meshwind.core.vectors import TINY
from meshwind.path.kernels.block_tridiagonal import solve
from meshwind.path.kernels.contact import link, spring_pull
from meshwind.path.kernels.coulomb import coefficient
from meshwind.path.kernels.geometry import (
    combine,
    cross,
    derivative,
    dot,
    minus,
    over,
    put,
    row,
    times,
)
from meshwind.path.kernels.state import EVALUATIONS, SOLVES, put_on_surface
from meshwind.surface.evaluate import SU, SV

EVEN = 1e-8
"""Share over mu N up to which a force does not move a particle."""
TURNS, FREE = 60, 10
"""Maximum number of solves for a step, and of those after which all particles change sides that would: later it is
only the first, which ends for sure."""
RIGID = 1e6
"""Stiffness, in units of the springs', by which a stuck particle does not move across."""
ROOM = 1e-13
"""Slip over the fibre's length that is round-off."""
ROUNDS = 5
"""Maximum number of steps by which a particle is put back to where the fibre lay."""


class Resistance(NamedTuple):
    """Where n particles lay when the increment began, and what resists their slip from there; empty: nothing does.

    lain, across (n, 3): positions, and the directions across the fibre there; bound (n,): mu N, negative where nothing
    resists; mode (n,): the side to which a particle is taken to slip, 0 for stuck; slip, side (n,): d, and the force
    across before friction; ways, pull (n, 2): the gradient of d, and the force before friction, in (u, v); pace: force
    that resists a slip, over its length; room: slip that is round-off; landed: mu N of particles that land.
    """

    lain: Floats
    across: Floats
    bound: Floats
    mode: Ints
    slip: Floats
    side: Floats
    ways: Floats
    pull: Floats
    pace: float
    room: float
    landed: float


@njit(cache=True)
def resistance(n, pace, room, landed):
    """Room for what resists n particles; 0 for a fibre that slips freely."""
    return Resistance(
        np.zeros((n, 3)), np.zeros((n, 3)), np.zeros(n), np.zeros(n, np.int8),
        np.zeros(n), np.zeros(n), np.zeros((n, 2)), np.zeros((n, 2)), pace, room, landed,
    )  # fmt: skip


@njit(cache=True)
def lay_down(resist, rough, state, contacts):
    """Note where the fibre lies, and what friction resists its slip from there with."""
    n = len(state.X)
    link(state.touching, contacts)
    fill(resist.bound, -1.0)
    i = contacts.after[0]
    while i < n - 1:
        mu, _, _ = coefficient(rough.friction, rough.body.spline.periodic, state.uv[i, 0], state.uv[i, 1])
        resist.bound[i] = lay_particle(resist, state, contacts.before[i], i, contacts.after[i], mu)
        i = contacts.after[i]


@njit(cache=True)
def lay_particle(resist, state, p, i, q, mu):
    """Note where particle i lies, between touching ones p and q; returns mu N."""
    outward = row(state.normal, i)
    X, station = state.X, state.station
    here = row(X, i)
    ahead, back = minus(row(X, q), here), minus(here, row(X, p))
    way = combine(1.0 / (station[q] - station[i]), ahead, 1.0 / (station[i] - station[p]), back)
    lean = dot(way, outward)
    span = np.sqrt(max(dot(way, way) - lean * lean, TINY))
    put(here, resist.lain, i)
    put(cross(outward, over(minus(way, times(lean, outward)), span)), resist.across, i)
    return held_by(state, p, i, q, mu)


@njit(forceinline=True, cache=True)
def held_by(state, p, i, q, mu):
    """Force mu N that friction can hold at particle i between touching ones p and q."""
    return mu * max(-dot(spring_pull(state.X, state.station, i, p, q), row(state.normal, i)), 0.0)


@njit(cache=True)
def follow_contacts(resist, state, inner, count):
    """Let go of particles that have lifted; those that have landed are resisted, but by no friction as yet.

    inner (count,): those that touched all through the step.
    """
    n, touching = len(state.X), state.touching
    last = c = 0
    for i in range(1, n - 1):
        if c < count and inner[c] == i:
            c += 1
        else:
            resist.bound[i] = -1.0
        if not touching[i]:
            resist.bound[i] = -1.0
            continue
        if resist.bound[i] < 0.0:
            after = i + 1
            while after < n - 1 and not touching[after]:
                after += 1
            lay_particle(resist, state, last, i, after, 0.0)
            resist.bound[i] = resist.landed
        last = i


@njit(cache=True)
def press_anew(resist, rough, state, contacts):
    """Hold the particles that still touch with the contact force of `state`; returns the largest change of mu N."""
    uv, before, after, n = state.uv, contacts.before, contacts.after, len(state.X)
    link(state.touching, contacts)
    for i in range(n):
        if not state.touching[i]:
            resist.bound[i] = -1.0
    most = 0.0
    i = after[0]
    while i < n - 1:
        if resist.bound[i] >= 0.0:
            mu, _, _ = coefficient(rough.friction, rough.body.spline.periodic, uv[i, 0], uv[i, 1])
            bound = held_by(state, before[i], i, after[i], mu)
            most = max(most, abs(bound - resist.bound[i]))
            resist.bound[i] = bound
        i = after[i]
    return most


@njit(cache=True)
def take_side(resist, i, metric):
    """Note the force across particle i before friction, and the side to which it is taken to slip.

    Where it lay it is held by all that it takes, up to what friction bears.
    """
    w, v, fu, fv = resist.ways[i, 0], resist.ways[i, 1], resist.pull[i, 0], resist.pull[i, 1]
    a, b = metric[2] * w - metric[1] * v, metric[0] * v - metric[1] * w
    square = a * w + b * v
    side = (a * fu + b * fv) / square if square > 0.0 else 0.0
    d, bound = resist.slip[i], resist.bound[i]
    resist.side[i] = side
    if abs(d) <= resist.room and abs(side) <= bound * (1.0 + EVEN):
        resist.mode[i] = 0
    else:
        resist.mode[i] = np.int8(np.copysign(1.0, side if abs(d) <= resist.room else d))


@njit(cache=True)
def resist_slip(resist, i, c, system):
    """Add to block c what resists particle i: all of the force across where it is stuck, else mu N against the slip."""
    w, v = resist.ways[i, 0], resist.ways[i, 1]
    stuck = resist.mode[i] == 0
    held = resist.side[i] + RIGID * resist.slip[i] if stuck else resist.bound[i] * resist.mode[i]
    brace(system.diagonal, c, RIGID if stuck else 0.0, w, v)
    system.right[c, 0] = resist.pull[i, 0] - held * w
    system.right[c, 1] = resist.pull[i, 1] - held * v


@njit(forceinline=True, cache=True)
def brace(diagonal, c, stiffness, w, v):
    """Add a stiffness along the gradient (w, v) to block c."""
    diagonal[c, 0] += stiffness * w * w
    diagonal[c, 1] += stiffness * w * v
    diagonal[c, 2] += stiffness * v * v


@njit(cache=True)
def choose_sides(resist, inner, system, shift, count, counters):
    """Solve for the step and which particles it leaves stuck; returns whether the matrix stays positive definite.

    One whose hold the step overcomes slips, and one that the step would bring back beyond where it lay sticks there.
    """
    mode = resist.mode
    for turn in range(TURNS):
        counters[SOLVES] += 1
        if not solve(system, shift, count):
            return False
        changed = False
        for c in range(count):
            i = inner[c]
            if resist.bound[i] < 0.0:
                continue
            w, v = resist.ways[i, 0], resist.ways[i, 1]
            d = slip_after(resist, system, i, c)
            if mode[i] == 0:
                held = resist.side[i] + RIGID * d
                then = np.int8(np.copysign(1.0, held)) if abs(held) > resist.bound[i] * (1.0 + EVEN) else mode[i]
            else:
                then = np.int8(0) if d * mode[i] < 0.0 else mode[i]
            if then != mode[i]:
                brace(system.diagonal, c, -RIGID if mode[i] == 0 else 0.0, w, v)
                mode[i] = then
                resist_slip(resist, i, c, system)
                changed = True
                if turn >= FREE:
                    break
        if not changed:
            break
    return True


@njit(forceinline=True, cache=True)
def slip_after(resist, system, i, c):
    """Slip of particle i, of block c, after a whole step."""
    return resist.slip[i] + resist.ways[i, 0] * system.x[c, 0] + resist.ways[i, 1] * system.x[c, 1]


@njit(cache=True)
def fall(resist, inner, system, count):
    """Least decrease of the energy, to first order in the springs', by a whole step."""
    total = 0.0
    for c in range(count):
        i = inner[c]
        total += resist.pull[i, 0] * system.x[c, 0] + resist.pull[i, 1] * system.x[c, 1]
        if resist.bound[i] >= 0.0:
            d = slip_after(resist, system, i, c)
            total -= resist.bound[i] * (abs(d) - abs(resist.slip[i]))
    return total


@njit(cache=True)
def slip_energy(resist, X, inner, count):
    """Energy of the slip of the touching particles: sum mu N |d| + pace d^2 / 2."""
    total = 0.0
    for c in range(count):
        i = inner[c]
        bound = resist.bound[i]
        if bound < 0.0:
            continue
        d = slip_at(resist, X, i)
        if abs(d) > resist.room:
            total += bound * abs(d) + 0.5 * resist.pace * d * d
    return total


@njit(forceinline=True, cache=True)
def slip_at(resist, X, i):
    """Slip d of particle i."""
    return dot(minus(row(X, i), row(resist.lain, i)), row(resist.across, i))


@njit(cache=True)
def farthest_slip(resist, state):
    """Largest distance by which a touching particle has slipped."""
    most = 0.0
    for i in range(1, len(state.X) - 1):
        if state.touching[i] and resist.bound[i] >= 0.0:
            most = max(most, abs(slip_at(resist, state.X, i)))
    return most


@njit(cache=True)
def stop_slip(resist, spline, state, i, counters):
    """Put a particle that was taken as stuck, or has slipped back beyond where it lay, to where it lay."""
    mode, across = resist.mode[i], row(resist.across, i)
    for _ in range(ROUNDS):
        d = slip_at(resist, state.X, i)
        if abs(d) <= resist.room or d * mode > 0.0:
            return
        su, sv = derivative(state.frames, i, SU), derivative(state.frames, i, SV)
        e, f, g = dot(su, su), dot(su, sv), dot(sv, sv)
        w, v = dot(across, su), dot(across, sv)
        a, b = g * w - f * v, e * v - f * w
        share = d / max(a * w + b * v, TINY)
        put_on_surface(spline, state, i, state.uv[i, 0] - share * a, min(max(state.uv[i, 1] - share * b, 0.0), 1.0))
        counters[EVALUATIONS] += 1
