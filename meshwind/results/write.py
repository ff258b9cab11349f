"""Writers of a run's files, except report and pictures, and of an edited mesh."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshwind.core.cast import Floats
from meshwind.core.units import lengths_in
from meshwind.layup.crossings import Crossings
from meshwind.layup.layup import Layup
from meshwind.layup.quads import QuadMesh
from meshwind.mesh.geometry.mesh import Mesh
from meshwind.path.lengths import bridges, lengths
from meshwind.path.paths import Paths
from meshwind.results import schema
from meshwind.results.image_files import write_chart_image
from meshwind.results.maps import maps
from meshwind.results.meshio_files import write_meshio
from meshwind.results.vtk_files import write_faces, write_lines, write_vertices
from meshwind.surface.evaluate import DEGREE
from meshwind.surface.fitting.deviation import Triangles
from meshwind.surface.grid import Grid, grid
from meshwind.surface.surface import Surface


def write_files(out: Path, layup: Layup, mesh: Mesh | None = None, units: str = "") -> None:
    """Write the fibres, the quad mesh and the surface into an existing folder.

    With the mesh, surface.vtu has the fit error: the distance of each of its points to the mesh.  units: the name of
    the unit of length, which each file carries.
    """
    write_paths(out / schema.PATHS, layup.paths, units)
    write_bridges(out / schema.BRIDGES, layup.paths, units)
    write_crossings(out / schema.CROSSINGS, layup.crossings, units)
    write_quads(out / schema.QUADS, layup.quads, units)
    write_obj(out / schema.QUADS_OBJ, layup.quads, units)
    on = grid(layup.paths.surface)
    fit_error = None if mesh is None else Triangles(mesh.vertices, mesh.faces).distances(on.points)
    write_surface(out / schema.SURFACE, on, maps(on, layup, fit_error), units)
    write_spline(out / schema.SPLINE, layup.paths.surface, units)
    write_chart_image(out / schema.CHART, layup.paths.surface, units)


def write_paths(path: Path, paths: Paths, units: str = "") -> None:
    """Write one polyline per path, with the data of its particles."""
    p, n = paths.gap.shape
    each = lengths(paths)
    point_data = {
        schema.UV: paths.uv.reshape(-1, 2),
        schema.ON_SURFACE: paths.on_surface.ravel(),
        schema.GAP: paths.gap.ravel(),
        schema.NORMAL: paths.normal.reshape(-1, 3),
        schema.SLIP: paths.slip.ravel(),
        schema.ARC_LENGTH: each.arc_length.ravel(),
    }
    cell_data = {
        schema.PATH: np.arange(p),
        schema.FAMILY: paths.family,
        schema.LENGTH: each.polyline_length,
        schema.FIBRE_LENGTH: paths.length,
        schema.BRIDGED_LENGTH: each.bridged_length,
        schema.MAX_GAP: each.max_gap,
        schema.MAX_SLIP: each.max_slip,
        schema.STATUS: paths.status,
    }
    write_lines(path, paths.points.reshape(-1, 3), np.arange(p + 1) * n, point_data, cell_data, units)


def write_bridges(path: Path, paths: Paths, units: str = "") -> None:
    """Write one polyline per span off the surface, its two ends on the surface, with the gap along it."""
    spans = bridges(paths)
    sizes = spans.last - spans.first + 1
    starts = np.concatenate([[0], np.cumsum(sizes)])
    row = np.repeat(spans.path, sizes)
    column = np.arange(starts[-1]) - np.repeat(starts[:-1] - spans.first, sizes)
    cell_data: dict[schema.Field, NDArray[Any]] = {
        schema.PATH: spans.path,
        schema.LENGTH: spans.length,
        schema.MAX_GAP: spans.max_gap,
        schema.RESOLVED: spans.resolved.astype(np.uint8),
    }
    points = paths.points[row, column]
    points[starts[:-1]], points[starts[1:] - 1] = spans.ends[:, 0], spans.ends[:, 1]
    write_lines(path, points, starts, {schema.GAP: paths.gap[row, column]}, cell_data, units)


def write_crossings(path: Path, crossings: Crossings, units: str = "") -> None:
    """Write one vertex per crossing; the angle in degrees."""
    point_data = {
        schema.PATH_A: crossings.path_a,
        schema.PATH_B: crossings.path_b,
        schema.ANGLE: np.degrees(crossings.angle),
        schema.QUALITY: np.abs(np.cos(crossings.angle)),
        schema.UV: crossings.uv,
        schema.ON_SURFACE: crossings.on_surface,
    }
    write_vertices(path, crossings.points, point_data, units)


def write_quads(path: Path, mesh: QuadMesh, units: str = "") -> None:
    """Write the quad mesh for VTK, meshio and ParaView."""
    data = {schema.UV: mesh.uv, schema.ON_SURFACE: mesh.on_surface}
    write_faces(path, mesh.points, mesh.quads, mesh.triangles, data, units)


def write_obj(path: Path, mesh: QuadMesh, units: str = "") -> None:
    """Write the quad mesh for CAD and mesh tools; 17 digits keep every coordinate exactly."""
    with path.open("w", encoding="ascii") as file:
        file.write(f"# quad mesh on the crossings of the fibres, {lengths_in(units)}\n")
        np.savetxt(file, mesh.points, fmt="v %.17g %.17g %.17g")
        np.savetxt(file, mesh.quads + 1, fmt="f %d %d %d %d")
        np.savetxt(file, mesh.triangles + 1, fmt="f %d %d %d")


def write_surface(path: Path, on: Grid, data: dict[schema.Field, Floats], units: str = "") -> None:
    """Write the grid with its maps as point data."""
    write_faces(path, on.points, on.quads, np.zeros((0, 3), dtype=np.int64), data, units)


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
    write_faces(out / schema.EDITED, mesh.vertices, np.empty((0, 4), np.int64), faces, data, units)
    parts = {str(name): np.ascontiguousarray(moves[:, k]) for k, name in enumerate((schema.DX, schema.DY, schema.DZ))}
    cells = [("triangle", faces.astype(np.int32))]
    write_meshio(out / schema.EDITED_PLY, vertices, cells, point_data=parts | {str(schema.MOVED): moved}, units=units)
