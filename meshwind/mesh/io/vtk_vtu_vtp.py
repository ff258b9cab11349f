"""Reading of VTK, VTU and VTP files by VTK; legacy files are checked first, as damaged ones end VTK's process."""

import re
from pathlib import Path
from typing import Any

import numpy as np

from meshwind.core.cast import Ints
from meshwind.core.errors import BadInputError
from meshwind.core.units import MILLIMETRES
from meshwind.mesh.io.cells_to_triangles import SIDES_OF_POLYHEDRA, CellBlock, surface_mesh
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.in_subprocess import DAMAGED, Arrays

VTK_KINDS = {
    0: "empty", 1: "vertex", 2: "vertex", 3: "line", 4: "polyline", 21: "line3", 35: "line4", 68: "line9", 75: "line9",
    5: "triangle", 6: "triangle strip", 7: "polygon", 8: "pixel", 9: "quad", 10: "tetra", 11: "voxel",
    12: "hexahedron", 13: "vtk-wedge", 14: "pyramid", 15: "pentagonal prism", 16: "hexagonal prism",
    22: "triangle6", 23: "quad8", 24: "tetra10", 25: "hexahedron20", 26: "vtk-wedge15", 27: "pyramid13",
    28: "quad9", 29: "hexahedron27", 30: "quad6", 31: "vtk-wedge12", 32: "vtk-wedge18", 33: "hexahedron24",
    34: "triangle7", 36: "quadratic polygon", 37: "pyramid19",
}  # fmt: skip
"""Kinds of cells by VTK's number (vtkCellType.h)."""
ANY_ORDER = {
    69: "triangle", 70: "quad", 71: "tetra", 72: "hexahedron", 73: "vtk-wedge", 74: "pyramid",
    76: "triangle", 77: "quad", 78: "tetra", 79: "hexahedron", 80: "vtk-wedge", 81: "pyramid",
}  # fmt: skip
"""Lagrange and Bezier cells, which have their corners first and any number of nodes after them."""
_POLYHEDRON = 42
_LISTS = rb"^(?:VERTICES|LINES|POLYGONS|TRIANGLE_STRIPS|CELLS)\s+(\d{1,10})\s+(\d{1,10})[ \t\r]*\n"


def read_vtk(path: Path) -> Arrays:
    """Surface of a file of polygons or of an unstructured grid, for `in_subprocess`."""
    found = surface_of_vtk(vtk_output(path))
    if found is None:
        raise BadInputError(f"{path.name}: holds no polygons or cells; save the part's surface as VTP, PLY or STL")
    return found.packed()


def surface_of_vtk(data: Any) -> FileMesh | None:
    """Surface of polygons and strips or of an unstructured grid, None for another kind of data.

    Only VTK's raw arrays are used, because its filters end the process on damaged connectivity.
    """
    from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkUnstructuredGrid

    if isinstance(data, vtkPolyData):
        lists = [(data.GetPolys(), "polygon"), (data.GetStrips(), "triangle strip")]
        tables = [(cells, name) for cells, name in lists if cells is not None and cells.GetNumberOfCells()]
        blocks = [(name, _sizes_and_nodes(cells)) for cells, name in tables]
    elif isinstance(data, vtkUnstructuredGrid):
        blocks = _of_grid(data)
    else:
        return None
    if data.GetPoints() is None or not blocks:
        return surface_mesh(np.empty((0, 3)), [])
    units = data.GetPoints().GetData().GetInformation().Get(vtk_units_label()) or ""
    points = vtk_array(data.GetPoints().GetData(), np.float64)
    return surface_mesh(points, blocks, units if units in MILLIMETRES else "")


def vtk_units_label() -> Any:
    """VTK's key for the name of an array's unit."""
    from vtkmodules.vtkCommonCore import vtkDataArray

    return vtkDataArray.UNITS_LABEL()


def _of_grid(grid: Any) -> list[CellBlock]:
    """Cells of an unstructured grid by their kind."""
    cells = grid.GetCells()
    if cells is None or cells.GetNumberOfCells() == 0:
        return []
    sizes, nodes = _sizes_and_nodes(cells)
    kind = _kinds(grid)
    if len(kind) != len(sizes):
        raise ValueError("its cell types are damaged")
    of_node = np.repeat(kind, sizes)
    codes = sorted(set(kind.tolist()) - {_POLYHEDRON})
    known = [code for code in {**VTK_KINDS, **ANY_ORDER} if code in codes]  # in the order of the tables
    blocks = [
        (VTK_KINDS.get(code, f"VTK {code}"), (sizes[kind == code], nodes[of_node == code]))
        for code in [*known, *(code for code in codes if code not in VTK_KINDS)]
    ]
    return blocks if not (kind == _POLYHEDRON).any() else [*blocks, (SIDES_OF_POLYHEDRA, _polyhedra(grid))]


def _polyhedra(grid: Any) -> tuple[Ints, Ints]:
    """The sides of all polyhedra.  Raises ValueError where VTK is too old to tell."""
    if not hasattr(grid, "GetPolyhedronFaces"):
        raise ValueError("it holds polyhedra, which VTK reads from version 9.4 on")
    return _sizes_and_nodes(grid.GetPolyhedronFaces())


def _sizes_and_nodes(cells: Any) -> tuple[Ints, Ints]:
    """Number of nodes of each cell, and the nodes of one cell after the other."""
    offsets = vtk_array(cells.GetOffsetsArray(), np.int64)
    nodes = vtk_array(cells.GetConnectivityArray(), np.int64)
    sizes = np.diff(offsets)
    if offsets[0] != 0 or (sizes < 0).any() or offsets[-1] != len(nodes):
        raise ValueError("its cells are damaged")
    return sizes, nodes


def _kinds(grid: Any) -> Ints:
    """VTK's number of each cell's kind; the method for it differs between versions of VTK."""
    import pyvista

    return np.asarray(pyvista.wrap(grid).celltypes, dtype=np.int64)


def vtk_output(path: Path) -> Any:
    """Run VTK's reader for the file, silently."""
    from vtkmodules.vtkCommonCore import vtkObject
    from vtkmodules.vtkIOLegacy import vtkGenericDataObjectReader
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

    readers: dict[str, Any] = {".vtp": vtkXMLPolyDataReader, ".vtu": vtkXMLUnstructuredGridReader}
    if path.suffix.lower() not in readers:
        _check_legacy(path.read_bytes())
    reader = readers.get(path.suffix.lower(), vtkGenericDataObjectReader)()
    reader.SetFileName(str(path))
    loud = vtkObject.GetGlobalWarningDisplay()
    vtkObject.SetGlobalWarningDisplay(0)
    try:
        reader.Update()
    finally:
        vtkObject.SetGlobalWarningDisplay(loud)
    if reader.GetErrorCode() != 0 or reader.GetOutput() is None:
        raise ValueError(DAMAGED)
    return reader.GetOutput()


def vtk_array(values: Any, dtype: type) -> Any:
    """Copy of a VTK array."""
    from vtkmodules.util import numpy_support

    return numpy_support.vtk_to_numpy(values).astype(dtype)  # type: ignore[no-untyped-call]


def _check_legacy(content: bytes) -> None:
    """Raise ValueError if version and cells disagree, or if a list of cells has the wrong size."""
    version = re.match(rb"# vtk DataFile Version (\d)\.\d\s*\n[^\n]*\n\s*(ASCII|BINARY)", content, re.IGNORECASE)
    if version is None:
        raise ValueError(DAMAGED)
    lists = list(re.finditer(_LISTS, content, re.MULTILINE | re.IGNORECASE))
    split = re.search(rb"^OFFSETS ", content, re.MULTILINE | re.IGNORECASE) is not None  # since version 5
    if lists and split != (int(version[1]) >= 5):
        raise ValueError(DAMAGED)
    if split or version[2].upper() == b"ASCII":
        return
    for found in lists:
        count, size = int(found[1]), int(found[2])
        if found.end() + 4 * size > len(content):
            raise ValueError(DAMAGED)
        numbers = np.frombuffer(content, ">i4", size, found.end()).astype(np.int64)
        if not _adds_up(numbers, count):
            raise ValueError(DAMAGED)


def _adds_up(numbers: Ints, count: int) -> bool:
    """Whether `count` cells, each its size followed by its nodes, fill the numbers exactly.

    The chain from cell to cell is followed by repeated doubling, without a loop over cells.
    """
    size = len(numbers)
    step = np.minimum(np.arange(size) + 1 + np.maximum(numbers, 0), size + 1)
    step = np.concatenate([step, [size + 1, size + 1]])  # the end, and beyond it
    position = 0
    while count:
        if count & 1:
            position = int(step[position])
        step = step[step]
        count >>= 1
    return position == size
