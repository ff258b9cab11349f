"""Any triangle mesh to a clean annulus: read, repair, choose the ends, trim."""

from meshwind.mandrel.annulus import Annulus
from meshwind.mandrel.findings import Findings, inspect
from meshwind.mandrel.mesh import Mesh
from meshwind.mandrel.read import SUFFIXES, read
from meshwind.mandrel.repair import mesh_from
from meshwind.mandrel.trim import annulus

__all__ = ["SUFFIXES", "Annulus", "Findings", "Mesh", "annulus", "inspect", "mesh_from", "read"]
