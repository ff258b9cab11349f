"""From a mesh file to an annulus: reading, repair, choice of the ends, trimming."""

from meshwind.mesh.geometry.mesh import Annulus, Mesh
from meshwind.mesh.inspection import Findings, check
from meshwind.mesh.io.read import SUFFIXES, check_file, read
from meshwind.mesh.opening.trim import annulus
from meshwind.mesh.repair.repair import mesh_from

__all__ = ["SUFFIXES", "Annulus", "Findings", "Mesh", "annulus", "check", "check_file", "mesh_from", "read"]
