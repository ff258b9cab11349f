"""The chart as an image (Fig. 7.7b): a pixel's red, green and blue are the x, y and z of a surface point."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import make_interp_spline

from meshwind.core.cast import Floats, floats, frozen
from meshwind.core.checks import check_type, whole
from meshwind.core.errors import BadInputError
from meshwind.surface.interpolate import sites, through
from meshwind.surface.surface import Surface

LEAST = 4
"""Pixels in either direction that a cubic needs."""


def surface_image(surface: Surface, width: int, height: int) -> Floats:
    """Sample a surface as an image, whose red, green and blue are x, y and z.

    Column c holds u = c / width, so that the right edge continues at the left one; row r holds v = r / (height - 1),
    so that the first row is the start rim and the last row the end rim.

    Parameters
    ----------
    surface : Surface
        Surface that closes in u.
    width, height : int
        Number of pixels, at least 4 each.

    Returns
    -------
    ndarray of float, shape (height, width, 3)
        Positions, in the surface's units.

    Raises
    ------
    BadInputError
        If the surface does not close in u or there are fewer than 4 pixels in either direction.

    See Also
    --------
    from_image : The inverse.

    Examples
    --------
    >>> import meshwind as mw
    >>> mw.surface_image(mw.shapes.cylinder(1.0, 3.0), width=64, height=32).shape
    (32, 64, 3)
    """
    check_type(surface, "surface", Surface, "as fit(chart) returns it")
    if not surface.periodic:
        raise BadInputError("an image wraps in u and this surface does not close; give one that is periodic in u")
    if min(whole(width, "width", 1), whole(height, "height", 1)) < LEAST:
        raise BadInputError(f"{width} x {height} pixels are too few for a surface; give at least {LEAST} x {LEAST}")
    v, u = np.meshgrid(np.linspace(0.0, 1.0, height), np.arange(width) / width, indexing="ij")
    points = surface.points(np.stack([u.ravel(), v.ravel()], axis=1))
    return np.asarray(frozen(points.reshape(height, width, 3)))


def from_image(image: ArrayLike) -> Surface:
    """Interpolate the pixels of an image by a bicubic surface.

    The surface has one span a pixel in u and one between two rows in v; its error falls with the fourth power of the
    number of pixels.

    Parameters
    ----------
    image : array_like of float, shape (height, width, 3)
        Positions laid out as by `surface_image`, at least 4 x 4.

    Returns
    -------
    Surface
        Surface through all pixels, periodic in u, in the unit of the image.

    Raises
    ------
    BadInputError
        If the image has another shape, too few pixels, or values that are not finite.

    See Also
    --------
    surface_image : The inverse.
    read_image : Read an image file that a run has written.

    Examples
    --------
    >>> import meshwind as mw
    >>> import numpy as np
    >>> cone = mw.shapes.cone(2.0, 1.0, 3.0)
    >>> again = mw.from_image(mw.surface_image(cone, 128, 9))
    >>> np.allclose(again.points([(0.1, 0.2)]), cone.points([(0.1, 0.2)]), atol=1e-6)
    True
    """
    pixels = floats(image, "image", -1, -1, 3)
    height, width = pixels.shape[:2]
    if min(width, height) < LEAST:
        raise BadInputError(f"an image of {width} x {height} pixels is too small; give at least {LEAST} x {LEAST}")
    spans = width, height - 1
    # Rows lie on the knots alone; the two rows between that the ends want as well follow without a knot of their own.
    along = make_interp_spline(np.linspace(0.0, 1.0, height), np.swapaxes(pixels, 0, 1), axis=1)
    return through(along(sites(spans[1], False)), spans)
