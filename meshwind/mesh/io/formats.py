"""Readers of mesh files through trimesh, VTK and meshio: each gives vertices (n, 3) and triangles (m, 3)."""

import logging
import re
from pathlib import Path
from typing import Any

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.cells import CellBlock, triangles
from meshwind.mesh.io.damage import check_obj, check_stl
from meshwind.mesh.io.isolated import Arrays
from meshwind.mesh.io.legacy import check_legacy

_VTK_KINDS = {
    5: "triangle", 7: "polygon", 9: "quad", 10: "tetra", 12: "hexahedron", 13: "vtk-wedge", 14: "pyramid",
    22: "triangle6", 23: "quad8", 24: "tetra10", 25: "hexahedron20", 26: "vtk-wedge15", 27: "pyramid13",
    28: "quad9", 29: "hexahedron27", 69: "triangle", 70: "quad", 71: "tetra", 72: "hexahedron",
}  # fmt: skip


def by_trimesh(path: Path) -> tuple[Floats, Ints]:
    """Read STL, PLY, OBJ, OFF, GLB or GLTF; the parts of a scene are joined where it places them."""
    import trimesh

    kind = path.suffix.lower()
    if kind == ".stl":
        check_stl(path)
    elif kind == ".obj":
        check_obj(path)
    log = logging.getLogger("trimesh")
    before, log.disabled = log.disabled, True
    try:
        loaded = trimesh.load(path, force="mesh", process=False, skip_materials=True, resolver=_Beside(path))
    except (LookupError, ValueError):
        if kind == ".obj":
            check_obj(path, failed=True)
        raise
    finally:
        log.disabled = before
    faces = np.asarray(getattr(loaded, "faces", np.empty((0, 3))), dtype=np.int64)
    return np.asarray(loaded.vertices, dtype=np.float64), faces


class _Beside:
    """What a file may name: a file in its own folder, or below."""

    def __init__(self, file: Path) -> None:
        self.folder = file.parent.resolve()

    def __getitem__(self, name: str) -> bytes:
        path = (self.folder / name).resolve()
        if not path.is_relative_to(self.folder):
            raise ValueError("it names a file outside its folder")
        return path.read_bytes()


def by_meshio(path: Path) -> Arrays:
    """For `isolated`, read MSH or INP: surface cells, or the skin of the volume cells where there are any."""
    import meshio

    if path.suffix.lower() == ".msh":
        _check_sections(path.read_bytes())
    elif re.search(rb"^\s*\*\s*include\b", path.read_bytes(), re.MULTILINE | re.IGNORECASE):
        raise BadInputError(f"{path.name}: includes another file, and none that a file names is read; make them one")
    try:
        mesh = meshio.read(path)
    except meshio.ReadError as error:
        raise ValueError(str(error)) from error
    points = np.asarray(mesh.points, dtype=np.float64)
    if points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    blocks = [(block.type, _sizes_and_nodes(block.data)) for block in mesh.cells]
    return {"vertices": points, "faces": triangles(blocks, len(points))}


def by_vtk(path: Path) -> Arrays:
    """For `isolated`, read VTP, VTU or legacy VTK of polygons or of an unstructured grid.

    VTK's filters end the process on damaged connectivity, so only its raw arrays are used.
    """
    from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkUnstructuredGrid

    data = vtk_output(path)
    if isinstance(data, vtkPolyData):
        cells, kinds = data.GetPolys(), None
    elif isinstance(data, vtkUnstructuredGrid):
        cells, kinds = data.GetCells(), _kinds(data)
    else:
        raise BadInputError(f"{path.name}: holds no polygons or cells; save the part's surface as VTP, PLY or STL")
    if data.GetPoints() is None or cells is None or cells.GetNumberOfCells() == 0:
        return {"vertices": np.empty((0, 3)), "faces": np.empty((0, 3), dtype=np.int64)}
    points = _array(data.GetPoints().GetData(), np.float64)
    offsets = _array(cells.GetOffsetsArray(), np.int64)
    nodes = _array(cells.GetConnectivityArray(), np.int64)
    sizes = np.diff(offsets)
    if offsets[0] != 0 or (sizes < 0).any() or offsets[-1] != len(nodes):
        raise ValueError("its cells are damaged")
    kind = np.full(len(sizes), 7) if kinds is None else kinds
    if len(kind) != len(sizes):
        raise ValueError("its cell types are damaged")
    of_node = np.repeat(kind, sizes)
    blocks: list[CellBlock] = [
        (name, (sizes[kind == code], nodes[of_node == code]))
        for code, name in _VTK_KINDS.items()
        if (kind == code).any()
    ]
    return {"vertices": points, "faces": triangles(blocks, len(points))}


def _kinds(grid: Any) -> Ints:
    """VTK's number of each cell's kind; its own method for this is not the same in all versions."""
    import pyvista

    return np.asarray(pyvista.wrap(grid).celltypes, dtype=np.int64)


def vtk_output(path: Path) -> Any:
    """Run VTK's reader for the file, silently."""
    from vtkmodules.vtkCommonCore import vtkObject
    from vtkmodules.vtkIOLegacy import vtkGenericDataObjectReader
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

    readers: dict[str, Any] = {".vtp": vtkXMLPolyDataReader, ".vtu": vtkXMLUnstructuredGridReader}
    if path.suffix.lower() not in readers:
        check_legacy(path.read_bytes())
    reader = readers.get(path.suffix.lower(), vtkGenericDataObjectReader)()
    reader.SetFileName(str(path))
    loud = vtkObject.GetGlobalWarningDisplay()
    vtkObject.SetGlobalWarningDisplay(0)
    try:
        reader.Update()
    finally:
        vtkObject.SetGlobalWarningDisplay(loud)
    if reader.GetErrorCode() != 0 or reader.GetOutput() is None:
        raise ValueError("damaged, cut short or of another format")
    return reader.GetOutput()


def _array(values: Any, dtype: type) -> Any:
    """Copy of a VTK array."""
    from vtkmodules.util import numpy_support

    return numpy_support.vtk_to_numpy(values).astype(dtype)  # type: ignore[no-untyped-call]


def _sizes_and_nodes(data: Any) -> tuple[Ints, Ints]:
    """Flatten a block of cells, given as a table or as rows of different length."""
    if isinstance(data, np.ndarray) and data.ndim == 2:
        return np.full(len(data), data.shape[1], dtype=np.int64), data.astype(np.int64).ravel()
    sizes = np.array([len(row) for row in data], dtype=np.int64)
    return sizes, np.concatenate([np.asarray(row, dtype=np.int64) for row in data])


def _check_sections(text: bytes) -> None:
    """Refuse a MSH file with a section that is not closed: meshio reads on for ever behind its end."""
    opened = set(re.findall(rb"^\$(?!End)(\w+)", text, re.MULTILINE))
    closed = set(re.findall(rb"^\$End(\w+)", text, re.MULTILINE))
    if not opened or opened != closed:
        raise ValueError("damaged, cut short or of another format")
