"""Reading of VTK, VTU and VTP files by VTK.

What a file announces is looked up first: damaged lists of legacy files end VTK's process, and its readers leave out
what they cannot follow.
"""

import codecs
from pathlib import Path
from typing import Any

from meshwind.core.errors import BadInputError
from meshwind.mesh.io.cells.surface import surface_mesh
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.in_subprocess import DAMAGED, Arrays
from meshwind.mesh.io.text import own_unit, plain_text
from meshwind.mesh.io.vtk.announced import (
    ADVICE,
    GRID,
    LEGACY,
    POLYGONS,
    announced_by_legacy,
    announced_by_xml,
    check_counts,
    form_of,
)
from meshwind.mesh.io.vtk.arrays import check_held, held_by_xml
from meshwind.mesh.io.vtk.cells import Cells, merged, of_grid, of_polygons, of_structured

_HEAD = 400
"""Length of the part of a legacy file that has more than one line."""


def read_vtk(path: Path) -> Arrays:
    """Surface of a file of polygons, or of an unstructured or structured grid, for `in_subprocess`."""
    content = path.read_bytes()
    form, pieces, unit, changed = form_of(content, path.name), 1, "", None
    if form == LEGACY:
        changed = _changed(content)
        announced, unit = announced_by_legacy(changed or content, path.name), own_unit(changed or content)
    else:
        announced, pieces = announced_by_xml(content)
    data = _output(path, form, changed)
    cells = cells_of(data, path.name)
    check_counts(announced, _counts(data))
    if form != LEGACY:
        check_held(held_by_xml(content), _counts(data) | _node_counts(data))
    return _surface(merged(cells) if pieces > 1 else cells, _unit(data) or unit).packed()


def surface_of_vtk(data: Any) -> FileMesh | None:
    """Surface of polygons and strips, or of an unstructured or structured grid, None for another kind of data."""
    cells = _cells(data)
    return None if cells is None else _surface(cells, _unit(data))


def cells_of(data: Any, name: str) -> Cells:
    """Cells of VTK's data.  Raises BadInputError with the file's name for data of another kind."""
    cells = _cells(data)
    if cells is None:
        raise BadInputError(f"{name}: holds no polygons or cells; {ADVICE}")
    return cells


def _cells(data: Any) -> Cells | None:
    from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkStructuredGrid, vtkUnstructuredGrid

    if isinstance(data, vtkPolyData):
        return of_polygons(data)
    if isinstance(data, vtkUnstructuredGrid):
        return of_grid(data)
    return of_structured(data) if isinstance(data, vtkStructuredGrid) else None


def _surface(cells: Cells, unit: str) -> FileMesh:
    return surface_mesh(cells.points, cells.blocks, unit, cells.words)


def _unit(data: Any) -> str:
    """Unit of length that the points are labelled with, as it is spelled there, "" if there is none."""
    from vtkmodules.vtkCommonCore import vtkDataArray

    points = data.GetPoints()
    label = None if points is None else points.GetData().GetInformation().Get(vtkDataArray.UNITS_LABEL())
    return (label or "").strip()


def _counts(data: Any) -> dict[str, int]:
    """Numbers of points and cells that were read."""
    from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkUnstructuredGrid

    counts = {"points": data.GetNumberOfPoints()}
    if isinstance(data, vtkPolyData):
        return counts | {"polygons": data.GetNumberOfPolys(), "strips": data.GetNumberOfStrips()}
    return counts | {"cells": data.GetNumberOfCells()} if isinstance(data, vtkUnstructuredGrid) else counts


def _node_counts(data: Any) -> dict[str, int]:
    """Numbers of nodes of the cells that were read, all counted as often as they are used."""
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    lists = {"cells": data.GetCells} if not isinstance(data, vtkPolyData) else {
        "polygons": data.GetPolys, "strips": data.GetStrips}  # fmt: skip
    found = {f"nodes of {key}": get() for key, get in lists.items()}
    return {key: cells.GetConnectivityArray().GetNumberOfValues() for key, cells in found.items() if cells}


def vtk_output(path: Path) -> Any:
    """What VTK's reader finds in a file; legacy files are checked first."""
    content = path.read_bytes()
    form, changed = form_of(content, path.name), None
    if form == LEGACY:
        changed = _changed(content)
        announced_by_legacy(changed or content, path.name)
    return _output(path, form, changed)


def _changed(content: bytes) -> bytes | None:
    """A legacy text file without a byte order mark and with line feeds, as VTK needs it; None if it is so already."""
    if b"ASCII" not in content[:_HEAD].upper():
        return None
    return plain_text(content) if content.startswith(codecs.BOM_UTF8) or b"\n" not in content[:_HEAD] else None


def _output(path: Path, form: str, changed: bytes | None) -> Any:
    """Run VTK's reader for the file, or for its content if that was changed, silently."""
    from vtkmodules.vtkCommonCore import vtkObject
    from vtkmodules.vtkIOLegacy import vtkGenericDataObjectReader
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

    readers: dict[str, Any] = {POLYGONS: vtkXMLPolyDataReader, GRID: vtkXMLUnstructuredGridReader}
    reader = readers.get(form, vtkGenericDataObjectReader)()
    if changed is None:
        reader.SetFileName(str(path))
    else:
        reader.ReadFromInputStringOn()
        reader.SetInputString(changed.decode("latin-1"))
    loud = vtkObject.GetGlobalWarningDisplay()
    vtkObject.SetGlobalWarningDisplay(0)
    try:
        reader.Update()
    finally:
        vtkObject.SetGlobalWarningDisplay(loud)
    if reader.GetErrorCode() != 0 or reader.GetOutput() is None:
        raise ValueError(DAMAGED)
    return reader.GetOutput()
