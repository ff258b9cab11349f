"""The smooth surface: one tensor B-spline type, fitted or analytic."""

from meshwind.surface import shapes
from meshwind.surface.fit import fit
from meshwind.surface.surface import FitError, Surface

__all__ = ["FitError", "Surface", "fit", "shapes"]
