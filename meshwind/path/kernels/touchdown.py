"""Where a bridge leaves the surface and comes back to it, to second order.

A path's contacts are its particles, so that a bridge begins at one up to a spacing too early.  The chord is tangent to
the surface where it truly leaves; one Newton step on that condition along the fibre finds the place.
"""

from typing import TYPE_CHECKING

import numpy as np
from numba import njit

from meshwind.core.cast import Floats, Ints
from meshwind.path.kernels.coulomb import dot, second_form, to_parameters
from meshwind.surface.evaluate import S, frame, unit_normal

if TYPE_CHECKING:
    from meshwind.path.paths import Paths

FARTHEST = 2.0
"""Spacings beyond which the step is no correction: there the surface is flat or has an edge."""


@njit(cache=True)
def touchdown(spline, X, uv, here, there, frames, place, point):
    """End of the bridge from particle `here`, which touches, to `there`.

    Leaves its parameters in place (2,) and its position in point (3,); frames (6, 3) is work space.  Returns how far
    along the surface it is from the particle, towards the bridge; 0, and the particle itself, at a fixed end of
    the path and where no step along the fibre would do.
    """
    n = len(X)
    for k in range(3):
        point[k] = X[here, k]
    place[0], place[1] = uv[here, 0], uv[here, 1]
    if here == 0 or here == n - 1:
        return 0.0
    frame(spline, place[0], place[1], frames)
    normal, along, rate = np.empty(3), np.empty(3), np.empty(2)
    unit_normal(frames, normal)
    far = 0.0
    for k in range(3):
        along[k] = X[there, k] - X[here, k]
        far += along[k] ** 2
    far = np.sqrt(far)
    dip = dot(along, normal) / max(far, 1e-300)
    for k in range(3):
        along[k] = along[k] / max(far, 1e-300) - dip * normal[k]
    to_parameters(frames, along, rate)
    press = -second_form(frames, normal, rate, rate)
    if press <= 0.0 or abs(dip) > FARTHEST * press * far / abs(there - here):
        return 0.0
    step = -dip / press
    place[0] += step * rate[0]
    place[1] = min(max(place[1] + step * rate[1], 0.0), 1.0)
    if not spline.periodic:
        place[0] = min(max(place[0], 0.0), 1.0)
    frame(spline, place[0], place[1], frames)
    for k in range(3):
        point[k] = frames[S, k]
    chord, bend = 0.0, press / max(dot(along, along), 1e-300)
    for k in range(3):
        chord += (point[k] - X[here, k]) ** 2
    return np.copysign(np.sqrt(chord) * (1.0 + chord * bend * bend / 24.0), step)


@njit(cache=True)
def _touchdowns(spline, X, uv, path, first, last, points, places):
    frames = np.empty((6, 3))
    for b in range(len(path)):
        p = path[b]
        touchdown(spline, X[p], uv[p], first[b], last[b], frames, places[b, 0], points[b, 0])
        touchdown(spline, X[p], uv[p], last[b], first[b], frames, places[b, 1], points[b, 1])


def touchdowns(paths: "Paths", path: Ints, first: Ints, last: Ints) -> tuple[Floats, Floats]:
    """Ends of the bridges of `path` (b,) between touching particles `first` and `last` (b,).

    Returns points (b, 2, 3) on the surface and their uv (b, 2, 2).  A bridge that reaches a fixed end of its path
    keeps it.
    """
    ends, places = np.empty((len(path), 2, 3)), np.empty((len(path), 2, 2))
    surface = paths.surface
    _touchdowns(surface.spline, paths.points, paths.uv, path, first, last, ends, places)
    return ends, places
