"""Reading of files by trimesh, silently."""

import logging
from pathlib import Path

import numpy as np

from meshwind.mesh.io.file_mesh import FileMesh


def by_trimesh(path: Path) -> FileMesh:
    """Vertices and triangles of a file; the parts of a scene are moved to their positions and joined."""
    import trimesh

    log = logging.getLogger("trimesh")
    before, log.disabled = log.disabled, True
    try:
        loaded = trimesh.load(path, force="mesh", process=False, skip_materials=True, resolver=_SameFolder(path))
    finally:
        log.disabled = before
    faces = np.asarray(getattr(loaded, "faces", np.empty((0, 3))), dtype=np.int64)
    return FileMesh(np.asarray(loaded.vertices, dtype=np.float64), faces)


class _SameFolder:
    """Other files that a mesh file may refer to: those in its own folder or below."""

    def __init__(self, file: Path) -> None:
        self.folder = file.parent.resolve()

    def __getitem__(self, name: str) -> bytes:
        path = (self.folder / name).resolve()
        if not path.is_relative_to(self.folder):
            raise ValueError("it refers to a file outside its folder")
        return path.read_bytes()
