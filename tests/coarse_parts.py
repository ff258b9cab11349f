"""Sample parts of fewer vertices, for tests in which nothing depends on how fine the mesh is."""

from pathlib import Path

import trimesh
from sample_parts import shapes
from sample_parts.mesher import Part, triangulate

from meshwind.mesh import Mesh, mesh_from


def coarse_vase(vertices: int = 1200) -> Mesh:
    """The vase; its programs are smaller by more than the share of its vertices."""
    return mesh_from(*triangulate(Part("vase.stl", shapes.vase, closed=False, vertices=vertices, grid=(200, 240)), 0))


def saved(part: Mesh, file: Path) -> Path:
    """A mesh in a file of the format that its name says."""
    trimesh.Trimesh(part.vertices, part.faces, process=False).export(file)
    return file
