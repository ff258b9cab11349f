"""A surface on another net: the start of an iteration on a finer one."""

import numpy as np

from meshwind.core.cast import Floats
from meshwind.surface.evaluate import DEGREE
from meshwind.surface.grid import parameter_grid
from meshwind.surface.surface import Surface


def resampled(surface: Surface, spans: tuple[int, int]) -> Floats:
    """A net (nu, nv, 3) with so many spans whose surface lies close to the given one, which is periodic in u.

    The quasi-interpolant (-f[i-1] + 8 f[i] - f[i+1]) / 6 of the values at the middles of the basis functions, in both
    directions; it reproduces cubics (de Boor, A practical guide to splines).
    """
    u = (np.arange(spans[0]) - 1) / spans[0]
    v = (np.arange(spans[1] + DEGREE + 2) - 2) / spans[1]
    values = surface.points(parameter_grid(u, v)).reshape(len(u), len(v), 3)
    values = (8.0 * values - np.roll(values, 1, axis=0) - np.roll(values, -1, axis=0)) / 6.0
    return np.asarray((8.0 * values[:, 1:-1] - values[:, :-2] - values[:, 2:]) / 6.0)
