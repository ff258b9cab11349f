"""The slide of a fibre under friction from its starting curve to rest, by increments of time.

An overdamped fibre of constant tension moves across itself at the rate |kg| - mu kn, and not at all where that is
negative (3.12).  Each increment is one implicit step of second order (BDF2): equilibrium under friction, with a force
that resists the slip over the length of the increment.  Both act from where the fibre lay before, moved on by
w^2 / (1 + 2 w) of its last slip, w being the ratio of the two increments; a particle that friction holds has no such
start.  Where the fibre comes to rest depends on how it got there: a particle that has slid one way may be drawn back
later, or be held where it stopped.
"""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import copy_table, fill, fill_table
from meshwind.core.vectors import TINY
from meshwind.path.kernels.contact import pull
from meshwind.path.kernels.coulomb import Fibre, Grip, blank_grip
from meshwind.path.kernels.geometry import dot, minus, over, put, row
from meshwind.path.kernels.grip import attach_to_curve, copy_grip, hold_all
from meshwind.path.kernels.relax import relax
from meshwind.path.kernels.relax_with_friction import relax_with_friction
from meshwind.path.kernels.resist import ROOM, lay_down, press_anew, resistance
from meshwind.path.kernels.state import (
    CONVERGED,
    EVALUATIONS,
    NEEDS_TREE,
    STALLED,
    Limits,
    blank,
    copy,
    energy,
    no_contacts,
    state_of,
)

FIRST, GROWTH = 1e-4, 1.12
"""Length of the first increment, in units of the fibre's length squared over its tension's mobility, and the factor
from each to the next: waves die out in the order of their lengths, each in a time of its length squared."""
FARTHEST = 0.005
"""Move within an increment, over the fibre's length, from which on increments no longer grow: a fibre that leaps off a
bump is followed."""
UNSETTLED = 5e-4
"""Move within an increment, over the length, up to which it counts though the contact force has not settled."""
LITTLE, HASTE = 1e-4, 1.5
"""Move within an increment, over the length, that is little, and the factor to the next after it."""
LATE = 0.1
"""Time from which on a fibre that moves little is at rest: its longest wave dies out in this time."""
AT_REST = 2e-6
"""Largest move within an increment, over the fibre's length, of a fibre at rest."""
FIRM = 1e3
"""Force over the tension that holds the fibre to its starting curve while it lifts off hollows, which takes no time."""
SAME, AT_ONCE, AT_LAST = 1e-4, 40, 300
"""Distance, over the length, up to which friction from an earlier curve leads to the same place of rest, and the most
steps by which it does, and by which a fibre is balanced where it lies."""
ROUNDS, BALANCE = 30, 1e-6
"""Maximum number of steps of an increment before a shorter one is tried, and the unbalanced force it leaves."""
PASSES, SETTLED = 4, 0.05
"""Maximum number of times that an increment is made anew with the contact force at its end, and the change from one to
the next, over the increment's move, with which it counts."""
MOST, DEAREST = 400, 8_000
"""Maximum number of increments, and of evaluations a particle, of a slide."""
LEANING = 16
"""Number of increments in a row over which a fibre that leans on a rim has slid off: in them the time grows six times,
and what has leaned for longer than one or two has not been seen to come back."""
SHORTER, SHORTEST = 0.3, 1e-6
"""Factor of an increment that fails, and the shortest that is tried."""


class Track(NamedTuple):
    """Where a fibre of n particles lay.

    lain (m, n, 2): its curve in (u, v) at first and after each step; turned (n, 2): the last step in which a particle
    slipped to the right and to the left; one that lands counts as both, for it begins anew there.
    """

    lain: Floats
    turned: Ints


@njit(nogil=True, cache=True)
def slide_all(first, last, rough, limits, batch, held, own):
    """Let paths first to last of a batch slide from their starting curves to rest.

    Writes to held (p, n, 2) the curve that friction holds each to from then on, and to own (p,) whether that is the
    starting curve itself; anchors are in samples of that curve.
    """
    n = batch.uv.shape[1]
    frames, offset = np.zeros((n, 6, 3)), np.zeros(n)
    track = Track(np.empty((MOST + 1, n, 2)), np.empty((n, 2), np.int64))
    for p in range(first, last):
        start, counters = batch.starts[p], batch.counters[p]
        state, grip = state_of(batch, p, frames), Grip(batch.anchor[p], offset, batch.mode[p])
        fibre = Fibre(state, grip, start)
        attach_to_curve(rough.body.spline, fibre, counters)
        copy_table(state.uv, held[p])
        residual, status = slide_one_way(rough, limits, fibre, counters)
        own[p] = status == CONVERGED
        if status in (NEEDS_TREE, CONVERGED):
            batch.residual[p], batch.status[p] = residual, status
            continue
        attach_to_curve(rough.body.spline, fibre, counters)
        residual, status, steps = slide(rough, limits, state, track, counters)
        copy_table(track.lain[steps], held[p])
        if status == CONVERGED:
            residual, status, k = settle(rough, limits, fibre, track, steps, counters)
            own[p] = k == 0
            copy_table(track.lain[k], held[p])
        batch.residual[p], batch.status[p] = residual, status


@njit(cache=True)
def slide_one_way(rough, limits, fibre, counters):
    """Bring a fibre that slips to one side only, and presses everywhere, to rest at once.

    Curves that shorten keep their order: one that begins to slip to one side alone never slips back, and friction from
    the starting curve is that at rest.  Returns (residual, status), the status STALLED where that is not so.
    """
    state, grip = fibre.state, fibre.grip
    n = len(state.X)
    resist = resistance(n, 0.0, 0.0, 0.0)
    lay_down(resist, rough, state, no_contacts(n))
    way = 0.0
    for i in range(1, n - 1):
        force = pull(state.X, i, i - 1, i + 1)
        side = dot(force, row(resist.across, i))
        if dot(force, row(state.normal, i)) > 0.0 or (abs(side) > resist.bound[i] and side * way < 0.0):
            return np.inf, STALLED
        if abs(side) > resist.bound[i]:
            way = side
    residual, status = relax_with_friction(rough, limits, fibre, counters)
    for i in range(n):
        if not state.touching[i] or grip.offset[i] * way < 0.0:
            return residual, STALLED
    return residual, status if status in (CONVERGED, NEEDS_TREE) else STALLED


@njit(cache=True)
def slide(rough, limits, state, track, counters):
    """Let a fibre that lies on its starting curve slide to rest, in place, and note its track.

    Returns (residual, status, steps).
    """
    n = len(state.X)
    before, last, older = blank(n), blank(n), blank(n)
    aimed = np.empty((n, 3))
    contacts = no_contacts(n)
    loose = Limits(limits.pull_off, max(limits.tolerance, BALANCE), ROUNDS)
    time, steps, leant = FIRST, 0, 0
    past = 0.0  # length of the increment before
    copy_table(state.uv, track.lain[0])
    fill_table(track.turned, 0)
    length = energy(state.X)[1]
    resist = resistance(n, 0.0, ROOM * length, FIRM * length)
    lay_down(resist, rough, state, contacts)
    fill(resist.bound, FIRM * length)
    spent = counters[EVALUATIONS] + DEAREST * n
    residual, status = relax(rough.body, limits, resist, state, counters)
    if status == NEEDS_TREE:
        return residual, status, steps
    for _ in range(MOST):
        copy(state, before)
        length = energy(state.X)[1]
        ratio = time / past if past > 0.0 else 0.0
        pace = (1.0 + 2.0 * ratio) / (1.0 + ratio) / (time * (n - 1) ** 2)
        resist = resistance(n, pace, ROOM * length, 0.0)
        lay_down(resist, rough, state, contacts)
        if past > 0.0:
            aim_ahead(resist, before, older, ratio * ratio / (1.0 + 2.0 * ratio))
        copy_table(resist.lain, aimed)
        move, settled = 0.0, False
        for turn in range(PASSES):
            copy(state, last)
            residual, status = relax(rough.body, loose, resist, state, counters)
            if status in (NEEDS_TREE, STALLED):
                break
            move = largest_move(state.X, before.X)
            if turn > 0 and largest_move(state.X, last.X) <= max(SETTLED * move, AT_REST * length):
                settled = True
                break
            eased = press_anew(resist, rough, state, contacts)
            bent = follow_bend(resist, aimed, before, state)
            if eased <= SETTLED * pace * move and bent <= SETTLED * move:
                settled = True
                break
        if status == NEEDS_TREE:
            break
        shorter = time > SHORTEST
        if counters[EVALUATIONS] > spent:
            status, shorter = STALLED, False
        if status == STALLED or (shorter and not settled and move > UNSETTLED * length):
            copy(before, state)
            if not shorter:
                break
            time *= SHORTER
            continue
        steps += 1
        copy_table(state.uv, track.lain[steps])
        note_ways(track.turned, resist, before, state, AT_REST * length, steps)
        copy(before, older)
        past = time
        leant = leant + 1 if status != CONVERGED else 0
        if leant == LEANING:
            break
        if time > LATE and move <= AT_REST * length:
            break
        time *= HASTE if move <= LITTLE * length else min(GROWTH, max(FARTHEST * length / move, SHORTER))
    return residual, status, steps


@njit(cache=True)
def aim_ahead(resist, now, before, share):
    """Move what the slip is measured from on by a share of the last increment's slip, as BDF2 does."""
    n = len(now.X)
    for i in range(1, n - 1):
        if resist.bound[i] >= 0.0 and now.touching[i] and before.touching[i]:
            across = row(resist.across, i)
            d = share * slip_from(before, i, row(now.X, i), across)
            for a in range(3):
                resist.lain[i, a] += d * across[a]


@njit(cache=True)
def follow_bend(resist, aimed, before, state):
    """Measure slips from where the fibre, not its tangent, passes a particle that moved along it.

    Returns the largest change of that place.
    """
    n, most = len(state.X), 0.0
    for i in range(1, n - 1):
        if resist.bound[i] >= 0.0 and before.touching[i]:
            across = row(resist.across, i)
            here = row(state.X, i)
            if resist.mode[i] == 0:  # held, it stays where it was
                put(row(before.X, i), aimed, i)
            straight = dot(minus(here, row(before.X, i)), across)
            d = straight - slip_from(before, i, here, across)
            square = 0.0
            for a in range(3):
                place = aimed[i, a] + d * across[a]
                square += (place - resist.lain[i, a]) ** 2
                resist.lain[i, a] = place
            most = max(most, np.sqrt(square))
    return most


@njit(cache=True)
def slip_from(before, i, here, across):
    """Distance across of a point from a fibre near its particle i."""
    X = before.X
    far = minus(here, row(X, i))
    slip = dot(far, across)
    if before.touching[i - 1] and before.touching[i + 1]:
        ahead, back = minus(row(X, i + 1), row(X, i)), minus(row(X, i), row(X, i - 1))
        way = over(minus(row(X, i + 1), row(X, i - 1)), 2.0)
        along = dot(far, way) / max(dot(way, way), TINY)
        slip -= 0.5 * along * along * dot(minus(ahead, back), across) + along * dot(way, across)
    return slip


@njit(cache=True)
def note_ways(turned, resist, before, state, least, step):
    """Note to which side each particle slipped in a step, by more than a least distance."""
    for i in range(1, len(turned) - 1):
        if not state.touching[i]:
            continue
        if not before.touching[i]:
            turned[i, 0] = turned[i, 1] = step
            continue
        d = slip_from(before, i, row(state.X, i), row(resist.across, i))
        if abs(d) > least:
            turned[i, 1 if d > 0.0 else 0] = step


@njit(cache=True)
def settle(rough, limits, fibre, track, steps, counters):
    """Balance a fibre at rest to the last, with friction from the earliest curve from which it slid one way only.

    Where that leads elsewhere friction holds it from where it lies.  Returns (residual, status, k), k being the number
    of that curve in the track, 0 for the starting curve.
    """
    state, n = fibre.state, len(fibre.state.X)
    rest, early, grip = blank(n), blank(n), blank_grip(n)
    copy(state, rest)
    length = energy(rest.X)[1]
    first, k = STALLED, 0
    for i in range(1, n - 1):
        if state.touching[i]:
            k = max(k, min(track.turned[i, 0], track.turned[i, 1]))
    left = np.inf
    if k < steps:
        quick = Limits(limits.pull_off, limits.tolerance, AT_ONCE)
        left, first = balance_from(rough, quick, fibre, track, k, counters)
        if first == NEEDS_TREE or (first != STALLED and largest_move(state.X, rest.X) <= SAME * length):
            return left, first, k
        copy(state, early)
        copy_grip(fibre.grip, grip)
        copy(rest, state)
    patient = Limits(limits.pull_off, limits.tolerance, min(limits.iterations, AT_LAST))
    residual, status = balance_from(rough, patient, fibre, track, steps, counters)
    if first == STALLED or status == NEEDS_TREE or largest_move(state.X, early.X) > SAME * length:
        return residual, status, steps
    copy(early, state)
    copy_grip(grip, fibre.grip)
    return left, first, k


@njit(cache=True)
def balance_from(rough, limits, fibre, track, k, counters):
    """Balance a fibre with friction from the curve on which it lay after k steps, 0 for the starting curve."""
    held = Fibre(fibre.state, fibre.grip, fibre.curve if k == 0 else track.lain[k])
    hold_all(held, rough.body.size)
    return relax_with_friction(rough, limits, held, counters)


@njit(cache=True)
def largest_move(X, before):
    """Largest distance between the particles of two states, across the fibre."""
    most = 0.0
    n = len(X)
    for i in range(1, n - 1):
        square = along = size = 0.0
        for k in range(3):
            way = X[i + 1, k] - X[i - 1, k]
            size += way * way
            along += way * (X[i, k] - before[i, k])
            square += (X[i, k] - before[i, k]) ** 2
        most = max(most, square - along * along / max(size, TINY))
    return np.sqrt(most)
