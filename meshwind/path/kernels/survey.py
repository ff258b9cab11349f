"""How far the surface stands out of a path's segments, or below them, between particles.

Within a knot span the surface is one polynomial, and across a knot it stays smooth to the second derivative: a segment
that passes one knot at most hides nothing that the frames at its ends do not know.  Across more, the control net says
whether there is anything else; only where there is, the surface is evaluated on the way.  A segment in the air is
followed from gap to gap, unless the gaps at its ends cover it.
"""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.kernel import njit
from meshwind.path.kernels.geometry import derivative, dot, minus, row, times
from meshwind.path.kernels.segment import SHORTEST_STEP, followed, meets, segment_of
from meshwind.path.kernels.state import EVALUATIONS, distance
from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV, S, position, spans_of

PROBES = 8
"""Shares of a segment at which it is compared with the surface that the frames at its ends predict."""
PER_SPAN = 3
"""Samples per span where the control net shows more than the frames: a bump of a spline is two spans wide or wider."""
SMOOTH, FLAT = 0.1, 3e-4
"""What the control net may differ from the frames' prediction: this share of it, and of the segment."""
FACET = 0.25
"""And this share of its second differences."""
EVEN_ARC = 8.0 / 27.0
"""Rise over the sum of the slopes at both ends, with a margin of two: a cubic's is 4/27 at most."""
STEEP = 0.25
"""Share of a segment that an even bow stays below: a prediction above it means nothing."""


class Survey(NamedTuple):
    """Heights over each segment of a path of n particles.

    rise, dip (n,): how far the surface stands out of the segment from each particle to the next at most, and how far
    it stays below between particles that touch; at (n,): the share of the segment where it rises most.
    """

    rise: Floats
    dip: Floats
    at: Floats


@njit(cache=True)
def blank_survey(n):
    """Room for the survey of n particles."""
    return Survey(np.zeros(n), np.zeros(n), np.zeros(n))


@njit(cache=True)
def survey(body, state, least, found, counters):
    """Survey a path whose lifted particles have true gaps and frames; returns its largest rise.

    Where the frames at the ends of a segment say that it is less than `least`, it is taken as none.
    """
    touching, clear = state.touching, state.clear
    rise, dip, at = found.rise, found.dip, found.at
    work = np.empty((6, 3))
    most = 0.0
    for i in range(len(touching) - 1):
        rise[i] = dip[i] = at[i] = 0.0
        air = not (touching[i] and touching[i + 1])
        if clear[i] + clear[i + 1] >= distance(state.X, i, i + 1) if air else even(body.spline, state, i, least):
            continue
        high, low, where = over_segment(body, state, i, air, work, counters)
        rise[i], at[i] = high, where
        dip[i] = 0.0 if air else low
        most = max(most, high)
    return most


@njit(cache=True)
def rises(body, state, least, counters):
    """Whether the surface stands out by more than `least` of any segment of a path that touches all along.

    Most segments need no survey.
    """
    work = np.empty((6, 3))
    for i in range(len(state.X) - 1):
        if not even(body.spline, state, i, least) and over_segment(body, state, i, False, work, counters)[0] > least:
            return True
    return False


@njit(cache=True)
def even(spline, state, i, least):
    """Whether nothing stands out of segment i, or below it, by `least`, as the frames at its ends say at once.

    Where it passes a knot at most, the slopes there bound what does.
    """
    if knots_passed(spline, state.uv, i) > 1.0:
        return False
    way = minus(row(state.X, i + 1), row(state.X, i))
    slopes = abs(dot(way, row(state.normal, i))) + abs(dot(way, row(state.normal, i + 1)))
    return EVEN_ARC * slopes < least


@njit(cache=True)
def over_segment(body, state, i, air, work, counters):
    """Largest rise over segment i, largest dip below it, and the share of it where it rises most."""
    segment = segment_of(state, i)
    spline, uv = body.spline, state.uv
    knots = knots_passed(spline, uv, i)
    high, low, where, odd = foreseen(spline, state, i, segment, knots)
    deep = there = 0.0
    if air and knots > 1.0:
        deep, there = followed(body, state, i, segment, SHORTEST_STEP if odd else np.inf, work, counters)
        if deep == 0.0 and (odd or not meets(body, state, i, segment, where, work, counters)):
            return 0.0, 0.0, 0.0  # the line between the feet goes over what the segment passes by
    if odd:
        high, low, where = sampled(spline, uv, i, segment, work[S], counters)
    if deep > high:
        high, where = deep, there
    return high, low, where


@njit(forceinline=True, cache=True)
def knots_passed(spline, uv, i):
    """Number of knots that segment i passes, in u or in v."""
    spans_u, spans_v = spans_of(spline.net)
    return max(
        abs(np.floor(uv[i + 1, 0] * spans_u) - np.floor(uv[i, 0] * spans_u)),
        abs(np.floor(uv[i + 1, 1] * spans_v) - np.floor(uv[i, 1] * spans_v)),
    )


@njit(cache=True)
def foreseen(spline, state, i, segment, knots):
    """Rise, dip and the rise's share of segment i by the frames at its ends, and whether there may be anything else."""
    if dot(segment.out, segment.out) == 0.0:
        return 0.0, 0.0, 0.0, True
    high, low, where, bow = predicted(state, i, segment)
    return high, low, where, knots > 1.0 and not follows(spline, state, i, segment, bow)


@njit(cache=True)
def seen(spline, state, i, point, counters):
    """Rise over segment i and dip below it by samples of the surface, whatever the frames predict."""
    high, low, _ = sampled(spline, state.uv, i, segment_of(state, i), point, counters)
    return high, low


@njit(cache=True)
def predicted(state, i, segment):
    """Rise, dip and the rise's share of segment i by the frames at its ends, and the bow's coefficients.

    The height of the surface over the segment is the polynomial of degree 5 with the frames' heights, slopes and
    bends along the straight line between the two in the parametric plane.
    """
    uv, frames = state.uv, state.frames
    du, dv = uv[i + 1, 0] - uv[i, 0], uv[i + 1, 1] - uv[i, 1]
    h0, s0, b0 = heights(frames, i, du, dv, segment)
    h1, s1, b1 = heights(frames, i + 1, du, dv, segment)
    # c0 + c1 t + c2 t^2 + t^3 (c3 + c4 t + c5 t^2)
    c0, c1, c2 = h0, s0, 0.5 * b0
    e, f, g = h1 - c0 - c1 - c2, s1 - c1 - 2.0 * c2, b1 - 2.0 * c2
    c3, c4, c5 = 10.0 * e - 4.0 * f + 0.5 * g, -15.0 * e + 7.0 * f - g, 6.0 * e - 3.0 * f + 0.5 * g
    bow = c0, c1, c2, c3, c4, c5
    high = low = where = 0.0
    for m in range(1, PROBES):
        t = m / PROBES
        h = height_at(bow, t)
        low = max(low, -h)
        if h > high:
            high, where = h, t
    return high, low, where, bow


@njit(forceinline=True, cache=True)
def height_at(bow, t):
    """The polynomial with coefficients bow (6,) at t."""
    return bow[0] + t * (bow[1] + t * (bow[2] + t * (bow[3] + t * (bow[4] + t * bow[5]))))


@njit(forceinline=True, cache=True)
def heights(frames, i, du, dv, segment):
    """Height over a segment of the surface at particle i, its slope and its bend along (du, dv)."""
    out = segment.out
    slope = du * dot(derivative(frames, i, SU), out) + dv * dot(derivative(frames, i, SV), out)
    bend = du * du * dot(derivative(frames, i, SUU), out) + dv * dv * dot(derivative(frames, i, SVV), out)
    bend += 2.0 * du * dv * dot(derivative(frames, i, SUV), out)
    return dot(minus(derivative(frames, i, S), segment.start), out), slope, bend


@njit(cache=True)
def follows(spline, state, i, segment, bow):
    """Whether the control net along segment i bows as predicted, so that the surface has nothing else there.

    Where it is smooth the net lies off the surface by a sixth of its second differences, much the same all along, and
    between its points, where it is taken as bilinear, by up to an eighth of them.
    """
    uv = state.uv
    du, dv = uv[i + 1, 0] - uv[i, 0], uv[i + 1, 1] - uv[i, 1]
    spans_u, spans_v = spans_of(spline.net)
    count = int(np.ceil(max(abs(du) * spans_u, abs(dv) * spans_v))) + 1
    first = net_height(spline, uv[i, 0], uv[i, 1], segment) - height_at(bow, 0.0)
    last = net_height(spline, uv[i + 1, 0], uv[i + 1, 1], segment) - height_at(bow, 1.0)
    size = 0.0
    for m in range(1, PROBES):
        t = m / PROBES
        size = max(size, abs(height_at(bow, t) - (1.0 - t) * bow[0] - t * height_at(bow, 1.0)))
    across_u, across_v = min(1.0, abs(du) * spans_u), min(1.0, abs(dv) * spans_v)
    facets = max(
        between_points(spline, state.frames, i, segment, across_u, across_v),
        between_points(spline, state.frames, i + 1, segment, across_u, across_v),
    )
    if size > STEEP * segment.length:
        return False
    allowed = SMOOTH * size + FLAT * segment.length + FACET * facets
    for m in range(1, count):
        t = m / count
        h = net_height(spline, uv[i, 0] + t * du, uv[i, 1] + t * dv, segment) - height_at(bow, t)
        if abs(h - (1.0 - t) * first - t * last) > allowed:
            return False
    return True


@njit(forceinline=True, cache=True)
def between_points(spline, frames, i, segment, across_u, across_v):
    """Second differences of the control net at particle i, across a segment: in u and v, as far as it moves on."""
    spans_u, spans_v = spans_of(spline.net)
    along_u = dot(derivative(frames, i, SUU), segment.out) / spans_u**2
    along_v = dot(derivative(frames, i, SVV), segment.out) / spans_v**2
    return across_u * abs(along_u) + across_v * abs(along_v)


@njit(cache=True)
def net_height(spline, u, v, segment):
    """Height over a segment of the control net, linear between its points, at (u, v)."""
    net = spline.net
    spans_u, spans_v = spans_of(net)
    if spline.periodic:
        u -= np.floor(u)
    x, y = u * spans_u + 1.0, v * spans_v + 1.0  # control point k is that of knot k - 1
    a, b = min(int(x), spans_u + 1), min(int(y), spans_v + 1)
    x, y = x - a, y - b
    total = 0.0
    for k in range(3):
        before = (1.0 - y) * net[a, b, k] + y * net[a, b + 1, k]
        after = (1.0 - y) * net[a + 1, b, k] + y * net[a + 1, b + 1, k]
        total += ((1.0 - x) * before + x * after - segment.start[k]) * segment.out[k]
    return total


@njit(cache=True)
def sampled(spline, uv, i, segment, point, counters):
    """Rise over segment i, dip below it and the rise's share of it, by samples of the surface in every span."""
    du, dv = uv[i + 1, 0] - uv[i, 0], uv[i + 1, 1] - uv[i, 1]
    spans_u, spans_v = spans_of(spline.net)
    count = int(np.ceil(PER_SPAN * max(abs(du) * spans_u, abs(dv) * spans_v))) + 1
    facing = dot(segment.out, segment.out) > 0.0
    high = low = where = 0.0
    counters[EVALUATIONS] += count - 1
    for m in range(1, count):
        t = m / count
        position(spline, uv[i, 0] + t * du, uv[i, 1] + t * dv, point)
        off = minus((point[0], point[1], point[2]), segment.start)
        if facing:
            h = dot(off, segment.out)
        else:
            along = min(max(dot(off, segment.way) / segment.length / segment.length, 0.0), 1.0)
            off = minus(off, times(along, segment.way))
            h = np.sqrt(dot(off, off))
        low = max(low, -h)
        if h > high:
            high, where = h, t
    return high, low, where
