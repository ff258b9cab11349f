"""Reading of scalar fields from mesh files, with the points that they belong to.

The points are the file's vertices or the centroids of its cells: repair and trimming renumber vertices.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from meshwind.core.cast import Floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.face_lists import Lists, whole
from meshwind.mesh.io.in_subprocess import Arrays, in_subprocess
from meshwind.mesh.io.ply import read_tables
from meshwind.mesh.io.ply_rows import Columns
from meshwind.mesh.io.vtk_cells import vtk_array
from meshwind.mesh.io.vtk_vtu_vtp import vtk_output

_BY_VTK = (".vtk", ".vtp", ".vtu")
_HOLD_SCALARS = (*_BY_VTK, ".ply", ".msh")


@dataclass(frozen=True)
class Scalars:
    """Scalar field: points (n, 3) and values (n,)."""

    points: Floats
    values: Floats


def read_scalars(path: str | Path, name: str) -> Scalars:
    """Read the scalar `name` from a VTK, VTP, VTU, PLY or MSH file, of its points or else of its cells.

    Raises BadInputError if the format cannot hold scalars, or the file cannot be read or has none of that name.
    """
    path = Path(path)
    kind = path.suffix.lower()
    if kind not in _HOLD_SCALARS:
        known = ", ".join(end[1:].upper() for end in _HOLD_SCALARS)
        raise BadInputError(f"{path.name}: this format holds no scalars; save the part with {name!r} as {known}")
    arrays = _read(path)
    names = arrays["names"].tolist()
    if name not in names:
        available = ", ".join(sorted(names)) or "none"
        raise BadInputError(f"{path.name}: has no scalar {name!r}; it holds: {available}")
    number = names.index(name)
    values, points = arrays[f"values {number}"], arrays.get(f"points {number}", arrays["points"])
    if len(values) != len(points) or not np.isfinite(values).all() or not np.isfinite(points).all():
        raise BadInputError(
            f"{path.name}: scalar {name!r} is not one finite number per vertex or cell; correct it first"
        )
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
        if kind == ".ply":
            return by_ply(path)
        return in_subprocess(by_vtk if kind in _BY_VTK else by_meshio, path)
    except BadInputError:
        raise
    except (OSError, ValueError, LookupError, ArithmeticError) as error:
        raise BadInputError(
            f"{path.name}: its scalars cannot be read; is it a whole {kind[1:].upper()} file?"
        ) from error


_Fields = dict[str, tuple[Floats | None, Floats]]
"""By name the cells' centroids, or None for scalars of the vertices, and the values."""


def by_vtk(path: Path) -> Arrays:
    """Points and scalars of a file, for `in_subprocess`; only raw arrays are used, as in `read_vtk`."""
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    path.stat()  # VTK does not report a missing file
    data = vtk_output(path)
    points = vtk_array(data.GetPoints().GetData(), np.float64)
    cells = data.GetPolys() if isinstance(data, vtkPolyData) else data.GetCells()
    offsets = vtk_array(cells.GetOffsetsArray(), np.int64)
    nodes = vtk_array(cells.GetConnectivityArray(), np.int64)
    sizes = np.diff(offsets)
    fields: _Fields = {}
    if len(sizes) and (sizes > 0).all() and offsets[0] == 0 and offsets[-1] == len(nodes):
        centroids = np.add.reduceat(points[nodes], offsets[:-1], axis=0) / sizes[:, None]
        _add_arrays(fields, data.GetCellData(), centroids)
    _add_arrays(fields, data.GetPointData(), None)
    return _packed(points, fields)


def _add_arrays(fields: _Fields, data: Any, points: Floats | None) -> None:
    """Add the scalars among VTK's arrays."""
    from vtkmodules.util import numpy_support

    for k in range(data.GetNumberOfArrays()):
        array = data.GetArray(k)
        if array is not None and array.GetName():
            _add(fields, array.GetName(), numpy_support.vtk_to_numpy(array), points)  # type: ignore[no-untyped-call]


def by_ply(path: Path) -> Arrays:
    """Points and scalars of a PLY file: the properties of its vertices, and those of its faces."""
    ply = read_tables(path)
    points, corners = ply.points(), ply.corners("face")
    fields: _Fields = {}
    if corners is not None and len(corners.sizes) and corners.sizes.min() > 0:
        nodes = whole(corners.values)
        if nodes.min() < 0 or nodes.max() >= len(points):
            raise ValueError("a face refers to a vertex that does not exist")
        centroids = np.add.reduceat(points[nodes], np.cumsum(corners.sizes) - corners.sizes, axis=0)
        _add_columns(fields, ply.tables["face"], centroids / corners.sizes[:, None])
    _add_columns(fields, ply.tables["vertex"], None)
    return _packed(points, fields)


def _add_columns(fields: _Fields, columns: Columns, points: Floats | None) -> None:
    """Add the scalars among the columns of an element, but not its coordinates."""
    for name, values in columns.items():
        if not isinstance(values, Lists) and name not in ("x", "y", "z"):
            _add(fields, name, values, points)


def by_meshio(path: Path) -> Arrays:
    """Points and scalars of a file, for `in_subprocess`."""
    import meshio

    mesh = meshio.read(path)
    points = np.asarray(mesh.points, dtype=np.float64)
    if points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    fields: _Fields = {}
    if mesh.cells and all(isinstance(block.data, np.ndarray) and block.data.ndim == 2 for block in mesh.cells):
        centroids = np.concatenate([points[block.data].mean(axis=1) for block in mesh.cells])
        for name, blocks in mesh.cell_data.items():
            if all(np.ndim(values) == 1 for values in blocks):
                _add(fields, name, np.concatenate(blocks), centroids)
    for name, values in mesh.point_data.items():
        _add(fields, name, values, None)
    return _packed(points, fields)


def _packed(points: Floats, fields: _Fields) -> Arrays:
    """Arrays by name, with centroids only for the scalars of cells."""
    packed: Arrays = {"points": points, "names": np.array(list(fields), dtype=np.str_)}
    for number, (centroids, values) in enumerate(fields.values()):
        packed[f"values {number}"] = values
        if centroids is not None:
            packed[f"points {number}"] = centroids
    return packed


def _add(fields: _Fields, name: str, values: object, points: Floats | None) -> None:
    """Add a field if it is a scalar."""
    array = np.asarray(values)
    if array.ndim == 1 and array.dtype.kind in "fiub":
        fields[str(name)] = points, array.astype(np.float64)
