"""Particles where the body needs them: one of them moves to each place where a segment passes inside.

A rib between two particles, or an edge, is met by no particle that stands where an even spacing puts it.  One moves
there, and is pinned: as it is tied to the fibre the springs would draw it off the rib, over which a fibre slides.  They
are given natural lengths as the fibre then lies, so that they pull alike all along.
"""

import numpy as np

from meshwind.core.kernel import njit
from meshwind.core.vectors import TINY
from meshwind.path.kernels.contact import lift, link
from meshwind.path.kernels.geometry import combine, derivative, dot, minus, row, second_form, times, to_parameters
from meshwind.path.kernels.state import EVALUATIONS, distance, move_particle, put_on_surface
from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV, spans_of

NOTICED, ALONE = 0.02, 1.5
"""A segment is mended that the surface stands out of by more than this share of the particles' mean distance, and than
so many times the sum of what it stands out of the two segments next to it: an even turn needs no mending."""
UNSEEN = NOTICED / (2.0 * ALONE)
"""What the surface stands out by, over the same, that changes nothing in which segments are mended."""
SHORTEST = 1e-3
"""Least distance of neighbours, over their mean, that counts for the springs."""
STIFF = 0.5
"""Share of the springs' stiffness from which what presses a particle draws it off, for a state not quite at rest."""
CENTRED, FURTHEST = 3, 0.5
"""Steps of Newton's method to where a pinned particle stands out furthest, and the longest of them in spans."""
ROUNDS = 8
"""Maximum number of times that particles are moved."""


@njit(cache=True)
def wanting(found, i, spacing):
    """Whether segment i wants a particle where the surface stands out of it."""
    rise = found.rise
    before = rise[i - 1] if i > 0 else 0.0
    after = rise[i + 1] if i + 2 < len(rise) else 0.0
    return rise[i] > NOTICED * spacing and rise[i] > ALONE * (before + after)


@njit(cache=True)
def any_wanting(found, spacing):
    """Whether any segment wants a particle."""
    count = 0
    for i in range(len(found.rise) - 1):
        count += wanting(found, i, spacing)
    return count > 0


@njit(cache=True)
def mend(body, state, found, spacing, counters):
    """Move a particle to each place where a segment wants one, and pin it there; returns how many were moved."""
    uv, n = state.uv, len(state.uv)
    moved = 0
    i = 0
    while i < n - 1:
        step = 1
        if wanting(found, i, spacing):
            t = found.at[i]
            u, v = (1.0 - t) * uv[i, 0] + t * uv[i + 1, 0], (1.0 - t) * uv[i, 1] + t * uv[i + 1, 1]
            k = make_room(state, i, t)
            if k > 0:
                put_on_surface(body.spline, state, k, u, v)
                counters[EVALUATIONS] += 1
                state.pinned[k] = True
                moved += 1
                step = 2  # the next segment is another now
        i += step
    return moved


@njit(cache=True)
def pin_beads(state, contacts):
    """Pin particles that the springs draw off what they rest on, as beads, though a fibre would rest there.

    The pull that presses one on the surface, times the surface's curvature along the fibre, is then more than the
    springs' stiffness.  Returns how many are pinned that were not.
    """
    X, touching, pinned, normal, frames = state.X, state.touching, state.pinned, state.normal, state.frames
    link(touching, contacts)
    count = 0
    for i in range(1, len(touching) - 1):
        if not touching[i] or pinned[i]:
            continue
        back, ahead = minus(row(X, i), row(X, contacts.before[i])), minus(row(X, contacts.after[i]), row(X, i))
        p, q = 1.0 / max(np.sqrt(dot(back, back)), TINY), 1.0 / max(np.sqrt(dot(ahead, ahead)), TINY)
        n = row(normal, i)
        press = dot(combine(p, back, -q, ahead), n)
        if not press > 0.0:
            continue
        way = combine(p, back, q, ahead)
        rate = to_parameters(derivative(frames, i, SU), derivative(frames, i, SV), way)
        form = (
            dot(derivative(frames, i, SUU), n),
            dot(derivative(frames, i, SUV), n),
            dot(derivative(frames, i, SVV), n),
        )
        bend = -second_form(form, rate, rate) / max(dot(way, way), TINY)
        if press * bend > STIFF * (p + q):
            pinned[i] = True
            count += 1
    return count


@njit(cache=True)
def make_room(state, i, t):
    """The particle that may move into segment i at share t of it, after those on the way have made room; 0 if none."""
    pinned = state.pinned
    n = len(pinned)
    for reach in range(n):
        low, high = i - reach, i + 1 + reach
        for k in (low, high) if t < 0.5 else (high, low):
            if 0 < k < n - 1 and not pinned[k]:
                if k <= i:
                    for m in range(k, i):
                        move_particle(state, m + 1, state, m)
                        pinned[m] = pinned[m + 1]
                    return i
                for m in range(k, i + 1, -1):
                    move_particle(state, m - 1, state, m)
                    pinned[m] = pinned[m - 1]
                return i + 1
    return 0


@njit(cache=True)
def centre(body, state, contacts, counters):
    """Move each pinned particle along the fibre to where the surface stands out furthest of the chord over it."""
    X, uv, frames = state.X, state.uv, state.frames
    spans_u, spans_v = spans_of(body.spline.net)
    for i in range(1, len(uv) - 1):
        if not (state.pinned[i] and state.touching[i]):
            continue
        p, q = contacts.before[i], contacts.after[i]
        for _ in range(CENTRED):
            way = minus(row(X, q), row(X, p))
            size = dot(way, way)
            out = row(state.normal, i)
            out = minus(out, times(dot(out, way) / max(size, TINY), way))
            su, sv = derivative(frames, i, SU), derivative(frames, i, SV)
            du, dv = to_parameters(su, sv, way)
            span = max(abs(du) * spans_u, abs(dv) * spans_v)
            if not span > 0.0:
                break
            du, dv = du / span, dv / span
            slope = du * dot(su, out) + dv * dot(sv, out)
            bend = du * du * dot(derivative(frames, i, SUU), out) + dv * dv * dot(derivative(frames, i, SVV), out)
            bend += 2.0 * du * dv * dot(derivative(frames, i, SUV), out)
            if not bend < 0.0:
                break
            step = min(max(-slope / bend, -FURTHEST), FURTHEST)
            u, v = uv[i, 0] + step * du, min(max(uv[i, 1] + step * dv, 0.0), 1.0)
            put_on_surface(body.spline, state, i, u, v)
            counters[EVALUATIONS] += 1


@njit(cache=True)
def spread_stations(state, slack, contacts):
    """Set the particles' stations to where they are along the fibre, the whole being n - 1.

    The fibre is that between touching particles, without those that it pulls off the surface; lifted ones are even.
    Returns how many it pulled off.
    """
    X, station = state.X, state.station
    n = len(X)
    released = lift(state, slack, True, contacts)
    total = 0.0
    for i in range(n - 1):
        total += distance(X, i, i + 1)
    least = SHORTEST * total / (n - 1)
    station[0] = 0.0
    i = 0
    while i < n - 1:
        j = contacts.after[i]
        step = max(distance(X, i, j) / (j - i), least)
        for m in range(i + 1, j + 1):
            station[m] = station[i] + (m - i) * step
        i = j
    scale = (n - 1) / station[n - 1]
    for i in range(n):
        station[i] *= scale
    return released
