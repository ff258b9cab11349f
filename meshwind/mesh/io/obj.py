"""Reading of OBJ files by trimesh, which reads damaged ones silently: they are checked first."""

import re
from pathlib import Path

import numpy as np

from meshwind.core.errors import BadInputError
from meshwind.mesh.io.by_trimesh import by_trimesh
from meshwind.mesh.io.file_mesh import FileMesh

_SEPARATORS = np.frombuffer(b" \t\r\n/", dtype=np.uint8)


def read_obj(path: Path) -> FileMesh:
    """Vertices and triangles of an OBJ file."""
    _check_obj(path)
    try:
        return by_trimesh(path)
    except (LookupError, ValueError):
        _check_obj(path, failed=True)
        raise


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
