"""Where a bridge leaves the surface and comes back to it, to second order.

A path's contacts are its particles, so that a bridge begins at one up to a spacing too early.  The chord is tangent to
the surface where it truly leaves; one Newton step on that condition along the fibre finds the place.
"""

import numpy as np

from meshwind.cast import Floats, Ints
from meshwind.path.paths import Paths

FARTHEST = 2.0
"""Spacings beyond which the step is no correction: there the surface is flat or has an edge."""


def touchdowns(paths: Paths, path: Ints, first: Ints, last: Ints) -> tuple[Floats, Floats]:
    """Ends of the bridges of `path` (b,) between touching particles `first` and `last` (b,).

    Returns points (b, 2, 3) on the surface and their uv (b, 2, 2).  A bridge that reaches a fixed end of its path
    keeps it.
    """
    n = paths.points.shape[1]
    ends, places = np.empty((len(path), 2, 3)), np.empty((len(path), 2, 2))
    for side, (here, there) in enumerate(((first, last), (last, first))):
        start, goal = paths.points[path, here], paths.points[path, there]
        chord = goal - start
        far = np.linalg.norm(chord, axis=1)
        chord = chord / np.maximum(far, 1e-300)[:, None]
        uv = paths.uv[path, here]
        frames = paths.surface.frames(uv)
        normal = paths.normal[path, here]
        dip = np.einsum("bk,bk->b", chord, normal)
        along = chord - dip[:, None] * normal
        rate = _rates(frames, along)
        form = np.einsum("bak,bk->ba", frames[:, 3:], normal)
        press = -(
            form[:, 0] * rate[:, 0] ** 2 + 2 * form[:, 1] * rate[:, 0] * rate[:, 1] + form[:, 2] * rate[:, 1] ** 2
        )
        spacing = far / np.maximum(np.abs(there - here), 1)
        step = np.divide(-dip, press, out=np.zeros_like(dip), where=press > 0)
        free = (here > 0) & (here < n - 1) & (np.abs(step) <= FARTHEST * spacing)
        step = np.where(free, step, 0.0)
        place = uv + step[:, None] * rate
        place[:, 1] = np.clip(place[:, 1], 0.0, 1.0)
        if not paths.surface.periodic:
            place[:, 0] = np.clip(place[:, 0], 0.0, 1.0)
        # where nothing moves the particle itself is the end, to the last digit
        ends[:, side] = np.where(free[:, None], paths.surface.points(place), start)
        places[:, side] = place
    return ends, places


def _rates(frames: Floats, along: Floats) -> Floats:
    """The (u, v) rates (b, 2) whose velocity on the surface is the tangent vector `along` (b, 3)."""
    su, sv = frames[:, 1], frames[:, 2]
    e, f, g = (np.einsum("bk,bk->b", x, y) for x, y in ((su, su), (su, sv), (sv, sv)))
    a, b = np.einsum("bk,bk->b", su, along), np.einsum("bk,bk->b", sv, along)
    det = np.maximum(e * g - f * f, 1e-300)
    return np.stack([(g * a - f * b) / det, (e * b - f * a) / det], axis=1)
