"""What an edit leaves of the wall of a part of which one skin is moved."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from meshwind.appearance.words import quantity
from meshwind.core.cast import Floats
from meshwind.editing.redesign import Redesign
from meshwind.mesh.geometry.areas_and_volumes import area_vectors
from meshwind.mesh.geometry.facet_tree import FacetTree
from meshwind.mesh.geometry.mesh import Mesh, Wall
from meshwind.mesh.geometry.rays import cast
from meshwind.mesh.opening.choose_ends import position_text
from meshwind.workflow.notes import Note

_THIN = 0.5
"""What is left of the wall's thickness at a place, over what was there, below which there is a warning."""
_THROUGH = 3.0
"""Over the wall's thickness: what lies further off is not the other skin across the wall."""


@dataclass(frozen=True)
class WallLeft:
    """Thickness (k,) of a wall before and after an edit, at points (k, 3) of the skin that was moved."""

    points: Floats
    before: Floats
    after: Floats


def wall_left(mesh: Mesh, wall: Wall, moves: Floats) -> WallLeft:
    """The wall below the vertices of the wound skin, when the mesh's vertices are moved by `moves` (n, 3).

    The other skin stays; where it is not across the wall, as below a flange, the thickness is not known and left out.
    """
    skin = wall.skin
    vectors = area_vectors(skin.vertices, skin.faces)
    normals = np.zeros_like(skin.vertices)
    for corner in skin.faces.T:
        np.add.at(normals, corner, vectors)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    inward = -normals if wall.side == "outer" else normals
    _, before = cast(FacetTree.of(mesh.vertices, wall.opposite), skin.vertices, inward, 0.0)
    known = np.flatnonzero(before < _THROUGH * wall.thickness)
    vertex = cKDTree(mesh.vertices).query(skin.vertices[known])[1]
    deeper = np.einsum("ij,ij->i", moves[vertex], inward[known])
    return WallLeft(skin.vertices[known], before[known], before[known] - deeper)


def about_wall(edited: Redesign, units: str = "") -> tuple[Note, ...]:
    """Notes on the wall of a redesigned part: what has become of it, with a warning where it has become thin."""
    wall = edited.before.chart.annulus.wall
    if wall is None:
        return ()
    left = wall_left(edited.part, wall, edited.displacement)
    if len(left.after) == 0:
        return (Note(f"only the {wall.side} skin is moved, so the wall becomes thicker or thinner"),)
    low, high = (quantity(float(value), units, 3) for value in (left.after.min(), left.after.max()))
    text = f"only the {wall.side} skin is moved; the wall is {low} to {high} thick below it afterwards"
    k = int(np.argmin(left.after / np.maximum(left.before, 1e-300)))
    if left.after[k] >= _THIN * left.before[k]:
        return (Note(text),)
    place = position_text(left.points[k], edited.part.diagonal)
    was, now = quantity(float(left.before[k]), units, 3), quantity(float(left.after[k]), units, 3)
    thin = (
        f"leaves {now} of the wall near {place}, where it was {was} thick"
        if left.after[k] > 0.0
        else f"moves the {wall.side} skin through the other one near {place}, where the wall was {was} thick"
    )
    return Note(text), Note(f"the edit {thin}; give a --bound", True)
