"""Reading of 3MF files, zip archives of XML for 3D printers."""

import zipfile
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.io.file_mesh import FileMesh

_Parts = list[tuple[Floats, Ints]]
_MAX_DEPTH = 16
"""Levels of objects within objects: if there are more, an object contains itself."""
_MAX_USES = 20_000
"""Uses of objects by others: a few objects that contain each other many times would take forever."""
_MAX_BYTES = 1 << 30
"""Largest unpacked size of the XML."""


def read_3mf(path: Path) -> FileMesh:
    """Vertices and triangles of all objects in the build, in the file's unit."""
    parts: _Parts = []
    with zipfile.ZipFile(path) as archive:
        for member in archive.infolist():
            if member.filename.lower().endswith(".model"):
                if member.file_size > _MAX_BYTES:
                    raise ValueError(f"it unpacks to more than {_MAX_BYTES >> 30} GB")
                parts += _Model(ElementTree.fromstring(archive.read(member))).built()
    if not parts:
        return FileMesh(np.empty((0, 3)), np.empty((0, 3), dtype=np.int64))
    starts = np.cumsum([0] + [len(points) for points, _ in parts[:-1]])
    faces = [triangles + start for (_, triangles), start in zip(parts, starts, strict=True)]
    return FileMesh(np.concatenate([points for points, _ in parts]), np.concatenate(faces))


class _Model:
    """The objects of one part of the archive."""

    def __init__(self, root: Element) -> None:
        self.root, self.uses = root, 0
        self.objects = {item.get("id"): item for item in root.iterfind("{*}resources/{*}object")}

    def built(self) -> _Parts:
        """Meshes of all items of the build."""
        return [part for item in self.root.iterfind("{*}build/{*}item") for part in self._used(item, _MAX_DEPTH)]

    def _used(self, use: Element, depth: int) -> _Parts:
        """Meshes of the object that a build item or component uses, moved by that use's transform."""
        item = self.objects.get(use.get("objectid"))
        if item is None or depth == 0:
            raise ValueError("an object is missing or contains itself")
        self.uses += 1
        if self.uses > _MAX_USES:
            raise ValueError(f"it uses objects more than {_MAX_USES} times")
        mesh = item.find("{*}mesh")
        inner = item.iterfind("{*}components/{*}component")
        parts = [_mesh(mesh)] if mesh is not None else [part for each in inner for part in self._used(each, depth - 1)]
        text = use.get("transform")
        if text is None:
            return parts
        matrix = np.array(text.split(), dtype=np.float64).reshape(4, 3)
        return [(points @ matrix[:3] + matrix[3], faces) for points, faces in parts]


def _mesh(mesh: Element) -> tuple[Floats, Ints]:
    """Arrays of one mesh element."""
    points = [[vertex.get(axis) for axis in "xyz"] for vertex in mesh.iterfind("{*}vertices/{*}vertex")]
    faces = [[face.get(corner) for corner in ("v1", "v2", "v3")] for face in mesh.iterfind("{*}triangles/{*}triangle")]
    triangles = np.array(faces, dtype=np.float64).reshape(-1, 3).astype(np.int64)
    if len(triangles) and (triangles.min() < 0 or triangles.max() >= len(points)):
        raise ValueError("a triangle refers to a vertex that does not exist")
    return np.array(points, dtype=np.float64).reshape(-1, 3), triangles
