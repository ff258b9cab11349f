"""The winding angle of fibres: from the direction along the part, which is square to the level lines of v."""

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.vectors import TINY
from meshwind.path.paths import Paths
from meshwind.surface.evaluate import SU


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
    way = np.gradient(paths.points, axis=1, edge_order=2 if n > 2 else 1).reshape(-1, 3)
    size = np.linalg.norm(way, axis=1) * np.linalg.norm(frames[:, SU], axis=1)
    around = np.abs((way * frames[:, SU]).sum(axis=1)) / np.maximum(size, TINY)
    return np.asarray(np.arcsin(np.minimum(around, 1.0)).reshape(p, n))
