"""Reading of OFF files: faces of any size, with normals, colours and texture coordinates left out."""

import re
from itertools import chain
from pathlib import Path

import numpy as np

from meshwind.core.errors import BadInputError
from meshwind.mesh.io.cells_to_triangles import surface_mesh
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.text import own_unit, text_of

_KEYWORD = re.compile(rb"(ST)?(C)?(N)?(4)?(n)?OFF\b(?:[ \t]+BINARY)?")


def read_off(path: Path) -> FileMesh:
    """Vertices and triangles of an OFF file."""
    content = text_of(path)
    lines = [line.partition(b"#")[0] if b"#" in line else line for line in content.split(b"\n")]
    rows = [line for line in lines if line.strip()]
    found = _KEYWORD.match(rows[0].strip()) if rows else None
    if found is not None:
        _check(path.name, found)
        rest = rows[0].strip()[found.end() :]
        rows = [rest, *rows[1:]] if rest.strip() else rows[1:]
    counts = rows[0].split() if rows else []
    if len(counts) < 2 or not all(word.isdigit() for word in counts[:2]):
        raise ValueError("its first line does not count vertices and faces")
    vertices, faces = int(counts[0]), int(counts[1])
    if vertices + faces > len(rows) - 1:
        raise BadInputError(
            f"{path.name}: is cut short: it announces {vertices} vertices and {faces} faces and holds "
            f"{len(rows) - 1} lines; copy or export it again"
        )
    points = [row.split()[:3] for row in rows[1 : 1 + vertices]]
    if any(len(point) < 3 for point in points):
        raise ValueError("a vertex has fewer than three coordinates")
    numbers = np.fromiter(map(float, chain.from_iterable(points)), dtype=np.float64, count=3 * vertices)
    cells = [row.split() for row in rows[1 + vertices : 1 + vertices + faces]]
    sizes = np.array([int(cell[0]) for cell in cells], dtype=np.int64)
    if any(size > len(cell) - 1 for size, cell in zip(sizes.tolist(), cells, strict=True)) or (sizes < 0).any():
        raise ValueError("a face has fewer corners than it says")
    corners = chain.from_iterable(cell[1 : 1 + size] for size, cell in zip(sizes.tolist(), cells, strict=True))
    nodes = np.fromiter(map(int, corners), dtype=np.int64, count=int(sizes.sum()))
    more = len(rows) - 1 - vertices - faces
    warnings = (f"{more} lines after the last face are left out",) if more else ()
    return surface_mesh(numbers.reshape(-1, 3), [("polygon", (sizes, nodes))], own_unit(content), warnings)


def _check(name: str, keyword: "re.Match[bytes]") -> None:
    """Refuse binary files, and points of other than three dimensions."""
    if keyword[0].endswith(b"BINARY"):
        raise BadInputError(f"{name}: is a binary OFF file, which is not read; export it as text, or as PLY")
    if keyword[4] or keyword[5]:
        raise BadInputError(f"{name}: has points of other than three dimensions; export it in three")
