"""The axis of a part, from the second and third moments of its surface."""

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.geometry.areas_and_volumes import areas

_SIMILAR_MOMENTS = 0.05
"""Relative difference below which two principal moments are similar: the part is nearly one of revolution."""
_EQUAL_MOMENTS = 1e-4
"""Relative difference below which two principal moments are equal to the accuracy of a mesh."""
_ROUND_OFF = 1e-6
"""A higher moment below this is round-off, even of single precision."""
_ORDER = np.array([1.0, np.sqrt(2.0), np.sqrt(3.0)])
"""Weights of x, y and z in `rank`: only the origin has rank 0 among points with whole or equal coordinates."""


def moments(vertices: Floats, faces: Ints) -> tuple[Floats, Floats]:
    """Centroid (3,) and area-weighted second moments (3, 3) of the surface, exact for flat faces."""
    area = areas(vertices, faces)
    corners = vertices[faces]
    centroid = (area[:, None] * corners.mean(axis=1)).sum(axis=0) / area.sum()
    corners = corners - centroid
    total = corners.sum(axis=1)
    second = np.einsum("f,fci,fcj->ij", area, corners, corners) + np.einsum("f,fi,fj->ij", area, total, total)
    return np.asarray(centroid), np.asarray(second / (12.0 * area.sum()))


def longest_axis(vertices: Floats, faces: Ints) -> tuple[Floats, str]:
    """Unit vector (3,) of the axis of a closed part, and which axis it is, in words.

    This is the longest principal axis, or the shortest if the other two are similar, as for a disc.  For a part that
    is nearly a ball it is the one that differs more from the other two, or z if all are equal.
    """
    size, frame = np.linalg.eigh(moments(vertices, faces)[1])
    short, long = (float(size[k + 1] - size[k]) / float(size[2]) for k in (0, 1))
    if short + long < _SIMILAR_MOMENTS:
        if max(short, long) < _EQUAL_MOMENTS:
            return np.array([0.0, 0.0, 1.0]), "the z axis, for the part is as round as a ball"
        which = "longest" if long >= short else "shortest"
        return frame[:, 2 if long >= short else 0], f"its {which} axis, though it is almost round"
    if long < _SIMILAR_MOMENTS:
        return frame[:, 0], "its axis of revolution"
    return frame[:, 2], "its longest axis"


def forward(vertices: Floats, faces: Ints, direction: Floats) -> Floats:
    """Unit vector along or against `direction`, from the fuller end of the part to the slimmer one.

    The fuller end has more of the surface near it.  If both ends are equal in this, higher moments decide: first how
    far the surface is from the axis.  A part that is symmetric in all of them is ordered by its coordinates, towards
    the larger ones.
    """
    unit = direction / np.linalg.norm(direction)
    centroid, second = moments(vertices, faces)
    middle = vertices[faces].mean(axis=1) - centroid
    along = middle @ unit
    away = np.linalg.norm(middle - along[:, None] * unit, axis=1) / float(np.sqrt(np.trace(second)))
    share = areas(vertices, faces)
    share = share / share.sum()
    along = along - share @ along
    along = along / (float(np.sqrt(share @ along**2)) + 1e-300)
    # odd in `along`, so that they change sign if the ends are exchanged; the skewness first
    odd = (along**3, -along * away**2, along**5, -(along**3) * away**2, -along * away**4)
    values = (float(share @ moment) for moment in odd)
    sign = next((value for value in values if abs(value) > _ROUND_OFF), float(rank(unit)))
    return np.asarray(unit if sign > 0 else -unit)


def rank(points: Floats) -> Floats:
    """Numbers (...) that order points (..., 3) about the origin if they do not differ in anything else.

    Round-off does not decide the order: of points with whole or equal coordinates only the origin has rank 0.
    """
    return np.asarray(points @ _ORDER)
