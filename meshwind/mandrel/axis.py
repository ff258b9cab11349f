"""The axis of a part, from the second and third moments of its surface."""

import numpy as np

from meshwind.cast import Floats, Ints
from meshwind.mandrel.measure import areas

_ALIKE = 0.05  # moments closer than this are equal
_LEVEL = 1e-3  # a skewness below this is none


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

    The longest principal axis, or the shortest where the other two are alike, as for a disc; z for a part as
    round as a ball, which has none of its own.
    """
    size, frame = np.linalg.eigh(moments(vertices, faces)[1])
    if size[2] - size[0] < _ALIKE * size[2]:
        return np.array([0.0, 0.0, 1.0]), "the z axis, for the part is as round as a ball"
    if size[2] - size[1] < _ALIKE * size[2]:
        return frame[:, 0], "its axis of revolution"
    return frame[:, 2], "its longest axis"


def forward(vertices: Floats, faces: Ints, direction: Floats) -> Floats:
    """The unit vector along or against `direction` that leads from the fuller end of the part to the slimmer.

    A part without a fuller end is told from its mirror image by its coordinates: towards the larger ones.
    """
    unit = direction / np.linalg.norm(direction)
    along = vertices[faces].mean(axis=1) @ unit
    area = areas(vertices, faces)
    along = along - (area * along).sum() / area.sum()
    spread = float(np.sqrt((area * along**2).sum() / area.sum()))
    skewness = float((area * along**3).sum() / area.sum()) / spread**3
    if abs(skewness) < _LEVEL:
        skewness = float(unit[np.argmax(np.abs(unit))])
    return np.asarray(unit if skewness > 0 else -unit)
