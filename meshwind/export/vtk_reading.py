"""VTK's XML files to arrays.  VTK is imported late: it takes longer than small exports."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshwind.cast import Floats, Ints
from meshwind.errors import BadInputError


@dataclass(frozen=True)
class Lines:
    """Polylines: line k goes through points starts[k] to starts[k + 1], with data of the points and of the lines."""

    points: Floats
    starts: Ints
    point_data: dict[str, NDArray[Any]]
    cell_data: dict[str, NDArray[Any]]


@dataclass(frozen=True)
class Faces:
    """Quads (q, 4) and triangles (t, 3) between points (n, 3), with data of the points."""

    points: Floats
    quads: Ints
    triangles: Ints
    point_data: dict[str, NDArray[Any]]


def read_lines(path: Path) -> Lines:
    """Read the polylines of a .vtp file; raises BadInputError where it cannot be read."""
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    poly = _read(vtkXMLPolyDataReader(), path)
    starts, corners = _cells(poly.GetLines())
    points = _points(poly)
    if len(starts) < 2 or len(corners) == 0:
        return Lines(points[:0], np.zeros(1, np.int64), _data(poly.GetPointData()), {})
    if not np.array_equal(corners, np.arange(len(points))):
        raise BadInputError(f"{path} cannot be used (its lines share points); run `meshwind wind` again")
    return Lines(points, starts, _data(poly.GetPointData()), _data(poly.GetCellData()))


def read_vertices(path: Path) -> tuple[Floats, dict[str, NDArray[Any]]]:
    """Read the points (n, 3) of a .vtp file and their data; raises BadInputError where it cannot be read."""
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    poly = _read(vtkXMLPolyDataReader(), path)
    return _points(poly), _data(poly.GetPointData())


def read_faces(path: Path) -> Faces:
    """Read the quads and triangles of a .vtu file; raises BadInputError where it cannot be read."""
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

    grid = _read(vtkXMLUnstructuredGridReader(), path)
    starts, corners = _cells(grid.GetCells())
    sizes = np.diff(starts)
    fours, threes = (
        corners[starts[:-1][sizes == size][:, None] + np.arange(size)].reshape(-1, size) for size in (4, 3)
    )
    return Faces(_points(grid), fours, threes, _data(grid.GetPointData()))


def _read(reader: Any, path: Path) -> Any:
    """Run a reader; what VTK complains of on the terminal, in many lines, becomes one error."""
    from vtkmodules.vtkCommonCore import vtkObject

    if not path.is_file():
        raise BadInputError(f"{path} is missing; run `meshwind wind` again")
    reader.SetFileName(str(path))
    shown = vtkObject.GetGlobalWarningDisplay()
    vtkObject.SetGlobalWarningDisplay(0)
    try:
        done = reader.GetExecutive().Update()
    finally:
        vtkObject.SetGlobalWarningDisplay(shown)
    if not done or reader.GetErrorCode():
        raise BadInputError(f"{path} cannot be used (VTK cannot read it); run `meshwind wind` again")
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
