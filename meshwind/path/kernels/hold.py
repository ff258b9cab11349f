"""The taut path under friction: Newton on Coulomb's law over sets of stuck and slipping particles, with contact.

At rest the fibre minimises E + sum mu N_i |d_i|, where d_i is the lateral distance from the starting curve and N_i
the contact force of the answer itself.  Each step is Newton's on the exact balance, N and the fibre's turning
included; it counts only if E + sum mu N_i |d_i| falls with N_i held at the step's start, and is shifted towards the
force until it does.  A particle that would cross the starting curve sticks there.  Contact comes first: friction
holds only where the surface presses.
"""

import numpy as np
from numba import njit

from meshwind.path.kernels.block_tridiagonal import solve_general
from meshwind.path.kernels.certificate import HALF_TURN, certify, largest_leap, unresolved
from meshwind.path.kernels.contact import lift, link
from meshwind.path.kernels.coulomb import HELD, STUCK, differentiate, weigh
from meshwind.path.kernels.glide import LONGEST_MOVE
from meshwind.path.kernels.grip import locate, slide, space_along, take_hold
from meshwind.path.kernels.newton import EVALUATIONS, ITERATIONS, SOLVES, carry_lifted, sag
from meshwind.path.kernels.relax import (
    CONVERGED,
    DESCENT,
    LIFTED,
    MOST_LANDINGS,
    SLID_END,
    SLID_START,
    STALLED,
    TOO_COARSE,
    failure,
    take_up,
)  # fmt: skip
from meshwind.path.kernels.state import blank, copy, energy

PATIENCE = 60
"""Steps after which a path that does not settle goes in circles: its sets are chosen anew, its steps halved."""
SHORT, CALM = 1.0 / 16.0, 1e-4
"""Least share of a step that halving leads to; unbalanced force below which whole steps are taken again."""
SHORTEST = 1e-3
"""Share of a step below which a shift towards the force serves better."""


@njit(cache=True)
def blank_balance(n):
    """Work space of `weigh`."""
    return (
        np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, 2, 2)), np.zeros((n, 5)), np.zeros((n, 2))
    )  # fmt: skip


@njit(cache=True)
def hold(body, pull_off, tolerance, limit, table, curve, state, grip, tally):
    """Bring a path that touches as `state` and `grip` say to rest under friction, in place.

    Returns (residual, status) as `relax` does.
    """
    X, uv, frames, normal, touching, clear = state
    place, offset, mode = grip
    periodic = body.spline.periodic
    n = len(X)
    trial = blank(n)
    after_grip = np.zeros(n), np.zeros(n), np.zeros(n, np.int8)
    spare = np.zeros(n), np.zeros(n), np.zeros(n, np.int8)
    before_t, after_t = np.zeros(n, np.int64), np.zeros(n, np.int64)
    balance, balance_t = blank_balance(n), blank_balance(n)
    ways, load = balance[3], balance[4]
    contacts = np.empty(n, np.int64)
    before, after = np.zeros(n, np.int64), np.zeros(n, np.int64)
    lower, diagonal, upper = np.empty((n, 2, 2)), np.empty((n, 2, 2)), np.empty((n, 2, 2))
    right, move, work = np.empty((n, 2)), np.empty((n, 2)), np.empty((n, 2, 2))
    kept, barred = np.empty(n, np.bool_), np.zeros(n, np.bool_)
    least = 0.1 * (np.pi / n) ** 2
    shift, stride = 0.0, 1.0
    now, length = energy(X)
    most = max(HALF_TURN, 1.2 * largest_leap(state, periodic))
    residual = best = np.inf
    caution = 0
    for turn in range(limit):
        tally[ITERATIONS] += 1
        if turn % PATIENCE == PATIENCE - 1:
            take_hold(body.spline, curve, state, grip, body.size, tally)
            shift, best = 0.0, np.inf
            stride = max(0.5 * stride, SHORT)
            now, length = energy(X)
        spacing = max(length, 1e-300) / (n - 1)
        for i in range(n):
            kept[i] = touching[i]
        released = 0
        if caution < 2:
            released = lift(X, normal, touching, pull_off * spacing, caution == 0, before, after)
        else:
            link(touching, before, after)
        if released > 0 and len(body.tree.levels) == 0:
            return residual, LIFTED
        barred[:] = False
        changed, force = weigh(state, periodic, before, after, table, curve, grip, barred, balance)
        residual = max(force, sag(X, after)) / spacing
        if released == 0 and changed == 0 and residual <= tolerance:
            if caution == 2 and lift(X, normal, touching, pull_off * spacing, False, before, after) > 0:
                break
            return residual, resting(uv, mode, after)
        count = differentiate(
            state, periodic, before, after, table, mode, balance, contacts, lower, diagonal, upper, right
        )
        best = min(best, force / length)
        firm = False
        cost = now
        for c in range(count):
            i = contacts[c]
            if mode[i] == 1 or mode[i] == -1:
                cost += load[i, 2] * load[i, 3] * abs(offset[i])
        accepted = False
        trials = 0
        while not accepted and shift < 1e6:
            tally[SOLVES] += 1
            if not solve_general(lower, diagonal, upper, shift, right, count, move, work):
                shift = max(4.0 * shift, least)
                continue
            wrong = 0
            for c in range(count):
                i = contacts[c]
                # a particle just released must leave to the side that it is pulled to
                slips = (mode[i] == 1 or mode[i] == -1) and load[i, 3] > 0.0
                if slips and offset[i] == 0.0 and move[c, 1] * mode[i] >= 0.0:
                    wrong += 1
                    if not firm:
                        mode[i], barred[i] = np.int8(STUCK), True
            if wrong > 0 and firm:
                shift = max(4.0 * shift, least)
                continue
            if wrong > 0:
                _, left = weigh(state, periodic, before, after, table, curve, grip, barred, balance)
                if left <= 1e-3 * force:  # nothing else moves: let them go, but by a small step
                    firm = True
                    barred[:] = False
                    shift = max(16.0 * shift, least)
                    weigh(state, periodic, before, after, table, curve, grip, barred, balance)
                count = differentiate(
                    state,
                    periodic,
                    before,
                    after,
                    table,
                    mode,
                    balance,
                    contacts,
                    lower,
                    diagonal,
                    upper,
                    right,
                )
                continue
            slope, square, reach = 0.0, 0.0, 0.0
            for c in range(count):
                i = contacts[c]
                slope += right[c, 0] * move[c, 0] + right[c, 1] * move[c, 1]
                for a in range(2):
                    square += move[c, a] ** 2
                    way = move[c, 0] * ways[i, 0, a] + move[c, 1] * ways[i, 1, a]
                    reach = max(reach, abs(way))
            if slope < 1e-3 * least * square:  # no descent: shift towards the force
                shift = max(4.0 * shift, least)
                continue
            step = min(stride if residual > CALM else 1.0, LONGEST_MOVE / max(reach, 1e-300))
            while step > SHORTEST:
                slide(
                    body.spline, step, move, contacts, count, curve, balance, state, grip, trial, after_grip, body.size,
                    tally,
                )  # fmt: skip
                carry_lifted(body, step, contacts, count, state, trial, tally)
                if largest_leap(trial, periodic) > most:
                    step *= 0.5
                    continue
                then, length_then = energy(trial[0])
                price = then
                for c in range(count):
                    i = contacts[c]
                    price += step * move[c, 0] * load[i, 4]
                    if (mode[i] == 1 or mode[i] == -1) and after_grip[2][i] != STUCK:
                        price += load[i, 2] * load[i, 3] * abs(offset[i] + step * move[c, 1])
                blind = slope <= 1e-13 * now and price <= cost * (1.0 + 1e-12)
                if price <= cost - DESCENT * step * slope or blind:
                    accepted = True
                    break
                if shift == 0.0:
                    # near the answer the held N misjudges; there Newton's step is known by the balance it leaves
                    for i in range(n):
                        spare[0][i], spare[1][i], spare[2][i] = after_grip[0][i], after_grip[1][i], after_grip[2][i]
                    link(trial[4], before_t, after_t)
                    _, left = weigh(trial, periodic, before_t, after_t, table, curve, spare, barred, balance_t)
                    if left < 0.5 * best * length_then:
                        accepted = True
                        break
                step *= 0.5
            if not accepted:
                trials += 1
                if trials > 6:
                    break
                shift = max(16.0 * shift, least)
        if accepted:
            for i in range(1, n - 1):
                if trial[4][i] and not touching[i]:  # landed: where on the starting curve, and on which side of it
                    after_grip[0][i] = min(
                        max(0.5 * (after_grip[0][i - 1] + after_grip[0][i + 1]), 0.0), len(curve) - 1
                    )
                    locate(curve, i, trial, after_grip, body.size)
                    d = after_grip[1][i]
                    after_grip[2][i] = np.int8(STUCK if d == 0.0 else (-1 if d > 0.0 else 1))
            copy(trial, state)
            for i in range(n):
                place[i], offset[i], mode[i] = after_grip[0][i], after_grip[1][i], after_grip[2][i]
            now, length = then, length_then
            caution = 0
            shift = 0.25 * shift if shift > least else 0.0
        else:
            for i in range(n):
                touching[i] = kept[i]
            shift = 0.0
            if caution == 2:
                break
            caution += 1
    return residual, failure(uv, periodic)


@njit(nogil=True, cache=True)
def hold_all(
    first, last, body, pull_off, tolerance, limit, resume, final,
    table, starts, place, mode, X, uv, normal, touching, gap, slip, residual, status, tallies,
):  # fmt: skip
    """Bring paths first to last to rest under friction: from their starting curves, or with `resume` as they are."""
    n = uv.shape[1]
    frames, offset = np.zeros((n, 6, 3)), np.zeros(n)
    for p in range(first, last):
        state = (X[p], uv[p], frames, normal[p], touching[p], gap[p])
        grip = place[p], offset, mode[p]
        curve, tally = starts[p], tallies[p]
        if resume:
            take_up(body, state, tally)
            take_hold(body.spline, curve, state, grip, body.size, tally)
        else:
            mode[p, :] = STUCK
            offset[:] = 0.0
            space_along(body.spline, curve, state, place[p])
            tally[EVALUATIONS] += 3 * n
        inside = 0
        for _ in range(MOST_LANDINGS):
            residual[p], status[p] = hold(body, pull_off, tolerance, limit, table, curve, state, grip, tally)
            if not final or status[p] == LIFTED:
                break
            inside = certify(body, state, slip[p], tally)
            if inside == 0 or status[p] != CONVERGED:
                break
            take_hold(body.spline, curve, state, grip, body.size, tally)
        if final and status[p] == CONVERGED:
            if inside > 0:
                status[p] = STALLED
            elif unresolved(state, body.spline.periodic):
                status[p] = TOO_COARSE


@njit(cache=True)
def resting(uv, mode, after):
    """Which rim a path at rest leans on, if any."""
    i = after[0]
    while i < len(uv) - 1:
        if mode[i] == HELD:
            return SLID_START if uv[i, 1] <= 0.5 else SLID_END
        i = after[i]
    return CONVERGED
