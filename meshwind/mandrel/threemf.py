"""Read 3MF, the zip archive of XML that printers take: its meshes, placed as its build says."""

import zipfile
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np

from meshwind.cast import Floats, Ints

_Parts = list[tuple[Floats, Ints]]
_DEPTH = 16  # objects within objects: deeper means that they hold themselves


def read(path: Path) -> tuple[Floats, Ints]:
    """Vertices (n, 3) in the file's units and triangles (m, 3) of every object that the build places."""
    parts: _Parts = []
    with zipfile.ZipFile(path) as archive:
        models = [name for name in archive.namelist() if name.lower().endswith(".model")]
        for name in models:
            root = ElementTree.fromstring(archive.read(name))
            objects = {item.get("id"): item for item in root.iterfind("{*}resources/{*}object")}
            for item in root.iterfind("{*}build/{*}item"):
                parts += _object(objects, item, _DEPTH)
    if not parts:
        return np.empty((0, 3)), np.empty((0, 3), dtype=np.int64)
    starts = np.cumsum([0] + [len(points) for points, _ in parts[:-1]])
    faces = [triangles + start for (_, triangles), start in zip(parts, starts, strict=True)]
    return np.concatenate([points for points, _ in parts]), np.concatenate(faces)


def _object(objects: dict[str | None, Element], use: Element, depth: int) -> _Parts:
    """Meshes of the object that a build item or component uses, moved by that use's transform."""
    item = objects.get(use.get("objectid"))
    if item is None or depth == 0:
        raise ValueError("an object is missing or holds itself")
    mesh = item.find("{*}mesh")
    if mesh is not None:
        parts = [_mesh(mesh)]
    else:
        parts = [part for inner in item.iterfind("{*}components/{*}component")
                 for part in _object(objects, inner, depth - 1)]  # fmt: skip
    text = use.get("transform")
    if text is None:
        return parts
    matrix = np.array(text.split(), dtype=np.float64).reshape(4, 3)
    return [(points @ matrix[:3] + matrix[3], faces) for points, faces in parts]


def _mesh(mesh: Element) -> tuple[Floats, Ints]:
    """Arrays of one mesh element; XML has no arrays, so this is the one loop over vertices."""
    points = [[vertex.get(axis) for axis in "xyz"] for vertex in mesh.iterfind("{*}vertices/{*}vertex")]
    faces = [[face.get(corner) for corner in ("v1", "v2", "v3")] for face in mesh.iterfind("{*}triangles/{*}triangle")]
    triangles = np.array(faces, dtype=np.float64).reshape(-1, 3).astype(np.int64)
    if len(triangles) and (triangles.min() < 0 or triangles.max() >= len(points)):
        raise ValueError("a triangle names a vertex that is not there")
    return np.array(points, dtype=np.float64).reshape(-1, 3), triangles
