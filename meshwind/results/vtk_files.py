"""VTK's XML files from arrays.  VTK is imported late: it takes longer than small runs.

Points and fields carry the name of their unit as VTK's own key UNITS_LABEL; `units` is that of lengths, "" where it is
not known.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshwind.core.cast import Floats, Ints
from meshwind.core.geometry import Block, Data
from meshwind.results.schema import Field, File

VERTEX, TRIANGLE, QUAD = 1, 5, 9
"""VTK's numbers of the cell types."""


def write_lines(path: Path, fields: File, block: Block, units: str) -> None:
    """Write polylines; fields: what the file holds."""
    poly = _polydata(fields, block, units)
    poly.SetLines(_cells(block.starts, np.arange(len(block.points))))
    _write_polydata(path, poly)


def write_vertices(path: Path, fields: File, block: Block, units: str) -> None:
    """Write points, each with a vertex cell."""
    poly = _polydata(fields, block, units)
    poly.SetVerts(_cells(np.arange(len(block.points) + 1), np.arange(len(block.points))))
    _write_polydata(path, poly)


def write_faces(path: Path, fields: File, block: Block, units: str) -> None:
    """Write an unstructured grid of quads and triangles, in this order.

    Without faces the points become vertex cells: meshio cannot read a grid that has no cell.
    """
    from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    grid = vtkUnstructuredGrid()
    grid.SetPoints(_points(block.points, units))
    _add(grid.GetPointData(), fields.point_data, block.point_data, units)
    cells = [(QUAD, block.quads), (TRIANGLE, block.triangles)]
    if not len(block.quads) + len(block.triangles):
        cells = [(VERTEX, np.arange(len(block.points))[:, None])]
    kinds = np.concatenate([np.full(len(corners), kind, dtype=np.uint8) for kind, corners in cells])
    sizes = np.concatenate([np.full(len(corners), corners.shape[1]) for _, corners in cells])
    corners = np.concatenate([corners.ravel() for _, corners in cells])
    grid.SetCells(_array(kinds), _cells(np.concatenate([[0], np.cumsum(sizes)]), corners))
    _write(vtkXMLUnstructuredGridWriter(), path, grid)


def _polydata(fields: File, block: Block, units: str) -> Any:
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    poly = vtkPolyData()
    poly.SetPoints(_points(block.points, units))
    _add(poly.GetPointData(), fields.point_data, block.point_data, units)
    _add(poly.GetCellData(), fields.cell_data, block.line_data, units)
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


def _add(attributes: Any, fields: Sequence[Field], data: Data, units: str) -> None:
    """Add the arrays of the fields, in this order, and then those of other fields that the data are named by."""
    others = [name for name in data if name not in fields and isinstance(name, Field)]
    for field in (*fields, *others):
        if field not in data:  # a surface that is exact has no uncertainty, one without a mesh no error
            continue
        array = _array(data[field])
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
