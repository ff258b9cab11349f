"""The maps of surface.vtu on the grid of the fitted surface."""

import numpy as np

from meshwind.core.cast import Floats
from meshwind.layup.direction import winding_angle
from meshwind.layup.layup import Layup
from meshwind.layup.windability import FLAT, of_frames
from meshwind.surface.grid import Grid


def maps(on: Grid, layup: Layup, fit_error: Floats | None = None) -> dict[str, Floats]:
    """Point data of surface.vtu; fit_error (k,) is the distance of each of the grid's points to the mesh."""
    press = of_frames(on.frames, FLAT / on.surface.size)
    data = {
        "uv": on.uv,
        "normal": press.normal,
        "gaussian_curvature": press.largest * press.smallest,
        "mean_curvature": 0.5 * (press.largest + press.smallest),
        "windability": press.share,
        "class": press.kind,
        "press_direction": press.direction,
        "press_reach": np.degrees(press.reach),
        "angle": np.degrees(winding_angle(layup.paths, *on.shape)).ravel(),
        "coverage": layup.coverage.at(on.uv),
        "layers": layup.bands.at(on.uv),
        "stretch": _stretch(on),
    }
    return data if fit_error is None else data | {"fit_error": fit_error}


def _stretch(on: Grid) -> Floats:
    """Area scale from the plane to the part at each point, over its mean: how far the chart squeezes it."""
    scale = np.linalg.norm(np.cross(on.frames[:, 1], on.frames[:, 2]), axis=1)
    return np.asarray(scale / scale.mean())
