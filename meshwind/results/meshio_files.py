"""Mesh files written by meshio, with their unit of length."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshwind.core.cast import Floats
from meshwind.core.units import lengths_in

_SIGNED = re.compile(rb"(written|This file was created) by meshio v[\w.]+|Created by meshio [^\n]+")
"""meshio's own line in the header of a file, which is replaced by one with the unit."""


def write_meshio(
    path: Path,
    points: Floats,
    cells: Sequence[tuple[str, NDArray[Any]]],
    *,
    point_data: Mapping[str, NDArray[Any]],
    cell_data: Mapping[str, Sequence[NDArray[Any]]] | None = None,
    units: str,
) -> None:
    """Write a binary .vtu, .vtk or .ply file whose header names the unit of length.

    A .ply file of triangles and quadrangles is text: trimesh reads binary rows of one length only.
    """
    import meshio

    own = [(kind, np.array(block)) for kind, block in cells]
    mesh = meshio.Mesh(np.array(points), own, point_data=dict(point_data), cell_data=dict(cell_data or {}))
    mesh.write(path, **({"binary": False} if path.suffix == ".ply" and len(own) > 1 else {}))
    path.write_bytes(_SIGNED.sub(f"meshwind, {lengths_in(units)}".encode("ascii"), path.read_bytes(), count=1))
