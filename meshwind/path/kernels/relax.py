"""The taut path: projected Newton on the particles' energy in the parametric plane, with lifting and landing.

The fibre is n particles joined by zero-length springs (4.1); at rest it minimises E = 1/2 sum |P_{i+1} - P_i|^2
outside the body.  The implicit step (4.16) with a long time step is a Gauss-Newton step on E; keeping the term
F . s_uu as well makes it Newton's, and the time step lives on as a shift of the Hessian where that is not positive
definite.  Lifted particles are eliminated: they lie evenly on the chord between touching ones (5.2).  Every iterate
stays outside the body, and a step counts only if E falls, so that lifting and landing cannot chatter.
"""

import numpy as np
from numba import njit

from meshwind.path.kernels.block_tridiagonal import solve
from meshwind.path.kernels.certificate import HALF_TURN, certify, largest_leap, unresolved
from meshwind.path.kernels.contact import lift, link
from meshwind.path.kernels.glide import LONGEST_MOVE, spread_along
from meshwind.path.kernels.newton import (
    EVALUATIONS,
    ITERATIONS,
    SOLVES,
    assemble,
    carry_lifted,
    land,
    move_touching,
    sag,
)
from meshwind.path.kernels.state import blank, copy, energy, place, touch_down
from meshwind.path.kernels.status import Status

CONVERGED, SLID_START, SLID_END, UNSTABLE, STALLED, LEFT_CHART, TOO_COARSE = (int(status) for status in Status)
LIFTED = TOO_COARSE + 1
"""The fibre leaves the surface and no search tree was given: start again with one.  No result ever has it."""

SMALLEST_STEP = 1e-7
DESCENT = 1e-4
"""Armijo's share of the predicted fall."""
PATIENCE = 60
"""Steps in a row that a path may lean on a rim before it counts as slid off there."""
MOST_LANDINGS = 4
"""Times that a path is relaxed anew because its certificate finds a particle inside the body."""
MOST_FALLS = 5
"""Saddles that a path may leave on its way to rest."""


@njit(cache=True)
def relax(body, pull_off, tolerance, limit, state, tally):
    """Bring a path to rest from `state`, in place.

    pull_off: angle (radians) of the pull that lifts a particle, infinite for a fibre that cannot leave the surface.
    Returns (residual, status): residual is the largest unbalanced force over the tension, an angle in radians.
    """
    trial = blank(len(state[0]))
    residual, status, odd = descend(body, pull_off, tolerance, limit, state, trial, tally)
    if odd:
        copy(trial, state)
    return residual, status


@njit(cache=True)
def descend(body, pull_off, tolerance, limit, state, trial, tally):
    """As `relax`; the answer is left in `state` or, where the third result says so, in `trial`."""
    n, periodic = len(state[0]), body.spline.periodic
    odd = False
    contacts = np.empty(n, np.int64)
    before, after = np.zeros(n, np.int64), np.zeros(n, np.int64)
    diagonal, upper, metric = np.empty((n, 3)), np.empty((n, 2, 2)), np.empty((n, 3))
    right, move, work = np.empty((n, 2)), np.empty((n, 2)), np.empty((n, 3))
    kept = np.empty(n, np.bool_)
    shift, least = 0.0, 0.1 * (np.pi / n) ** 2
    now, length = energy(state[0])
    most = max(HALF_TURN, 1.2 * largest_leap(state, periodic))
    residual = np.inf
    caution = falls = leant = leaning = 0
    for _ in range(limit):
        tally[ITERATIONS] += 1
        X, uv, frames, normal, touching, clear = state
        spacing = max(length, 1e-300) / (n - 1)
        for i in range(n):
            kept[i] = touching[i]
        released = 0
        if caution < 2:
            released = lift(X, normal, touching, pull_off * spacing, caution == 0, before, after)
        else:
            link(touching, before, after)
        if released > 0 and len(body.tree.levels) == 0:
            return residual, LIFTED, odd
        count, force, leaning = assemble(state, periodic, before, after, contacts, diagonal, upper, metric, right)
        residual = max(force, sag(X, after)) / spacing
        if released == 0 and residual <= tolerance:
            if caution == 2 and lift(X, normal, touching, pull_off * spacing, False, before, after) > 0:
                break  # at rest but for pulls that no step could follow
            tally[SOLVES] += 1
            if solve(diagonal, upper, metric, 0.0, right, count, move, work):
                if leaning == 0:
                    return residual, CONVERGED, odd
                return residual, UNSTABLE if falls > 0 else leaving_by(uv, leaning), odd
            falls += 1
            if falls > MOST_FALLS or not fall(
                body, state, trial, contacts, count,
                diagonal, upper, metric, least, tally,
            ):  # fmt: skip
                return residual, UNSTABLE, odd
            state, trial, odd = trial, state, not odd
            now, length = energy(state[0])
            continue
        leant = leant + 1 if leaning > 0 else 0
        if leant > PATIENCE:
            return residual, leaving_by(uv, leaning), odd
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
            move_touching(body.spline, step, move, contacts, count, state, trial, tally)
            carry_lifted(body, step, contacts, count, state, trial, tally)
            if largest_leap(trial, periodic) > most:  # neighbours on two sides: one went through the body
                step *= 0.5
                continue
            then, length_then = energy(trial[0])
            # below round-off the energy cannot judge a step, and Newton's is right
            blind = slope <= 1e-13 * now and then <= now * (1.0 + 1e-12)
            if then <= now - DESCENT * step * slope or blind:
                accepted = True
                break
            step *= 0.5
        if accepted:
            state, trial, odd = trial, state, not odd
            now, length = then, length_then
            caution = 0
            shift = 0.25 * shift if shift > least else 0.0
        else:
            for i in range(n):
                touching[i] = kept[i]
            if caution == 2:
                break
            caution += 1
    return residual, failure(state[1], periodic), odd


@njit(cache=True)
def fall(body, state, trial, contacts, count, diagonal, upper, metric, least, tally):
    """Leave a saddle of the energy along its steepest descending mode, found by inverse iteration.

    Writes the lower of the two sides into `trial`; returns False where neither side is lower.
    """
    right, mode, work = np.empty((count, 2)), np.zeros((count, 2)), np.empty((count, 3))
    shift = least
    for c in range(count):
        right[c, 0] = right[c, 1] = np.sin(np.pi * (c + 1.0) / (count + 1.0)) + 0.1
    while True:
        tally[SOLVES] += 1
        if solve(diagonal, upper, metric, shift, right, count, mode, work):
            break
        shift *= 2.0
        if shift > 1.0 / least:
            return False
    for _ in range(8):
        reach = np.abs(mode).max()
        for c in range(count):
            x, y = mode[c, 0] / reach, mode[c, 1] / reach
            right[c, 0] = metric[c, 0] * x + metric[c, 1] * y
            right[c, 1] = metric[c, 1] * x + metric[c, 2] * y
        tally[SOLVES] += 1
        solve(diagonal, upper, metric, shift, right, count, mode, work)
    mode /= np.abs(mode).max()
    best = energy(state[0])[0]
    chosen = 0.0
    for step in (0.03, -0.03):
        move_touching(body.spline, step, mode, contacts, count, state, trial, tally)
        carry_lifted(body, 0.0, contacts, count, state, trial, tally)
        then = energy(trial[0])[0]
        if then < best:
            best, chosen = then, step
    if chosen > 0.0:  # the trial holds the other side
        move_touching(body.spline, chosen, mode, contacts, count, state, trial, tally)
        carry_lifted(body, 0.0, contacts, count, state, trial, tally)
    return chosen != 0.0


@njit(cache=True)
def failure(uv, periodic):
    """Why a path did not come to rest: it lies on a rim or hangs over it, or else nobody knows."""
    for i in range(1, len(uv) - 1):
        if uv[i, 1] <= 0.0 or uv[i, 1] >= 1.0 or (not periodic and (uv[i, 0] <= 0.0 or uv[i, 0] >= 1.0)):
            return leaving_by(uv, i)
    return STALLED


@njit(cache=True)
def leaving_by(uv, i):
    """Where a path leaves whose particle i is held: over a rim, or an edge of a surface open in u."""
    if uv[i, 1] <= 0.0:
        return SLID_START
    return SLID_END if uv[i, 1] >= 1.0 else LEFT_CHART


@njit(nogil=True, cache=True)
def relax_all(
    first, last, body, pull_off, tolerance, limit, resume, final, starts,
    X, uv, normal, touching, gap, slip, residual, status, tallies,
):  # fmt: skip
    """Relax paths first to last: from their starting curves (p, m, 2), or with `resume` from what the arrays hold.

    Only a `final` answer pays for its certificate; others leave lower bounds of the gaps.
    """
    n = uv.shape[1]
    frames = np.empty((n, 6, 3))
    for p in range(first, last):
        state = (X[p], uv[p], frames, normal[p], touching[p], gap[p])
        if resume:
            take_up(body, state, tallies[p])
        else:
            begin(body.spline, starts[p], state, tallies[p])
        residual[p], status[p] = settle(body, pull_off, tolerance, limit, final, state, slip[p], tallies[p])


@njit(cache=True)
def begin(spline, curve, state, tally):
    """Put a path on its starting curve (m, 2), evenly spaced by length."""
    spread_along(spline, curve, state[1], state[2], tally)
    place(spline, state)
    tally[EVALUATIONS] += len(state[1])


@njit(cache=True)
def settle(body, pull_off, tolerance, limit, final, state, slip, tally):
    """Bring a path to rest from `state` and, if the answer is `final`, certify it; what it finds inside lands.

    Returns (residual, status).
    """
    inside = 0
    residual, status = np.inf, STALLED
    for _ in range(MOST_LANDINGS):
        residual, status = relax(body, pull_off, tolerance, limit, state, tally)
        if not final or status == LIFTED:
            return residual, status
        inside = certify(body, state, slip, tally)
        if inside == 0 or status != CONVERGED:
            break
    if status == CONVERGED:
        if inside > 0:
            status = STALLED
        elif unresolved(state, body.spline.periodic):
            status = TOO_COARSE
    return residual, status


@njit(cache=True)
def take_up(body, state, tally):
    """Complete a state of which positions, parameters and contacts are known; what is inside the body lands."""
    touching, uv, clear = state[4], state[1], state[5]
    for i in range(len(touching)):
        if touching[i]:
            touch_down(body.spline, state, i, uv[i, 0], uv[i, 1])
            tally[EVALUATIONS] += 1
        elif clear[i] <= 0.0:
            land(body, state[0], state, i, tally)
