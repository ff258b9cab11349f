"""One Newton step of the touching particles: its blocks, and the trial state it leads to."""

import numpy as np
from numba import njit

from meshwind.path.kernels.contact import pull
from meshwind.path.kernels.state import copy_lifted, copy_particle, touch_down
from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV, S, unit_normal
from meshwind.surface.tree import nearest_foot

EVALUATIONS, FEET, SOLVES, ITERATIONS = range(4)
"""Places of a path's counters."""

MOST_STEPS = 200
"""Steps in which a particle is followed around the body."""
SINK = 1e-12
"""A particle deeper than this times the part's size has landed."""


@njit(cache=True)
def held(uv, i, periodic, fu, fv):
    """Bit 1: the force pushes particle i out over an edge in u; bit 2: out over a rim in v."""
    bits = 0
    if not periodic and ((uv[i, 0] <= 0.0 and fu < 0.0) or (uv[i, 0] >= 1.0 and fu > 0.0)):
        bits |= 1
    if (uv[i, 1] <= 0.0 and fv < 0.0) or (uv[i, 1] >= 1.0 and fv > 0.0):
        bits |= 2
    return bits


@njit(cache=True)
def assemble(state, periodic, before, after, contacts, diagonal, upper, metric, right):
    """Hessian and force of the energy over the touching particles (5.2) in the parametric plane.

    The diagonal block is J'J's share of (4.16) less F . s_ab, which makes the step Newton's.  Returns the number
    of blocks, the largest unbalanced force in the tangent plane, and the last particle held at a rim or edge (0: none).
    """
    X, uv, frames = state[0], state[1], state[2]
    n = len(X)
    force = np.empty(3)
    count = 0
    worst = 0.0
    last = leaning = 0
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
        bits = held(uv, i, periodic, fu, fv)
        diagonal[count, 0] = weight * auu - fuu
        diagonal[count, 1] = weight * auv - fuv
        diagonal[count, 2] = weight * avv - fvv
        if count > 0:
            p = before[i]
            for a in range(2):
                for b in range(2):
                    dot = 0.0
                    if not ((last >> a) & 1 or (bits >> b) & 1):
                        for k in range(3):
                            dot -= frames[p, SU + a, k] * frames[i, SU + b, k]
                    upper[count - 1, a, b] = dot / (i - p)
        if bits:  # a held direction drops out of the system
            leaning = i
            auv = 0.0
            diagonal[count, 1] = 0.0
            if bits & 1:
                fu = 0.0
                diagonal[count, 0] = weight * auu
            if bits & 2:
                fv = 0.0
                diagonal[count, 2] = weight * avv
        metric[count, 0], metric[count, 1], metric[count, 2] = auu, auv, avv
        right[count, 0], right[count, 1] = fu, fv
        det = auu * avv - auv * auv
        if det > 0.0:
            worst = max(worst, (fu * fu * avv - 2.0 * fu * fv * auv + fv * fv * auu) / det)
        last = bits
        count += 1
        i = after[i]
    return count, np.sqrt(worst), leaning


@njit(cache=True)
def move_touching(spline, step, move, contacts, count, state, trial, tally):
    """Write into `trial` the touching particles moved on the surface by step * move (count, 2), and the two ends."""
    uv = state[1]
    n = len(uv)
    copy_particle(state, trial, 0)
    copy_particle(state, trial, n - 1)
    for c in range(count):
        i = contacts[c]
        u, v = uv[i, 0] + step * move[c, 0], min(max(uv[i, 1] + step * move[c, 1], 0.0), 1.0)
        if not spline.periodic:
            u = min(max(u, 0.0), 1.0)
        touch_down(spline, trial, i, u, v)
    tally[EVALUATIONS] += count


@njit(cache=True)
def carry_lifted(body, step, contacts, count, state, trial, tally):
    """Write into `trial` the lifted particles, so that none is inside the body.

    They are carried along by their two touching neighbours, which `trial` already holds, and drawn towards the
    chord; those that would sink land on their feet (section 5.3).
    """
    X, clear = state[0], state[5]
    Y = trial[0]
    i = 0
    for c in range(count + 1):
        j = contacts[c] if c < count else len(X) - 1
        for m in range(i + 1, j):
            t = (m - i) / (j - i)
            copy_lifted(state, trial, m)
            moved = 0.0
            for k in range(3):
                chord = (1.0 - t) * X[i, k] + t * X[j, k]
                carried = (1.0 - t) * (Y[i, k] - X[i, k]) + t * (Y[j, k] - X[j, k])
                shift = carried + step * (chord - X[m, k])
                Y[m, k] += shift
                moved += shift * shift
            trial[4][m] = False
            trial[5][m] = clear[m] - np.sqrt(moved)
            # the gap shrinks by no more than the particle moved: mostly no foot point is needed
            if trial[5][m] <= 0.0:
                land(body, X, trial, m, tally)
        i = j


@njit(cache=True)
def land(body, X, trial, m, tally):
    """Find the foot of lifted particle m, which comes from X[m]; let it touch there if it has sunk (Algorithm 2).

    Else its gap is noted.  A particle whose foot is on a side that faces the other way may have gone through the
    body: its way is then followed, and it touches where it went in.
    """
    Y, uv, frames, normal, touching, clear = trial
    facing = np.empty(3)
    for k in range(3):
        facing[k] = normal[m, k]
    u, v = uv[m, 0], uv[m, 1]
    height, gap = measure_gap(body, trial, m, tally)
    sunk = height < -SINK * body.size
    turned = 0.0
    for k in range(3):
        turned += facing[k] * normal[m, k]
    if not sunk and turned < 0.0:
        sunk = follow(body, X[m], u, v, trial, m, tally)
    touching[m] = sunk
    clear[m] = 0.0 if sunk else gap
    if sunk:
        for k in range(3):
            Y[m, k] = frames[m, S, k]


@njit(cache=True)
def measure_gap(body, trial, m, tally):
    """Height of particle m over its nearest foot, along the normal there, and its distance from it."""
    Y, uv, frames, normal = trial[0], trial[1], trial[2], trial[3]
    tally[FEET] += 1
    tally[EVALUATIONS] += nearest_foot(body, Y[m], uv[m], frames[m])
    unit_normal(frames[m], normal[m])
    height = 0.0
    square = 0.0
    for k in range(3):
        r = Y[m, k] - frames[m, S, k]
        height += r * normal[m, k]
        square += r * r
    return height, np.sqrt(square)


@njit(cache=True)
def follow(body, start, u, v, trial, m, tally):
    """Follow particle m from `start`, whose foot is near (u, v), to where it is; whether it meets the body.

    Each step is as long as the gap, so that none leaps over a thin part.  Leaves the foot where it goes in, or that
    of its goal.
    """
    Y, uv = trial[0], trial[1]
    goal = np.empty(3)
    way = 0.0
    for k in range(3):
        goal[k] = Y[m, k]
        way += (goal[k] - start[k]) ** 2
    way = np.sqrt(way)
    goal_u, goal_v = uv[m, 0], uv[m, 1]
    uv[m, 0], uv[m, 1] = u, v
    t = 0.0
    met = False
    for _ in range(MOST_STEPS):
        for k in range(3):
            Y[m, k] = start[k] + t * (goal[k] - start[k])
        height, gap = measure_gap(body, trial, m, tally)
        if height < -SINK * body.size:
            met = True
            break
        t += max(gap, 1e-3 * body.size) / max(way, 1e-300)
        if t >= 1.0:
            break
    for k in range(3):
        Y[m, k] = goal[k]
    if not met:
        uv[m, 0], uv[m, 1] = goal_u, goal_v
        measure_gap(body, trial, m, tally)
    return met


@njit(cache=True)
def sag(X, after):
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
