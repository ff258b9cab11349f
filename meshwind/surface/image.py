"""The chart as an image (Fig. 7.7b): a pixel's red, green and blue are the x, y and z of a surface point."""

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import make_interp_spline

from meshwind.core.cast import Floats, floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.surface.interpolate import sites, through
from meshwind.surface.surface import Surface

LEAST = 4
"""Pixels in either direction that a cubic needs."""


def surface_image(surface: Surface, width: int, height: int) -> Floats:
    """Sample a surface as an image (height, width, 3) in its own units.

    Column c is u = c / width, so that the image repeats from its right edge to its left one; row r is
    v = r / (height - 1), so that the first row is one end and the last row the other.  Raises BadInputError for
    fewer than 4 pixels in either direction or a surface that does not close in u.
    """
    if not surface.periodic:
        raise BadInputError("an image wraps in u and this surface does not close; give one that is periodic in u")
    if min(width, height) < LEAST:
        raise BadInputError(f"{width} x {height} pixels are too few for a surface; give at least {LEAST} x {LEAST}")
    v, u = np.meshgrid(np.linspace(0.0, 1.0, height), np.arange(width) / width, indexing="ij")
    points = surface.points(np.stack([u.ravel(), v.ravel()], axis=1))
    return np.asarray(frozen(points.reshape(height, width, 3)))


def from_image(image: ArrayLike) -> Surface:
    """The bicubic surface through the pixels of an image (height, width, 3), laid out as by `surface_image`.

    It has one span a pixel in u and one between two rows in v; the error falls with the fourth power of the pixels.
    Raises BadInputError for another shape, fewer than 4 pixels in either direction, or values that are not finite.
    """
    pixels = floats(image, "image", -1, -1, 3)
    height, width = pixels.shape[:2]
    if min(width, height) < LEAST:
        raise BadInputError(f"an image of {width} x {height} pixels is too small; give at least {LEAST} x {LEAST}")
    spans = width, height - 1
    # Rows lie on the knots alone; the two rows between that the ends want as well follow without a knot of their own.
    along = make_interp_spline(np.linspace(0.0, 1.0, height), np.swapaxes(pixels, 0, 1), axis=1)
    return through(along(sites(spans[1], False)), spans)
