"""Cells of VTK's data as blocks: only its raw arrays are used, as its filters end the process on damaged ones."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.lists import spread
from meshwind.mesh.io.cells.kinds import SIDES_OF_POLYHEDRA, SOLIDS, base_of
from meshwind.mesh.io.cells.surface import CellBlock

VTK_KINDS = {
    0: "empty", 1: "vertex", 2: "vertex", 3: "line", 4: "polyline", 21: "line3", 35: "line4", 68: "line9", 75: "line9",
    5: "triangle", 6: "triangle strip", 7: "polygon", 8: "pixel", 9: "quad", 10: "tetra", 11: "voxel",
    12: "hexahedron", 13: "vtk-wedge", 14: "pyramid", 15: "pentagonal prism", 16: "hexagonal prism",
    22: "triangle6", 23: "quad8", 24: "tetra10", 25: "hexahedron20", 26: "vtk-wedge15", 27: "pyramid13",
    28: "quad9", 29: "hexahedron27", 30: "quad6", 31: "vtk-wedge12", 32: "vtk-wedge18", 33: "hexahedron24",
    34: "triangle7", 36: "quadratic polygon", 37: "pyramid19",
}  # fmt: skip
"""Kinds of cells by VTK's number (vtkCellType.h)."""
_ANY_ORDER = {
    69: ("Lagrange", "triangle", 3), 70: ("Lagrange", "quad", 4), 71: ("Lagrange", "tetra", 4),
    72: ("Lagrange", "hexahedron", 8), 73: ("Lagrange", "vtk-wedge", 6), 74: ("Lagrange", "pyramid", 5),
    76: ("Bezier", "triangle", 3), 77: ("Bezier", "quad", 4), 78: ("Bezier", "tetra", 4),
    79: ("Bezier", "hexahedron", 8), 80: ("Bezier", "vtk-wedge", 6), 81: ("Bezier", "pyramid", 5),
}  # fmt: skip
"""Cells of any order by VTK's number: they have their corners first."""
_SECOND_ORDER = {(69, 6): "triangle6", (70, 9): "quad9", (71, 10): "tetra10"}
"""Those whose nodes are those of a cell of second order, by number and size."""
_POLYHEDRON = 42
GHOSTS = "vtkGhostType"
"""Name of the array that marks points and cells."""
_NOT_SHOWN = 1 | 8 | 32
"""Flags of vtkGhostType on cells: a copy of another piece's cell, one that others refine, a hidden one."""
_HIDDEN_POINT = 2


@dataclass(frozen=True)
class Cells:
    """Points (n, 3), blocks of cells on them, and words on cells that are left out or flattened.

    places: of each block where VTK's arrays of cells have the values of its cells.
    """

    points: Floats
    blocks: list[CellBlock]
    places: list[Ints]
    words: tuple[str, ...] = ()


def of_polygons(data: Any) -> Cells:
    """Polygons and strips of vtkPolyData, whose cells are its vertices, lines, polygons and strips in turn."""
    lists = [("vertex", data.GetVerts()), ("line", data.GetLines())]
    at = sum(cells.GetNumberOfCells() for _, cells in lists)
    ghosts, left_out = _ghosts(data.GetCellData()), 0
    blocks: list[CellBlock] = []
    places = []
    for kind, cells in (("polygon", data.GetPolys()), ("triangle strip", data.GetStrips())):
        if cells.GetNumberOfCells() == 0:
            continue
        sizes, nodes = sizes_and_nodes(cells)
        shown = _shown(ghosts, at, len(sizes))
        places.append(at + np.flatnonzero(shown))
        at += len(sizes)
        left_out += int((~shown).sum())
        blocks.append((kind, (sizes[shown], nodes[np.repeat(shown, sizes)])))
    return Cells(points_of(data), blocks, places, _of_ghosts(left_out, sum(map(len, places))))


def of_grid(grid: Any) -> Cells:
    """Cells of vtkUnstructuredGrid by their kind."""
    cells = grid.GetCells()
    if cells is None or cells.GetNumberOfCells() == 0:
        return Cells(points_of(grid), [], [])
    sizes, nodes = sizes_and_nodes(cells)
    kind = _kinds(grid)
    if len(kind) != len(sizes):
        raise ValueError("its cell types are damaged")
    shown = _shown(_ghosts(grid.GetCellData()), 0, len(sizes))
    words = list(_of_ghosts(int((~shown).sum()), int(shown.sum())))
    blocks: list[CellBlock] = []
    places = []
    for code in _in_order(kind[shown]):
        of = shown & (kind == code)
        if code not in _ANY_ORDER:
            places.append(np.flatnonzero(of))
        if code == _POLYHEDRON:
            blocks.append((SIDES_OF_POLYHEDRA, _polyhedra(grid, of)))
        elif code not in _ANY_ORDER:
            blocks.append((VTK_KINDS.get(code, f"VTK {code}"), (sizes[of], nodes[np.repeat(of, sizes)])))
        else:
            for size in np.unique(sizes[of]).tolist():
                same = of & (sizes == size)
                block, word = _any_order(code, nodes[np.repeat(same, sizes)].reshape(-1, size))
                blocks.append(block)
                places.append(np.flatnonzero(same))
                words += [word] if word else []
    return Cells(points_of(grid), blocks, places, tuple(words))


def of_structured(grid: Any) -> Cells:
    """Quadrangles of vtkStructuredGrid if it is one point thick, otherwise hexahedra."""
    points = points_of(grid)
    size: list[int] = [0, 0, 0]
    grid.GetDimensions(size)
    i, j, k = size
    if i * j * k != len(points):
        raise ValueError("its dimensions do not fit its points")
    numbers = np.arange(len(points)).reshape(k, j, i)
    across = tuple(slice(None) if count > 1 else 0 for count in (k, j, i))
    table = _boxes(numbers[across])
    if table is None:
        return Cells(points, [], [])
    hidden = _ghosts(grid.GetPointData(), _HIDDEN_POINT)
    shown = _shown(_ghosts(grid.GetCellData()), 0, len(table))
    if hidden is not None and len(hidden) == len(points):
        shown &= ~hidden[table].any(axis=1)
    kept = table[shown]
    kind = "quad" if table.shape[1] == 4 else "hexahedron"
    words = _of_ghosts(int((~shown).sum()), len(kept))
    blocks: list[CellBlock] = [(kind, (np.full(len(kept), table.shape[1]), kept.ravel()))]
    return Cells(points, blocks, [np.flatnonzero(shown)], words)


def _boxes(numbers: Ints) -> Ints | None:
    """Corners of the quadrangles or hexahedra between the points of a grid, None if it has one dimension."""
    if numbers.ndim < 2:
        return None
    here, there = slice(None, -1), slice(1, None)
    ring = [(here, here), (here, there), (there, there), (there, here)]
    if numbers.ndim == 2:
        return np.column_stack([numbers[way].ravel() for way in ring])
    return np.column_stack([numbers[(step, *way)].ravel() for step in (here, there) for way in ring])


def merged(cells: Cells) -> Cells:
    """The same with one number for points at the same place, as pieces of a solid have their own at what they share."""
    if not any(kind == SIDES_OF_POLYHEDRA or base_of(kind) in SOLIDS for kind, _ in cells.blocks):
        return cells
    rows = np.ascontiguousarray(cells.points + 0.0).view(f"V{3 * 8}").ravel()
    _, first, place = np.unique(rows, return_index=True, return_inverse=True)
    number = first[place.ravel()]
    blocks: list[CellBlock] = [(kind, (sizes, number[nodes], *more)) for kind, (sizes, nodes, *more) in cells.blocks]
    return replace(cells, blocks=blocks)


def _in_order(kinds: Ints) -> list[int]:
    """The numbers of the kinds, each once, the known ones first."""
    found = set(kinds.tolist())
    known = [*VTK_KINDS, *_ANY_ORDER, _POLYHEDRON]
    return [*(code for code in known if code in found), *sorted(found - set(known))]


def _any_order(code: int, table: Ints) -> tuple[CellBlock, str]:
    """Cells (c, n) of any order, and words on those that are taken flat between their corners."""
    family, kind, corners = _ANY_ORDER[code]
    count, size = table.shape
    if size < corners:
        raise ValueError(f"cells of VTK's kind {code} have the wrong number of nodes")
    if (code, size) in _SECOND_ORDER:
        return (_SECOND_ORDER[code, size], (np.full(count, size), table.ravel())), ""
    word = f"{count} {family} cells of {size} nodes (VTK's kind {code}) are taken flat between their corners"
    block = (kind, (np.full(count, corners), table[:, :corners].ravel()))
    return block, word if size > corners else ""


def _polyhedra(grid: Any, shown: Bools) -> tuple[Ints, Ints, Ints]:
    """The sides of the polyhedra that are shown, and how many each has.

    Raises ValueError where VTK is too old to tell.
    """
    if not hasattr(grid, "GetPolyhedronFaces") or grid.GetPolyhedronFaces() is None:
        raise ValueError("it holds polyhedra, which VTK reads from version 9.4 on")
    sizes, nodes = sizes_and_nodes(grid.GetPolyhedronFaces())
    counts, faces = sizes_and_nodes(grid.GetPolyhedronFaceLocations())
    if len(counts) != len(shown) or (counts[shown] == 0).any():
        raise ValueError("its polyhedra are damaged")
    which = faces[np.repeat(shown, counts)]
    if len(which) and (which.min() < 0 or which.max() >= len(sizes)):
        raise ValueError("its polyhedra are damaged")
    start = (np.cumsum(sizes) - sizes)[which]
    taken = sizes[which]
    return taken, nodes[spread(start, taken)], counts[shown]


def _ghosts(data: Any, flags: int = _NOT_SHOWN) -> Bools | None:
    """Which cells or points are marked, None if none is."""
    array = data.GetArray(GHOSTS)
    if array is None:
        return None
    marks = vtk_array(array, np.int64) & flags
    return np.asarray(marks.ravel() != 0)


def _shown(ghosts: Bools | None, first: int, count: int) -> Bools:
    """Which of `count` cells from the first on are not marked."""
    if ghosts is None or len(ghosts) < first + count:
        return np.ones(count, dtype=np.bool_)
    return ~ghosts[first : first + count]


def _of_ghosts(left_out: int, kept: int) -> tuple[str, ...]:
    words = "cells that are marked as hidden or as copies (vtkGhostType) are left out: {} of {}"
    return (words.format(left_out, left_out + kept),) if left_out else ()


def points_of(data: Any) -> Floats:
    """Points (n, 3) of VTK's data."""
    if data.GetPoints() is None:
        return np.empty((0, 3))
    points: Floats = vtk_array(data.GetPoints().GetData(), np.float64)
    return points


def sizes_and_nodes(cells: Any) -> tuple[Ints, Ints]:
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


def vtk_array(values: Any, dtype: type) -> Any:
    """Copy of a VTK array."""
    from vtkmodules.util import numpy_support

    return numpy_support.vtk_to_numpy(values).astype(dtype)  # type: ignore[no-untyped-call]
