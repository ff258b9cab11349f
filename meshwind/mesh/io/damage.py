"""Say what is wrong with an STL or OBJ file, where its reader would only fail or read on silently."""

import re
from pathlib import Path

import numpy as np

from meshwind.core.errors import BadInputError

_HEADER, _FACET = 84, 50  # bytes of a binary STL file
_SEPARATORS = np.frombuffer(b" \t\r\n/", dtype=np.uint8)


def check_stl(path: Path) -> None:
    """Refuse a file that ends before its last triangle.  ValueError where it is none at all."""
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


def check_obj(path: Path, failed: bool = False) -> None:
    """Refuse a face that names a vertex that is not there, by its number and line.

    Vertex 0 does not exist, and vertices counted from the end are rare: only a file that has either, or that
    its reader `failed` on, is read line by line.
    """
    content = path.read_bytes()
    if not (failed or _names_zero_or_less(content)):
        return
    there = face = 0
    for number, line in enumerate(content.replace(b"\\\n", b" ").splitlines(), 1):
        if line.startswith((b"v ", b"v\t")):
            there += 1
        elif line.startswith((b"f ", b"f\t")):
            face += 1
            _check_face(line, there, f"{path.name}: face {face} in line {number}", content)


def _names_zero_or_less(content: bytes) -> bool:
    """Whether a face names vertex 0 or a negative one."""
    text = np.frombuffer(content, dtype=np.uint8)
    blank = (text[:-2] == 32) | (text[:-2] == 9)
    zero = (text[1:-1] == ord("0")) & np.isin(text[2:], _SEPARATORS)
    place = np.flatnonzero(blank & (zero | (text[1:-1] == ord("-"))))
    start = np.concatenate([[0], np.flatnonzero(text == 10) + 1])
    return bool((text[start[np.searchsorted(start, place, side="right") - 1]] == ord("f")).any())


def _check_face(line: bytes, there: int, what: str, content: bytes) -> None:
    """Refuse a face that names none of the vertices so far, or of all where it counts from the first."""
    words = [word.split(b"/")[0] for word in line.split(b"#")[0].split()[1:]]
    if not all(re.fullmatch(rb"[+-]?\d{1,18}", word) for word in words):
        raise BadInputError(f"{what} names no vertices; export the mesh again")
    for index in map(int, words):
        if index == 0 or index < -there:
            raise BadInputError(f"{what} names vertex {index}: OBJ counts from 1; export the mesh again")
        if index > there and index > len(re.findall(rb"^v[ \t]", content, re.MULTILINE)):
            total = len(re.findall(rb"^v[ \t]", content, re.MULTILINE))
            raise BadInputError(f"{what} names vertex {index}, but there are {total}; export the mesh again")
