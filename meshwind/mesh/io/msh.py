"""Reading of MSH files by meshio."""

import re
from pathlib import Path
from typing import Any

import numpy as np

from meshwind.core.cast import Ints
from meshwind.mesh.io.cells_to_triangles import surface_mesh
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.in_subprocess import DAMAGED, Arrays


def read_msh(path: Path) -> Arrays:
    """Surface of a file, for `in_subprocess`."""
    import meshio

    _check_sections(path.read_bytes())
    try:
        mesh = meshio.read(path)
    except meshio.ReadError as error:
        raise ValueError(str(error)) from error
    return surface_of(mesh).packed()


def surface_of(mesh: Any) -> FileMesh:
    """Surface of a mesh of meshio's."""
    points = np.asarray(mesh.points, dtype=np.float64)
    if points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    blocks = [(block.type, _sizes_and_nodes(block.data)) for block in mesh.cells]
    return surface_mesh(points, blocks)


def _sizes_and_nodes(data: Any) -> tuple[Ints, Ints]:
    """Sizes and nodes of a block of cells, given as a table or as rows of different length."""
    if isinstance(data, np.ndarray) and data.ndim == 2:
        return np.full(len(data), data.shape[1], dtype=np.int64), data.astype(np.int64).ravel()
    sizes = np.array([len(row) for row in data], dtype=np.int64)
    return sizes, np.concatenate([np.asarray(row, dtype=np.int64) for row in data])


def _check_sections(text: bytes) -> None:
    """Refuse an MSH file with a section that is not closed: meshio would read on forever at its end."""
    opened = set(re.findall(rb"^\$(?!End)(\w+)", text, re.MULTILINE))
    closed = set(re.findall(rb"^\$End(\w+)", text, re.MULTILINE))
    if not opened or opened != closed:
        raise ValueError(DAMAGED)
