"""Where a bridge leaves the surface and comes back to it, to second order.

A path's contacts are its particles, so that a bridge begins at one up to a spacing too early.  The chord is tangent to
the surface where it truly leaves; one Newton step on that condition along the fibre finds the place.
"""

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.kernel import njit
from meshwind.core.vectors import TINY
from meshwind.path.kernels.geometry import dot, minus, over, row, second_form, times, to_parameters
from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV, S, frame, unit_normal
from meshwind.surface.surface import Surface

FARTHEST = 2.0
"""Spacings beyond which the step is no correction: there the surface is flat or has an edge."""
CLOSER = 0.5
"""Share of the chord's slope to the surface that a step may leave: more, and the surface bends otherwise there."""


@njit(cache=True)
def touchdown(spline, X, uv, here, there, frames, where, point):
    """End of the bridge from particle `here`, which touches, to `there`.

    Leaves its parameters in where (2,) and its position in point (3,); frames (6, 3) is work space.  Returns how far
    along the surface it is from the particle, towards the bridge, and what share of the chord's slope to the surface is
    left there.  Both are 0, and the end is the particle, at a fixed end of the path and where no step along the fibre
    would do.
    """
    start = row(X, here)
    point[0], point[1], point[2] = start
    where[0], where[1] = uv[here, 0], uv[here, 1]
    if here == 0 or here == len(X) - 1:
        return 0.0, 0.0
    frame(spline, where[0], where[1], frames)
    normal_at = np.empty(3)
    unit_normal(frames, normal_at)
    normal, su, sv = (normal_at[0], normal_at[1], normal_at[2]), row(frames, SU), row(frames, SV)
    chord = minus(row(X, there), start)
    far = np.sqrt(dot(chord, chord))
    dip = dot(chord, normal) / max(far, TINY)
    along = minus(over(chord, max(far, TINY)), times(dip, normal))
    rate = to_parameters(su, sv, along)
    form = dot(row(frames, SUU), normal), dot(row(frames, SUV), normal), dot(row(frames, SVV), normal)
    press = -second_form(form, rate, rate)
    if press <= 0.0 or abs(dip) > FARTHEST * press * far / abs(there - here):
        return 0.0, 0.0
    step = -dip / press
    u, v = where[0], where[1]
    where[0] += step * rate[0]
    where[1] = min(max(where[1] + step * rate[1], 0.0), 1.0)
    if not spline.periodic:
        where[0] = min(max(where[0], 0.0), 1.0)
    frame(spline, where[0], where[1], frames)
    point[0], point[1], point[2] = row(frames, S)
    unit_normal(frames, normal_at)
    rest = minus(row(X, there), row(frames, S))
    left = dot(rest, (normal_at[0], normal_at[1], normal_at[2])) / max(np.sqrt(dot(rest, rest)), TINY)
    if abs(left) > CLOSER * abs(dip):
        where[0], where[1] = u, v
        point[0], point[1], point[2] = start
        return 0.0, 0.0
    way, bend = minus(row(frames, S), start), press / max(dot(along, along), TINY)
    square = dot(way, way)
    along_it = np.copysign(np.sqrt(square) * (1.0 + square * bend * bend / 24.0), step)
    return along_it, abs(left) / max(abs(dip), TINY)


@njit(nogil=True, cache=True)
def _touchdowns(spline, X, uv, path, first, last, points, where):
    frames = np.empty((6, 3))
    for b in range(len(path)):
        p = path[b]
        touchdown(spline, X[p], uv[p], first[b], last[b], frames, where[b, 0], points[b, 0])
        touchdown(spline, X[p], uv[p], last[b], first[b], frames, where[b, 1], points[b, 1])


def touchdowns(
    surface: Surface, points: Floats, uv: Floats, path: Ints, first: Ints, last: Ints
) -> tuple[Floats, Floats]:
    """Ends of the bridges of `path` (b,) between touching particles `first` and `last` (b,).

    The paths have particles points (p, n, 3) at or above uv (p, n, 2).  Returns points (b, 2, 3) on the surface and
    their uv (b, 2, 2).  A bridge that reaches a fixed end of its path keeps it.
    """
    ends, end_uv = np.empty((len(path), 2, 3)), np.empty((len(path), 2, 2))
    _touchdowns(surface.spline, points, uv, path, first, last, ends, end_uv)
    return ends, end_uv
