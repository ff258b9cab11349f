"""The axis of a part, from the second and third moments of its surface."""

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.geometry.areas_and_volumes import areas

_ALIKE = 0.05  # moments closer than this are equal
_ROUND = 1e-4  # moments closer than this are equal to the accuracy of a mesh
_LEVEL = 1e-6  # a skewness below this is round-off, of single precision too
_ORDER = np.array([1.0, np.sqrt(2.0), np.sqrt(3.0)])


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
    """Unit vector (3,) of the axis of a closed part, and what it is in words.

    The longest principal axis, or the shortest where the other two are alike, as for a disc.  Of a part almost as
    round as a ball it is the one that stands out from the others more, and z where none does.
    """
    size, frame = np.linalg.eigh(moments(vertices, faces)[1])
    short, long = (float(size[k + 1] - size[k]) / float(size[2]) for k in (0, 1))
    if short + long < _ALIKE:
        if max(short, long) < _ROUND:
            return np.array([0.0, 0.0, 1.0]), "the z axis, for the part is as round as a ball"
        which = "longest" if long >= short else "shortest"
        return frame[:, 2 if long >= short else 0], f"its {which} axis, though it is almost round"
    if long < _ALIKE:
        return frame[:, 0], "its axis of revolution"
    return frame[:, 2], "its longest axis"


def forward(vertices: Floats, faces: Ints, direction: Floats) -> Floats:
    """The unit vector along or against `direction` that leads from the fuller end of the part to the slimmer.

    Fuller is the end with more of the surface near it, or else the one with the surface further from the axis, or
    else what higher moments tell.  A part with none of these is told from its mirror image by its coordinates:
    towards the larger ones.
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
    # odd in `along`, so that they change sign with the part turned end for end; the skewness first
    told = (along**3, -along * away**2, along**5, -(along**3) * away**2, -along * away**4)
    clues = (float(share @ clue) for clue in told)
    clue = next((value for value in clues if abs(value) > _LEVEL), float(rank(unit)))
    return np.asarray(unit if clue > 0 else -unit)


def rank(places: Floats) -> Floats:
    """Numbers (...) by which places (..., 3) about the origin are ordered where nothing else tells them apart.

    No place with whole or equal coordinates but the origin has 0, so that round-off decides nothing.
    """
    return np.asarray(places @ _ORDER)
