"""What an edit leaves of the wall of a part of which one skin is moved."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from meshwind.core.cast import Floats
from meshwind.mesh.geometry.areas_and_volumes import area_vectors
from meshwind.mesh.geometry.facet_tree import FacetTree
from meshwind.mesh.geometry.mesh import Mesh, Wall
from meshwind.mesh.geometry.rays import cast

_THROUGH = 3.0
"""Over the wall's thickness: what lies further off is not the other skin across the wall."""


@dataclass(frozen=True)
class WallLeft:
    """Thickness (k,) of a wall before and after an edit, at points (k, 3) of the skin that was moved."""

    points: Floats
    before: Floats
    after: Floats

    @property
    def pierced(self) -> bool:
        """Whether the skin that was moved has come through the other one."""
        return bool((self.after <= 0.0).any())


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
