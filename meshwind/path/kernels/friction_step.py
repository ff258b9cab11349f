"""One step of a path under friction: Newton's, shifted towards the force until the merit decreases."""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools
from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import fill
from meshwind.core.vectors import TINY
from meshwind.path.kernels.block_tridiagonal import GeneralSystem, general_system, solve_general
from meshwind.path.kernels.certificate import largest_leap
from meshwind.path.kernels.contact import link
from meshwind.path.kernels.coulomb import (
    STUCK,
    Balance,
    Fibre,
    Grip,
    balance_forces,
    blank_balance,
    blank_grip,
    slips,
)
from meshwind.path.kernels.glide import LONGEST_MOVE
from meshwind.path.kernels.grip import copy_grip, move_with_grip
from meshwind.path.kernels.jacobian import differentiate
from meshwind.path.kernels.landing import carry_lifted
from meshwind.path.kernels.relax import (
    BLIND_RISE,
    BLIND_SLOPE,
    DESCENT,
    SHIFT_UP,
)
from meshwind.path.kernels.state import (
    SOLVES,
    Contacts,
    energy,
    no_contacts,
)

SHORTEST = 1e-3
"""Share of a step below which a shift towards the force serves better."""
LARGEST_SHIFT = 1e6
"""Shift, in units of the springs' stiffness, with which the step is along the force and too short to matter."""
FAST_UP = 16.0
"""Factor of the shift after a step that did not count: less would repeat it."""
MAX_FAILURES = 6
"""Maximum number of steps that do not count before less is released: with `FAST_UP` they cover all shifts."""
CONVEX = 1e-3
"""Share of the smallest shift by which the balance must resist the step, lest this does not lead downhill."""
ALONE = 1e-3
"""Share of the unbalanced force below which particles that stick again were all that moved."""
BETTER = 0.5
"""Share of the least unbalanced force so far to which Newton's step must bring it where the energy misjudges it."""


class Workspace(NamedTuple):
    """Room for a step: contacts, balance and linear system, and the same for judging a trial.

    touched (n,): which particles touched when the step began; barred (n,): stuck ones that may not slip in this step.
    """

    contacts: Contacts
    balance: Balance
    system: GeneralSystem
    touched: Bools
    barred: Bools
    trial_contacts: Contacts
    trial_balance: Balance
    trial_grip: Grip


class Start(NamedTuple):
    """What a step starts from.

    energy: E; merit: E + sum mu N |d|; residual: the largest unbalanced force; best: the least so far, over the length;
    share: that of Newton's step which is tried first; most: the leap above which neighbours are on two sides; least:
    the smallest shift.
    """

    energy: float
    merit: float
    residual: float
    best: float
    share: float
    most: float
    least: float


class Direction(NamedTuple):
    """Slope of the merit along a step, the share of it that is tried first, and whether it is Newton's, unshifted."""

    slope: float
    first: float
    newton: bool


@njit(cache=True)
def workspace(n):
    """Room for the steps of n particles."""
    return Workspace(
        no_contacts(n), blank_balance(n), general_system(n), np.empty(n, np.bool_), np.zeros(n, np.bool_),
        no_contacts(n), blank_balance(n), blank_grip(n),
    )  # fmt: skip


@njit(forceinline=True, cache=True)
def take_step(rough, fibre, trial, work, count, start, shift, counters):
    """Shift Newton's step towards the force until it counts; meanwhile particles that would move the wrong way stick.

    Leaves the moved fibre in `trial`; returns whether the step counts, its shift, and the energy and length there.
    """
    contacts, balance, system = work.contacts, work.balance, work.system
    firm = np.bool_(False)  # whether released particles stay so; a literal would have callees compiled twice
    failures = 0
    while shift < LARGEST_SHIFT:
        counters[SOLVES] += 1
        if not solve_general(system, shift, count):
            shift = max(SHIFT_UP * shift, start.least)
            continue
        if stick_wrong(fibre.grip, contacts, balance, system.x, count, work.barred, firm) > 0:
            if firm:
                shift = max(SHIFT_UP * shift, start.least)
                continue
            _, left = balance_forces(rough, fibre, contacts, work.barred, balance)
            if left <= ALONE * start.residual:  # nothing else moves: let them go, but by a small step
                firm = True  # type: ignore[assignment]
                fill(work.barred, False)
                shift = max(FAST_UP * shift, start.least)
                balance_forces(rough, fibre, contacts, work.barred, balance)
            differentiate(rough, fibre, contacts, balance, system)
            continue
        slope, square, reach = measure_step(contacts.inner, balance.ways, system, count)
        if slope < CONVEX * start.least * square:  # no descent: shift towards the force
            shift = max(SHIFT_UP * shift, start.least)
            continue
        direction = Direction(slope, min(start.share, LONGEST_MOVE / max(reach, TINY)), shift == 0.0)
        accepted, then, length = line_search(rough, fibre, trial, work, count, start, direction, counters)
        if accepted:
            return True, shift, then, length
        failures += 1
        if failures > MAX_FAILURES:
            break
        shift = max(FAST_UP * shift, start.least)
    return False, shift, start.energy, 0.0


@njit(cache=True)
def stick_wrong(grip, contacts, balance, move, count, barred, firm):
    """Number of particles just released that the step moves against their pull; unless `firm` they stick again."""
    mode = grip.mode
    wrong = 0
    for c in range(count):
        i = contacts.inner[c]
        if slips(mode[i]) and balance.mu[i] > 0.0 and grip.offset[i] == 0.0 and move[c, 1] * mode[i] >= 0.0:
            wrong += 1
            if not firm:
                mode[i], barred[i] = np.int8(STUCK), True
    return wrong


@njit(cache=True)
def measure_step(inner, ways, system, count):
    """Slope of the merit along the step, its squared length, and the largest move in u or v."""
    right, move = system.right, system.x
    slope, square, reach = 0.0, 0.0, 0.0
    for c in range(count):
        i = inner[c]
        slope += right[c, 0] * move[c, 0] + right[c, 1] * move[c, 1]
        for a in range(2):
            square += move[c, a] ** 2
            way = move[c, 0] * ways[i, 0, a] + move[c, 1] * ways[i, 1, a]
            reach = max(reach, abs(way))
    return slope, square, reach


@njit(forceinline=True, cache=True)
def line_search(rough, fibre, trial, work, count, start, direction, counters):
    """Shorten the step until the merit falls and no neighbours leap too far.

    Writes the moved fibre into `trial`; returns whether the step counts, and the energy and length there.
    """
    body, slope, inner = rough.body, direction.slope, work.contacts.inner
    then, length = start.energy, 0.0
    step = direction.first
    while step > SHORTEST:
        move_with_grip(rough, step, fibre, trial, work, count, counters)
        carry_lifted(body, step, work.contacts, count, fibre.state, trial.state, counters)
        if largest_leap(trial.state, body.spline.periodic) > start.most:
            step *= 0.5
            continue
        then, length = energy(trial.state.X)
        price = merit_after(then, work.system.x, step, fibre.grip, trial.grip.mode, inner, work.balance, count)
        # below round-off the merit cannot judge a step, and Newton's is right
        blind = slope <= BLIND_SLOPE * start.energy and price <= start.merit * (1.0 + BLIND_RISE)
        if price <= start.merit - DESCENT * step * slope or blind:
            return True, then, length
        # near the answer the held N misjudges; there Newton's step is known by the balance it leaves
        if direction.newton and residual_after(rough, trial, work) < BETTER * start.best * length:
            return True, then, length
        step *= 0.5
    return False, then, length


@njit(cache=True)
def merit(now, grip, inner, balance, count):
    """E + sum mu N |d| over the slipping particles, E being `now`."""
    for c in range(count):
        i = inner[c]
        if slips(grip.mode[i]):
            now += balance.press[i] * balance.mu[i] * abs(grip.offset[i])
    return now


@njit(cache=True)
def merit_after(then, move, step, grip, trial_mode, inner, balance, count):
    """The merit after a step, E being `then`, with N and the excess F . t - R_t as they were before it."""
    for c in range(count):
        i = inner[c]
        then += step * move[c, 0] * balance.excess[i]
        if slips(grip.mode[i]) and trial_mode[i] != STUCK:
            then += balance.press[i] * balance.mu[i] * abs(grip.offset[i] + step * move[c, 1])
    return then


@njit(cache=True)
def residual_after(rough, trial, work):
    """Largest unbalanced force of a trial, whose grip stays as it is."""
    copy_grip(trial.grip, work.trial_grip)
    link(trial.state.touching, work.trial_contacts)
    spare = Fibre(trial.state, work.trial_grip, trial.curve)
    _, left = balance_forces(rough, spare, work.trial_contacts, work.barred, work.trial_balance)
    return left
