"""A segment of a path in the air: whether it passes through the body between its particles."""

from typing import NamedTuple

import numpy as np

from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import copy_table
from meshwind.core.vectors import TINY
from meshwind.path.kernels.geometry import dot, minus, over, plus, row, times, to_parameters
from meshwind.path.kernels.state import EVALUATIONS, FEET
from meshwind.surface.evaluate import SU, SV, S, position, spans_of, unit_normal
from meshwind.surface.tree import nearest_foot

SHORTEST_STEP = 1.0 / 3.0
"""Shortest step along a segment in the air, in spans: nothing narrower stands on the surface."""
BEHIND = 1e-3
"""How far behind the surface a segment that runs into it is looked at, as a share of its length."""
MOST_STEPS = 400
"""Maximum number of such steps."""
OPPOSED = 0.1
"""Half the sum of two unit normals shorter than this says nothing of which way is out."""
STEEP = 0.25
"""Slope of a segment to the surface from which it runs into it."""


class Segment(NamedTuple):
    """A segment: its start, its way to the end, its length, and the unit vector at right angles that points outwards.

    out is zero where the surface faces opposite ways at the ends.
    """

    start: tuple[float, float, float]
    way: tuple[float, float, float]
    length: float
    out: tuple[float, float, float]


@njit(cache=True)
def segment_of(state, i):
    """Segment i of a path."""
    X, normal = state.X, state.normal
    start = row(X, i)
    way = minus(row(X, i + 1), start)
    length = max(np.sqrt(dot(way, way)), TINY)
    out = times(0.5, plus(row(normal, i), row(normal, i + 1)))
    out = minus(out, times(dot(out, way) / length / length, way))
    size = np.sqrt(dot(out, out))
    return Segment(start, way, length, over(out, size) if size > OPPOSED else (0.0, 0.0, 0.0))


@njit(cache=True)
def meets(body, state, i, segment, t, work, counters):
    """Whether segment i is inside the body below the point at share t from foot to foot, which is 0 for none."""
    if t == 0.0:
        return False
    point, foot, normal = np.empty(3), np.empty(2), np.empty(3)
    for k in range(2):
        foot[k] = (1.0 - t) * state.uv[i, k] + t * state.uv[i + 1, k]
    position(body.spline, foot[0], foot[1], point)
    along = dot(minus((point[0], point[1], point[2]), segment.start), segment.way) / segment.length / segment.length
    counters[EVALUATIONS] += 1
    return into(body, segment, min(max(along, 0.0), 1.0), point, foot, normal, work, counters) > 0.0


@njit(cache=True)
def followed(body, state, i, segment, stride, work, counters):
    """How deep segment i, which is in the air, passes inside the body, and the share of it where it is deepest.

    Each step is as long as the gap, and at least `stride` spans of the surface, by the frame below or by the spans from
    end to end, or, if less, half the segment; but where the segment runs into the surface, just to behind it.
    """
    spans_u, spans_v = spans_of(body.spline.net)
    uv = state.uv
    spans = max(abs(uv[i + 1, 0] - uv[i, 0]) * spans_u, abs(uv[i + 1, 1] - uv[i, 1]) * spans_v)
    longest = min(0.5, stride / max(spans, TINY)) * segment.length
    point, foot, normal = np.empty(3), np.empty(2), np.empty(3)
    foot[0], foot[1] = state.uv[i, 0], state.uv[i, 1]
    ahead = over(segment.way, segment.length)
    end = segment.length - state.clear[i + 1]
    deep, where = 0.0, 0.0
    gap, s = state.clear[i], 0.0
    copy_table(state.frames[i], work)
    entering = -dot(ahead, row(state.normal, i))
    for _ in range(MOST_STEPS):
        du, dv = to_parameters(row(work, SU), row(work, SV), ahead)
        least = min(stride / max(abs(du) * spans_u, abs(dv) * spans_v, TINY), longest)
        if entering > STEEP:
            least = min(least, gap / entering + BEHIND * segment.length)
        s += max(gap, least)
        if s >= end:
            break
        inside = into(body, segment, s / segment.length, point, foot, normal, work, counters)
        gap = abs(inside)
        if inside > deep:
            deep, where = inside, s
        entering = -dot(ahead, (normal[0], normal[1], normal[2]))
    return deep, where / segment.length


@njit(cache=True)
def into(body, segment, share, point, foot, normal, work, counters):
    """How deep a segment is inside the body at a share of it, negative outside.

    Writes the point, its foot, from the one before, and the normal and frame there.
    """
    for k in range(3):
        point[k] = segment.start[k] + share * segment.way[k]
    counters[FEET] += 1
    counters[EVALUATIONS] += nearest_foot(body, point, foot, work)
    unit_normal(work, normal)
    away = minus((point[0], point[1], point[2]), row(work, S))
    gap = np.sqrt(dot(away, away))
    return gap if dot(away, (normal[0], normal[1], normal[2])) < 0.0 and 0.0 < foot[1] < 1.0 else -gap
