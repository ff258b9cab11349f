"""VTK's XML files to arrays."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.core.geometry import Block
from meshwind.core.spoken import called
from meshwind.mesh.io.in_subprocess import Arrays, in_subprocess

POINT, CELL = "point: ", "cell: "
"""Prefixes of the names of point data and cell data among the arrays of a file."""


def read_lines(path: Path) -> Block:
    """Read the polylines of a .vtp file; raises BadInputError if it cannot be read."""
    held = _held(lines_by_vtk, path)
    starts, corners, points = held["starts"], held["corners"], held["points"]
    if len(starts) < 2 or len(corners) == 0:
        return Block(points[:0], point_data=_named(held, POINT))
    if not np.array_equal(corners, np.arange(len(points))):
        raise BadInputError(f"{path} cannot be used (its lines share points); run {called('wind')} again")
    return Block(points, starts, point_data=_named(held, POINT), line_data=_named(held, CELL))


def read_vertices(path: Path) -> tuple[Floats, dict[str, NDArray[Any]]]:
    """Read the points (n, 3) of a .vtp file and their data; raises BadInputError if it cannot be read."""
    held = _held(lines_by_vtk, path)
    return held["points"], _named(held, POINT)


def read_faces(path: Path) -> Block:
    """Read the quads and triangles of a .vtu file; raises BadInputError if it cannot be read."""
    held = _held(faces_by_vtk, path)
    starts, corners = held["starts"], held["corners"]
    sizes = np.diff(starts)
    fours, threes = (
        corners[starts[:-1][sizes == size][:, None] + np.arange(size)].reshape(-1, size) for size in (4, 3)
    )
    return Block(held["points"], quads=fours, triangles=threes, point_data=_named(held, POINT))


def _held(work: Callable[[Path], Arrays], path: Path) -> Arrays:
    """Arrays of a file, read in another process, as a damaged file can end it."""
    if not path.is_file():
        raise BadInputError(f"{path} is missing; run {called('wind')} again")
    try:
        held = in_subprocess(work, path)
    except (OSError, ValueError) as error:
        raise BadInputError(f"{path} cannot be used (VTK cannot read it); run {called('wind')} again") from error
    starts, corners = held["starts"], held["corners"]
    if len(starts) and (starts[0] != 0 or (np.diff(starts) < 0).any() or starts[-1] != len(corners)):
        raise BadInputError(f"{path} cannot be used (its cells are damaged); run {called('wind')} again")
    if len(corners) and (corners.min() < 0 or corners.max() >= len(held["points"])):
        raise BadInputError(f"{path} cannot be used (its cells name points that it lacks); run {called('wind')} again")
    return held


def lines_by_vtk(path: Path) -> Arrays:
    """Points, polylines and data of a .vtp file, for `in_subprocess`."""
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    poly = _read(vtkXMLPolyDataReader(), path)
    return _packed(poly, poly.GetLines())


def faces_by_vtk(path: Path) -> Arrays:
    """Points, cells and data of a .vtu file, for `in_subprocess`."""
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

    grid = _read(vtkXMLUnstructuredGridReader(), path)
    return _packed(grid, grid.GetCells())


def _packed(data: Any, cells: Any) -> Arrays:
    starts, corners = _cells(cells)
    held = {"points": _points(data), "starts": starts, "corners": corners}
    for kind, attributes in ((POINT, data.GetPointData()), (CELL, data.GetCellData())):
        held |= {kind + name: values for name, values in _data(attributes).items()}
    return held


def _named(held: Arrays, kind: str) -> dict[str, NDArray[Any]]:
    return {name.removeprefix(kind): values for name, values in held.items() if name.startswith(kind)}


def _read(reader: Any, path: Path) -> Any:
    """Run a reader."""
    reader.SetFileName(str(path))
    if not reader.GetExecutive().Update() or reader.GetErrorCode():
        raise ValueError("VTK cannot read it")
    return reader.GetOutput()


def _points(data: Any) -> Floats:
    points = data.GetPoints()
    return np.zeros((0, 3)) if points is None else _array(points.GetData()).astype(np.float64)


def _cells(cells: Any) -> tuple[Ints, Ints]:
    starts, corners = (_array(part) for part in (cells.GetOffsetsArray(), cells.GetConnectivityArray()))
    return starts.astype(np.int64), corners.astype(np.int64)


def _data(attributes: Any) -> dict[str, NDArray[Any]]:
    arrays = (attributes.GetArray(k) for k in range(attributes.GetNumberOfArrays()))
    return {array.GetName(): _array(array) for array in arrays if array is not None}


def _array(values: Any) -> NDArray[Any]:
    """A copy that outlives the VTK object."""
    from vtkmodules.util import numpy_support

    convert: Any = numpy_support.vtk_to_numpy
    return np.array(convert(values))
