"""Reading of PLY files: polygons and strips, as text and binary in both byte orders, beside elements of other kinds.

No reader at hand takes faces beside strips, or lists of different length in a binary file.
"""

import codecs
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.cells.surface import CellBlock, surface_mesh
from meshwind.mesh.io.face_lists import Lists, face_blocks, strip_block
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.ply.header import Element, Header, read_header
from meshwind.mesh.io.ply.rows import Binary, BrokenRow, Columns, CutShort, Table
from meshwind.mesh.io.ply.text import Text
from meshwind.mesh.io.text import plain_text

_CORNERS = ("vertex_indices", "vertex_index")
_READ = ("vertex", "face", "tristrips")
_NO_SURFACE = ("edge", "edges", "line", "lines", "polyline", "material", "camera", "user", "texture", "light")
_LIKE_SURFACE = re.compile("(?i)face|tri|strip|fan|quad|poly|patch|grid|mesh|surf|cell")
_LIKE_CORNERS = re.compile("(?i)vert|ind|corner|node|point")
_GRID = "range_grid"


@dataclass(frozen=True)
class Ply:
    """The elements of a file: by element and property the numbers (rows,) or the `Lists`; and words on the rest."""

    header: Header
    tables: dict[str, Columns]
    rest: str

    def points(self) -> Floats:
        """Positions (n, 3) of the vertices."""
        vertex = self.tables.get("vertex", {})
        if not all(axis in vertex and not isinstance(vertex[axis], Lists) for axis in "xyz"):
            raise ValueError("its vertices have no x, y and z")
        return np.column_stack([np.asarray(vertex[axis], dtype=np.float64) for axis in "xyz"])

    def corners(self, element: str) -> Lists | None:
        """Vertices of the faces or strips; None if there are none."""
        table = self.tables.get(element, {})
        found = next((table[name] for name in _CORNERS if isinstance(table.get(name), Lists)), None)
        if found is None and any(each.rows for each in self.header.elements if each.name == element):
            raise ValueError(f"its element {element} has no list vertex_indices")
        return found

    def not_read(self) -> list[tuple[str, int]]:
        """Names and rows of the elements of unknown kind that may be part of the surface."""
        rest = [each for each in self.header.elements if each.rows and each.name not in (*_READ, *_NO_SURFACE)]
        return [(each.name, each.rows) for each in rest if _may_be_surface(each)]


def _may_be_surface(element: Element) -> bool:
    """Whether an element has lists that may be those of vertices, by the names of the lists or its own."""
    lists = [p for p in element.properties if p.length_kind and p.kind[0] in "iu"]
    return bool(lists) and (
        _LIKE_SURFACE.search(element.name) is not None or any(_LIKE_CORNERS.search(p.name) for p in lists)
    )


def read_ply(path: Path) -> FileMesh:
    """Vertices and triangles of a PLY file."""
    ply = read_tables(path)
    points = ply.points()
    blocks: list[CellBlock] = []
    told: tuple[str, ...] = ()
    faces, strips = ply.corners("face"), ply.corners("tristrips")
    if faces is not None:
        blocks, told = face_blocks(faces, len(points))
    if strips is not None:
        blocks.append(strip_block(strips))
    left = ply.not_read()
    if not blocks and left:
        raise BadInputError(f"{path.name}: {_unread(ply.header, *left[0])}, and has no faces; export it as polygons")
    words = [f"{_unread(ply.header, *each)}; left out beside the faces" for each in left]
    return surface_mesh(points, blocks, ply.header.units, (*told, *words, *((ply.rest,) if ply.rest else ())))


def _unread(header: Header, name: str, rows: int) -> str:
    """Words on an element that is not read."""
    if name != _GRID:
        return f"holds {rows} rows of the element {name[:40]!r}, which is not known"
    size = dict(line.split()[:2] for line in header.remarks if line.startswith(("num_cols ", "num_rows ")))
    shape = " x ".join(size[key] for key in ("num_cols", "num_rows") if key in size)
    return f"holds a range grid of {rows} points ({shape or 'of a scanner'}), which is not a mesh"


def read_tables(path: Path) -> Ply:
    """All elements of a PLY file.

    Raises ValueError if it is none, and BadInputError if it is cut short, or its rows are not as the header says.
    """
    content = path.read_bytes()
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        content = plain_text(content)
    header = read_header(content)
    source: Binary | Text
    at = 0
    if header.order:
        source, at = Binary(content, header.order), header.end
    else:
        head = content[: header.end]
        lines = head.count(b"\n") or head.count(b"\r")
        source = Text(path.name, plain_text(content[header.end :]), lines)
    tables: list[tuple[Element, Table]] = []
    for element in header.elements:
        if not element.rows or not element.properties:
            continue
        try:
            table = source.table(element, at)
        except BrokenRow as error:
            if isinstance(source, Text):  # an earlier row that is too short or too long may be the reason
                source.check_rows([*tables, (element, Table({}, error.starts, at))], at)
            if not isinstance(error, CutShort):
                raise
            raise BadInputError(
                f"{path.name}: is cut short: it announces {element.rows} rows of {element.name[:40]!r} and holds "
                f"{error.rows}; copy or export it again"
            ) from None
        tables.append((element, table))
        at = table.end
    if isinstance(source, Text):
        source.check_rows(tables, at)
    columns: dict[str, Any] = {element.name: table.columns for element, table in tables}
    return Ply(header, columns, source.after(at))
