"""Where points of a mesh lie on a surface."""

import numpy as np

from meshwind.core.cast import Floats, frozen
from meshwind.core.threads import parallel_for
from meshwind.surface.evaluate import Spline
from meshwind.surface.foot import feet
from meshwind.surface.surface import Surface


def feet_of(surface: Surface, points: Floats, guess: Floats) -> Floats:
    """Parameters (k, 2) of the feet of points (k, 3), from a guess (k, 2)."""
    middle = points.mean(axis=0)  # far from the origin the feet would lose digits
    uv, frames = np.array(guess), np.empty((len(points), 6, 3))
    spline = Spline(frozen(surface.net - middle), surface.periodic)
    parallel_for(feet, len(points), 500, spline, points - middle, uv, frames)
    return uv
