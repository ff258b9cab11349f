"""Points of the parametric plane: grids of them, and the speeds of the parameters."""

import numpy as np

from meshwind.core.cast import Floats
from meshwind.surface.evaluate import SU, SV
from meshwind.surface.surface import Surface


def parameter_grid(u: Floats, v: Floats) -> Floats:
    """All pairs (nu nv, 2) of parameters u (nu,) and v (nv,), u slowest."""
    return np.stack(np.meshgrid(u, v, indexing="ij"), axis=2).reshape(-1, 2)


def midpoints(count: int) -> Floats:
    """Middles (count,) of equal intervals of [0, 1]."""
    return (np.arange(count) + 0.5) / count


def mean_speeds(surface: Surface, count: int) -> tuple[float, float]:
    """Mean lengths of s_u and of s_v over the middles of count x count cells: extents around and along the part."""
    frames = surface.frames(parameter_grid(midpoints(count), midpoints(count)))
    around, along = np.linalg.norm(frames[:, [SU, SV]], axis=2).mean(axis=0)
    return float(around), float(along)
