"""Reading of STL files by trimesh, which gives no reason why it cannot read a damaged file: they are checked first."""

import re
from pathlib import Path

from meshwind.core.errors import BadInputError
from meshwind.mesh.io.by_trimesh import by_trimesh
from meshwind.mesh.io.file_mesh import FileMesh

_HEADER, _FACET = 84, 50  # bytes of a binary STL file


def read_stl(path: Path) -> FileMesh:
    """Vertices and triangles of an STL file."""
    _check_stl(path)
    return by_trimesh(path)


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
