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

import numpy as np
from numba import njit

from meshwind.path.kernels.contact import pull
from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV

STUCK, HELD = 0, 2
"""Modes of a touching particle beside sigma = +1 and -1: on the starting curve; pressed against a rim."""


MARGIN, FAINT = 1e-8, 1e-10
"""A stuck particle lets go above this share over mu N, and this angle: below them no set may fit."""


@njit(inline="always", cache=True)
def dot(a, b):
    """Scalar product of two vectors in space."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(cache=True)
def curve_at(curve, s):
    """Point (u, v) and derivative by s of the Catmull-Rom spline through curve (m, 2), s in samples: third order."""
    m = len(curve)
    k = min(max(int(np.floor(s)), 0), m - 2)
    x = s - k
    u, du = catmull_rom(curve, k, m, 0, x)
    v, dv = catmull_rom(curve, k, m, 1, x)
    return u, v, du, dv


@njit(inline="always", cache=True)
def catmull_rom(curve, k, m, a, x):
    """Coordinate a, and its derivative, at share x from sample k of m to the next."""
    p0, p1 = curve[k, a], curve[k + 1, a]
    if m == 2:
        return p0 + x * (p1 - p0), p1 - p0
    d0 = 0.5 * (p1 - curve[k - 1, a]) if k > 0 else -1.5 * p0 + 2.0 * p1 - 0.5 * curve[2, a]
    d1 = 0.5 * (curve[k + 2, a] - p0) if k < m - 2 else 1.5 * p1 - 2.0 * p0 + 0.5 * curve[m - 3, a]
    y, z = x * x, x * x * x
    value = (2 * z - 3 * y + 1) * p0 + (z - 2 * y + x) * d0 + (3 * y - 2 * z) * p1 + (z - y) * d1
    return value, (6 * y - 6 * x) * (p0 - p1) + (3 * y - 4 * x + 1) * d0 + (3 * y - 2 * x) * d1


@njit(cache=True)
def nearest_on(curve, s, u, v, frame):
    """The s whose point of the curve is nearest (u, v) in the metric of `frame`, from a guess."""
    for _ in range(12):
        pu, pv, du, dv = curve_at(curve, s)
        along = square = 0.0
        for k in range(3):
            c = frame[SU, k] * du + frame[SV, k] * dv
            along += c * (frame[SU, k] * (u - pu) + frame[SV, k] * (v - pv))
            square += c * c
        step = min(max(along / max(square, 1e-300), -4.0), 4.0)
        then = min(max(s + step, 0.0), len(curve) - 1.0)
        done = abs(then - s) <= 1e-12 * len(curve)
        s = then
        if done:
            break
    return s


@njit(cache=True)
def coefficient(table, periodic, u, v, out):
    """Friction at (u, v) and its two derivatives, bilinear in a table (rows over u, columns over v)."""
    rows, columns = table.shape
    out[1] = out[2] = 0.0
    if rows == 1 and columns == 1:
        out[0] = table[0, 0]
        return
    spans = rows if periodic else rows - 1
    x = (u - np.floor(u)) * spans if periodic else u * spans
    y = v * (columns - 1)
    i, j = min(max(int(x), 0), spans - 1), min(max(int(y), 0), columns - 2)
    x, y = x - i, y - j
    k = (i + 1) % rows
    a, b, c, d = table[i, j], table[i, j + 1], table[k, j], table[k, j + 1]
    out[0] = (1 - x) * ((1 - y) * a + y * b) + x * ((1 - y) * c + y * d)
    out[1] = ((1 - y) * (c - a) + y * (d - b)) * spans
    out[2] = ((1 - x) * (b - a) + x * (d - c)) * (columns - 1)


@njit(cache=True)
def to_parameters(frame, w, out):
    """The (u, v) rates whose velocity on the surface is the tangent vector w."""
    e, f, g = dot(frame[SU], frame[SU]), dot(frame[SU], frame[SV]), dot(frame[SV], frame[SV])
    a, b = dot(frame[SU], w), dot(frame[SV], w)
    det = max(e * g - f * f, 1e-300)
    out[0], out[1] = (g * a - f * b) / det, (e * b - f * a) / det


@njit(inline="always", cache=True)
def second_form(frame, n, a, b):
    """The second fundamental form of two (u, v) rates, about the outward normal n."""
    return (
        dot(frame[SUU], n) * a[0] * b[0]
        + dot(frame[SUV], n) * (a[0] * b[1] + a[1] * b[0])
        + dot(frame[SVV], n) * a[1] * b[1]
    )


@njit(cache=True)
def along_curve(curve, s, frame, n, t, b, way):
    """At place s of the starting curve: its unit tangent t, b = n x t, and t in (u, v)."""
    _, _, u, v = curve_at(curve, s)
    square = 0.0
    for k in range(3):
        t[k] = frame[SU, k] * u + frame[SV, k] * v
        square += t[k] * t[k]
    square = max(square, 1e-300)
    size = np.sqrt(square)
    for k in range(3):
        t[k] /= size
    way[0], way[1] = u / size, v / size
    across(n, t, b)


@njit(inline="always", cache=True)
def across(n, t, b):
    """b = n x t."""
    b[0] = n[1] * t[2] - n[2] * t[1]
    b[1] = n[2] * t[0] - n[0] * t[2]
    b[2] = n[0] * t[1] - n[1] * t[0]


@njit(cache=True)
def weigh(state, periodic, before, after, table, curve, grip, barred, balance):
    """Force balance of every touching particle, and the directions in which it may move.

    grip is (s, offset, mode): place on the starting curve, signed lateral distance from it, and mode. Fills
    balance: t, b (n, 3), of the fibre where it slips and of the starting curve where it is stuck, and turn (n, 3),
    the rim's curvature where it is held; ways (n, 2, 2), t and b in (u, v); load (n, 5) as F . t, F . b, N, mu and
    F . t - R_t; rest (n, 2) the residual R. b points to the same side of the starting curve everywhere. Releases
    stuck particles that slip, unless `barred` (n,), and holds those pressed against a rim. Returns the number of
    modes changed and the largest unbalanced force.
    """
    X, uv, frames, normal, touching, clear = state
    place, offset, mode = grip
    t, b, turn, ways, load, rest = balance
    n = len(X)
    force, m, mu = np.empty(3), np.empty(3), np.empty(3)
    changed, worst = 0, 0.0
    i = after[0]
    while i < n - 1:
        p, q = before[i], after[i]
        pull(X, i, p, q, force)
        normal_i = normal[i]
        for k in range(3):
            m[k] = (X[q, k] - X[i, k]) / (q - i) + (X[i, k] - X[p, k]) / (i - p)
        lean = dot(m, normal_i)
        span = np.sqrt(max(dot(m, m) - lean * lean, 1e-300))
        press = max(-dot(force, normal_i), 0.0)
        coefficient(table, periodic, uv[i, 0], uv[i, 1], mu)
        was = mode[i]
        if was == HELD:
            mode[i] = np.int8(-1 if offset[i] > 0.0 else 1)
        along_curve(curve, place[i], frames[i], normal_i, t[i], b[i], ways[i, 0])
        back = dot(m, t[i]) < 0.0  # the fibre runs the other way along its starting curve
        if was == STUCK and not barred[i]:
            # across the fibre itself, which at a kink is not the direction of its starting curve
            across(normal_i, m, turn[i])
            side = dot(force, turn[i]) / span
            if back:
                side = -side
            if abs(side) > mu[0] * press * (1.0 + MARGIN) + FAINT * span:
                mode[i] = np.int8(-1 if side > 0.0 else 1)
        if mode[i] != STUCK:
            for k in range(3):
                t[i, k] = (m[k] - lean * normal_i[k]) / span
            across(normal_i, t[i], b[i])
            if back:
                for k in range(3):
                    b[i, k] = -b[i, k]
            to_parameters(frames[i], t[i], ways[i, 0])
            to_parameters(frames[i], b[i], ways[i, 1])
            out = dot(force, frames[i, SV]) + mode[i] * mu[0] * press * dot(b[i], frames[i, SV])
            if (uv[i, 1] <= 0.0 and out < 0.0) or (uv[i, 1] >= 1.0 and out > 0.0):
                mode[i] = np.int8(HELD)
                size = np.sqrt(dot(frames[i, SU], frames[i, SU]))
                for k in range(3):
                    t[i, k] = frames[i, SU, k] / size
                    turn[i, k] = frames[i, SUU, k] / size**2
                across(normal_i, t[i], b[i])
                ways[i, 0, 0], ways[i, 0, 1] = 1.0 / size, 0.0
        load[i, 0], load[i, 1], load[i, 2], load[i, 3] = dot(force, t[i]), dot(force, b[i]), press, mu[0]
        rest[i, 0], rest[i, 1] = load[i, 0], 0.0
        if mode[i] != HELD:
            rest[i, 0] = dot(force, m) / span
            if back and mode[i] == STUCK:
                rest[i, 0] = -rest[i, 0]
        load[i, 4] = load[i, 0] - rest[i, 0]
        if mode[i] == STUCK or mode[i] == HELD:
            ways[i, 1, 0] = ways[i, 1, 1] = 0.0
        else:
            rest[i, 1] = load[i, 1] + mode[i] * mu[0] * press
        if mode[i] != was:
            changed += 1
        worst = max(worst, np.sqrt(rest[i, 0] ** 2 + rest[i, 1] ** 2))
        i = q
    return changed, worst


@njit(cache=True)
def differentiate(state, periodic, before, after, table, mode, balance, contacts, lower, diagonal, upper, right):
    """Blocks of -dR/dx over the touching particles, exact, so that the step is Newton's; returns their number.

    The unknowns of a particle are its moves along t and b; a stuck or held one moves along t only.
    """
    X, uv, frames, normal = state[0], state[1], state[2], state[3]
    t, b, turn, ways, load, rest = balance
    n = len(X)
    mu = np.empty(3)
    count = 0
    i = after[0]
    while i < n - 1:
        p, q = before[i], after[i]
        contacts[count] = i
        low, own, up = lower[count], diagonal[count], upper[count]
        low[:], own[:], up[:] = 0.0, 0.0, 0.0
        gp, gq = 1.0 / (i - p), 1.0 / (q - i)
        press, sigma = load[i, 2], float(mode[i])
        bound = mode[i] == STUCK or mode[i] == HELD
        coefficient(table, periodic, uv[i, 0], uv[i, 1], mu)
        grip = sigma * mu[0] if press > 0.0 and not bound else 0.0
        lean = square = ahead = spin = 0.0
        for k in range(3):
            m = gq * (X[q, k] - X[i, k]) + gp * (X[i, k] - X[p, k])
            lean += m * normal[i, k]
            square += m * m
            ahead += m * t[i, k]
            spin += (gp * (X[p, k] - X[i, k]) + gq * (X[q, k] - X[i, k])) * turn[i, k]
        flat = max(np.sqrt(max(square - lean * lean, 0.0)), 1e-300)
        scale = 2.0 / flat if mode[i] != STUCK or ahead >= 0.0 else -2.0 / flat
        # R_t = (|e|^2 - |a|^2) / |n x m|, or the pull along the rim; R_b across the fibre, whose direction turns
        bent = load[i, 0] / flat
        for k in range(3):
            e, f = gq * (X[q, k] - X[i, k]), gp * (X[i, k] - X[p, k])
            side, out = b[i, k], grip * normal[i, k]
            if mode[i] == HELD:
                along_p, along_i, along_q = gp * t[i, k], -(gp + gq) * t[i, k], gq * t[i, k]
            else:
                along_p, along_q = scale * gp * f, scale * gq * e
                along_i = -along_p - along_q
            across_p, across_q = gp * (side * (1.0 + bent) - out), gq * (side * (1.0 - bent) - out)
            across_i = -across_p - across_q
            low[0, 0] -= along_p * t[p, k]
            own[0, 0] -= along_i * t[i, k]
            up[0, 0] -= along_q * t[q, k]
            low[0, 1] -= along_p * b[p, k]
            own[0, 1] -= along_i * b[i, k]
            up[0, 1] -= along_q * b[q, k]
            low[1, 0] -= across_p * t[p, k]
            own[1, 0] -= across_i * t[i, k]
            up[1, 0] -= across_q * t[q, k]
            low[1, 1] -= across_p * b[p, k]
            own[1, 1] -= across_i * b[i, k]
            up[1, 1] -= across_q * b[q, k]
        if mode[i] == HELD:
            own[0, 0] -= spin
        elif not bound:
            for a in range(2):
                dn_t = -second_form(frames[i], normal[i], ways[i, 0], ways[i, a])
                dn_b = -second_form(frames[i], normal[i], ways[i, 1], ways[i, a])
                slope = mu[1] * ways[i, a, 0] + mu[2] * ways[i, a, 1]
                own[1, a] -= (bent * lean + press) * dn_b + sigma * press * slope
                own[1, a] += grip * (load[i, 0] * dn_t + load[i, 1] * dn_b)
        if bound:
            low[1, :], own[1, :], up[1, :], own[0, 1] = 0.0, 0.0, 0.0, 0.0
            own[1, 1] = 1.0
        if fixed(mode, p, n):
            low[:, 1] = 0.0
        if p == 0:
            low[:, 0] = 0.0
        if fixed(mode, q, n):
            up[:, 1] = 0.0
        if q == n - 1:
            up[:, 0] = 0.0
        right[count, 0], right[count, 1] = rest[i, 0], rest[i, 1]
        count += 1
        i = q
    return count


@njit(inline="always", cache=True)
def fixed(mode, i, n):
    """Whether particle i of n cannot move across: an end of the path, stuck, or at a rim."""
    return i == 0 or i == n - 1 or mode[i] == STUCK or mode[i] == HELD
