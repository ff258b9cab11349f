"""All files of a run but the report and the picture."""

from pathlib import Path

from meshwind.layup.layup import Layup
from meshwind.mesh.geometry.mesh import Mesh
from meshwind.results.fibres import write_bridges, write_crossings, write_paths
from meshwind.results.image_files import write_chart_image
from meshwind.results.maps import maps
from meshwind.results.quad_files import write_obj, write_quads
from meshwind.results.surface_files import write_surface, write_surface_npz
from meshwind.surface.deviation import Triangles
from meshwind.surface.grid import grid


def write_files(out: Path, layup: Layup, mesh: Mesh | None = None, units: str = "") -> None:
    """Write the fibres, the quad mesh and the surface into a folder that is there.

    With the mesh, surface.vtu carries the fit error: how far each of its points lies from the mesh.  units: the name
    of the unit of length, which each file carries.
    """
    write_paths(out / "paths.vtp", layup.paths, units)
    write_bridges(out / "bridges.vtp", layup.paths, units)
    write_crossings(out / "crossings.vtp", layup.crossings, units)
    write_quads(out / "quads.vtu", layup.quads, units)
    write_obj(out / "quads.obj", layup.quads, units)
    on = grid(layup.paths.surface)
    fit_error = None if mesh is None else Triangles(mesh.vertices, mesh.faces).distances(on.points)
    write_surface(out / "surface.vtu", on, maps(on, layup, fit_error), units)
    write_surface_npz(out / "surface.npz", layup.paths.surface, units)
    write_chart_image(out / "chart.png", layup.paths.surface, units)
