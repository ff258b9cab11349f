"""Reading of STEP and IGES files by OpenCASCADE, which cuts their faces into triangles."""

from pathlib import Path
from typing import Any

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.core.opencascade import IGES, STEP, occ, parts_of, quiet, read_shape
from meshwind.core.units import BY_FILE, converted_from, unit_named
from meshwind.mesh.geometry.areas_and_volumes import areas
from meshwind.mesh.io.cad_end import about_end
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.in_subprocess import Arrays

CAD = STEP + IGES
_CHORD, _TURN = 1e-4, float(np.radians(8.0))
"""How far triangles may lie off the CAD faces, over their solid's diagonal, and how far a face may turn within an edge.

Vertices are on the faces: smooth parts are fitted to 1e-5 of the diagonal, as from meshes with four times as many.
"""
_OWN = 20
"""Solids, the largest ones, that are cut by their own diagonal; the others by that of all, as many would take long."""
_SEAM = 1e-5
"""Gap between faces, over the diagonal, up to which surfaces without a solid are sewn together."""
_MISSING = 5e-3
"""Share of the CAD faces' area by which the triangles may differ: chords across 8 degrees take 0.2 %."""


def read_cad_mesh(path: Path) -> Arrays:
    """Surface of all faces of a file, for `in_subprocess`, in mm."""
    warnings = about_end(path)
    held = read_shape(path)
    shape = held.shape
    if shape is None or not parts_of(shape, "FACE"):
        raise BadInputError(f"{path.name}: holds no CAD faces; export the whole part into one file, as STEP or STL")
    diagonal, area = _sizes(shape)
    if not 0.0 < diagonal < 1e50:
        raise BadInputError(f"{path.name}: its CAD faces have no finite size; export the part as STL from CAD")
    solids = parts_of(shape, "SOLID")
    if not solids:
        shape = _sewn(shape, _SEAM * diagonal)
    largest = sorted(solids, key=lambda solid: -_sizes(solid)[1])[:_OWN]
    for solid in largest:
        _cut(solid, _sizes(solid)[0])
    _cut(shape, diagonal)
    tables = [_triangles(face) for face in parts_of(shape, "FACE")]
    counts = [len(points) for points, _ in tables]
    starts = np.cumsum([0, *counts[:-1]])
    vertices = np.concatenate([points for points, _ in tables])
    triangles = np.concatenate([corners + start for (_, corners), start in zip(tables, starts, strict=True)])
    cut = float(areas(vertices, triangles).sum()) if len(triangles) else 0.0
    warnings += _warnings(held.lost, counts, cut, area)
    of = "each solid" if solids else "all of them"
    if len(solids) > _OWN:
        of = f"each of the {_OWN} largest solids, and of all of them for the others"
    note = f"its {len(counts)} CAD faces are cut into triangles within 1e-4 of the diagonal of {of}"
    units, units_from = _unit(held.units)
    return FileMesh(vertices, triangles, units, warnings, units_from, (note,)).packed()


def _unit(units: tuple[str, ...]) -> tuple[str, str]:
    """The unit of the converted lengths, "" if the file names none and they are as written, and who named it."""
    names = dict.fromkeys(unit_named(unit) or unit for unit in units)
    if not names or list(names) == ["mm"]:
        return "mm" if names else "", BY_FILE
    return "mm", converted_from(" and ".join(names)[:60])


def _cut(shape: Any, diagonal: float) -> None:
    """Cut the faces of a shape into triangles, but for those that are cut as finely already."""
    rules = occ("IMeshTools").IMeshTools_Parameters()
    rules.Deflection, rules.Angle, rules.Relative, rules.InParallel = _CHORD * diagonal, _TURN, False, False
    with quiet():
        occ("BRepMesh").BRepMesh_IncrementalMesh(shape, rules)


def _warnings(lost: int, counts: list[int], cut: float, area: float) -> tuple[str, ...]:
    """What of the file's faces is not in the triangles; counts: vertices of each face; areas after and before."""
    words, empty = [], counts.count(0)
    if lost:
        words.append(f"{lost} of its parts could not be read; left out")
    if empty:
        words.append(f"{empty} of {len(counts)} CAD faces could not be cut into triangles; left out")
    elif area > 0.0 and abs(cut - area) > _MISSING * area:
        words.append(f"the triangles have {100.0 * cut / area:.3g} % of the area of the CAD faces that they stand for")
    return tuple(words)


def _sizes(shape: Any) -> tuple[float, float]:
    """Diagonal of the bounding box, and area."""
    box, properties = occ("Bnd").Bnd_Box(), occ("GProp").GProp_GProps()
    occ("BRepBndLib").BRepBndLib.Add_s(shape, box, False)
    if box.IsVoid() or box.IsOpen():
        return 0.0, 0.0
    occ("BRepGProp").BRepGProp.SurfaceProperties_s(shape, properties)
    return float(np.sqrt(box.SquareExtent())), float(properties.Mass())


def _sewn(shape: Any, near: float) -> Any:
    """The shape, with faces that meet sharing their edges."""
    sewing = occ("BRepBuilderAPI").BRepBuilderAPI_Sewing(near)
    sewing.Add(shape)
    with quiet():
        sewing.Perform()
    sewn = sewing.SewedShape()
    return shape if sewn.IsNull() else sewn


def _triangles(face: Any) -> tuple[Floats, Ints]:
    """Vertices and triangles of one face, in its place and outward by its orientation; none if it was not cut."""
    place = occ("TopLoc").TopLoc_Location()
    table = occ("BRep").BRep_Tool.Triangulation_s(face, place)
    if table is None or table.NbTriangles() == 0:
        return np.empty((0, 3)), np.empty((0, 3), dtype=np.int64)
    move = place.Transformation()
    nodes = (table.Node(k).Transformed(move) for k in range(1, table.NbNodes() + 1))
    points = np.array([(node.X(), node.Y(), node.Z()) for node in nodes])
    corners = np.array([table.Triangle(k).Get() for k in range(1, table.NbTriangles() + 1)], dtype=np.int64) - 1
    turned = face.Orientation() == occ("TopAbs").TopAbs_Orientation.TopAbs_REVERSED
    return points, corners[:, ::-1] if turned != move.IsNegative() else corners
