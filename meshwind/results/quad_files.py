"""The files of the quad mesh: quads.vtu and quads.obj."""

from pathlib import Path

import numpy as np

from meshwind.core.units import lengths_in
from meshwind.layup.quads import QuadMesh
from meshwind.results.vtk_files import write_faces


def write_quads(path: Path, mesh: QuadMesh, units: str = "") -> None:
    """Write the quad mesh for VTK, meshio and ParaView."""
    data = {"uv": mesh.uv, "on_surface": mesh.on_surface}
    write_faces(path, mesh.points, mesh.quads, mesh.triangles, data, units)


def write_obj(path: Path, mesh: QuadMesh, units: str = "") -> None:
    """Write the quad mesh for CAD and mesh tools; 17 digits bring every coordinate back exactly."""
    with path.open("w", encoding="ascii") as file:
        file.write(f"# quad mesh on the crossings of the fibres, {lengths_in(units)}\n")
        np.savetxt(file, mesh.points, fmt="v %.17g %.17g %.17g")
        np.savetxt(file, mesh.quads + 1, fmt="f %d %d %d %d")
        np.savetxt(file, mesh.triangles + 1, fmt="f %d %d %d")
