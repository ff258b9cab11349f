"""The winding angle of fibres: from the direction along the part, which is square to the level lines of v."""

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.vectors import TINY
from meshwind.path.paths import Paths
from meshwind.surface.evaluate import SU, SV


def winding_angle(paths: Paths) -> Floats:
    """Angle of each fibre from the direction square to the level line of v.

    Parameters
    ----------
    paths : Paths
        Paths; where one is in the air, the level line is that through its foot.

    Returns
    -------
    ndarray of float, shape (p, n)
        Angles in radians, from 0, along the part, to pi/2, a hoop.
    """
    p, n = paths.gap.shape
    frames = paths.surface.frames(paths.uv.reshape(-1, 2))
    points, uv = (np.gradient(each, axis=1, edge_order=2 if n > 2 else 1) for each in (paths.points, paths.uv))
    rate = uv.reshape(-1, 2)
    # on the surface by the parameters, as chords of many turns cut their corners
    on = frames[:, SU] * rate[:, :1] + frames[:, SV] * rate[:, 1:]
    way = np.where(paths.on_surface.reshape(-1, 1), on, points.reshape(-1, 3))
    size = np.linalg.norm(way, axis=1) * np.linalg.norm(frames[:, SU], axis=1)
    around = np.abs((way * frames[:, SU]).sum(axis=1)) / np.maximum(size, TINY)
    return np.asarray(np.arcsin(np.minimum(around, 1.0)).reshape(p, n))
