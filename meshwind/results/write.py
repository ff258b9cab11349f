"""Writers of a run's files, except report and pictures, and of an edited mesh."""

from pathlib import Path
from typing import Any

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.geometry import Block, Data
from meshwind.core.units import lengths_in
from meshwind.layup.layup import Layup
from meshwind.layup.quads import QuadMesh
from meshwind.mesh.geometry.mesh import Mesh
from meshwind.path.blocks import bridges_block, paths_block
from meshwind.results import schema
from meshwind.results.image_files import write_chart_image
from meshwind.results.maps import maps
from meshwind.results.meshio_files import write_meshio
from meshwind.results.vtk_files import write_faces, write_lines, write_vertices
from meshwind.surface.evaluate import DEGREE
from meshwind.surface.fitting.deviation import Triangles
from meshwind.surface.grid import Grid, grid
from meshwind.surface.surface import Surface


def surface_maps(layup: Layup, mesh: Mesh | None = None) -> Data:
    """The maps of surface.vtu; with the mesh also the fit error, the distance of each point of the grid to it."""
    on = grid(layup.paths.surface)
    fit_error = None if mesh is None else Triangles(mesh.vertices, mesh.faces).distances(on.points)
    return maps(on, layup, fit_error)


def write_files(out: Path, layup: Layup, maps: Data, units: str = "") -> None:
    """Write the fibres, the quad mesh and the surface into an existing folder.

    maps: those of surface.vtu; units: the name of the unit of length, which each file carries.
    """
    write_lines(out / schema.PATHS, schema.PATHS, paths_block(layup.paths), units)
    write_lines(out / schema.BRIDGES, schema.BRIDGES, bridges_block(layup.paths), units)
    write_vertices(out / schema.CROSSINGS, schema.CROSSINGS, layup.crossings.block, units)
    write_faces(out / schema.QUADS, schema.QUADS, layup.quads.block, units)
    write_obj(out / schema.QUADS_OBJ, layup.quads, units)
    write_surface(out / schema.SURFACE, grid(layup.paths.surface), maps, units)
    write_spline(out / schema.SPLINE, layup.paths.surface, units)
    write_chart_image(out / schema.CHART, layup.paths.surface, units)


def write_obj(path: Path, mesh: QuadMesh, units: str = "") -> None:
    """Write the quad mesh for CAD and mesh tools; 17 digits keep every coordinate exactly."""
    with path.open("w", encoding="ascii") as file:
        file.write(f"# quad mesh on the crossings of the fibres, {lengths_in(units)}\n")
        np.savetxt(file, mesh.points, fmt="v %.17g %.17g %.17g")
        np.savetxt(file, mesh.quads + 1, fmt="f %d %d %d %d")
        np.savetxt(file, mesh.triangles + 1, fmt="f %d %d %d")


def write_surface(path: Path, on: Grid, data: Data, units: str = "") -> None:
    """Write the grid with its maps as point data."""
    write_faces(path, schema.SURFACE, Block(on.points, quads=on.quads, point_data=data), units)


def write_spline(path: Path, surface: Surface, units: str = "") -> None:
    """Write the spline of the surface; if `periodic_u`, scipy's BSpline needs the first three rows again at the end."""
    knots_u, knots_v = surface.knots
    arrays: dict[str, Any] = {
        schema.CONTROL_POINTS: surface.control_points,
        schema.KNOTS_U: knots_u,
        schema.KNOTS_V: knots_v,
        schema.DEGREE: np.int64(DEGREE),
        schema.PERIODIC_U: np.bool_(surface.periodic),
        schema.UNITS: np.str_(units),
    }
    if surface.uncertainty is not None:
        arrays[schema.UNCERTAINTY] = surface.uncertainty
    if surface.threshold is not None:
        arrays[schema.THRESHOLD] = np.float64(surface.threshold)
    with path.open("wb") as file:
        np.savez(file, **arrays)


def write_edited(out: Path, mesh: Mesh, displacement: Floats, units: str) -> None:
    """Write edited.ply and edited.vtu: an edited mesh, in the order of the mesh that was read.

    Point data: displacement (n, 3) in edited.vtu, its parts dx, dy, dz in edited.ply, and its size `moved` in both.
    """
    moves, vertices, faces = np.asarray(displacement), np.asarray(mesh.vertices), np.asarray(mesh.faces)
    moved = np.linalg.norm(moves, axis=1)
    data = {schema.DISPLACEMENT: moves, schema.MOVED: moved}
    write_faces(out / schema.EDITED, schema.EDITED, Block(mesh.vertices, triangles=faces, point_data=data), units)
    parts = {str(name): np.ascontiguousarray(moves[:, k]) for k, name in enumerate((schema.DX, schema.DY, schema.DZ))}
    cells = [("triangle", faces.astype(np.int32))]
    write_meshio(out / schema.EDITED_PLY, vertices, cells, point_data=parts | {str(schema.MOVED): moved}, units=units)
