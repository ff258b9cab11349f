"""Newton's linear system for the touching particles of a frictionless path, in the parametric plane."""

import numpy as np

from meshwind.core.kernel import njit
from meshwind.core.vectors import TINY
from meshwind.path.kernels.contact import held, spring_pull
from meshwind.path.kernels.geometry import derivative, dot, minus, row, times, to_parameters
from meshwind.path.kernels.resist import brace, resist_slip, slip_at, take_side
from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV

PINNED = 1e8
"""Stiffness of a pinned particle along the fibre, over that of its springs."""


@njit(cache=True)
def assemble(state, periodic, resist, contacts, system, faint):
    """Hessian and force of the energy over the touching particles (5.2) in the parametric plane.

    A pinned particle is not pulled along the fibre, and too stiff to move there; what resists a slip is one more force.
    The diagonal block is J'J's share of (4.16) less F . s_ab, which makes the step Newton's.  Returns the number of
    blocks, the largest unbalanced force in the tangent plane, and the last particle that is pressed out over a rim or
    edge by more than a `faint` force (0: none).
    """
    X, uv, frames, station = state.X, state.uv, state.frames, state.station
    index, before, after = contacts.inner, contacts.before, contacts.after
    diagonal, upper, metric, right = system.diagonal, system.upper, system.metric, system.right
    n = len(X)
    count = 0
    worst = 0.0
    last = leaning = 0
    i = after[0]
    while i < n - 1:
        index[count] = i
        force = spring_pull(X, station, i, before[i], after[i])
        weight = 1.0 / (station[i] - station[before[i]]) + 1.0 / (station[after[i]] - station[i])
        su, sv = derivative(frames, i, SU), derivative(frames, i, SV)
        auu, auv, avv = dot(su, su), dot(su, sv), dot(sv, sv)
        slips = len(resist.bound) > 0 and resist.bound[i] >= 0.0
        way = row(resist.across, i) if slips else (0.0, 0.0, 0.0)
        if slips:
            resist.slip[i] = slip_at(resist, X, i)
            force = minus(force, times(resist.pace * resist.slip[i], way))
        fu, fv = dot(force, su), dot(force, sv)
        fuu, fuv = dot(force, derivative(frames, i, SUU)), dot(force, derivative(frames, i, SUV))
        fvv = dot(force, derivative(frames, i, SVV))
        du = dv = pin_u = pin_v = pin = single = 0.0
        if state.pinned[i]:
            du, dv = to_parameters(su, sv, minus(row(X, after[i]), row(X, before[i])))
            pin_u, pin_v = auu * du + auv * dv, auv * du + avv * dv
            single = 1.0 / max(pin_u * du + pin_v * dv, TINY)
            along = single * (fu * du + fv * dv)
            fu, fv = fu - along * pin_u, fv - along * pin_v
            pin = PINNED * weight * single
        bits = held(uv, i, periodic, fu, fv)
        diagonal[count, 0] = weight * auu - fuu + pin * pin_u * pin_u
        diagonal[count, 1] = weight * auv - fuv + pin * pin_u * pin_v
        diagonal[count, 2] = weight * avv - fvv + pin * pin_v * pin_v
        if count > 0:
            couple(state, before[i], i, last, bits, upper[count - 1])
        if bits:  # a held direction drops out of the system
            if force_squared(fu, fv, auu, auv, avv) > faint * faint:
                leaning = i
            auv = 0.0
            diagonal[count, 1] = 0.0
            if bits & 1:
                fu = 0.0
                diagonal[count, 0] = weight * auu
            if bits & 2:
                fv = 0.0
                diagonal[count, 2] = weight * avv
        metric[count, 0], metric[count, 1], metric[count, 2] = auu, auv, avv
        right[count, 0], right[count, 1] = fu, fv
        if len(resist.bound):
            resist.pull[i, 0], resist.pull[i, 1] = fu, fv
        if slips:
            resist.ways[i, 0] = 0.0 if bits & 1 else dot(way, su)
            resist.ways[i, 1] = 0.0 if bits & 2 else dot(way, sv)
            take_side(resist, i, metric[count])
            brace(diagonal, count, resist.pace, resist.ways[i, 0], resist.ways[i, 1])
            resist_slip(resist, i, count, system)
            back = resist.side[i] if resist.mode[i] == 0 else resist.bound[i] * resist.mode[i]
            fu, fv = fu - back * resist.ways[i, 0], fv - back * resist.ways[i, 1]
            if state.pinned[i]:  # across where it lay is no longer quite across the fibre
                along = single * (fu * du + fv * dv)
                fu, fv = fu - along * pin_u, fv - along * pin_v
                if resist.mode[i] == 0:  # it is held both along and across
                    fu = fv = 0.0
            if not bits:
                diagonal[count, 0] += back * dot(way, derivative(frames, i, SUU))
                diagonal[count, 1] += back * dot(way, derivative(frames, i, SUV))
                diagonal[count, 2] += back * dot(way, derivative(frames, i, SVV))
        worst = max(worst, force_squared(fu, fv, auu, auv, avv))
        last = bits
        count += 1
        i = after[i]
    return count, np.sqrt(worst), leaning


@njit(forceinline=True, cache=True)
def force_squared(fu, fv, auu, auv, avv):
    """Square of a force in the tangent plane of which the products with s_u and s_v are known."""
    det = auu * avv - auv * auv
    return (fu * fu * avv - 2.0 * fu * fv * auv + fv * fv * auu) / det if det > 0.0 else 0.0


@njit(cache=True)
def couple(state, p, i, held_p, held_i, block):
    """Write the block (2, 2) that couples particle p to i, without the directions that are held."""
    frames, weight = state.frames, 1.0 / (state.station[i] - state.station[p])
    for a in range(2):
        for b in range(2):
            block[a, b] = 0.0
            if not ((held_p >> a) & 1 or (held_i >> b) & 1):
                block[a, b] = -dot(derivative(frames, p, SU + a), derivative(frames, i, SU + b)) * weight
