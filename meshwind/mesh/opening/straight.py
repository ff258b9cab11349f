"""Cut a ragged rim straight."""

from dataclasses import replace

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.vectors import unit
from meshwind.mesh.geometry.areas_and_volumes import loop_area_vector, loop_centroid
from meshwind.mesh.geometry.topology import boundary, loops, patches
from meshwind.mesh.opening.curved_facets import CurvedFacets
from meshwind.mesh.opening.cut_opening import pinched, split_where, without_unused
from meshwind.mesh.opening.plane import Rim, linked

_RAGGED = 0.5
"""Mean square of the steps between the heights of a rim's vertices over that of the heights: 2 for noise, near 0 for a
smooth rim (von Neumann 1941) ..."""
_PLANE = 1e-3
"""... where the heights, over the radius of the rim, are more than round-off."""
_BELOW = (0.25, 0.5, 1.0, 2.0)
"""Median edges of the rim below its lowest vertex at which a ragged one is cut."""


def straightened(surface: CurvedFacets, points: Floats) -> CurvedFacets:
    """Cut the rim through the given points (k, 3) straight, a little below, if it is ragged.

    The surface stays as it is where the rim is smooth, or where no plane cuts off just that rim.
    """
    height = points - loop_centroid(points, np.arange(len(points)))
    outward = -unit(loop_area_vector(points, np.arange(len(points))))
    height = height @ outward
    steps, even = float(((np.roll(height, -1) - height) ** 2).mean()), float((height**2).mean())
    if even <= (_PLANE * Rim(points).radius) ** 2 or steps <= _RAGGED * even:
        return surface
    loop = next(rim for rim in loops(surface.faces) if (surface.vertices[rim] == points[0]).all(axis=1).any())
    step = float(np.median(np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)))
    for share in _BELOW:
        level = points[int(np.argmin(height))] @ outward - share * step
        cut = _cut(surface, loop, outward, float(level))
        if cut is not None:
            return cut
    return surface


def _cut(surface: CurvedFacets, loop: Ints, outward: Floats, level: float) -> CurvedFacets | None:
    """Cut off what lies beyond a plane and is connected with a rim; None where that leaves no rim in its place."""
    above = linked(surface.faces, surface.vertices @ outward > level, loop)
    parted, side = split_where(surface, lambda points: points @ outward - level, above)
    beyond = (side[parted.faces] >= 0).all(axis=1)
    left = without_unused(replace(parted, faces=parted.faces[~beyond]))
    gone = np.unique(parted.faces[beyond])
    rims = set(np.unique(boundary(surface.faces))) - set(loop.tolist())
    if pinched(left.faces) or patches(left.faces).any() or not rims.isdisjoint(gone.tolist()):
        return None
    return left if len(loops(left.faces)) == len(loops(surface.faces)) else None
