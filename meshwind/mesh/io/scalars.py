"""Scalars of a mesh file, at its own vertices or at the middles of its cells, as the file holds them.

Repair and trimming renumber vertices, so scalars keep the places they were given at.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from meshwind.core.cast import Floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.formats import vtk_output
from meshwind.mesh.io.isolated import Arrays, isolated

_BY_VTK = (".vtk", ".vtp", ".vtu")
_BY_MESHIO = (".ply", ".msh")


@dataclass(frozen=True)
class Scalars:
    """One number at each of n places: points (n, 3), values (n,)."""

    points: Floats
    values: Floats


def read_scalars(path: str | Path, name: str) -> Scalars:
    """Read the scalar `name` from a VTK, VTP, VTU, PLY or MSH file, of its points or else of its cells.

    Raises BadInputError where the format cannot hold scalars, the file cannot be read or has none of that name.
    """
    path = Path(path)
    kind = path.suffix.lower()
    if kind not in _BY_VTK + _BY_MESHIO:
        known = ", ".join(end[1:].upper() for end in _BY_VTK + _BY_MESHIO)
        raise BadInputError(f"{path.name}: this format holds no scalars; save the part with {name!r} as {known}")
    read = _read(path)
    names = read["names"].tolist()
    if name not in names:
        there = ", ".join(sorted(names)) or "none"
        raise BadInputError(f"{path.name}: has no scalar {name!r}; it holds: {there}")
    number = names.index(name)
    values, places = read[f"values {number}"], read.get(f"places {number}", read["points"])
    if len(values) != len(places) or not np.isfinite(values).all() or not np.isfinite(places).all():
        raise BadInputError(f"{path.name}: scalar {name!r} is not one finite number a vertex or cell; mend it first")
    return Scalars(frozen(places), frozen(values))


def scalar_names(path: str | Path) -> tuple[str, ...]:
    """Names of the scalars that `read_scalars` finds in a file; none where its format holds none.

    Raises BadInputError where the file cannot be read.
    """
    path = Path(path)
    if path.suffix.lower() not in _BY_VTK + _BY_MESHIO:
        return ()
    return tuple(sorted(_read(path)["names"].tolist()))


def _read(path: Path) -> Arrays:
    kind = path.suffix.lower()
    try:
        return isolated(by_vtk if kind in _BY_VTK else by_meshio, path)
    except (OSError, ValueError) as error:
        raise BadInputError(
            f"{path.name}: its scalars cannot be read; is it a whole {kind[1:].upper()} file?"
        ) from error


_Fields = dict[str, tuple[Floats | None, Floats]]
"""Per name the cells' middles, None for scalars of the points, and the values."""


def by_vtk(path: Path) -> Arrays:
    """Points and scalars of a file for `isolated`, by raw arrays only as in `formats`."""
    from vtkmodules.util import numpy_support
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    path.stat()  # VTK says nothing of a file that is not there
    data = vtk_output(path)
    points = numpy_support.vtk_to_numpy(data.GetPoints().GetData()).astype(np.float64)  # type: ignore[no-untyped-call]
    cells = data.GetPolys() if isinstance(data, vtkPolyData) else data.GetCells()
    offsets = numpy_support.vtk_to_numpy(cells.GetOffsetsArray()).astype(np.int64)  # type: ignore[no-untyped-call]
    nodes = numpy_support.vtk_to_numpy(cells.GetConnectivityArray()).astype(np.int64)  # type: ignore[no-untyped-call]
    sizes = np.diff(offsets)
    fields: _Fields = {}
    if len(sizes) and (sizes > 0).all() and offsets[0] == 0 and offsets[-1] == len(nodes):
        middles = np.add.reduceat(points[nodes], offsets[:-1], axis=0) / sizes[:, None]
        _keep_all(fields, data.GetCellData(), middles)
    _keep_all(fields, data.GetPointData(), None)
    return _packed(points, fields)


def _keep_all(fields: _Fields, data: Any, places: Floats | None) -> None:
    """Note the single numbers among VTK's arrays."""
    from vtkmodules.util import numpy_support

    for k in range(data.GetNumberOfArrays()):
        array = data.GetArray(k)
        if array is not None and array.GetName():
            _keep(fields, array.GetName(), numpy_support.vtk_to_numpy(array), places)  # type: ignore[no-untyped-call]


def by_meshio(path: Path) -> Arrays:
    """Points and scalars of a file for `isolated`."""
    import meshio

    mesh = meshio.read(path)
    points = np.asarray(mesh.points, dtype=np.float64)
    if points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    fields: _Fields = {}
    if mesh.cells and all(isinstance(block.data, np.ndarray) and block.data.ndim == 2 for block in mesh.cells):
        middles = np.concatenate([points[block.data].mean(axis=1) for block in mesh.cells])
        for name, blocks in mesh.cell_data.items():
            if all(np.ndim(values) == 1 for values in blocks):
                _keep(fields, name, np.concatenate(blocks), middles)
    for name, values in mesh.point_data.items():
        _keep(fields, name, values, None)
    return _packed(points, fields)


def _packed(points: Floats, fields: _Fields) -> Arrays:
    """As arrays by name: the cells' middles only where the scalar is theirs."""
    packed: Arrays = {"points": points, "names": np.array(list(fields), dtype=np.str_)}
    for number, (places, values) in enumerate(fields.values()):
        packed[f"values {number}"] = values
        if places is not None:
            packed[f"places {number}"] = places
    return packed


def _keep(fields: _Fields, name: str, values: object, places: Floats | None) -> None:
    """Note a field if it is of single numbers."""
    array = np.asarray(values)
    if array.ndim == 1 and array.dtype.kind in "fiub":
        fields[str(name)] = places, array.astype(np.float64)
