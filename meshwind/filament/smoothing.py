"""Smoothing of a table over a surface's cells by diffusion, which keeps its integral."""

import igl
import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from meshwind.core.cast import Floats
from meshwind.surface.grid import grid_quads, midpoints, parameter_grid
from meshwind.surface.surface import Surface

_STEPS = 4
"""Implicit steps of the diffusion: what spreads from a point is then close to a bell curve."""


def smoothed(surface: Surface, cells: Floats, area: Floats, width: float) -> Floats:
    """Values (nu, nv) over cells, smoothed as by a bell curve with a standard deviation of half a width.

    The heat equation is solved on the triangles between the cells' centres, with no flow over a rim: the integral over
    the area (nu, nv) is kept to round-off. What falls below the least value, as it may where cells are slender, is
    raised to it and the rest scaled, so that the integral stays.
    """
    nu, nv = cells.shape
    quads = grid_quads(nu, nv, True)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    points = surface.points(parameter_grid(midpoints(nu), midpoints(nv)))
    stiffness = -igl.cotmatrix(points, faces)  # its rows add up to 0, which keeps the integral
    mass = sparse.diags(area.ravel())
    time = 0.125 * width * width / _STEPS
    solver = splu((mass + time * stiffness).tocsc())
    values = cells.ravel().astype(np.float64)
    for _ in range(_STEPS):
        values = solver.solve(area.ravel() * values)
    least = float(cells.min())
    above = np.maximum(values - least, 0.0)
    wanted = float(((cells - least) * area).sum())
    held = float((above * area.ravel()).sum())
    return np.asarray((least + above * (wanted / held if held > 0.0 else 1.0)).reshape(nu, nv))
