"""Distances along the surface from one path of a family to the next (Fig. 6.3).

The two are next to each other in the chart unrolled over all turns of u, where one strand of a path lies between
two strands of the next, however steep the winding is.  The distance is measured across: by the straight line in (u, v)
where that is as short as the geodesic, and otherwise by the geodesic itself, on few particles.
"""

import numpy as np

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import inner
from meshwind.core.threads import parallel_for
from meshwind.core.vectors import TINY
from meshwind.path.kernels.glide import MAX_STEPS, Factors, glide
from meshwind.path.kernels.state import Limits
from meshwind.path.paths import Paths
from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV, S, frame, tangents, unit_normal

SEAM = 1e-12
"""Starts closer than this to the seam from below, in turns, are on it, but for round-off."""
_STRAIGHT = 0.2
"""Angle (radians) by which a line in (u, v) may turn within the surface: it is longer than the geodesic by 1/24 of its
square, 0.17 %, or some more where the turn is uneven."""
_SQUARE = 0.03
"""Largest cosine of the angle at which a distance meets the other path."""
_SAMPLES = 201
"""Number of particles of a path from which it is measured, evenly chosen."""
_FEET = 8
"""Largest number of feet tried on the other path."""
_LEAST_RATE, _MOST_RATE = 0.2, 5.0
"""Bounds of the rate at which the shift to the foot falls as the foot moves: 1 in the plane."""
_SEGMENTS = 8
"""Segments of a geodesic across."""
_BALANCE = 1e-3
"""Unbalanced force (radians) that is left on it."""
_GAUSS = (0.5 - np.sqrt(0.15), 0.5, 0.5 + np.sqrt(0.15)), (5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0)
"""Places and weights of Gauss's rule of three points on [0, 1]."""


def apart(paths: Paths, first: Ints, second: Ints) -> Floats:
    """Largest distance (m,) between each path in `first` and the next one of its family, in `second`, either way."""
    return larger(*both_ways(paths, first.astype(np.int64), second.astype(np.int64)))


def larger(there: Floats, back: Floats) -> Floats:
    """The largest distance (m,) of both ways (m, n)."""
    return np.maximum(there.max(axis=1, initial=0.0), back.max(axis=1, initial=0.0))


def measured(paths: Paths) -> Ints:
    """Particles (k,) from which a path is measured."""
    return sampled(paths, _SAMPLES)


def sampled(paths: Paths, most: int) -> Ints:
    """Particles (k,) of a path, no more than so many, the ends among them."""
    n = paths.uv.shape[1]
    return np.rint(np.linspace(0.0, n - 1.0, min(n, most))).astype(np.int64)


def both_ways(paths: Paths, first: Ints, second: Ints) -> tuple[Floats, Floats]:
    """Distances (m, k) of particles of paths `first` to paths `second`, and back."""
    which = measured(paths)
    shift = to_next(paths, first, second)
    there, back = (np.empty((len(first), len(which))) for _ in range(2))
    for a, b, way, out in ((first, second, shift, there), (second, first, -shift, back)):
        parallel_for(_measure, len(a), 1, paths.surface.spline, frozen(paths.uv), (a, b), which, way, out)
    return there, back


def to_next(paths: Paths, first: Ints, second: Ints) -> Floats:
    """Turns (m,) by which u of paths `second` is shifted to the strand that is next to each of `first`."""
    shift = np.zeros(len(first))
    if paths.surface.periodic:
        begin = paths.uv[:, 0, 0]
        step = begin[second] - begin[first]
        shift = np.mod(step + SEAM, 1.0) - SEAM - step
        shift[first == second] = 1.0
    return shift


@njit(nogil=True, cache=True)
def _measure(begin, end, spline, uv, pairs, which, shift, out):
    """Write distances (k,) of pairs begin to end: from particles `which` of path pairs[0][m] to path pairs[1][m]."""
    n = uv.shape[1]
    line, here = np.empty((n, 2)), np.empty((6, 3))
    room = _room(_SEGMENTS + 1)
    for m in range(begin, end):
        from_, to = uv[pairs[0][m]], uv[pairs[1][m]]
        for j in range(n):
            line[j, 0], line[j, 1] = to[j, 0] + shift[m], to[j, 1]
        near = -1
        for k in range(len(which)):
            place = from_[which[k]]
            tangents(spline, place[0], place[1], here)
            near = _nearest(here, place, line, near)
            out[m, k] = _across(spline, place, line, float(near), room)


@njit(cache=True)
def _room(n):
    """Room for a geodesic of n particles: its places (n, 2), frames, and what `glide` takes."""
    factors = Factors(np.empty((n, 3)), np.empty((n, 2, 2)), np.empty((n, 2)))
    return np.empty((n, 2)), np.empty((n, 6, 3)), factors, np.zeros(4, np.int64)


@njit(cache=True)
def _nearest(here, place, line, near):
    """The vertex of a line (n, 2) nearest to a place by the metric there: the next local one from `near`, if given."""
    n = len(line)
    best = np.inf
    if near < 0:
        for j in range(n):
            far = _squared(here, line[j, 0] - place[0], line[j, 1] - place[1])
            if far < best:
                best, near = far, j
        return near
    best = _squared(here, line[near, 0] - place[0], line[near, 1] - place[1])
    for step in (1, -1):
        j = near + step
        while 0 <= j < n:
            far = _squared(here, line[j, 0] - place[0], line[j, 1] - place[1])
            if far > best:
                break
            best, near = far, j
            j += step
    return near


@njit(forceinline=True, cache=True)
def _squared(here, du, dv):
    """Squared length of a step in (u, v) by the metric of a frame."""
    total = 0.0
    for d in range(3):
        total += (here[SU, d] * du + here[SV, d] * dv) ** 2
    return total


@njit(cache=True)
def _across(spline, place, line, t, room):
    """Distance from a place to a line, whose foot is sought from index t on; 0 for a place beyond an end."""
    last = len(line) - 1.0
    distance, best, rate = 0.0, np.inf, 1.0
    tried = off = np.inf
    for _ in range(_FEET):
        j = min(int(t), int(last) - 1)
        du, dv = line[j + 1, 0] - line[j, 0], line[j + 1, 1] - line[j, 1]
        foot = (line[j, 0] + (t - j) * du, line[j, 1] + (t - j) * dv)
        length, lean, speed = _connect(spline, place, foot, (du, dv), room)
        if abs(lean) < best:
            distance, best = length * np.sqrt(max(1.0 - lean * lean, 0.0)), abs(lean)
        if (t == 0.0 and lean > _SQUARE) or (t == last and lean < -_SQUARE):
            return 0.0
        if best <= _SQUARE or length == 0.0:
            break
        now = lean * length / max(speed, TINY)
        if tried < np.inf and t != tried:
            rate = min(max((now - off) / (t - tried), _LEAST_RATE), _MOST_RATE)
        tried, off = t, now
        t = min(max(t - now / rate, 0.0), last)
    return distance


@njit(cache=True)
def _connect(spline, place, foot, way, room):
    """Length of the shortest line between two places, cosine of its angle to `way` at the foot, and |way|.

    The angle is that of the direction from the place to the foot.
    """
    curve, frames, factors, counters = room
    du, dv = foot[0] - place[0], foot[1] - place[1]
    here, normal = frames[0], np.empty(3)
    length = turn = sharpest = 0.0
    for g in range(3):
        frame(spline, place[0] + _GAUSS[0][g] * du, place[1] + _GAUSS[0][g] * dv, here)
        unit_normal(here, normal)
        square = _squared(here, du, dv)
        now = _sideways(here, normal, du, dv) / max(square, TINY)
        length += _GAUSS[1][g] * np.sqrt(square)
        turn += _GAUSS[1][g] * now
        sharpest = max(sharpest, abs(now))
    n = len(curve)
    tangents(spline, foot[0], foot[1], here)
    unit_normal(here, normal)
    along, tangent, end, left = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for d in range(3):
        along[d] = here[SU, d] * way[0] + here[SV, d] * way[1]
        tangent[d] = here[SU, d] * du + here[SV, d] * dv
        end[d] = here[S, d]
    if sharpest > _STRAIGHT:
        for i in range(n):
            curve[i, 0], curve[i, 1] = place[0] + i * du / (n - 1), place[1] + i * dv / (n - 1)
        _, found = glide(spline, Limits(np.inf, _BALANCE, MAX_STEPS), curve, frames, factors, counters)
        if found:
            for d in range(3):
                tangent[d] = end[d] - frames[n - 2, S, d]
            off = inner(tangent, normal)
            for d in range(3):
                tangent[d] -= off * normal[d]
            length, turn = min(length, _length(spline, curve, here)), 0.0
    size, speed = np.sqrt(inner(tangent, tangent)), np.sqrt(inner(along, along))
    for d in range(3):
        e, f = (d + 1) % 3, (d + 2) % 3
        left[d] = normal[e] * tangent[f] - normal[f] * tangent[e]
    # the line bends away from the geodesic between the same places by half of its turn
    lean = np.cos(0.5 * turn) * inner(tangent, along) - np.sin(0.5 * turn) * inner(left, along)
    return length, lean / max(size * speed, TINY), speed


@njit(cache=True)
def _sideways(here, normal, du, dv):
    """Acceleration of a straight line in (u, v) across itself, times its speed, within the tangent plane."""
    total = 0.0
    for d in range(3):
        e, f = (d + 1) % 3, (d + 2) % 3
        ahead, over = here[SU, e] * du + here[SV, e] * dv, here[SU, f] * du + here[SV, f] * dv
        bend = here[SUU, d] * (du * du) + here[SUV, d] * (2.0 * du * dv) + here[SVV, d] * (dv * dv)
        total += (normal[e] * over - normal[f] * ahead) * bend
    return total


@njit(cache=True)
def _length(spline, curve, here):
    """Length on the surface of a polyline (n, 2) in (u, v); chords between its places could cut an edge."""
    length = 0.0
    for i in range(1, len(curve)):
        du, dv = curve[i, 0] - curve[i - 1, 0], curve[i, 1] - curve[i - 1, 1]
        for g in range(3):
            t = _GAUSS[0][g]
            tangents(spline, curve[i - 1, 0] + t * du, curve[i - 1, 1] + t * dv, here)
            length += _GAUSS[1][g] * np.sqrt(_squared(here, du, dv))
    return length
