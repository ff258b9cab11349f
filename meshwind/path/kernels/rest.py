"""Frictionless paths with their certificates: relaxed, and given particles where the body needs them."""

import numpy as np

from meshwind.core.kernel import njit
from meshwind.path.kernels.certificate import DEEPEST, certify, leaps, turned
from meshwind.path.kernels.coulomb import RoughBody, coefficient
from meshwind.path.kernels.glide import spread_along
from meshwind.path.kernels.landing import land
from meshwind.path.kernels.mend import ROUNDS, UNSEEN, any_wanting, centre, mend, pin_beads, spread_stations
from meshwind.path.kernels.relax import relax
from meshwind.path.kernels.resist import farthest_slip, lay_down, press_anew, resistance
from meshwind.path.kernels.state import (
    CONVERGED,
    EVALUATIONS,
    NEEDS_TREE,
    STALLED,
    TOO_COARSE,
    UNSTABLE,
    Limits,
    blank,
    copy,
    no_contacts,
    put_on_surface,
    spring_energy,
    state_of,
)
from meshwind.path.kernels.survey import blank_survey, survey

MAX_LANDINGS = 4
"""Maximum number of times that a path is relaxed anew because its certificate finds a particle inside the body."""
PASSES, PRESSED = 8, 1e-6
"""Maximum number of times that contact forces are taken anew, and the change over the largest with which they count."""
NEAR = 3e-4
"""Longest slip over the length of a path that counts as at rest where it lay."""
BALANCE = 1e-8
"""Unbalanced force that short springs leave where particles stick: it is their round-off."""
EVEN = 3
"""Number of times that the springs' natural lengths are made even after particles were moved: each brings the pulls
closer to one another by the square of the fibre's bends."""
NO_FRICTION = np.zeros((1, 1))
"""Coefficients over a body without friction; of the same type as those of one with it."""
LEVELLED, SLOW = 20, 0.5
"""Maximum number of times that a path under friction is balanced anew until its springs pull alike, and the share that
each must leave at most of what was beyond the law for another to be made."""


@njit(nogil=True, cache=True)
def relax_all(first, last, body, limits, resume, final, batch):
    """Relax paths first to last of a batch: from their starting curves, or with `resume` from what the batch holds.

    Only a `final` answer pays for its certificate; others leave lower bounds of the gaps.
    """
    frames = np.empty((batch.uv.shape[1], 6, 3))
    for p in range(first, last):
        state, counters = state_of(batch, p, frames), batch.counters[p]
        if resume:
            restore_contact(body, state, counters)
        else:
            start_on_curve(body.spline, batch.starts[p], state, counters)
        batch.residual[p], batch.status[p] = relax_and_certify(body, limits, final, state, batch.required[p], counters)


@njit(cache=True)
def start_on_curve(spline, curve, state, counters):
    """Put a path on its starting curve (m, 2), evenly spaced by length."""
    uv = state.uv
    spread_along(spline, curve, uv, state.frames, counters)
    for i in range(len(uv)):
        put_on_surface(spline, state, i, uv[i, 0], uv[i, 1])
    counters[EVALUATIONS] += len(uv)


@njit(cache=True)
def relax_and_certify(body, limits, final, state, required, counters):
    """Relax a path and, if the answer is `final`, certify it, with particles where the body needs them.

    Writes the friction that each particle requires into required (n,); returns (residual, status).
    """
    start = blank(len(state.X))
    copy(state, start)
    rough, resist = frictionless(body)
    residual, status = settle(rough, resist, limits, final, state, required, counters)
    first = status
    for again in (False, True):  # from where it failed, then from where it started
        if status not in (UNSTABLE, STALLED):
            break
        if again:
            copy(start, state)
        if pin_where_needed(body, state, required, counters) > 0:
            residual, status = settle_evenly(rough, resist, limits, final, True, state, required, counters)
    if status not in (CONVERGED, NEEDS_TREE):
        return residual, first
    if not final or status != CONVERGED:
        return residual, status
    return resolve(rough, resist, limits, state, required, residual, counters)


@njit(cache=True)
def resolve(rough, resist, limits, state, required, residual, counters):
    """Give a path at rest particles where the body needs them, and say whether they resolve it; as `relax` returns."""
    body, n, status = rough.body, len(state.X), CONVERGED
    found = blank_survey(n)
    spacing = spring_energy(state)[1] / (n - 1)
    deep = survey(body, state, UNSEEN * spacing, found, counters)
    if any_wanting(found, spacing):
        best, least, left = blank(n), deep, residual
        copy(state, best)
        for _ in range(ROUNDS):
            if mend(body, state, found, spacing, counters) == 0:
                break
            residual, status = settle_evenly(rough, resist, limits, True, True, state, required, counters)
            if status != CONVERGED:
                break
            spacing = spring_energy(state)[1] / (n - 1)
            deep = survey(body, state, UNSEEN * spacing, found, counters)
            if deep <= least:
                copy(state, best)
                least, left = deep, residual
            elif least <= DEEPEST * spacing:  # it was better without
                break
            if not any_wanting(found, spacing):
                break
        if status != CONVERGED or deep > least:
            copy(best, state)
            certify(body, state, required, counters)
            deep, residual, status = least, left, CONVERGED
            spacing = spring_energy(state)[1] / (n - 1)
    if deep > DEEPEST * spacing or leaps(state, body.spline.periodic):
        return residual, TOO_COARSE
    return residual, status


@njit(cache=True)
def pin_where_needed(body, state, required, counters):
    """Pin what the springs draw off edges, and move particles to those that they have left; returns how many."""
    n = len(state.X)
    certify(body, state, required, counters)
    count, found = pin_beads(state, no_contacts(n)), blank_survey(n)
    spacing = spring_energy(state)[1] / (n - 1)
    survey(body, state, UNSEEN * spacing, found, counters)
    return count + mend(body, state, found, spacing, counters)


@njit(cache=True)
def settle_evenly(rough, resist, limits, final, centred, state, required, counters):
    """As `settle`, with equal pulls along the fibre.

    If `centred`, pinned particles move to the middle of what they rest on.
    """
    residual, status = np.inf, STALLED
    for _ in range(EVEN):
        residual, status = settle_evened(rough, resist, limits, final, centred, state, required, counters)
        if status != CONVERGED:
            break
    return residual, status


@njit(forceinline=True, cache=True)
def settle_evened(rough, resist, limits, final, centred, state, required, counters):
    """As `settle_evenly`, with springs made even once."""
    body, n = rough.body, len(state.X)
    contacts = no_contacts(n)
    released = spread_stations(state, limits.pull_off * spring_energy(state)[1] / (n - 1), contacts)
    if released > 0 and len(body.tree.levels) == 0:
        return np.inf, NEEDS_TREE
    if centred:
        centre(body, state, contacts, counters)
    return settle(rough, resist, limits, final, state, required, counters)


@njit(cache=True)
def level(rough, resist, limits, state, required, residual, counters):
    """Balance a path at rest, whose springs are uneven, until Coulomb's law holds; returns by how much it does not.

    The tension is the same all along the fibre, but the springs' pulls only become so, and what friction holds is that
    of the contact force before.
    """
    best = blank(len(state.X))
    copy(state, best)
    least = max(residual, beyond_law(rough, state))
    for _ in range(LEVELLED):
        if least <= BALANCE:
            break
        left, status = settle_evened(rough, resist, limits, True, False, state, required, counters)
        left = max(left, beyond_law(rough, state))
        if status != CONVERGED or left >= least:
            break
        copy(state, best)
        slow, least = left > SLOW * least, left
        if slow:
            break
    copy(best, state)
    certify(rough.body, state, required, counters)
    return least


@njit(cache=True)
def beyond_law(rough, state):
    """Largest turn of a path in the surface beyond what friction holds, in radians, away from the rims."""
    most = 0.0
    for i in range(1, len(state.X) - 1):
        u, v = state.uv[i, 0], state.uv[i, 1]
        if state.touching[i] and 0.0 < v < 1.0:
            mu, _, _ = coefficient(rough.friction, rough.body.spline.periodic, u, v)
            side, press = turned(state.X, state.normal, i)
            most = max(most, abs(side) - mu * max(press, 0.0))
    return most


@njit(cache=True)
def settle(rough, resist, limits, final, state, required, counters):
    """Relax a path; if the answer is `final`, what its certificate finds inside the body lands, and it is relaxed anew.

    Returns (residual, status).
    """
    inside = 0
    residual, status = np.inf, STALLED
    for _ in range(MAX_LANDINGS):
        residual, status = come_to_rest(rough, resist, limits, state, counters)
        if not final or status == NEEDS_TREE:
            return residual, status
        inside = certify(rough.body, state, required, counters)
        if inside == 0 or status != CONVERGED:
            break
    return residual, STALLED if status == CONVERGED and inside > 0 else status


@njit(cache=True)
def come_to_rest(rough, resist, limits, state, counters):
    """Relax a path against what resists a slip from where it lies now, with the contact forces of where it comes to.

    Where something resists, a path that slips far is not followed: that takes a slide.
    """
    if len(resist.bound) == 0:
        return relax(rough.body, limits, resist, state, counters)
    contacts = no_contacts(len(state.X))
    loose = Limits(limits.pull_off, max(limits.tolerance, BALANCE), limits.iterations)
    lay_down(resist, rough, state, contacts)
    residual, status = np.inf, STALLED
    for _ in range(PASSES):
        residual, status = relax(rough.body, loose, resist, state, counters)
        if status != CONVERGED:
            break
        largest = resist.bound.max()
        if press_anew(resist, rough, state, contacts) <= PRESSED * largest:
            break
    if status == CONVERGED and farthest_slip(resist, state) > NEAR * spring_energy(state)[1]:
        status = STALLED
    return residual, status


@njit(cache=True)
def frictionless(body):
    """A body without friction, and what resists a slip there: nothing."""
    return RoughBody(body, NO_FRICTION), resistance(0, 0.0, 0.0, 0.0)


@njit(cache=True)
def restore_contact(body, state, counters):
    """Complete a state of which positions, parameters and contacts are known; what is inside the body lands."""
    uv = state.uv
    for i in range(len(uv)):
        if state.touching[i]:
            put_on_surface(body.spline, state, i, uv[i, 0], uv[i, 1])
            counters[EVALUATIONS] += 1
        elif state.clear[i] <= 0.0:
            land(body, state.X, state, i, counters)
