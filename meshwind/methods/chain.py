"""The chain of particles and springs in the parametric plane: what every on-surface scheme computes in a step.

A chain is (X, uv, V, frames, normal, touching, clear): positions (n, 3); parameters (n, 2) of the particle or of
its foot; velocities (n, 2) in the plane; frames (n, 6, 3) of which s, s_u, s_v are kept; outward normals (n, 3);
whether it touches (n,); and for lifted particles a lower bound of the gap (n,).
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from meshwind.surface.evaluate import SU, SV, S, frame, tangents, unit_normal

EVALUATIONS, FEET, SOLVES, STEPS = range(4)
"""Places of a run's counters."""

CONVERGED, STOPPED, DIVERGED = range(3)
"""As in `meshwind.methods.run.Ending`."""

GROWTH = 100.0
"""A run diverges once its energy exceeds this times the initial one: no true motion of springs gains any."""


TINY = 1e-300
"""Stands for no length: a closed fibre that shrinks to its fixed point."""


class Physics(NamedTuple):
    """Time step h, spring constant over mass K/m, damping over mass beta/m, and friction mu."""

    step: float
    stiff: float
    damp: float
    friction: float


@njit(cache=True)
def place(spline, chain, contacts, count, bends):
    """Put the contacts on the surface at their parameters; with `bends` their frames have second derivatives too."""
    X, uv, V, frames, normal, touching, clear = chain
    for c in range(count):
        i = contacts[c]
        if bends:
            frame(spline, uv[i, 0], uv[i, 1], frames[i])
        else:
            tangents(spline, uv[i, 0], uv[i, 1], frames[i])
        unit_normal(frames[i], normal[i])
        for k in range(3):
            X[i, k] = frames[i, S, k]


@njit(cache=True)
def link(touching, before, after):
    """Fill each touching particle's nearest touching neighbours; the two ends always count as touching."""
    n = len(touching)
    last = 0
    for i in range(1, n):
        if touching[i] or i == n - 1:
            before[i] = last
            after[last] = i
            last = i


@njit(inline="always", cache=True)
def held(uv, i, periodic, fu, fv):
    """Bit 1: the force pushes particle i out over an edge in u; bit 2: out over a rim in v."""
    bits = 0
    if not periodic and ((uv[i, 0] <= 0.0 and fu < 0.0) or (uv[i, 0] >= 1.0 and fu > 0.0)):
        bits |= 1
    if (uv[i, 1] <= 0.0 and fv < 0.0) or (uv[i, 1] >= 1.0 and fv > 0.0):
        bits |= 2
    return bits


@njit(cache=True)
def gather(chain, periodic, friction, contacts, before, after, forces):
    """Forces (4.1, with lifted particles 5.2) on the touching particles, per unit of spring constant.

    forces is (bits, metric, force, press): held directions (n,); J'J (n, 3); J'F (n, 2); F . n (n,), each by
    contact.  A held direction drops out.  Returns the number of contacts and the largest tangential force beyond
    what friction holds.
    """
    X, uv, V, frames, normal, touching, clear = chain
    bits, metric, force, press = forces
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
        bit = held(uv, i, periodic, fu, fv)
        if bit:
            guv = 0.0
            if bit & 1:
                fu = V[i, 0] = 0.0
            if bit & 2:
                fv = V[i, 1] = 0.0
        contacts[count], bits[count], press[count] = i, bit, fn
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
def rub(chain, physics, contacts, count, metric, press, move):
    """Scale each velocity and move by friction (4.19); return the kinetic energy over the mass."""
    V = chain[2]
    h, stiff, damp, friction = physics
    kinetic = 0.0
    for c in range(count):
        i = contacts[c]
        square = metric[c, 0] * V[i, 0] ** 2 + 2.0 * metric[c, 1] * V[i, 0] * V[i, 1] + metric[c, 2] * V[i, 1] ** 2
        if friction > 0.0:
            speed = np.sqrt(max(square, 0.0))
            loss = h * friction * stiff * abs(press[c])
            share = 1.0 - loss / speed if speed > loss else 0.0
            for a in range(2):
                V[i, a] *= share
                move[c, a] *= share
            square *= share * share
        kinetic += 0.5 * square
    return kinetic


@njit(cache=True)
def carry(spline, chain, contacts, count, move, bends):
    """Move the contacts by `move`, stopping them at the rims (and edges); return the longest move in the plane."""
    uv, V = chain[1], chain[2]
    longest = 0.0
    for c in range(count):
        i = contacts[c]
        longest = max(longest, abs(move[c, 0]), abs(move[c, 1]))
        for a in range(2):
            x = uv[i, a] + move[c, a]
            if (a == 1 or not spline.periodic) and not 0.0 <= x <= 1.0:
                x = min(max(x, 0.0), 1.0)
                V[i, a] = 0.0
            uv[i, a] = x
    place(spline, chain, contacts, count, bends)
    return longest


@njit(cache=True)
def stretch(X):
    """The springs' energy 1/2 sum |P_{i+1} - P_i|^2 over K, and the length."""
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
def sag(X, after):
    """Largest distance of a lifted particle from its even place on the chord."""
    worst = 0.0
    i, n = 0, len(X)
    while i < n - 1:
        j = after[i]
        for m in range(i + 1, j):
            t = (m - i) / (j - i)
            d = 0.0
            for k in range(3):
                d += (X[m, k] - (1.0 - t) * X[i, k] - t * X[j, k]) ** 2
            worst = max(worst, d)
        i = j
    return np.sqrt(worst)


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
        side = max(whole - press * press - along * along / max(span, 1e-300), 0.0)
        total += np.arctan2(np.sqrt(side), abs(press))
        count += 1
    return total / max(count, 1)
