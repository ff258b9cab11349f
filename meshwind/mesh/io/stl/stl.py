"""Reading of STL files: binary ones here, by their count and their length; those of text by `text_stl`.

No reader at hand says that count and length disagree, or takes several solids one after the other in a binary file.
"""

import re
from pathlib import Path

import numpy as np

from meshwind.core.errors import BadInputError
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.stl.text import read_text_stl
from meshwind.mesh.io.text import own_unit, plain_text

_HEADER, _FACET = 84, 50  # bytes of a binary STL file
_FACETS = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_TURNED = _FACETS.newbyteorder(">")
_START = 4096
"""Length of the part of a file that tells text from binary data."""
_MAX_SOLIDS = 100_000


def read_stl(path: Path) -> FileMesh:
    """Vertices and triangles of an STL file."""
    content = path.read_bytes()
    if _is_text(content):
        return read_text_stl(path.name, plain_text(content).rstrip(b"\0\x1a"))
    if len(content) < _HEADER:
        raise ValueError("shorter than the header of a binary STL file")
    if b"\0" not in content[:_START]:
        raise ValueError("it is neither binary nor text that begins with solid")
    return _binary(path.name, content)


def _is_text(content: bytes) -> bool:
    """Whether a file is text; the header of a binary one may begin with solid, too."""
    if len(content) >= _HEADER and len(content) == _HEADER + _FACET * _count(content, 0):
        return False
    start = content[:_START]
    if start.startswith((b"\xff\xfe", b"\xfe\xff")):
        return True
    begins = re.match(rb"(?:\xef\xbb\xbf)?\s*(solid|facet)\b", start, re.IGNORECASE) is not None
    return begins and (b"\0" not in start or re.search(rb"(?i)\bfacet\s+normal\s", start) is not None)


def _count(content: bytes, at: int) -> int:
    """Number of triangles that a header announces."""
    return int.from_bytes(content[at + 80 : at + _HEADER], "little")


def _binary(name: str, content: bytes) -> FileMesh:
    """Triangles of a binary file.  Raises BadInputError if it is cut short."""
    solids, at = _solids(content)
    announced, left = _count(content, 0), len(content) - at
    present, odd = divmod(len(content) - _HEADER, _FACET)
    warnings = []
    facets = _FACETS
    if announced and left >= _FACET and not content[at:].strip(b"\0"):
        warnings.append(f"{left} zeros after the last triangle are not read")
        left = 0
    if left and not odd and int.from_bytes(content[80:_HEADER], "big") == present:
        solids, left, facets = [(_HEADER, present)], 0, _TURNED
        warnings.append("count and coordinates are stored highest byte first, against the format; read as stored")
    if left and not odd:
        solids, left = [(_HEADER, present)], 0
        advice = ", but if it was cut short, copy or export it again" if announced > present else ""
        warnings.append(
            f"the file announces {announced} triangles and is as long as {present}; all {present} are read{advice}"
        )
    if left < 0:
        raise BadInputError(
            f"{name}: is cut short: it announces {announced} triangles and holds {present}; copy or export it again"
        )
    if left >= _FACET:
        raise BadInputError(
            f"{name}: announces {announced} triangles and is as long as {present} and a part of one; "
            "copy or export it again"
        )
    if left:
        warnings.append(f"{left} bytes after the last triangle are not read")
    parts = [np.frombuffer(content, facets, count, start)["corners"].reshape(-1, 3) for start, count in solids]
    corners = np.concatenate(parts).astype(np.float64)
    return FileMesh(corners, np.arange(len(corners)).reshape(-1, 3), own_unit(content), tuple(warnings))


def _solids(content: bytes) -> tuple[list[tuple[int, int]], int]:
    """Where the triangles of each solid begin and how many there are, and the end of the last one.

    Solids after the first count only if they fill the file: what follows the first may be of another kind.
    """
    solids: list[tuple[int, int]] = []
    at = 0
    while at + _HEADER <= len(content) and len(solids) < _MAX_SOLIDS:
        count = _count(content, at)
        solids.append((at + _HEADER, count))
        at += _HEADER + _FACET * count
        if count == 0:
            break
    if at == len(content):
        return solids, at
    return solids[:1], _HEADER + _FACET * _count(content, 0)
