"""The smooth surface: one tensor B-spline type, fitted or analytic."""

from meshwind.surface import shapes
from meshwind.surface.fitting import fit
from meshwind.surface.image import from_image, surface_image
from meshwind.surface.surface import FitError, Surface

__all__ = ["FitError", "Surface", "fit", "from_image", "shapes", "surface_image"]
