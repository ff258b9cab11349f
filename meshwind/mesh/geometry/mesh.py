"""The triangle mesh as it was read and repaired."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints, PicklableRecord


@dataclass(frozen=True)
class Mesh(PicklableRecord):
    """Triangle mesh of a part: manifold, in one piece, oriented outwards.

    `read` makes one and repairs it.  A mesh that is built from arrays must be sound already.

    Parameters
    ----------
    vertices : ndarray of float, shape (n, 3)
        Positions, in the unit of the file.
    faces : ndarray of int, shape (m, 3)
        Vertices of each triangle, counted from 0, counterclockwise as seen from outside.
    name : str, default "mesh"
        Name for titles and messages.
    repairs : tuple of str, optional
        What was changed, in words.
    read_vertices, read_faces : int, default 0
        What the file held before it was repaired.

    Examples
    --------
    >>> import meshwind as mw
    >>> mesh = mw.read("data/elbow.obj")
    >>> mesh.vertices.shape[1], mesh.faces.shape[1], mesh.name
    (3, 3, 'elbow.obj')
    """

    vertices: Floats
    faces: Ints
    name: str = "mesh"
    repairs: tuple[str, ...] = ()
    read_vertices: int = 0
    read_faces: int = 0

    @property
    def diagonal(self) -> float:
        """Diagonal of the bounding box, in the mesh's units."""
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0)))
