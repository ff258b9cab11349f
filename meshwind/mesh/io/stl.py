"""Reading of STL files: binary ones by their length, and text with loops of any number of corners."""

import re
from pathlib import Path

import numpy as np

from meshwind.core.errors import BadInputError
from meshwind.mesh.io.cells_to_triangles import surface_mesh
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.text import text_of

_HEADER, _FACET = 84, 50  # bytes of a binary STL file
_FACETS = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("colour", "<u2")])


def read_stl(path: Path) -> FileMesh:
    """Vertices and triangles of an STL file."""
    if _is_text(path):
        return _text(path)
    return _binary(path)


def _is_text(path: Path) -> bool:
    """Whether the file is text; refuses text that ends before its last triangle."""
    size = path.stat().st_size
    with path.open("rb") as file:
        start = file.read(512)
        file.seek(max(0, size - 1024))
        end = file.read()
    if b"\0" in start:
        return False
    if re.match(rb"\s*solid\b[\s\S]*?\bfacet\s", start, re.IGNORECASE) and not re.search(rb"(?i)end\s*solid", end):
        raise BadInputError(f"{path.name}: is cut short, its last line is not endsolid; copy or export it again")
    return True


def _text(path: Path) -> FileMesh:
    """Facets of all solids of a text file; a loop of more than three corners is a polygon."""
    corners: list[bytes] = []
    sizes: list[int] = []
    facets = before = 0
    for line in text_of(path).split(b"\n"):
        words = line.split()
        key = words[0].lower() if words else b""
        if key == b"vertex":
            corners += words[1:4]
        elif key == b"endloop":
            sizes.append(len(corners) // 3 - before)
            before = len(corners) // 3
        elif key == b"facet":
            facets += 1
    if len(sizes) != facets or before != len(corners) // 3:
        raise ValueError(f"{facets} facets begin in it, and {len(sizes)} loops end")
    if any(b"," in word for word in corners):
        raise BadInputError(f"{path.name}: writes numbers with commas; export it with decimal points")
    points = np.fromiter(map(float, corners), dtype=np.float64, count=len(corners)).reshape(-1, 3)
    return surface_mesh(points, [("polygon", (np.array(sizes, dtype=np.int64), np.arange(len(points))))])


def _binary(path: Path) -> FileMesh:
    """Triangles of a binary file: as many as it announces, or as its length holds where that is a whole number."""
    content = path.read_bytes()
    if len(content) < _HEADER:
        raise ValueError("shorter than the header of a binary STL file")
    facets, at, announced, warnings = [], 0, 0, []
    while at + _HEADER <= len(content):
        announced = int.from_bytes(content[at + 80 : at + _HEADER], "little")
        present, odd = divmod(len(content) - at - _HEADER, _FACET)
        count, more = announced, len(content) - at - _HEADER - announced * _FACET
        if more < 0 and odd:
            raise BadInputError(
                f"{path.name}: is cut short: it announces {announced} triangles and holds {present};"
                " copy or export it again"
            )
        if more and not odd:
            count, more = present, 0
            warnings.append(
                f"the file announces {announced} triangles and is as long as {present}, which are read; if it was cut "
                "short, copy or export it again"
            )
        facets.append(np.frombuffer(content, _FACETS, count, at + _HEADER))
        at += _HEADER + count * _FACET
        if more < _HEADER:
            break
    if at < len(content):
        warnings.append(f"{len(content) - at} bytes after the last triangle are left out")
    corners = np.concatenate([each["corners"] for each in facets]).reshape(-1, 3).astype(np.float64)
    return FileMesh(corners, np.arange(len(corners)).reshape(-1, 3), warnings=tuple(warnings))
