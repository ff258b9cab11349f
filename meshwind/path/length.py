"""The length of a fibre from its particles, of fourth order where the polyline's is second, and what it may be off by.

The chord c of an arc of curvature k is shorter than it by c^3 k^2 / 24.  The fibre in equilibrium is the shortest, or
all but, so that its length forgives the particles' own error, which is of second order: what is left is of the fourth.
A bridge is straight from where it truly leaves the surface, between particles, to where it comes back.  Where the
surface between two particles is not as even as their neighbours say, the polyline counts, and what the surface stands
out of it is the error.
"""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Floats, frozen
from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import copy_row
from meshwind.core.threads import parallel_for
from meshwind.core.vectors import TINY
from meshwind.path.kernels.geometry import dot, minus, row
from meshwind.path.kernels.state import EVALUATIONS, FEET, State, distance
from meshwind.path.kernels.survey import blank_survey, seen, survey
from meshwind.path.kernels.touchdown import touchdown
from meshwind.surface.evaluate import S, frame
from meshwind.surface.surface import Surface
from meshwind.surface.tree import nearest_foot

UNEVEN = 0.5
"""Share by which the surface may stand out of a segment more or less than of an even arc, and by which the curvature
may change along it, to count as one."""
DETOUR = 4.0
"""Longest way round what stands out of the middle half of a segment, over its square by the segment, with a margin."""
ROUNDED = 1e-3
"""What its ends may add to a bridge, as a share of its length, beyond the longest way round what stands out of it."""
SHARE, GAP, AT_U, AT_V, FOOT, POINT = 0, 1, 2, 3, 4, 7
"""Columns of a point of a segment: where on it, its gap, and its foot; and their number."""
CLOSE_ENOUGH = 0.01
"""How far above the largest gap found a bound of others may be, over the segment."""
DEEPEST_HALF = 12
"""Maximum number of times that a segment is halved."""
LANDED = 0.5
"""Share of what the true ends of a bridge change its length by that is left as an error, as of the arc before them: the
fibre may leave it sooner, and how it bends where it ends is not known.  What a step leaves of its slope comes on top:
there the surface bends otherwise than at the particle."""
EXPLAINED = 3.0
"""Longest way round the arc on which a bridge lands, over what that adds to its length: 1.5, with a margin of two."""
BETWEEN_SAMPLES = 1.25
"""Largest distance of the surface from a segment over its largest rise at samples: an even bow is an eighth higher in
its middle than at its thirds, and under a surface that bows aside one of 1,111 paths lay 15 % deeper."""


class Laid(NamedTuple):
    """Fibres with particles points (p, n, 3), at or above uv (p, n, 2), with gaps (p, n) and normals (p, n, 3)."""

    points: Floats
    uv: Floats
    touching: Bools
    gap: Floats
    normal: Floats


class Measured(NamedTuple):
    """Of p fibres: length, its error, and the largest distance of the fibre from its polyline (p,)."""

    length: Floats
    error: Floats
    off: Floats


@njit(cache=True)
def bend(X, i):
    """Curvature of the fibre at particle i, squared, from the turn of its chords."""
    before, after = max(distance(X, i, i - 1), TINY), max(distance(X, i + 1, i), TINY)
    square = 0.0
    for k in range(3):
        square += ((X[i + 1, k] - X[i, k]) / after - (X[i, k] - X[i - 1, k]) / before) ** 2
    return (2.0 * np.sqrt(square) / (before + after)) ** 2  # where three coincide the square of TINY would be 0


@njit(cache=True)
def run_length(X, normal, first, last, rise):
    """Length of the fibre on the surface from particle `first` to `last`, all of which touch, and its error."""
    total = error = 0.0
    for i in range(first, last):
        chord = distance(X, i, i + 1)
        # curvature is known inside the run, and taken from its neighbour at the run's ends
        a, b = max(i, first + 1), min(i + 1, last - 1)
        k2 = 0.5 * (bend(X, a) + bend(X, b)) if last - first > 1 else 0.0
        change = abs(np.sqrt(bend(X, a)) - np.sqrt(bend(X, b))) if last - first > 1 else 0.0
        arc = chord * chord * chord * k2 / 24.0
        even = 0.125 * chord * chord * np.sqrt(k2)
        odd = abs(rise[i] - even)
        if odd <= UNEVEN * even and change <= UNEVEN * np.sqrt(k2):
            total += chord + arc
            error += 2.0 * arc * odd / max(even, TINY)
            if (i == first and first > 0) or (i + 1 == last and last < len(X) - 1):
                error += LANDED * arc
        else:
            total += chord
            error += detour(X, normal, i, chord, rise[i])
    return total, error


@njit(cache=True)
def detour(X, normal, i, chord, rise):
    """Longest way round what stands out of segment i by `rise`: twice that, or less where little turns."""
    turn = 0.0
    for j in range(max(i, 1), min(i + 2, len(X) - 1)):
        turn = max(turn, np.sqrt(bend(X, j)) * 0.5 * (distance(X, j, j - 1) + distance(X, j + 1, j)))
    facing = 0.0
    for k in range(3):
        facing += (normal[i + 1, k] - normal[i, k]) ** 2
    turn = max(turn, np.sqrt(facing))
    return min(max(DETOUR * rise / max(chord, TINY), 0.5 * turn), 2.0) * rise


def measured(surface: Surface, laid: Laid) -> Measured:
    """Measure fibres, in the surface's units."""
    length, error, off = (np.empty(len(laid.points)) for _ in range(3))
    centred = surface.centred
    body = centred.body_without_tree if laid.touching.all() else centred.body
    # copies, as kernels are compiled anew for read-only arrays
    points = laid.points - surface.middle
    there = Laid(points, laid.uv.copy(), laid.touching.copy(), laid.gap.copy(), laid.normal.copy())
    parallel_for(measure_all, len(length), 8, body, there, length, error, off)
    return Measured(frozen(length), frozen(error), frozen(off))


@njit(nogil=True, cache=True)
def measure_all(first, last, body, laid, length, error, off):
    """Write the measures (p,) of fibres first to last."""
    n = laid.points.shape[1]
    frames, station, counters = np.empty((n, 6, 3)), np.arange(n) * 1.0, np.zeros(4, np.int64)
    found, point = blank_survey(n), np.empty(3)
    for p in range(first, last):
        uv, touching, gap = laid.uv[p], laid.touching[p], laid.gap[p]
        for i in range(n):
            frame(body.spline, uv[i, 0], uv[i, 1], frames[i])
        state = State(laid.points[p], uv, frames, laid.normal[p], touching, gap, station, touching)
        survey(body, state, 0.0, found, counters)
        for i in range(n - 1):
            if touching[i] and touching[i + 1]:
                high, low = seen(body.spline, state, i, point, counters)
                found.rise[i], found.dip[i] = max(found.rise[i], high), max(found.dip[i], low)
        length[p], error[p] = fibre_length(body.spline, state, found.rise)
        # a fibre that lies above its segments, as the surface does beside a hollow, is as much further from its bottom
        off[p] = BETWEEN_SAMPLES * found.rise.max() + max(found.dip.max(), peak(body, state, counters))


@njit(cache=True)
def peak(body, state, counters):
    """How far the largest gap may be above that of any particle.

    A gap is no larger than the distance from any foot: between two points of a segment it is largest, at most, where
    their feet are as far.  Segments are halved until that is no more than a little above the largest gap.
    """
    X, touching, gap = state.X, state.touching, state.clear
    stack, work = np.empty((DEEPEST_HALF + 1, 2, POINT)), np.empty((6, 3))
    largest = gap.max()
    most = beyond = largest
    for i in range(len(gap) - 1):
        if touching[i] and touching[i + 1]:
            continue
        enough = CLOSE_ENOUGH * distance(X, i, i + 1)
        for k in range(2):
            at_particle(state, i + k, k, stack[0, k])
        size = 1
        while size > 0:
            size -= 1
            reach = farthest(X, i, stack[size, 0], stack[size, 1])
            if reach <= max(most, beyond):
                continue
            if reach <= most + enough or size == DEEPEST_HALF - 1:
                beyond = reach
                continue
            copy_row(stack[size, 1], stack[size + 1, 1])
            middle = stack[size, 1]
            halve(body, X, i, stack[size, 0], middle, work, counters)
            copy_row(middle, stack[size + 1, 0])
            most = max(most, middle[GAP])
            size += 2
    return max(most, beyond) - largest


@njit(cache=True)
def at_particle(state, i, t, point):
    """Note particle i, at share t of a segment: its share, gap, foot and where that is in the plane."""
    point[SHARE], point[GAP] = t, state.clear[i]
    point[AT_U], point[AT_V] = state.uv[i, 0], state.uv[i, 1]
    for k in range(3):
        point[FOOT + k] = state.frames[i, S, k]


@njit(cache=True)
def halve(body, X, i, low, high, work, counters):
    """Write into `high` the point of segment i in the middle of two."""
    where, uv = np.empty(3), np.empty(2)
    t = 0.5 * (low[SHARE] + high[SHARE])
    for k in range(3):
        where[k] = (1.0 - t) * X[i, k] + t * X[i + 1, k]
    uv[0], uv[1] = 0.5 * (low[AT_U] + high[AT_U]), 0.5 * (low[AT_V] + high[AT_V])
    counters[FEET] += 1
    counters[EVALUATIONS] += nearest_foot(body, where, uv, work)
    square = 0.0
    for k in range(3):
        high[FOOT + k] = work[S, k]
        square += (where[k] - work[S, k]) ** 2
    high[SHARE], high[GAP], high[AT_U], high[AT_V] = t, np.sqrt(square), uv[0], uv[1]


@njit(cache=True)
def farthest(X, i, low, high):
    """Largest distance that a point of segment i between two can have from the nearer of their feet."""
    slope = here = there = 0.0
    for k in range(3):
        way = X[i + 1, k] - X[i, k]
        a, b = X[i, k] - low[FOOT + k], X[i, k] - high[FOOT + k]
        slope += 2.0 * way * (a - b)
        here, there = here + a * a, there + b * b
    if slope == 0.0:
        return 0.0
    t = (there - here) / slope  # where both are as far
    if not low[SHARE] < t < high[SHARE]:
        return 0.0
    square = 0.0
    for k in range(3):
        square += ((1.0 - t) * X[i, k] + t * X[i + 1, k] - low[FOOT + k]) ** 2
    return np.sqrt(square)


@njit(cache=True)
def fibre_length(spline, state, rise):
    """Length of a fibre and its error."""
    X, uv, touching = state.X, state.uv, state.touching
    n = len(X)
    frames, where, here, there = np.empty((6, 3)), np.empty(2), np.empty(3), np.empty(3)
    total = error = 0.0
    i = 0
    while i < n - 1:
        j = i
        while j < n - 1 and touching[j + 1]:
            j += 1
        length, doubt = run_length(X, state.normal, i, j, rise)
        total, error = total + length, error + doubt
        if j == n - 1:
            break
        i = j + 1
        while i < n - 1 and not touching[i]:
            i += 1
        before, left = touchdown(spline, X, uv, j, i, frames, where, here)
        after, right = touchdown(spline, X, uv, i, j, frames, where, there)
        square = chord = 0.0
        for k in range(3):
            square += (there[k] - here[k]) ** 2
        for m in range(j, i):
            d = distance(X, m, m + 1)
            chord += d
            if m > j and m < i - 1:
                error += detour(X, state.normal, m, d, rise[m])
        straight = before + after + np.sqrt(square)
        first = detour(X, state.normal, j, distance(X, j, j + 1), rise[j])
        last = detour(X, state.normal, i - 1, distance(X, i - 1, i), rise[i - 1])
        if before + after <= chord and straight - chord <= first + last + ROUNDED * chord:
            total += straight
            error += (LANDED + max(left, right)) * abs(straight - chord) + max(straight - chord - first - last, 0.0)
            error += unexplained(first, before, here, row(X, i), chord)
            error += unexplained(last, after, there, row(X, j), chord)
        else:  # the ends lie beyond one another, or further round than the surface stands out
            total += chord
            error += first + last + max(straight - chord, 0.0)
    return total, error


@njit(cache=True)
def unexplained(way_round, landing, point, end, chord):
    """What of the way round all that stands out of a bridge's first or last segment is left as an error.

    Where the fibre leaves later than at its particle, the arc on the way there stands out, and adds to the length what
    `landing` as far as `point` does.  Where it leaves sooner, or at its particle, something else stands out.
    """
    if landing <= 0.0:
        return way_round
    rest = minus((point[0], point[1], point[2]), end)
    return max(way_round - EXPLAINED * abs(landing + np.sqrt(dot(rest, rest)) - chord), 0.0)
