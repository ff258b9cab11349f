"""Filling of boundary loops that are not ends."""

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.geometry.areas_and_volumes import areas, loop_area, loop_centroid, perimeter
from meshwind.mesh.geometry.mesh import Mesh

_DEFECT_EDGES, _DEFECT_PERIMETER = 8, 0.2
"""Largest number of edges of a missing face, and its largest perimeter over the root of the part's area."""
_SEAM_AREA = 1e-3
"""Largest area of an open seam over that of the circle of the same perimeter."""


def fill_defects(mesh: Mesh, rims: list[Ints], requested: list[Ints]) -> tuple[Floats, Ints, list[Ints], list[str]]:
    """Fill the loops that are defects of the mesh, except for requested ends.

    Returns vertices, faces, the other loops, and notes for the user.
    """
    vertices, faces = mesh.vertices, mesh.faces
    spared = {int(loop[0]) for loop in requested}
    defects = [int(loop[0]) not in spared and is_defect(vertices, faces, loop) for loop in rims]
    for loop in [loop for loop, defect in zip(rims, defects, strict=True) if defect]:
        vertices, faces = fill_hole(vertices, faces, loop)
    count = sum(defects)
    notes = [f"filled {count} {'hole' if count == 1 else 'holes'} of missing faces or open seams"] if count else []
    return vertices, faces, [loop for loop, defect in zip(rims, defects, strict=True) if not defect], notes


def is_defect(vertices: Floats, faces: Ints, loop: Ints) -> bool:
    """Whether a loop is a missing face or an open seam of the mesh rather than an opening of the part."""
    length = perimeter(vertices, loop)
    small = len(loop) <= _DEFECT_EDGES and length < _DEFECT_PERIMETER * float(np.sqrt(areas(vertices, faces).sum()))
    return small or loop_area(vertices, loop) < _SEAM_AREA * length**2 / (4.0 * np.pi)


def fill_hole(vertices: Floats, faces: Ints, loop: Ints) -> tuple[Floats, Ints]:
    """Close a loop, in the orientation of its faces, by one face or by a fan to its centroid, a new last vertex."""
    if len(loop) == 3:
        return vertices, np.concatenate([faces, loop[None, ::-1]])
    centre = np.full(len(loop), len(vertices))
    fan = np.column_stack([np.roll(loop, -1), loop, centre])
    return np.concatenate([vertices, loop_centroid(vertices, loop)[None]]), np.concatenate([faces, fan])
