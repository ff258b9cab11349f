"""The taut path: projected Newton on the particles' energy in the parametric plane, with lifting and landing.

The fibre is n particles joined by zero-length springs (4.1); at rest it minimises E = 1/2 sum |P_{i+1} - P_i|^2
outside the body.  The implicit step (4.16) with a long time step is a Gauss-Newton step on E; keeping the term
F . s_uu as well makes it Newton's.  Lifted particles are eliminated: they lie evenly on the chord between
touching ones (5.2).  Every iterate stays outside the body, and a step counts only if E falls, so that lifting
and landing cannot chatter.
"""

import numpy as np
from numba import njit, prange

from meshwind.path.block_tridiagonal import solve
from meshwind.path.contact import lift, lift_once, link, pull
from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV, S, frame, unit_normal
from meshwind.surface.foot import foot

CONVERGED, SLID_START, SLID_END, UNSTABLE, STALLED = range(5)
EVALUATIONS, FEET, SOLVES, ITERATIONS = range(4)

PULL = 1e-9
"""A pull off the surface below this angle (radians) is round-off, not lift."""
SINK = 1e-12
"""A particle deeper than this times the part's size has landed."""
SMALLEST_STEP = 1e-7


@njit(cache=True)
def _pins(uv, i, periodic, gu, gv):
    """Bit 1: u is held at the edge, bit 2: v is, because the force pushes outward there."""
    held = 0
    if not periodic and ((uv[i, 0] <= 0.0 and gu > 0.0) or (uv[i, 0] >= 1.0 and gu < 0.0)):
        held |= 1
    if (uv[i, 1] <= 0.0 and gv > 0.0) or (uv[i, 1] >= 1.0 and gv < 0.0):
        held |= 2
    return held


@njit(cache=True)
def _assemble(X, uv, frames, periodic, before, after, contacts, diagonal, upper, metric, right):
    """Newton's blocks for the touching particles; returns (their count, largest unbalanced force)."""
    n = len(X)
    force = np.empty(3)
    count = 0
    worst = 0.0
    held = 0
    i = after[0]
    while i < n - 1:
        contacts[count] = i
        pull(X, i, before[i], after[i], force)
        weight = 1.0 / (i - before[i]) + 1.0 / (after[i] - i)
        auu = auv = avv = fu = fv = fuu = fuv = fvv = 0.0
        for k in range(3):
            su, sv = frames[i, SU, k], frames[i, SV, k]
            auu += su * su
            auv += su * sv
            avv += sv * sv
            fu += force[k] * su
            fv += force[k] * sv
            fuu += force[k] * frames[i, SUU, k]
            fuv += force[k] * frames[i, SUV, k]
            fvv += force[k] * frames[i, SVV, k]
        metric[count, 0], metric[count, 1], metric[count, 2] = auu, auv, avv
        diagonal[count, 0] = weight * auu - fuu
        diagonal[count, 1] = weight * auv - fuv
        diagonal[count, 2] = weight * avv - fvv
        right[count, 0], right[count, 1] = fu, fv
        hold = _pins(uv, i, periodic, -fu, -fv)
        if count > 0:
            w = 1.0 / (i - before[i])
            p = before[i]
            for a in range(2):
                for b in range(2):
                    dot = 0.0
                    for k in range(3):
                        dot += frames[p, 1 + a, k] * frames[i, 1 + b, k]
                    if (held >> a) & 1 or (hold >> b) & 1:
                        dot = 0.0
                    upper[count - 1, a, b] = -w * dot
        if hold & 1:
            right[count, 0], diagonal[count, 0], diagonal[count, 1] = 0.0, weight * auu, 0.0
        if hold & 2:
            right[count, 1], diagonal[count, 2], diagonal[count, 1] = 0.0, weight * avv, 0.0
        if hold:
            metric[count, 1] = 0.0
        # |J^T F| in the tangent plane: F' G^-1 F, with the held directions left out
        det = metric[count, 0] * metric[count, 2] - metric[count, 1] ** 2
        if det > 0.0:
            ru, rv = right[count, 0], right[count, 1]
            size = (
                ru * ru * metric[count, 2] - 2.0 * ru * rv * metric[count, 1] + rv * rv * metric[count, 0]
            ) / det
            worst = max(worst, size)
        held = hold
        count += 1
        i = after[i]
    return count, np.sqrt(worst)


@njit(cache=True)
def _energy(X):
    total = 0.0
    length = 0.0
    for i in range(len(X) - 1):
        d = 0.0
        for k in range(3):
            d += (X[i + 1, k] - X[i, k]) ** 2
        total += d
        length += np.sqrt(d)
    return 0.5 * total, length


@njit(cache=True)
def _sag(X, touching, before, after):
    """Largest distance of a lifted particle from its even place on the chord."""
    worst = 0.0
    i, n = 0, len(X)
    while i < n - 1:
        j = after[i]
        for m in range(i + 1, j):
            t = (m - i) / (j - i)
            d = 0.0
            for k in range(3):
                d += (X[m, k] - (1.0 - t) * X[i, k] - t * X[j, k]) ** 2
            worst = max(worst, d)
        i = j
    return np.sqrt(worst)


@njit(cache=True)
def _move(net, periodic, size, step, move, contacts, count, state, trial, tally):
    """Write into `trial` the state after a step: touching particles on the surface, lifted ones towards the
    chord, and those that would sink landed on their feet."""
    X, uv, frames, normal, touching, clear = state
    Y, uw, frames_, normal_, touching_, clear_ = trial
    n = len(X)
    Y[0], Y[n - 1] = X[0], X[n - 1]
    uw[0], uw[n - 1] = uv[0], uv[n - 1]
    for c in range(count):
        i = contacts[c]
        u, v = uv[i, 0] + step * move[c, 0], min(max(uv[i, 1] + step * move[c, 1], 0.0), 1.0)
        if not periodic:
            u = min(max(u, 0.0), 1.0)
        uw[i, 0], uw[i, 1] = u, v
        frame(net, periodic, u, v, frames_[i])
        unit_normal(frames_[i], normal_[i])
        Y[i] = frames_[i, S]
        clear_[i] = 0.0
        touching_[i] = True
    tally[EVALUATIONS] += count
    i = 0
    c = 0
    while i < n - 1:
        j = contacts[c] if c < count else n - 1
        for m in range(i + 1, j):
            # carried along by its two touching neighbours, and by `step` towards the chord
            t = (m - i) / (j - i)
            moved = 0.0
            for k in range(3):
                chord = (1.0 - t) * X[i, k] + t * X[j, k]
                carried = (1.0 - t) * (Y[i, k] - X[i, k]) + t * (Y[j, k] - X[j, k])
                shift = carried + step * (chord - X[m, k])
                Y[m, k] = X[m, k] + shift
                moved += shift * shift
            room = clear[m] - np.sqrt(moved)
            touching_[m] = False
            uw[m] = uv[m]
            if room > 0.0:
                # the gap can shrink by no more than the particle moved: no foot point is needed
                clear_[m] = room
                frames_[m] = frames[m]
                normal_[m] = normal[m]
                continue
            tally[FEET] += 1
            tally[EVALUATIONS] += foot(net, periodic, Y[m], uw[m], frames_[m])
            unit_normal(frames_[m], normal_[m])
            gap = 0.0
            dist = 0.0
            for k in range(3):
                r = Y[m, k] - frames_[m, S, k]
                gap += r * normal_[m, k]
                dist += r * r
            if gap < -SINK * size:
                touching_[m] = True
                Y[m] = frames_[m, S]
                clear_[m] = 0.0
            else:
                clear_[m] = np.sqrt(dist)
        i = j
        c += 1


@njit(cache=True)
def _copy(source, target):
    target[0][:] = source[0]
    target[1][:] = source[1]
    target[2][:] = source[2]
    target[3][:] = source[3]
    target[4][:] = source[4]
    target[5][:] = source[5]


@njit(cache=True)
def _blank(n):
    return (
        np.zeros((n, 3)),
        np.zeros((n, 2)),
        np.zeros((n, 6, 3)),
        np.zeros((n, 3)),
        np.ones(n, np.bool_),
        np.zeros(n),
    )


@njit(cache=True)
def _place(net, periodic, state):
    """Put every particle on the surface at its uv."""
    X, uv, frames, normal, touching, clear = state
    for i in range(len(X)):
        frame(net, periodic, uv[i, 0], uv[i, 1], frames[i])
        unit_normal(frames[i], normal[i])
        X[i] = frames[i, S]
        touching[i] = True
        clear[i] = 0.0


@njit(cache=True)
def _even(X, uv):
    """Move the particles along the polyline uv so that they are evenly spaced by length in space."""
    n = len(X)
    s = np.zeros(n)
    for i in range(1, n):
        d = 0.0
        for k in range(3):
            d += (X[i, k] - X[i - 1, k]) ** 2
        s[i] = s[i - 1] + np.sqrt(d)
    old = uv.copy()
    j = 0
    for i in range(1, n - 1):
        want = s[n - 1] * i / (n - 1)
        while j < n - 2 and s[j + 1] < want:
            j += 1
        t = (want - s[j]) / max(s[j + 1] - s[j], 1e-300)
        uv[i, 0] = old[j, 0] + t * (old[j + 1, 0] - old[j, 0])
        uv[i, 1] = old[j, 1] + t * (old[j + 1, 1] - old[j, 1])


@njit(cache=True)
def relax(net, periodic, size, uv, tolerance, limit, tally):
    """Bring the path that starts as the curve uv (n, 2) on the surface to rest.

    Returns (state, residual, status): state is the tuple (X, uv, frames, normal, touching, clear) at rest and
    residual the largest unbalanced force over the tension (an angle in radians).
    """
    n = len(uv)
    state, trial = _blank(n), _blank(n)
    state[1][:] = uv
    _place(net, periodic, state)
    _even(state[0], state[1])
    _place(net, periodic, state)
    tally[EVALUATIONS] += 2 * n
    contacts = np.empty(n, np.int64)
    before, after = np.zeros(n, np.int64), np.zeros(n, np.int64)
    diagonal, upper = np.empty((n, 3)), np.empty((n, 2, 2))
    metric, right = np.empty((n, 3)), np.empty((n, 2))
    move, work = np.empty((n, 2)), np.empty((n, 3))
    shift, least = 0.0, 0.1 * (np.pi / n) ** 2
    kept = np.empty(n, np.bool_)
    energy, length = _energy(state[0])
    residual = np.inf
    caution = 0
    status = STALLED
    for _ in range(limit):
        tally[ITERATIONS] += 1
        spacing = length / (n - 1)
        X, uv_, frames, normal, touching, clear = state
        kept[:] = touching
        released = 0
        if caution == 0:
            released = lift(X, normal, touching, PULL * spacing, before, after)
        elif caution == 1:
            released = lift_once(X, normal, touching, PULL * spacing, before, after)
        else:
            link(touching, before, after)
        count, force = _assemble(
            X, uv_, frames, periodic, before, after, contacts, diagonal, upper, metric, right
        )
        residual = max(force, _sag(X, touching, before, after)) / spacing
        if released == 0 and residual <= tolerance:
            if caution == 2:
                touching[:] = kept
                if lift(X, normal, touching, PULL * spacing, before, after) > 0:
                    touching[:] = kept
                    break
            stable = solve(diagonal, upper, metric, 0.0, right, count, move, work)
            tally[SOLVES] += 1
            status = CONVERGED if stable else UNSTABLE
            break
        # the source's time step h in the form 1 / h^2: none while H is positive definite (a pure Newton step)
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
        step = min(1.0, 0.25 / max(reach, 1e-300))
        accepted = False
        while step > SMALLEST_STEP:
            _move(net, periodic, size, step, move, contacts, count, state, trial, tally)
            energy_, length_ = _energy(trial[0])
            # below round-off the energy cannot judge a step, and Newton's is right
            if energy_ <= energy - 1e-4 * step * slope or (
                slope <= 1e-13 * energy and energy_ <= energy * (1 + 1e-12)
            ):
                accepted = True
                break
            step *= 0.5
        if accepted:
            _copy(trial, state)
            energy, length = energy_, length_
            caution = 0
            shift = 0.25 * shift if shift > least else 0.0
        else:
            touching[:] = kept
            if caution == 2:
                break
            caution += 1
    for i in range(1, n - 1):
        if state[4][i] and status == CONVERGED:
            if state[1][i, 1] <= 0.0:
                status = SLID_START
            elif state[1][i, 1] >= 1.0:
                status = SLID_END
    return state, residual, status


@njit(parallel=True, cache=True)
def relax_all(
    net,
    periodic,
    size,
    curves,
    tolerance,
    limit,
    X,
    uv,
    touching,
    gap,
    normal,
    slip,
    residual,
    status,
    tallies,
):
    """Relax every curve (p, n, 2), one a thread, and write the results path by path."""
    for p in prange(len(curves)):
        state, residual[p], status[p] = relax(net, periodic, size, curves[p], tolerance, limit, tallies[p])
        finish(net, periodic, state, X[p], uv[p], touching[p], gap[p], normal[p], slip[p], tallies[p])


@njit(cache=True)
def finish(net, periodic, state, X, uv, touching, gap, normal, slip, tally):
    """Copy a state out, with true gaps of the lifted particles and the slip |kg| / kn of the touching ones."""
    n = len(X)
    X[:], uv[:], normal[:], touching[:] = state[0], state[1], state[3], state[4]
    slip[:] = np.nan
    at = np.empty((6, 3))
    for i in range(n):
        gap[i] = 0.0
        if not touching[i]:
            tally[FEET] += 1
            tally[EVALUATIONS] += foot(net, periodic, X[i], uv[i], at)
            unit_normal(at, normal[i])
            d = 0.0
            for k in range(3):
                d += (X[i, k] - at[S, k]) ** 2
            gap[i] = np.sqrt(d)
        elif 0 < i < n - 1:
            press = 0.0
            whole = 0.0
            along = 0.0
            span = 0.0
            for k in range(3):
                bend = X[i + 1, k] - 2.0 * X[i, k] + X[i - 1, k]
                chord = X[i + 1, k] - X[i - 1, k]
                press -= bend * normal[i, k]
                whole += bend * bend
                along += bend * chord
                span += chord * chord
            side = max(whole - press * press - along * along / max(span, 1e-300), 0.0)
            if press > 0.0:
                slip[i] = np.sqrt(side) / press
            else:
                slip[i] = 0.0
