"""Surfaces of other libraries' meshes in memory, and of arrays."""

import sys
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.cells.surface import SIDES_OF_POLYHEDRA, CellBlock, surface_mesh
from meshwind.mesh.io.file_mesh import FileMesh

Made = TypeVar("Made")
_ADVICE = "give a path, a trimesh.Trimesh, a pyvista.PolyData, a meshio.Mesh, a meshwind.Mesh or (vertices, faces)"


def surface_in_memory(mesh: object) -> FileMesh:
    """Surface of a mesh of trimesh, PyVista (VTK) or meshio, or of a pair of arrays (vertices, faces).

    Faces (m, 3) are triangles and (m, 4) quadrangles.  Raises BadInputError for anything else.
    """
    if isinstance(mesh, tuple | list) and len(mesh) == 2:
        return _of_arrays(*mesh)
    found = by_library(mesh, {"trimesh": _of_trimesh, "meshio": _of_meshio, "vtkmodules": _of_vtk})
    if found is None:
        raise BadInputError(f"mesh is of type {type(mesh).__name__}; {_ADVICE}")
    return found


def by_library(mesh: object, ways: Mapping[str, Callable[[Any], Made | None]]) -> Made | None:
    """What the way of the first library makes of a mesh that knows it; None where none does."""
    for library, of in ways.items():
        found = of(mesh) if library in sys.modules else None  # what is not imported cannot have made it
        if found is not None:
            return found
    return None


def _of_arrays(vertices: Any, faces: Any) -> FileMesh:
    try:
        points, cells = np.asarray(vertices, dtype=np.float64), np.asarray(faces)
    except (TypeError, ValueError) as error:
        raise BadInputError(
            "vertices and faces are not arrays of numbers; give (n, 3) and (m, 3) or (m, 4), or faces with different "
            "numbers of corners as a mesh of PyVista or meshio"
        ) from error
    if points.ndim != 2 or points.shape[1] != 3 or cells.ndim != 2 or cells.shape[1] not in (3, 4):
        raise BadInputError(f"vertices are {points.shape} and faces {cells.shape}; give (n, 3) and (m, 3) or (m, 4)")
    if cells.shape[1] == 3:
        return FileMesh(points, cells)  # the repair checks the indices
    return _checked(points, [("quad", (np.full(len(cells), 4), cells.astype(np.int64).ravel()))])


def _checked(points: Any, blocks: Any) -> FileMesh:
    try:
        return surface_mesh(points, blocks)
    except ValueError as error:
        raise BadInputError(f"mesh: {error}; give indices from 0 to {len(points) - 1}") from error


def _of_trimesh(mesh: Any) -> FileMesh | None:
    import trimesh

    if isinstance(mesh, trimesh.Scene):
        mesh, units = mesh.to_mesh(), mesh.units
    elif isinstance(mesh, trimesh.Trimesh):
        units = mesh.units
    else:
        return None
    vertices, faces = np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces, dtype=np.int64)
    return FileMesh(vertices, faces, "" if units is None else str(units))


def _of_meshio(mesh: object) -> FileMesh | None:
    import meshio

    return surface_mesh(*blocks_of(mesh)) if isinstance(mesh, meshio.Mesh) else None


def blocks_of(mesh: Any) -> tuple[Floats, list[CellBlock]]:
    """Points (n, 3) and blocks of cells of a mesh of meshio."""
    points = np.asarray(mesh.points, dtype=np.float64)
    if points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    return points, [_block(block.type, block.data) for block in mesh.cells]


def _block(kind: str, data: Any) -> CellBlock:
    """A block of meshio's cells; polyhedra, of which each is a list of sides, are given by their sides."""
    if kind.startswith("polyhedron"):
        counts = np.array([len(cell) for cell in data], dtype=np.int64)
        return SIDES_OF_POLYHEDRA, (*_sizes_and_nodes([side for cell in data for side in cell]), counts)
    return "polygon" if kind.startswith("polygon") else kind, _sizes_and_nodes(data)


def _sizes_and_nodes(data: Any) -> tuple[Ints, Ints]:
    """Sizes and nodes of a block of cells, given as a table or as rows of different length."""
    if isinstance(data, np.ndarray) and data.ndim == 2:
        return np.full(len(data), data.shape[1], dtype=np.int64), data.astype(np.int64).ravel()
    sizes = np.array([len(row) for row in data], dtype=np.int64)
    return sizes, np.concatenate([np.empty(0, dtype=np.int64), *(np.asarray(row, dtype=np.int64) for row in data)])


def _of_vtk(mesh: object) -> FileMesh | None:
    from meshwind.mesh.io.vtk.vtk import surface_of_vtk

    return surface_of_vtk(mesh)
