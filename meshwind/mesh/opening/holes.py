"""Fill boundary loops that are no ends."""

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.geometry.areas_and_volumes import areas, loop_area_vector, loop_centroid, perimeter

_FEW_EDGES = 8
_SMALL = 0.2  # perimeter over the root of the part's area
_SLIT = 1e-3  # area over that of the circle of the same perimeter


def is_defect(vertices: Floats, faces: Ints, loop: Ints) -> bool:
    """Whether a loop is a fault of the mesh, a missing face or an open seam, and no opening of the part."""
    length = perimeter(vertices, loop)
    small = len(loop) <= _FEW_EDGES and length < _SMALL * float(np.sqrt(areas(vertices, faces).sum()))
    return small or loop_size(vertices, loop) < _SLIT * length**2 / (4.0 * np.pi)


def loop_size(vertices: Floats, loop: Ints) -> float:
    """Area that a loop encloses; unlike the perimeter it is nothing for an open seam."""
    return float(np.linalg.norm(loop_area_vector(vertices, loop)))


def filled(vertices: Floats, faces: Ints, loop: Ints) -> tuple[Floats, Ints]:
    """Close a loop, given in the sense of its faces, by one face or by the fan to its centroid, the last vertex."""
    if len(loop) == 3:
        return vertices, np.concatenate([faces, loop[None, ::-1]])
    centre = np.full(len(loop), len(vertices))
    fan = np.column_stack([np.roll(loop, -1), loop, centre])
    return np.concatenate([vertices, loop_centroid(vertices, loop)[None]]), np.concatenate([faces, fan])
