"""The taut path under friction: Newton on Coulomb's law over sets of stuck and slipping particles, with contact.

In equilibrium the fibre minimises E + sum mu N_i |d_i|, where d_i is the lateral distance from the starting curve and
N_i the contact force of the answer itself.  Each step is Newton's on the exact balance, N and the fibre's turning
included; it counts only if E + sum mu N_i |d_i| falls with N_i held at the step's start, and is shifted towards the
force until it does.  A particle that would cross the starting curve sticks there.  Contact comes first: friction
holds only where the surface presses.
"""

import numpy as np

from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import fill
from meshwind.core.vectors import TINY
from meshwind.path.kernels.certificate import HALF_TURN, certify, largest_leap
from meshwind.path.kernels.contact import DEEP, NOTHING, lift, release
from meshwind.path.kernels.coulomb import (
    HELD,
    Fibre,
    Grip,
    balance_forces,
    blank_grip,
)
from meshwind.path.kernels.friction_step import Start, merit, take_step, workspace
from meshwind.path.kernels.grip import attach_to_curve, copy_grip, hold_all, hold_landed, restore_grip
from meshwind.path.kernels.jacobian import differentiate
from meshwind.path.kernels.landing import sag
from meshwind.path.kernels.relax import (
    LEAP_MARGIN,
    LEAST_SHIFT,
    SHIFT_DOWN,
    failure,
)
from meshwind.path.kernels.resist import ROOM, resistance
from meshwind.path.kernels.rest import MAX_LANDINGS, level, pin_where_needed, resolve, restore_contact, settle_evenly
from meshwind.path.kernels.state import (
    CONVERGED,
    ITERATIONS,
    NEEDS_TREE,
    SLID_OFF_END,
    SLID_OFF_START,
    STALLED,
    blank,
    copy,
    energy,
    state_of,
)

RESTART = 60
"""Number of steps after which a path that does not settle goes in circles: its active set is chosen anew."""
SHORT, CALM = 1.0 / 16.0, 1e-4
"""Least share of Newton's step that is tried first, which is halved at every restart; unbalanced force below which
whole steps are tried again."""


@njit(cache=True)
def relax_with_friction(rough, limits, fibre, counters):
    """Bring a path that touches as its state and grip say to equilibrium under friction, in place.

    Returns (residual, status) as `relax` does.
    """
    body, state, grip = rough.body, fibre.state, fibre.grip
    periodic, n = body.spline.periodic, len(state.X)
    trial = Fibre(blank(n), blank_grip(n), fibre.curve)
    work = workspace(n)
    least = LEAST_SHIFT * (np.pi / n) ** 2
    shift, stride = 0.0, 1.0
    now, length = energy(state.X)
    most = max(HALF_TURN, LEAP_MARGIN * largest_leap(state, periodic))
    residual = best = np.inf
    caution = np.int64(DEEP)  # a literal would have its callees compiled twice
    for turn in range(limits.iterations):
        counters[ITERATIONS] += 1
        if turn % RESTART == RESTART - 1:
            restore_grip(body.spline, fibre, body.size, counters)
            shift, best = 0.0, np.inf
            stride = max(0.5 * stride, SHORT)
            now, length = energy(state.X)
        spacing = max(length, TINY) / (n - 1)
        slack = limits.pull_off * spacing
        for i in range(n):
            work.touched[i] = state.touching[i]
        released = release(state, slack, caution, work.contacts)
        if released > 0 and len(body.tree.levels) == 0:
            return residual, NEEDS_TREE
        fill(work.barred, False)
        changed, force = balance_forces(rough, fibre, work.contacts, work.barred, work.balance)
        residual = max(force, sag(state.X, work.contacts.after, state.station)) / spacing
        if released == 0 and changed == 0 and residual <= limits.tolerance:
            if caution == NOTHING and lift(state, slack, False, work.contacts) > 0:
                break
            return residual, where_it_leans(state.uv, grip.mode, work.contacts.after)
        count = differentiate(rough, fibre, work.contacts, work.balance, work.system)
        best = min(best, force / length)
        share = stride if residual > CALM else 1.0
        start = Start(now, merit(now, grip, work.contacts.inner, work.balance, count), force, best, share, most, least)
        accepted, shift, then, length_then = take_step(rough, fibre, trial, work, count, start, shift, counters)
        if accepted:
            hold_landed(fibre, trial, body.size)
            copy(trial.state, state)
            copy_grip(trial.grip, grip)
            now, length = then, length_then
            caution = np.int64(DEEP)
            shift = SHIFT_DOWN * shift if shift > least else 0.0
        else:
            for i in range(n):
                state.touching[i] = work.touched[i]
            shift = 0.0
            if caution == NOTHING:
                break
            caution += 1
    return residual, failure(state.uv, periodic)


@njit(cache=True)
def where_it_leans(uv, mode, after):
    """Status of a path in equilibrium: which rim it leans on, if any."""
    i = after[0]
    while i < len(uv) - 1:
        if mode[i] == HELD:
            return SLID_OFF_START if uv[i, 1] <= 0.5 else SLID_OFF_END
        i = after[i]
    return CONVERGED


@njit(nogil=True, cache=True)
def relax_all_with_friction(first, last, rough, limits, resume, final, batch):
    """Relax paths first to last of a batch under friction: from their starting curves, or with `resume` as they are.

    Only a `final` answer pays for its certificate; others leave lower bounds of the gaps.
    """
    n = batch.uv.shape[1]
    body = rough.body
    frames, offset = np.zeros((n, 6, 3)), np.zeros(n)
    for p in range(first, last):
        counters = batch.counters[p]
        fibre = Fibre(state_of(batch, p, frames), Grip(batch.anchor[p], offset, batch.mode[p]), batch.starts[p])
        if resume:
            restore_contact(body, fibre.state, counters)
            restore_grip(body.spline, fibre, body.size, counters)
        else:
            attach_to_curve(body.spline, fibre, counters)
        required, stalled = batch.required[p], resume and batch.status[p] == STALLED
        residual, status = certified_with_friction(rough, limits, final, resume, stalled, fibre, required, counters)
        batch.residual[p], batch.status[p] = residual, status


@njit(forceinline=True, cache=True)
def certified_with_friction(rough, limits, final, resume, stalled, fibre, required, counters):
    """As `relax_and_certify`, under friction.

    A path that has been at rest, or whose slide `stalled`, slides on from where it lay: over what only its particles of
    now meet, and where Newton's method fails.
    """
    body, state = rough.body, fibre.state
    before = blank(len(state.X))
    if final:
        copy(state, before)
    inside = 0
    residual, status = np.inf, STALLED
    for _ in range(0 if stalled else MAX_LANDINGS):
        residual, status = relax_with_friction(rough, limits, fibre, counters)
        if not final or status == NEEDS_TREE:
            return residual, status
        inside = certify(body, state, required, counters)
        if inside == 0 or status != CONVERGED:
            break
        restore_grip(body.spline, fibre, body.size, counters)
    if status == CONVERGED and inside > 0:
        status = STALLED
    if status != CONVERGED and not (resume and final and limits.iterations > 0):
        return residual, status
    resist = resistance(len(state.X), 0.0, ROOM * energy(before.X)[1], 0.0)
    anew = status != CONVERGED
    if anew:
        first = status
        copy(before, state)
        pin_where_needed(body, state, required, counters)
        residual, status = settle_evenly(rough, resist, limits, final, True, state, required, counters)
        if status != CONVERGED:
            return residual, status if status == NEEDS_TREE else first
    residual, status = resolve(rough, resist, limits, state, required, residual, counters)
    if anew or state.pinned.any():
        if status == CONVERGED:
            residual = level(rough, resist, limits, state, required, residual, counters)
        hold_all(fibre, body.size)
    return residual, status
