"""Fitting the surface to a flattened mesh, and how far the two lie apart."""

from meshwind.surface.fitting.fit import fit

__all__ = ["fit"]
