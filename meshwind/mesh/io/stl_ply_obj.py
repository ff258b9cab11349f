"""Reading of STL, PLY, OBJ, OFF, GLB and GLTF files by trimesh, which also cuts polygons into triangles.

STL and OBJ files are checked first, because trimesh gives no reason why it cannot read a damaged file, or reads it
silently.
"""

import logging
import re
from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError

_HEADER, _FACET = 84, 50  # bytes of a binary STL file
_SEPARATORS = np.frombuffer(b" \t\r\n/", dtype=np.uint8)


def read_stl_ply_obj(path: Path) -> tuple[Floats, Ints]:
    """Vertices (n, 3) and triangles (m, 3) of a file; the parts of a scene are moved to their positions and joined."""
    import trimesh

    kind = path.suffix.lower()
    if kind == ".stl":
        _check_stl(path)
    elif kind == ".obj":
        _check_obj(path)
    log = logging.getLogger("trimesh")
    before, log.disabled = log.disabled, True
    try:
        loaded = trimesh.load(path, force="mesh", process=False, skip_materials=True, resolver=_SameFolder(path))
    except (LookupError, ValueError):
        if kind == ".obj":
            _check_obj(path, failed=True)
        raise
    finally:
        log.disabled = before
    faces = np.asarray(getattr(loaded, "faces", np.empty((0, 3))), dtype=np.int64)
    return np.asarray(loaded.vertices, dtype=np.float64), faces


class _SameFolder:
    """Other files that a mesh file may refer to: those in its own folder or below."""

    def __init__(self, file: Path) -> None:
        self.folder = file.parent.resolve()

    def __getitem__(self, name: str) -> bytes:
        path = (self.folder / name).resolve()
        if not path.is_relative_to(self.folder):
            raise ValueError("it refers to a file outside its folder")
        return path.read_bytes()


def _check_stl(path: Path) -> None:
    """Refuse a file that ends before its last triangle.  Raises ValueError if it is not an STL file."""
    size = path.stat().st_size
    with path.open("rb") as file:
        start = file.read(512)
        file.seek(max(0, size - 1024))
        end = file.read()
    if b"\0" not in start:
        if re.match(rb"\s*solid\b[\s\S]*?\bfacet\s", start, re.IGNORECASE) and not re.search(rb"(?i)end\s*solid", end):
            raise BadInputError(f"{path.name}: is cut short, its last line is not endsolid; copy or export it again")
        return
    if size < _HEADER:
        raise ValueError("shorter than the header of a binary STL file")
    announced, present = int.from_bytes(start[80:84], "little"), (size - _HEADER) / _FACET
    if announced > present:
        raise BadInputError(
            f"{path.name}: is cut short: it announces {announced} triangles and holds {int(present)};"
            " copy or export it again"
        )


def _check_obj(path: Path, failed: bool = False) -> None:
    """Refuse a face that refers to a vertex that does not exist; the message has its number and line.

    Only a file with vertex 0, which does not exist, or with vertices counted from the end, which are rare, or one on
    which its reader `failed`, is read line by line.
    """
    content = path.read_bytes()
    if not (failed or _has_index_below_one(content)):
        return
    vertices = face = 0
    for number, line in enumerate(content.replace(b"\\\n", b" ").splitlines(), 1):
        if line.startswith((b"v ", b"v\t")):
            vertices += 1
        elif line.startswith((b"f ", b"f\t")):
            face += 1
            _check_face(line, vertices, f"{path.name}: face {face} in line {number}", content)


def _has_index_below_one(content: bytes) -> bool:
    """Whether a face refers to vertex 0 or a negative one."""
    text = np.frombuffer(content, dtype=np.uint8)
    blank = (text[:-2] == 32) | (text[:-2] == 9)
    zero = (text[1:-1] == ord("0")) & np.isin(text[2:], _SEPARATORS)
    position = np.flatnonzero(blank & (zero | (text[1:-1] == ord("-"))))
    start = np.concatenate([[0], np.flatnonzero(text == 10) + 1])
    return bool((text[start[np.searchsorted(start, position, side="right") - 1]] == ord("f")).any())


def _check_face(line: bytes, vertices: int, what: str, content: bytes) -> None:
    """Refuse a face with a vertex that does not exist: in the whole file, or above it if it counts backwards."""
    words = [word.split(b"/")[0] for word in line.split(b"#")[0].split()[1:]]
    if not all(re.fullmatch(rb"[+-]?\d{1,18}", word) for word in words):
        raise BadInputError(f"{what} has no vertex numbers; export the mesh again")
    for index in map(int, words):
        if index == 0 or index < -vertices:
            raise BadInputError(f"{what} refers to vertex {index}: OBJ counts from 1; export the mesh again")
        if index > vertices and index > len(re.findall(rb"^v[ \t]", content, re.MULTILINE)):
            total = len(re.findall(rb"^v[ \t]", content, re.MULTILINE))
            raise BadInputError(f"{what} refers to vertex {index}, but there are {total}; export the mesh again")
