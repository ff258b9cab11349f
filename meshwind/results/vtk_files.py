"""VTK's XML files from arrays.  VTK is imported late: it takes longer than small runs.

Points and fields carry the name of their unit as VTK's own key UNITS_LABEL; `units` is that of lengths, "" where it is
not known.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from meshwind.core.cast import Floats, Ints
from meshwind.results.schema import Field

Data: TypeAlias = Mapping[Field, NDArray[Any]]

VERTEX, TRIANGLE, QUAD = 1, 5, 9
"""VTK's numbers of the cell types."""


def write_lines(path: Path, points: Floats, starts: Ints, point_data: Data, cell_data: Data, units: str) -> None:
    """Write polylines over consecutive points: line k holds points starts[k] to starts[k + 1] (l + 1,)."""
    poly = _polydata(points, point_data, cell_data, units)
    poly.SetLines(_cells(starts, np.arange(len(points))))
    _write_polydata(path, poly)


def write_vertices(path: Path, points: Floats, point_data: Data, units: str) -> None:
    """Write points, each with a vertex cell."""
    poly = _polydata(points, point_data, {}, units)
    poly.SetVerts(_cells(np.arange(len(points) + 1), np.arange(len(points))))
    _write_polydata(path, poly)


def write_faces(path: Path, points: Floats, quads: Ints, triangles: Ints, point_data: Data, units: str) -> None:
    """Write an unstructured grid of quads (q, 4) and triangles (t, 3), in this order.

    Without faces the points become vertex cells: meshio cannot read a grid that has no cell.
    """
    from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    grid = vtkUnstructuredGrid()
    grid.SetPoints(_points(points, units))
    _add(grid.GetPointData(), point_data, units)
    blocks = [(QUAD, quads), (TRIANGLE, triangles)]
    if not len(quads) + len(triangles):
        blocks = [(VERTEX, np.arange(len(points))[:, None])]
    kinds = np.concatenate([np.full(len(block), kind, dtype=np.uint8) for kind, block in blocks])
    sizes = np.concatenate([np.full(len(block), block.shape[1]) for _, block in blocks])
    corners = np.concatenate([block.ravel() for _, block in blocks])
    grid.SetCells(_array(kinds), _cells(np.concatenate([[0], np.cumsum(sizes)]), corners))
    _write(vtkXMLUnstructuredGridWriter(), path, grid)


def _polydata(points: Floats, point_data: Data, cell_data: Data, units: str) -> Any:
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    poly = vtkPolyData()
    poly.SetPoints(_points(points, units))
    _add(poly.GetPointData(), point_data, units)
    _add(poly.GetCellData(), cell_data, units)
    return poly


def _write_polydata(path: Path, poly: Any) -> None:
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    _write(vtkXMLPolyDataWriter(), path, poly)


def _write(writer: Any, path: Path, data: Any) -> None:
    """Write uncompressed: five times as fast as with zlib, which saves only a tenth on such numbers.

    The text is made in memory, as VTK itself ends the process if the disk is full.
    """
    writer.WriteToOutputStringOn()
    writer.SetInputData(data)
    writer.SetDataModeToBinary()
    writer.SetCompressorTypeToNone()
    if writer.Write() != 1:
        raise OSError(f"VTK could not write {path.name}")
    path.write_text(writer.GetOutputString(), encoding="utf-8", newline="\n")


def _points(points: Floats, units: str) -> Any:
    from vtkmodules.vtkCommonCore import vtkPoints

    out = vtkPoints()
    out.SetData(_labelled(_array(points.reshape(-1, 3)), units))
    return out


def _cells(starts: Ints, corners: Ints) -> Any:
    from vtkmodules.vtkCommonDataModel import vtkCellArray

    out = vtkCellArray()
    out.SetData(_array(starts.astype(np.int64)), _array(corners.astype(np.int64)))
    return out


def _add(attributes: Any, data: Data, units: str) -> None:
    for field, values in data.items():
        array = _array(values)
        array.SetName(str(field))
        attributes.AddArray(_labelled(array, field.unit_in(units)))


def _labelled(array: Any, unit: str) -> Any:
    """The array, labelled with the name of its unit if it has one."""
    if unit:
        array.GetInformation().Set(array.UNITS_LABEL(), unit)
    return array


def _array(values: NDArray[Any]) -> Any:
    """A VTK array with its own copy of the values; booleans become uint8."""
    from vtkmodules.util import numpy_support

    plain = values.astype(np.uint8) if values.dtype == np.bool_ else values
    convert: Any = numpy_support.numpy_to_vtk
    return convert(np.ascontiguousarray(plain), deep=True)
