"""The exact derivative of the balance under friction, so that the step is Newton's.

The unknowns of a particle are its moves along t and b; a stuck or held one moves along t only.
"""

from typing import NamedTuple

import numpy as np

from meshwind.core.kernel import njit
from meshwind.core.vectors import TINY
from meshwind.path.kernels.coulomb import HELD, STUCK, coefficient, fixed, slips
from meshwind.path.kernels.geometry import (
    Vector,
    combine,
    derivative,
    dot,
    minus,
    plus,
    row,
    second_form,
    times,
)
from meshwind.surface.evaluate import SUU, SUV, SVV


class Lever(NamedTuple):
    """Numbers of particle i, between touching ones p and q, from which its blocks are made.

    before, after: stiffness of the two springs; a, e: their pulls; lean: m . n; flat: |n x m|; ahead: m . t; bent:
    F . t / |n x m|; sigma: the mode as a number; press: N; grip: sigma mu where friction acts, else 0.
    """

    before: float
    after: float
    a: Vector
    e: Vector
    lean: float
    flat: float
    ahead: float
    bent: float
    sigma: float
    press: float
    grip: float


@njit(cache=True)
def differentiate(rough, fibre, contacts, balance, system):
    """Blocks of -dR/dx and R of the touching particles; returns their number."""
    table, periodic = rough.friction, rough.body.spline.periodic
    X, uv, frames, normals = fibre.state.X, fibre.state.uv, fibre.state.frames, fibre.state.normal
    inner, before, after, mode = contacts.inner, contacts.before, contacts.after, fibre.grip.mode
    along, across, turn, residual = balance.along, balance.across, balance.turn, balance.residual
    lower, diagonal, upper, right = system.lower, system.diagonal, system.upper, system.right
    n = len(X)
    count = 0
    i = after[0]
    while i < n - 1:
        p, q = before[i], after[i]
        inner[count] = i
        normal, t, b = row(normals, i), row(along, i), row(across, i)
        mu = coefficient(table, periodic, uv[i, 0], uv[i, 1])
        a, e = times(1.0 / (i - p), minus(row(X, i), row(X, p))), times(1.0 / (q - i), minus(row(X, q), row(X, i)))
        m, press = plus(e, a), balance.press[i]
        lean = dot(m, normal)
        flat = max(np.sqrt(max(dot(m, m) - lean * lean, 0.0)), TINY)
        grip = mode[i] * mu[0] if press > 0.0 and slips(mode[i]) else 0.0
        bent = balance.pull_along[i] / flat
        lever = Lever(1.0 / (i - p), 1.0 / (q - i), a, e, lean, flat, dot(m, t), bent, float(mode[i]), press, grip)
        along_p, along_i, along_q = turn_along(lever, t)
        across_p, across_i, across_q = turn_across(lever, b, normal)
        fill(lower, count, along_p, across_p, row(along, p), row(across, p))
        fill(diagonal, count, along_i, across_i, t, b)
        fill(upper, count, along_q, across_q, row(along, q), row(across, q))
        if mode[i] == HELD:
            diagonal[count, 0, 0] -= dot(minus(e, a), row(turn, i))
        elif slips(mode[i]):
            turn_surface(frames, normal, mu, lever, balance, i, diagonal, count)
        drop_fixed(mode, p, i, q, lower, diagonal, upper, count)
        right[count, 0], right[count, 1] = residual[i, 0], residual[i, 1]
        count += 1
        i = q
    return count


@njit(cache=True)
def turn_along(lever, t):
    """Derivatives of R_t = (|e|^2 - |a|^2) / |n x m| by the positions p, i and q, or of the pull along the rim."""
    gp, gq = lever.before, lever.after
    if lever.sigma == HELD:
        return times(gp, t), times(-(gp + gq), t), times(gq, t)
    scale = 2.0 / lever.flat if lever.sigma != STUCK or lever.ahead >= 0.0 else -2.0 / lever.flat
    along_p, along_q = times(scale * gp, lever.a), times(scale * gq, lever.e)
    return along_p, combine(-1.0, along_p, -1.0, along_q), along_q


@njit(cache=True)
def turn_across(lever, b, normal):
    """Derivatives of R_b across the fibre, whose direction turns, by the positions p, i and q."""
    held = times(lever.grip, normal)
    across_p = times(lever.before, minus(times(1.0 + lever.bent, b), held))
    across_q = times(lever.after, minus(times(1.0 - lever.bent, b), held))
    return across_p, combine(-1.0, across_p, -1.0, across_q), across_q


@njit(cache=True)
def fill(blocks, count, along, across, t, b):
    """Write a block of -dR/dx from the derivatives by a position that moves along t and b."""
    blocks[count, 0, 0], blocks[count, 0, 1] = -dot(along, t), -dot(along, b)
    blocks[count, 1, 0], blocks[count, 1, 1] = -dot(across, t), -dot(across, b)


@njit(cache=True)
def turn_surface(frames, normal, mu, lever, balance, i, diagonal, count):
    """Subtract what the turning of the normal and the change of friction add to dR/dx."""
    form = (
        dot(derivative(frames, i, SUU), normal),
        dot(derivative(frames, i, SUV), normal),
        dot(derivative(frames, i, SVV), normal),
    )
    t, b = (balance.ways[i, 0, 0], balance.ways[i, 0, 1]), (balance.ways[i, 1, 0], balance.ways[i, 1, 1])
    for a in range(2):
        way = t if a == 0 else b
        dn_t, dn_b = -second_form(form, t, way), -second_form(form, b, way)
        slope = mu[1] * way[0] + mu[2] * way[1]
        bend = (lever.bent * lever.lean + lever.press) * dn_b + lever.sigma * lever.press * slope
        diagonal[count, 1, a] -= bend
        diagonal[count, 1, a] += lever.grip * (balance.pull_along[i] * dn_t + balance.pull_across[i] * dn_b)


@njit(forceinline=True, cache=True)
def drop_fixed(mode, p, i, q, lower, diagonal, upper, count):
    """Take out of a row what cannot move: across a particle that is stuck or held, and the path's ends."""
    n = len(mode)
    if not slips(mode[i]):
        for a in range(2):
            lower[count, 1, a] = diagonal[count, 1, a] = upper[count, 1, a] = 0.0
        diagonal[count, 0, 1], diagonal[count, 1, 1] = 0.0, 1.0
    for a in range(2):
        if fixed(mode, p, n):
            lower[count, a, 1] = 0.0
        if p == 0:
            lower[count, a, 0] = 0.0
        if fixed(mode, q, n):
            upper[count, a, 1] = 0.0
        if q == n - 1:
            upper[count, a, 0] = 0.0
