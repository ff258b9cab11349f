"""The maps of surface.vtu on the grid of the fitted surface."""

import numpy as np

from meshwind.core.cast import Floats
from meshwind.layup.direction import winding_angle
from meshwind.layup.layup import Layup
from meshwind.layup.windability import FLAT, of_frames
from meshwind.results import schema
from meshwind.surface.grid import Grid


def maps(on: Grid, layup: Layup, fit_error: Floats | None = None) -> dict[schema.Field, Floats]:
    """Point data of surface.vtu; fit_error (k,) is the distance of each of the grid's points to the mesh."""
    press = of_frames(on.frames, FLAT / on.surface.size, (on.surface, on.uv))
    data = {
        schema.UV: on.uv,
        schema.NORMAL: press.normal,
        schema.GAUSSIAN_CURVATURE: press.largest * press.smallest,
        schema.MEAN_CURVATURE: 0.5 * (press.largest + press.smallest),
        schema.WINDABILITY: press.share,
        schema.CLASS: press.kind,
        schema.PRESS_DIRECTION: press.direction,
        schema.PRESS_REACH: np.degrees(press.reach),
        schema.ANGLE: np.degrees(winding_angle(layup.paths, *on.shape)).ravel(),
        schema.COVERAGE: layup.coverage.at(on.uv),
        schema.LAYERS: layup.bands.at(on.uv),
        schema.STRETCH: _stretch(on),
    }
    if on.surface.uncertainty is not None:
        data[schema.UNCERTAINTY] = on.surface.uncertainty_at(on.uv)
    return data if fit_error is None else data | {schema.FIT_ERROR: fit_error}


def _stretch(on: Grid) -> Floats:
    """Area scale from the chart to the part at each point, over its mean."""
    scale = np.linalg.norm(np.cross(on.frames[:, 1], on.frames[:, 2]), axis=1)
    return np.asarray(scale / scale.mean())
