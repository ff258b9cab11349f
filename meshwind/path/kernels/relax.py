"""The taut path: projected Newton on the particles' energy in the parametric plane, with lifting and landing.

The fibre is n particles joined by zero-length springs (4.1); in equilibrium it minimises
E = 1/2 sum |P_{i+1} - P_i|^2 outside the body.  The implicit step (4.16) with a long time step is a Gauss-Newton step
on E; keeping the term F . s_uu as well makes it Newton's, and the time step lives on as a shift of the Hessian where
that is not positive definite.  Lifted particles are eliminated: they lie evenly on the chord between touching ones
(5.2).  Every iterate stays outside the body, and a step counts only if E falls, so that lifting and landing cannot
chatter.
"""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools
from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import copy_row
from meshwind.core.vectors import TINY
from meshwind.path.kernels.assembly import assemble
from meshwind.path.kernels.block_tridiagonal import SymmetricSystem, solve, symmetric_system
from meshwind.path.kernels.certificate import HALF_TURN, largest_leap
from meshwind.path.kernels.contact import DEEP, NOTHING, RIM, lift, release
from meshwind.path.kernels.glide import LONGEST_MOVE
from meshwind.path.kernels.landing import carry_lifted, sag
from meshwind.path.kernels.resist import (
    Resistance,
    choose_sides,
    fall,
    follow_contacts,
    slip_energy,
    stop_slip,
)
from meshwind.path.kernels.state import (
    CONVERGED,
    EVALUATIONS,
    ITERATIONS,
    LEFT_CHART,
    NEEDS_TREE,
    SLID_OFF_END,
    SLID_OFF_START,
    SOLVES,
    STALLED,
    UNSTABLE,
    Contacts,
    blank,
    copy,
    copy_particle,
    no_contacts,
    put_on_surface,
    spring_energy,
)

SMALLEST_STEP = 1e-7
"""Share of Newton's step below which no shorter one is tried."""
DESCENT = 1e-4
"""Armijo's share of the predicted decrease."""
BLIND_SLOPE, BLIND_RISE = 1e-13, 1e-12
"""Predicted decrease over the energy that round-off hides, and the increase over the energy that it may show."""
LEAST_SHIFT = 0.1
"""Smallest shift of the Hessian over the springs' smallest eigenvalue, about (pi / n)^2."""
SHIFT_UP, SHIFT_DOWN = 4.0, 0.25
"""Factors of the shift where the matrix is not definite, and after a step that counts: up fast, and down as fast."""
LEAP_MARGIN = 1.2
"""A path that leaps further than this times its leap at the start has gone through the body."""
MAX_LEANING = 60
"""Maximum number of steps in a row that a path may lean on a rim before it counts as slid off there."""
MAX_ESCAPES = 5
"""Maximum number of saddles that a path may leave."""
INVERSE_ITERATIONS = 8
"""Steps of the inverse iteration for the descending mode: its sign counts, not its digits."""
LOPSIDED = 0.1
"""Added to half a wave as the first guess of that mode, so that an antisymmetric mode is not orthogonal to it."""
ESCAPE_STEP = 0.03
"""Largest move in u or v along the descending mode: so long that the energy shows which side is lower."""


class Workspace(NamedTuple):
    """Contacts and linear system of the present step, and what resists a slip.

    touched (n,): which particles touched when the step began.
    """

    contacts: Contacts
    system: SymmetricSystem
    touched: Bools
    resist: Resistance


@njit(cache=True)
def relax(body, limits, resist, state, counters):
    """Bring a path to equilibrium from `state`, in place, against what resists a slip.

    Returns (residual, status): residual is the largest unbalanced force over the tension, an angle in radians.
    """
    trial = blank(len(state.X))
    residual, status, swapped = minimise(body, limits, resist, state, trial, counters)
    if swapped:
        copy(trial, state)
    return residual, status


@njit(cache=True)
def minimise(body, limits, resist, state, trial, counters):
    """As `relax`; where the third result says so the answer is left in `trial`."""
    n, periodic = len(state.X), body.spline.periodic
    swapped = False
    copy_row(state.station, trial.station)
    copy_row(state.pinned, trial.pinned)
    work = Workspace(no_contacts(n), symmetric_system(n), np.empty(n, np.bool_), resist)
    contacts, system = work.contacts, work.system
    shift, least = 0.0, LEAST_SHIFT * (np.pi / n) ** 2
    now, length = spring_energy(state)
    most = max(HALF_TURN, LEAP_MARGIN * largest_leap(state, periodic))
    residual = np.inf
    caution = np.int64(DEEP)  # a literal would have its callees compiled twice
    escapes = leant = 0
    for _ in range(limits.iterations):
        counters[ITERATIONS] += 1
        spacing = max(length, TINY) / (n - 1)
        slack = limits.pull_off * spacing
        for i in range(n):
            work.touched[i] = state.touching[i]
        released = release(state, slack, caution, contacts)
        if released > 0 and len(body.tree.levels) == 0:
            return residual, NEEDS_TREE, swapped
        count, force, leaning = assemble(state, periodic, resist, contacts, system, limits.tolerance * spacing)
        residual = max(force, sag(state.X, contacts.after, state.station)) / spacing
        if released == 0 and residual <= limits.tolerance:
            if caution == NOTHING and lift(state, slack, False, contacts) > 0:
                break  # in equilibrium but for pulls that no step could follow
            counters[SOLVES] += 1
            if len(resist.bound) or solve(system, 0.0, count):
                return residual, where_it_rests(state.uv, leaning, escapes > 0), swapped
            escapes += 1
            if escapes > MAX_ESCAPES or not escape_saddle(body, state, trial, work, count, least, counters):
                return residual, UNSTABLE, swapped
            state, trial, swapped = trial, state, not swapped
            now, length = spring_energy(state)
            continue
        leant = leant + 1 if leaning > 0 else 0
        if leant > MAX_LEANING:
            return residual, leaving_by(state.uv, leaning), swapped
        definite, shift = newton_step(resist, contacts.inner, system, count, shift, least, counters)
        if not definite:
            break
        accepted, then, length_then = line_search(body, most, count, now, state, trial, work, counters)
        if accepted:
            state, trial, swapped = trial, state, not swapped
            now, length = then, length_then
            if len(resist.bound):
                follow_contacts(resist, state, contacts.inner, count)
            caution = np.int64(DEEP)
            shift = SHIFT_DOWN * shift if shift > least else 0.0
        else:
            for i in range(n):
                state.touching[i] = work.touched[i]
            if caution == NOTHING:
                break
            caution += 1
    return residual, failure(state.uv, periodic), swapped


@njit(cache=True)
def newton_step(resist, inner, system, count, shift, least, counters):
    """Solve for the step, with the Hessian shifted until it is definite; returns whether it is, and the shift."""
    while shift < 1.0 / least:
        if len(resist.bound):
            definite = choose_sides(resist, inner, system, shift, count, counters)
        else:
            counters[SOLVES] += 1
            definite = solve(system, shift, count)
        if definite:
            return True, shift
        shift = max(SHIFT_UP * shift, least)
    return False, shift


@njit(cache=True)
def line_search(body, most, count, now, state, trial, work, counters):
    """Shorten the step until the energy, which is `now`, falls, and no neighbours leap further than `most`.

    Writes the moved path into `trial`; returns whether the step counts, the energy there and the length.
    """
    right, move, resist = work.system.right, work.system.x, work.resist
    slope = reach = 0.0
    start = now + slip_energy(resist, state.X, work.contacts.inner, count) if len(resist.bound) else now
    for c in range(count):
        slope += right[c, 0] * move[c, 0] + right[c, 1] * move[c, 1]
        reach = max(reach, abs(move[c, 0]), abs(move[c, 1]))
    if len(resist.bound):
        slope = fall(resist, work.contacts.inner, work.system, count)
    step = min(1.0, LONGEST_MOVE / max(reach, TINY))
    then, length = now, 0.0
    while step > SMALLEST_STEP:
        move_touching(body.spline, step, move, work, count, state, trial, counters)
        carry_lifted(body, step, work.contacts, count, state, trial, counters)
        if largest_leap(trial, body.spline.periodic) > most:  # neighbours on two sides: one went through the body
            step *= 0.5
            continue
        then, length = spring_energy(trial)
        cost = then + slip_energy(resist, trial.X, work.contacts.inner, count) if len(resist.bound) else then
        # below round-off the energy cannot judge a step, and Newton's is right
        blind = slope <= BLIND_SLOPE * start and cost <= start * (1.0 + BLIND_RISE)
        if cost <= start - DESCENT * step * slope or blind:
            return True, then, length
        step *= 0.5
    return False, then, length


@njit(cache=True)
def move_touching(spline, step, move, work, count, state, trial, counters):
    """Write into `trial` the touching particles moved on the surface by step * move (count, 2), and the two ends."""
    uv, inner, resist = state.uv, work.contacts.inner, work.resist
    n = len(uv)
    copy_particle(state, trial, 0)
    copy_particle(state, trial, n - 1)
    for c in range(count):
        i = inner[c]
        u, v = uv[i, 0] + step * move[c, 0], min(max(uv[i, 1] + step * move[c, 1], 0.0), 1.0)
        if not spline.periodic:
            u = min(max(u, 0.0), 1.0)
        put_on_surface(spline, trial, i, u, v)
        if len(resist.bound) and resist.bound[i] >= 0.0:
            stop_slip(resist, spline, trial, i, counters)
    counters[EVALUATIONS] += count


@njit(cache=True)
def escape_saddle(body, state, trial, work, count, least, counters):
    """Leave a saddle of the energy along its direction of most negative curvature, found by inverse iteration.

    Writes the lower of the two sides into `trial`; returns False where neither side is lower.
    """
    system, contacts = work.system, work.contacts
    metric = system.metric
    right, mode = np.empty((count, 2)), np.zeros((count, 2))
    modal = SymmetricSystem(system.diagonal, system.upper, metric, right, mode, system.inverse)
    for c in range(count):
        right[c, 0] = right[c, 1] = np.sin(np.pi * (c + 1.0) / (count + 1.0)) + LOPSIDED
    shift = least
    while True:
        counters[SOLVES] += 1
        if solve(modal, shift, count):
            break
        shift *= 2.0
        if shift > 1.0 / least:
            return False
    for _ in range(INVERSE_ITERATIONS):
        reach = _reach(mode)
        for c in range(count):
            x, y = mode[c, 0] / reach, mode[c, 1] / reach
            right[c, 0] = metric[c, 0] * x + metric[c, 1] * y
            right[c, 1] = metric[c, 1] * x + metric[c, 2] * y
        counters[SOLVES] += 1
        solve(modal, shift, count)
    reach = _reach(mode)
    for c in range(count):
        mode[c, 0], mode[c, 1] = mode[c, 0] / reach, mode[c, 1] / reach
    best = spring_energy(state)[0]
    chosen = 0.0
    for step in (ESCAPE_STEP, -ESCAPE_STEP):
        move_touching(body.spline, step, mode, work, count, state, trial, counters)
        carry_lifted(body, 0.0, contacts, count, state, trial, counters)
        then = spring_energy(trial)[0]
        if then < best:
            best, chosen = then, step
    if chosen > 0.0:  # the trial holds the other side
        move_touching(body.spline, chosen, mode, work, count, state, trial, counters)
        carry_lifted(body, 0.0, contacts, count, state, trial, counters)
    return chosen != 0.0


@njit(cache=True)
def _reach(mode):
    """Largest move of a particle along one of its directions."""
    reach = 0.0
    for c in range(len(mode)):
        reach = max(reach, abs(mode[c, 0]), abs(mode[c, 1]))
    return reach


@njit(cache=True)
def where_it_rests(uv, leaning, escaped):
    """Status of a path in stable equilibrium, of which particle `leaning` leans on a rim or edge (0: none does).

    A path that has escaped from a saddle to come there has no stable equilibrium of its own.
    """
    if leaning == 0:
        return CONVERGED
    return UNSTABLE if escaped else leaving_by(uv, leaning)


@njit(cache=True)
def failure(uv, periodic):
    """Status of a path that found no equilibrium: where it lies on a rim or hangs over it, or else STALLED."""
    for i in range(1, len(uv) - 1):
        if at_rim(uv[i, 1]) or (not periodic and at_rim(uv[i, 0])):
            return leaving_by(uv, i)
    return STALLED


@njit(cache=True)
def leaving_by(uv, i):
    """Where a path leaves whose particle i is held: over a rim, or an edge of a surface open in u."""
    if uv[i, 1] <= RIM:
        return SLID_OFF_START
    return SLID_OFF_END if uv[i, 1] >= 1.0 - RIM else LEFT_CHART


@njit(forceinline=True, cache=True)
def at_rim(v):
    """Whether v is on a rim, or u on an edge, of a surface that ends there."""
    return v <= RIM or v >= 1.0 - RIM
