"""Coulomb's law at a touching particle: stuck to the starting curve, or slipping with friction mu N against it.

Friction holds the lateral part of the force only, because the tension is the same all along the fibre (3.4): each
particle is free along the fibre.  A stuck one stays on the starting curve c and needs |F . b| <= mu N (3.12); one that
slips has left c to the side where F . b pulls, and is held back by the whole of mu N.  With e and a the springs to the
next and the last touching particle, F = e - a, m = e + a, b = n x m / |n x m| and N = -F . n the balance reads

    R_t = F . m / |n x m| = 0,  equal tension: |e| = |a|, so that F / |e| is the turn of the fibre's unit tangent, and
    R_b = F . b + sigma mu N = 0, where sigma = -sign of the slip.

Where the fibre bends sharply m leans out of the tangent plane and R_t is not the springs' own pull F . t; their
difference counts as one more force, held while a step is judged.
"""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.kernel import njit
from meshwind.core.vectors import TINY
from meshwind.path.kernels.contact import pull
from meshwind.path.kernels.geometry import (
    Vector,
    combine,
    cross,
    derivative,
    dot,
    minus,
    over,
    plus,
    put,
    row,
    times,
    to_parameters,
)
from meshwind.path.kernels.starting_curve import curve_at
from meshwind.path.kernels.state import State
from meshwind.surface.evaluate import SU, SUU, SV
from meshwind.surface.tree import Body

STUCK, HELD = 0, 2
"""Modes of a touching particle beside sigma = +1 and -1: on the starting curve; pressed against a rim."""
MARGIN, FAINT = 1e-8, 1e-10
"""A stuck particle slips above this share over mu N, and this angle: below them no active set may fit."""
ON_CURVE = 1e-12
"""Round-off of a lateral distance over the part's size: nearer to the starting curve counts as on it.

A stuck particle slips only where the force over mu N, against the stiffness 2 of its springs, moves it further: else it
would stick again at once, and slip and stick for ever.
"""


class RoughBody(NamedTuple):
    """A body, and the coefficients of friction over it, bilinear in a table (rows over u, columns over v)."""

    body: Body
    friction: Floats


class Grip(NamedTuple):
    """How the n particles of a fibre are held to its starting curve.

    anchor (n,): where on the curve each belongs, in samples; offset (n,): its signed lateral distance from there,
    positive to the left; mode (n,): STUCK, HELD, or sigma of one that slips.
    """

    anchor: Floats
    offset: Floats
    mode: Ints


class Fibre(NamedTuple):
    """A path under friction: its state, and its grip on the starting curve (m, 2)."""

    state: State
    grip: Grip
    curve: Floats


class Balance(NamedTuple):
    """Balance of forces of n particles, and the directions in which they may move.

    along, across (n, 3): t and b of the fibre where it slips, of the starting curve where it is stuck; b points to the
    same side of the starting curve everywhere.  turn (n, 3): the rim's curvature where the particle is held there.
    ways (n, 2, 2): t and b in (u, v).
    pull_along, pull_across, press, mu, excess (n,): F . t, F . b, N, the coefficient of friction and F . t - R_t;
    residual (n, 2): R_t and R_b.
    """

    along: Floats
    across: Floats
    turn: Floats
    ways: Floats
    pull_along: Floats
    pull_across: Floats
    press: Floats
    mu: Floats
    excess: Floats
    residual: Floats


class Springs(NamedTuple):
    """Springs at one particle: F and m, m . n, |n x m|, the contact force N and what friction can hold, mu N."""

    force: Vector
    sum: Vector
    lean: float
    span: float
    press: float
    bound: float


class Ways(NamedTuple):
    """Directions in which one particle may move, t and b, and their rates of (u, v), zero where it may not."""

    t: Vector
    b: Vector
    t_uv: tuple[float, float]
    b_uv: tuple[float, float]


@njit(cache=True)
def blank_grip(n):
    """A grip of n particles, all stuck."""
    return Grip(np.zeros(n), np.zeros(n), np.zeros(n, np.int8))


@njit(cache=True)
def blank_balance(n):
    """Room for the balance of n particles."""
    return Balance(
        np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, 2, 2)),
        np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n), np.zeros((n, 2)),
    )  # fmt: skip


@njit(forceinline=True, cache=True)
def slips(mode):
    """Whether a particle slips on the surface, neither stuck nor held at a rim."""
    return mode == 1 or mode == -1


@njit(forceinline=True, cache=True)
def slipping(side):
    """Mode of a particle that slips to the side of the given sign: friction points the other way."""
    return np.int8(-1 if side > 0.0 else 1)


@njit(cache=True)
def coefficient(table, periodic, u, v):
    """Friction at (u, v) and its two derivatives, bilinear in a table (rows over u, columns over v)."""
    rows, columns = table.shape
    if rows == 1 and columns == 1:
        return table[0, 0], 0.0, 0.0
    spans = rows if periodic else rows - 1
    x = (u - np.floor(u)) * spans if periodic else u * spans
    y = v * (columns - 1)
    i, j = min(max(int(x), 0), spans - 1), min(max(int(y), 0), columns - 2)
    x, y = x - i, y - j
    k = (i + 1) % rows
    a, b, c, d = table[i, j], table[i, j + 1], table[k, j], table[k, j + 1]
    mu = (1 - x) * ((1 - y) * a + y * b) + x * ((1 - y) * c + y * d)
    return mu, ((1 - y) * (c - a) + y * (d - b)) * spans, ((1 - x) * (b - a) + x * (d - c)) * (columns - 1)


@njit(cache=True)
def balance_forces(rough, fibre, contacts, barred, balance):
    """Assemble the residual of every touching particle, and update the active set of stuck and slipping ones.

    A stuck particle slips where friction cannot hold it, unless it is barred (n,) from that; one that is pressed
    against a rim is held there.  Returns the number of modes changed and the largest unbalanced force.
    """
    table, periodic, curve = rough.friction, rough.body.spline.periodic, fibre.curve
    least = 2.0 * ON_CURVE * rough.body.size
    X, uv, frames, normals = fibre.state.X, fibre.state.uv, fibre.state.frames, fibre.state.normal
    anchor, offset, mode = fibre.grip.anchor, fibre.grip.offset, fibre.grip.mode
    before, after, turn, residual = contacts.before, contacts.after, balance.turn, balance.residual
    n = len(X)
    changed, worst = 0, 0.0
    i = after[0]
    while i < n - 1:
        normal, su, sv = row(normals, i), derivative(frames, i, SU), derivative(frames, i, SV)
        mu, _, _ = coefficient(table, periodic, uv[i, 0], uv[i, 1])
        springs = springs_at(X, before[i], i, after[i], normal, mu)
        now = slipping(offset[i]) if mode[i] == HELD else mode[i]
        ways = along_curve(curve, anchor[i], su, sv, normal)
        back = dot(springs.sum, ways.t) < 0.0  # the fibre runs the other way along its starting curve
        if mode[i] == STUCK and not barred[i]:
            now = let_slip(springs, normal, back, least)
        if now != STUCK:
            ways = along_fibre(springs, su, sv, normal, back)
            if pressed_out(springs, uv[i, 1], sv, now, ways.b):
                now = np.int8(HELD)
                ways = along_rim(su, normal)
                put(over(derivative(frames, i, SUU), np.sqrt(dot(su, su)) ** 2), turn, i)
        residual[i, 0], residual[i, 1] = residuals(springs, ways, now, back)
        note(springs, ways, mu, residual[i, 0], balance, i)
        worst = max(worst, np.sqrt(residual[i, 0] ** 2 + residual[i, 1] ** 2))
        changed += now != mode[i]
        mode[i] = now
        i = after[i]
    return changed, worst


@njit(cache=True)
def springs_at(X, p, i, q, normal, mu):
    """The springs at particle i between touching ones p and q."""
    force = pull(X, i, p, q)
    total = plus(over(minus(row(X, q), row(X, i)), q - i), over(minus(row(X, i), row(X, p)), i - p))
    lean = dot(total, normal)
    span = np.sqrt(max(dot(total, total) - lean * lean, TINY))
    press = max(-dot(force, normal), 0.0)
    return Springs(force, total, lean, span, press, mu * press)


@njit(cache=True)
def along_curve(curve, s, su, sv, normal):
    """Ways of a particle that is stuck at anchor s of the starting curve: along that curve."""
    _, _, u, v = curve_at(curve, s)
    way = combine(u, su, v, sv)
    size = np.sqrt(max(dot(way, way), TINY))
    t = over(way, size)
    return Ways(t, cross(normal, t), (u / size, v / size), (0.0, 0.0))


@njit(cache=True)
def let_slip(springs, normal, back, least):
    """Mode of a stuck particle: it slips where friction lets more than the `least` force across the fibre pass.

    That is across the fibre itself, which at a kink is not the direction of its starting curve.
    """
    side = dot(springs.force, cross(normal, springs.sum)) / springs.span
    if back:
        side = -side
    if abs(side) > springs.bound * (1.0 + MARGIN) + FAINT * springs.span + least:
        return slipping(side)
    return np.int8(STUCK)


@njit(cache=True)
def along_fibre(springs, su, sv, normal, back):
    """Ways of a particle that slips: along the fibre and across it."""
    t = over(minus(springs.sum, times(springs.lean, normal)), springs.span)
    b = cross(normal, t)
    if back:
        b = -b[0], -b[1], -b[2]
    return Ways(t, b, to_parameters(su, sv, t), to_parameters(su, sv, b))


@njit(cache=True)
def pressed_out(springs, v, sv, mode, b):
    """Whether the springs and friction press a slipping particle at a rim out over it."""
    out = dot(springs.force, sv) + mode * springs.bound * dot(b, sv)
    return (v <= 0.0 and out < 0.0) or (v >= 1.0 and out > 0.0)


@njit(cache=True)
def along_rim(su, normal):
    """Ways of a particle that is held at a rim: along the rim."""
    size = np.sqrt(dot(su, su))
    t = over(su, size)
    return Ways(t, cross(normal, t), (1.0 / size, 0.0), (0.0, 0.0))


@njit(cache=True)
def residuals(springs, ways, mode, back):
    """R_t and R_b of a particle; at a rim the pull along it takes the place of R_t."""
    if mode == HELD:
        return dot(springs.force, ways.t), 0.0
    uneven = dot(springs.force, springs.sum) / springs.span
    if mode == STUCK:
        return -uneven if back else uneven, 0.0
    return uneven, dot(springs.force, ways.b) + mode * springs.bound


@njit(forceinline=True, cache=True)
def note(springs, ways, mu, uneven, balance, i):
    """Write the ways and forces of particle i into the balance."""
    put(ways.t, balance.along, i)
    put(ways.b, balance.across, i)
    balance.ways[i, 0, 0], balance.ways[i, 0, 1] = ways.t_uv
    balance.ways[i, 1, 0], balance.ways[i, 1, 1] = ways.b_uv
    balance.pull_along[i], balance.pull_across[i] = dot(springs.force, ways.t), dot(springs.force, ways.b)
    balance.press[i], balance.mu[i], balance.excess[i] = springs.press, mu, balance.pull_along[i] - uneven


@njit(forceinline=True, cache=True)
def fixed(mode, i, n):
    """Whether particle i of n cannot move across: an end of the path, stuck, or at a rim."""
    return i == 0 or i == n - 1 or not slips(mode[i])
