"""The triangle mesh as it was read and repaired."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints, Kept


@dataclass(frozen=True)
class Mesh(Kept):
    """A triangle mesh, repaired: manifold, one component, one orientation, outward.

    vertices (n, 3) in the units of the file; faces (m, 3) indices from 0; repairs says in words what was
    changed; read_vertices and read_faces count what the file held.
    """

    vertices: Floats
    faces: Ints
    name: str = "mesh"
    repairs: tuple[str, ...] = ()
    read_vertices: int = 0
    read_faces: int = 0

    @property
    def diagonal(self) -> float:
        """Length of the bounding box's diagonal, in the mesh's units."""
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0)))
