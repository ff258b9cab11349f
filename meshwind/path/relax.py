"""The taut path: projected Newton on the particles' energy in the parametric plane, with lifting and landing.

The fibre is n particles joined by zero-length springs (4.1); at rest it minimises E = 1/2 sum |P_{i+1} - P_i|^2
outside the body.  The implicit step (4.16) with a long time step is a Gauss-Newton step on E; keeping the term
F . s_uu as well makes it Newton's, and the time step lives on as a shift of the Hessian where that is not positive
definite.  Lifted particles are eliminated: they lie evenly on the chord between touching ones (5.2).  Every iterate
stays outside the body, and a step counts only if E falls, so that lifting and landing cannot chatter.
"""

import numpy as np
from numba import njit

from meshwind.path.block_tridiagonal import solve
from meshwind.path.contact import lift, link
from meshwind.path.newton import EVALUATIONS, FEET, ITERATIONS, SOLVES, advance, assemble, sag
from meshwind.path.paths import Status
from meshwind.path.state import blank, copy, energy, place, space_evenly
from meshwind.surface.evaluate import S, unit_normal
from meshwind.surface.tree import nearest_foot

CONVERGED, SLID_START, SLID_END, UNSTABLE, STALLED = (int(status) for status in Status)
LIFTED = STALLED + 1
"""The fibre leaves the surface and no search tree was given: start again with one.  No result ever has it."""

PULL = 1e-9
"""A pull off the surface below this angle (radians) is round-off, not lift."""
SMALLEST_STEP = 1e-7
LONGEST_MOVE = 0.25
"""No step moves a particle further than this in u or v: beyond it the quadratic model means nothing."""
DESCENT = 1e-4
"""Armijo's share of the predicted fall."""


@njit(cache=True)
def relax(net, periodic, boxes, levels, size, tolerance, limit, state, tally):
    """Bring the path that starts as the curve state[1] (n, 2) on the surface to rest, in place.

    Returns (residual, status): residual is the largest unbalanced force over the tension, an angle in radians.
    """
    X, uv, frames, normal, touching, clear = state
    n = len(X)
    trial = blank(n)
    place(net, periodic, state)
    space_evenly(state)
    place(net, periodic, state)
    tally[EVALUATIONS] += 2 * n
    contacts = np.empty(n, np.int64)
    before, after = np.zeros(n, np.int64), np.zeros(n, np.int64)
    diagonal, upper, metric = np.empty((n, 3)), np.empty((n, 2, 2)), np.empty((n, 3))
    right, move, work = np.empty((n, 2)), np.empty((n, 2)), np.empty((n, 3))
    kept = np.empty(n, np.bool_)
    shift, least = 0.0, 0.1 * (np.pi / n) ** 2
    now, length = energy(X)
    residual = np.inf
    caution = 0
    for _ in range(limit):
        tally[ITERATIONS] += 1
        spacing = length / (n - 1)
        for i in range(n):
            kept[i] = touching[i]
        released = 0
        if caution < 2:
            released = lift(X, normal, touching, PULL * spacing, caution == 0, before, after)
        else:
            link(touching, before, after)
        if released > 0 and len(levels) == 0:
            return residual, LIFTED
        count, force = assemble(state, periodic, before, after, contacts, diagonal, upper, metric, right)
        residual = max(force, sag(X, after)) / spacing
        if released == 0 and residual <= tolerance:
            if caution == 2 and lift(X, normal, touching, PULL * spacing, False, before, after) > 0:
                break  # at rest but for pulls that no step could follow
            tally[SOLVES] += 1
            if not solve(diagonal, upper, metric, 0.0, right, count, move, work):
                return residual, UNSTABLE
            return residual, resting_place(uv, contacts, count)
        definite = False
        while not definite and shift < 1.0 / least:
            tally[SOLVES] += 1
            definite = solve(diagonal, upper, metric, shift, right, count, move, work)
            if not definite:
                shift = max(4.0 * shift, least)
        if not definite:
            break
        slope = 0.0
        reach = 0.0
        for c in range(count):
            slope += right[c, 0] * move[c, 0] + right[c, 1] * move[c, 1]
            reach = max(reach, abs(move[c, 0]), abs(move[c, 1]))
        step = min(1.0, LONGEST_MOVE / max(reach, 1e-300))
        accepted = False
        while step > SMALLEST_STEP:
            advance(net, periodic, boxes, levels, size, step, move, contacts, count, state, trial, tally)
            then, length_then = energy(trial[0])
            # below round-off the energy cannot judge a step, and Newton's is right
            blind = slope <= 1e-13 * now and then <= now * (1.0 + 1e-12)
            if then <= now - DESCENT * step * slope or blind:
                accepted = True
                break
            step *= 0.5
        if accepted:
            copy(trial, state)
            now, length = then, length_then
            caution = 0
            shift = 0.25 * shift if shift > least else 0.0
        else:
            for i in range(n):
                touching[i] = kept[i]
            if caution == 2:
                break
            caution += 1
    return residual, STALLED


@njit(cache=True)
def resting_place(uv, contacts, count):
    """Which rim a path at rest leans on, if any: it has slid off there."""
    for c in range(count):
        if uv[contacts[c], 1] <= 0.0:
            return SLID_START
        if uv[contacts[c], 1] >= 1.0:
            return SLID_END
    return CONVERGED


@njit(nogil=True, cache=True)
def relax_all(
    first,
    last,
    net,
    periodic,
    boxes,
    levels,
    size,
    tolerance,
    limit,
    X,
    uv,
    normal,
    touching,
    gap,
    slip,
    residual,
    status,
    tallies,
):
    """Relax paths first to last; uv (p, n, 2) holds the starting curves and becomes the answer."""
    n = uv.shape[1]
    frames = np.empty((n, 6, 3))
    for p in range(first, last):
        state = (X[p], uv[p], frames, normal[p], touching[p], gap[p])
        residual[p], status[p] = relax(net, periodic, boxes, levels, size, tolerance, limit, state, tallies[p])
        if status[p] != LIFTED:
            certify(net, periodic, boxes, levels, state, slip[p], tallies[p])


@njit(cache=True)
def certify(net, periodic, boxes, levels, state, slip, tally):
    """True gaps of the lifted particles, and the slip |kg| / kn that each touching one needs."""
    X, uv, frames, normal, touching, gap = state
    n = len(X)
    for i in range(n):
        slip[i] = np.nan
        if not touching[i]:
            tally[FEET] += 1
            tally[EVALUATIONS] += nearest_foot(net, periodic, boxes, levels, X[i], uv[i], frames[i])
            unit_normal(frames[i], normal[i])
            square = 0.0
            for k in range(3):
                square += (X[i, k] - frames[i, S, k]) ** 2
            gap[i] = np.sqrt(square)
        elif 0 < i < n - 1:
            gap[i] = 0.0
            slip[i] = needed_slip(X, normal, i)


@njit(cache=True)
def needed_slip(X, normal, i):
    """|kg| / kn from the turn of the polyline at particle i; 0 where the fibre runs straight."""
    press = whole = along = span = 0.0
    for k in range(3):
        bend = X[i + 1, k] - 2.0 * X[i, k] + X[i - 1, k]
        chord = X[i + 1, k] - X[i - 1, k]
        press -= bend * normal[i, k]
        whole += bend * bend
        along += bend * chord
        span += chord * chord
    side = max(whole - press * press - along * along / max(span, 1e-300), 0.0)
    return np.sqrt(side) / press if press > PULL * np.sqrt(span) else 0.0
