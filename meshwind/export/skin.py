"""surface.vtu read back: the grid on the fitted surface, with its maps."""

from pathlib import Path

import numpy as np

from meshwind.core.errors import BadInputError
from meshwind.results.vtk_reading import Faces, read_faces
from meshwind.surface.grid import grid
from meshwind.surface.surface import Surface

FILE = "surface.vtu"
_OFF = 1e-9
"""Points of the grid lie no further from where they belong, over the surface's size."""


def read_skin(folder: Path, surface: Surface, trusted: bool = False) -> Faces:
    """Read the grid of a folder's surface; raises BadInputError where the file is damaged or of another surface.

    trusted: this very process has written the file.
    """
    skin, on = read_faces(folder / FILE, trusted), grid(surface)
    if (
        skin.points.shape != on.points.shape
        or not np.array_equal(skin.quads, on.quads)
        or not np.isfinite(skin.points).all()
        or np.abs(skin.points - on.points).max() > _OFF * surface.size
        or not np.array_equal(skin.point_data.get("uv", on.points), on.uv)
        or skin.point_data.get("normal", on.uv).shape != on.points.shape
    ):
        raise BadInputError(f"{folder / FILE} cannot be used (it is of another surface); run `meshwind wind` again")
    return skin
