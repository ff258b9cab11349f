"""The files of the fitted surface: surface.vtu with the maps, and surface.npz with the surface itself."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats
from meshwind.results.vtk_files import write_faces
from meshwind.surface.grid import Grid
from meshwind.surface.surface import DEGREE, Surface


def write_surface(path: Path, on: Grid, data: Mapping[str, Floats], units: str = "") -> None:
    """Write the grid with its maps as point data."""
    write_faces(path, on.points, on.quads, np.zeros((0, 3), dtype=np.int64), data, units)


def write_surface_npz(path: Path, surface: Surface, units: str = "") -> None:
    """Write the spline: with `periodic_u`, repeat the first three rows for scipy's BSpline.  units: "" if unknown."""
    knots_u, knots_v = surface.knots
    with path.open("wb") as file:
        np.savez(
            file,
            control_points=surface.control_points,
            knots_u=knots_u,
            knots_v=knots_v,
            degree=np.int64(DEGREE),
            periodic_u=np.bool_(surface.periodic),
            units=np.str_(units),
        )
