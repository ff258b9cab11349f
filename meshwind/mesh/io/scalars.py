"""Reading of scalar fields from meshes in files and in memory, with the points that they belong to.

The points are the mesh's vertices or the centroids of its cells: repair and trimming renumber vertices.
"""

from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.face_lists import Lists, whole
from meshwind.mesh.io.fields import Field, Fields, add_scalar, centroids, has_surface, means, packed, used_points
from meshwind.mesh.io.in_memory import blocks_of, by_library
from meshwind.mesh.io.in_subprocess import Arrays, in_subprocess
from meshwind.mesh.io.msh.data import msh_fields
from meshwind.mesh.io.msh.msh import mesh_of
from meshwind.mesh.io.msh.sections import sections_of
from meshwind.mesh.io.ply.ply import read_tables
from meshwind.mesh.io.ply.rows import Columns
from meshwind.mesh.io.read import path_of
from meshwind.mesh.io.vtk.cells import GHOSTS
from meshwind.mesh.io.vtk.vtk import cells_of, vtk_output

_BY_VTK = (".vtk", ".vtp", ".vtu")
_HOLD_SCALARS = (*_BY_VTK, ".ply", ".msh")


@dataclass(frozen=True)
class Scalars:
    """Scalar field: points (n, 3) and values (n,)."""

    points: Floats
    values: Floats


def read_scalars(mesh: str | PathLike[str] | Any, name: str) -> Scalars:
    """Take the scalar `name` of a VTK, VTP, VTU, PLY or MSH file, or of a mesh of PyVista, meshio or trimesh in memory.

    It is one of its points or else of its cells.  Raises BadInputError if the format cannot hold scalars, or the file
    cannot be read or has none of that name.
    """
    if not isinstance(mesh, str | PathLike):
        return _chosen(_in_memory(mesh, name), name, "the mesh in memory")
    path = path_of(mesh)
    kind = path.suffix.lower()
    if kind not in _HOLD_SCALARS:
        known = ", ".join(end[1:].upper() for end in _HOLD_SCALARS)
        raise BadInputError(f"{path.name}: this format holds no scalars; save the part with {name!r} as {known}")
    return _chosen(_read(path), name, path.name)


def _in_memory(mesh: object, name: str) -> Arrays:
    found = by_library(mesh, {"trimesh": _of_trimesh, "meshio": _of_meshio, "pyvista": _of_pyvista})
    if found is None:
        raise BadInputError(
            f"a mesh of type {type(mesh).__name__} holds no scalar {name!r}; give its file, or a mesh of PyVista, "
            "meshio or trimesh that has it"
        )
    return found


def _of_trimesh(mesh: Any) -> Arrays | None:
    import trimesh

    if not isinstance(mesh, trimesh.Trimesh):
        return None
    fields: Fields = {}
    for name, values in mesh.face_attributes.items():
        add_scalar(fields, name, values, np.asarray(mesh.triangles_center))
    for name, values in mesh.vertex_attributes.items():
        add_scalar(fields, name, values, None)
    return packed(np.asarray(mesh.vertices, dtype=np.float64), fields)


def _of_meshio(mesh: Any) -> Arrays | None:
    import meshio

    if not isinstance(mesh, meshio.Mesh):
        return None
    points, blocks = blocks_of(mesh)
    of_surface = [number for number, block in enumerate(blocks) if has_surface(block[0])]
    fields: Fields = {}
    if of_surface:
        middles = np.concatenate([centroids(points, blocks[number]) for number in of_surface])
        for name, held in mesh.cell_data.items():
            add_scalar(fields, name, np.concatenate([held[number] for number in of_surface]), middles)
    used = used_points(len(points), blocks)
    for name, values in mesh.point_data.items():
        add_scalar(fields, name, np.asarray(values)[used], None)
    return packed(points[used], fields)


def _of_pyvista(mesh: Any) -> Arrays | None:
    import pyvista as pv

    return of_vtk(mesh, "the mesh in memory") if isinstance(mesh, pv.DataSet) else None


def _chosen(arrays: Arrays, name: str, of: str) -> Scalars:
    names = arrays["names"].tolist()
    if name not in names:
        available = ", ".join(sorted(names)) or "none"
        raise BadInputError(f"{of}: has no scalar {name!r}; it holds: {available}")
    number = names.index(name)
    if problem := str(arrays["problems"][number]):
        raise BadInputError(f"{of}: scalar {name!r} {problem}")
    values, points = arrays[f"values {number}"], arrays.get(f"points {number}", arrays["points"])
    if len(values) != len(points) or not np.isfinite(values).all() or not np.isfinite(points).all():
        raise BadInputError(f"{of}: scalar {name!r} is not one finite number per vertex or cell; correct it first")
    return Scalars(frozen(points), frozen(values))


def scalar_names(path: str | Path) -> tuple[str, ...]:
    """Names of the scalars that `read_scalars` finds in a file; none if its format cannot hold any.

    Raises BadInputError if the file cannot be read.
    """
    path = Path(path)
    if path.suffix.lower() not in _HOLD_SCALARS:
        return ()
    return tuple(sorted(_read(path)["names"].tolist()))


def _read(path: Path) -> Arrays:
    kind = path.suffix.lower()
    try:
        return in_subprocess(by_vtk, path) if kind in _BY_VTK else by_ply(path) if kind == ".ply" else by_msh(path)
    except BadInputError:
        raise
    except (OSError, ValueError, LookupError, ArithmeticError) as error:
        reason = (
            f" ({str(error).strip().splitlines()[0][:200]})" if isinstance(error, ValueError) and str(error) else ""
        )
        raise BadInputError(
            f"{path.name}: its scalars cannot be read{reason}; is it a whole {kind[1:].upper()} file?"
        ) from error


def by_vtk(path: Path) -> Arrays:
    """Points and scalars of a file, for `in_subprocess`; the cells are those that are read as a mesh."""
    path.stat()  # VTK does not report a missing file
    return of_vtk(vtk_output(path), path.name)


def of_vtk(data: Any, name: str) -> Arrays:
    """Points and scalars of VTK's data, which messages call by a name."""
    cells = cells_of(data, name)
    of_cells = [(block, places) for block, places in zip(cells.blocks, cells.places, strict=True)
                if has_surface(block[0])]  # fmt: skip
    fields: Fields = {}
    if of_cells:
        middles = np.concatenate([centroids(cells.points, block) for block, _ in of_cells])
        places = np.concatenate([places for _, places in of_cells])
        _add_arrays(fields, (data.GetCellData(), data.GetNumberOfCells()), middles, places)
    used = np.flatnonzero(used_points(len(cells.points), cells.blocks))
    _add_arrays(fields, (data.GetPointData(), len(cells.points)), None, used)
    return packed(cells.points[used], fields)


def _add_arrays(fields: Fields, arrays: tuple[Any, int], points: Floats | None, places: Ints) -> None:
    """Add the scalars among VTK's arrays, which have so many values, with what they have at these places."""
    from vtkmodules.util import numpy_support

    data, count = arrays
    for k in range(data.GetNumberOfArrays()):
        array = data.GetArray(k)
        if array is None or not array.GetName() or array.GetName() == GHOSTS:
            continue
        values = numpy_support.vtk_to_numpy(array)  # type: ignore[no-untyped-call]
        if len(values) == count:
            add_scalar(fields, array.GetName(), values[places], points)
        elif values.ndim == 1:
            fields[array.GetName()] = Field(problem=f"has {len(values)} values for {count} points or cells; correct it")


def by_ply(path: Path) -> Arrays:
    """Points and scalars of a PLY file: the properties of its vertices, and those of its faces."""
    ply = read_tables(path)
    points, corners = ply.points(), ply.corners("face")
    fields: Fields = {}
    if corners is not None and len(corners.sizes) and corners.sizes.min() > 0:
        _add_columns(fields, ply.tables["face"], means(points, corners.sizes, whole(corners.values)))
    _add_columns(fields, ply.tables["vertex"], None)
    return packed(points, fields)


def _add_columns(fields: Fields, columns: Columns, points: Floats | None) -> None:
    """Add the scalars among the columns of an element, but not its coordinates."""
    for name, values in columns.items():
        if not isinstance(values, Lists) and name not in ("x", "y", "z"):
            add_scalar(fields, name, values, points)


def by_msh(path: Path) -> Arrays:
    """Points and scalars of an MSH file."""
    sections = sections_of(path.read_bytes())
    mesh = mesh_of(sections)
    return packed(mesh.points, msh_fields(sections, mesh))
