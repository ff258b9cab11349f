"""Reading of OFF files: faces of any size; normals, colours and texture coordinates are left out.

The rules are those of Geomview's manual, section OFF Files.  No reader at hand takes them all: larger faces, files
without the keyword, homogeneous coordinates and binary ones.
"""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.core.lists import spread
from meshwind.mesh.io.cells.surface import surface_mesh
from meshwind.mesh.io.face_lists import Lists, face_blocks
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.lines import Lines, NotANumber, without_comments
from meshwind.mesh.io.ply.header import Element, Property
from meshwind.mesh.io.ply.rows import Binary, BrokenRow, CutShort, Step, walk
from meshwind.mesh.io.ply.text import list_length
from meshwind.mesh.io.text import own_unit, plain_text

_KEYWORD = re.compile(rb"((?:ST|C|N|4|n)*)OFF|((?:st|c|4)*)off")
_BINARY = re.compile(rb"((?:ST|C|N|4|n)*)OFF[ \t]+BINARY[^\n]*\n")
_MAX_COLOUR = 4
"""Largest number of numbers of a face's colour."""


def read_off(path: Path) -> FileMesh:
    """Vertices and triangles of an OFF file."""
    content = path.read_bytes()
    binary = _BINARY.match(content)
    if binary is not None:
        return _binary(path.name, content, binary)
    content = plain_text(content)
    lines = Lines.of(without_comments(content))
    filled = np.flatnonzero(lines.filled())
    layout, used = _layout(path.name, [lines.words(line) for line in filled[:6].tolist()])
    return _Data(path.name, lines, filled[used:], layout).mesh(own_unit(content))


@dataclass(frozen=True)
class _Layout:
    """What the first lines say: numbers of vertices and faces; `homogeneous` points have a fourth coordinate.

    width: of a vertex with its normal, colour and texture coordinates.
    """

    vertices: int
    faces: int
    homogeneous: bool
    width: int


def _layout(name: str, lines: list[list[bytes]]) -> tuple[_Layout, int]:
    """The layout, and how many of the lines say it.  Raises ValueError if they do not."""
    words = lines[0] if lines else []
    used, options = 1, ""
    keyword = _KEYWORD.fullmatch(words[0]) if words else None
    if keyword is not None:
        options = (keyword[1] or keyword[2] or b"").decode()
        words = words[1:]
    if "n" in options:
        if not words:
            words, used = _line(lines, used), used + 1
        _check_dimension(name, words[0])
        words = words[1:]
    while len(words) < 2 and used < len(lines):
        words, used = words + lines[used], used + 1
    if len(words) == 2 and used < len(lines) and len(lines[used]) == 1:  # the number of edges
        words, used = words + lines[used], used + 1
    if not 2 <= len(words) <= 3 or not all(re.fullmatch(rb"\d{1,15}", word) for word in words[:2]):
        raise ValueError("its first lines do not count vertices and faces")
    return _with_options(options, int(words[0]), int(words[1])), used


def _with_options(options: str, vertices: int, faces: int) -> _Layout:
    """The layout by the letters before OFF."""
    upper = options.replace("n", "").upper()
    width = 3 + ("4" in upper) + 3 * ("N" in upper) + 4 * ("C" in upper) + 2 * ("ST" in upper)
    return _Layout(vertices, faces, "4" in upper, width)


def _line(lines: list[list[bytes]], at: int) -> list[bytes]:
    if at >= len(lines):
        raise ValueError("it ends within its first lines")
    return lines[at]


def _check_dimension(name: str, word: bytes) -> None:
    """Refuse points of other than three dimensions."""
    if word != b"3":
        dimension = word.decode("latin-1")[:10]
        raise BadInputError(
            f"{name}: has points of {dimension} dimensions (nOFF), which are not read; export it in three"
        )


def _flat(name: str, points: Floats, homogeneous: bool) -> Floats:
    """Positions (n, 3), of homogeneous coordinates divided by the last one."""
    if not homogeneous:
        return points[:, :3]
    if (points[:, 3] == 0.0).any():
        raise BadInputError(
            f"{name}: has vertices at infinity (4OFF with a weight of 0); export it in three dimensions"
        )
    return points[:, :3] / points[:, 3:4]


@dataclass(frozen=True)
class _Data:
    """The lines of vertices and faces."""

    name: str
    lines: Lines
    filled: Ints
    layout: _Layout

    def mesh(self, units: str) -> FileMesh:
        """The surface in the file.  Raises BadInputError."""
        at, points = self._points()
        faces, used = self._faces(self.filled[at:])
        left = len(self.filled) - at - used
        blocks, warnings = face_blocks(faces, len(points))
        more = (f"{left} lines after the last face are not read",) if left else ()
        return surface_mesh(points, blocks, units, (*warnings, *more))

    def _numbers(self, which: Ints) -> tuple[Floats, Ints]:
        """Numbers of some lines one after the other, and how many each line has."""
        marks = np.zeros(len(self.lines.first), dtype=bool)
        marks[which] = True
        rows = self.lines.rows(marks)
        try:
            return rows.floats(), rows.sizes
        except NotANumber as error:
            number = self.lines.number(int(which[error.row]))
            raise BadInputError(f"{self.name}: line {number} {error.words}") from None

    def _cut_short(self) -> BadInputError:
        vertices, faces = self.layout.vertices, self.layout.faces
        return BadInputError(
            f"{self.name}: is cut short: it announces {vertices} vertices and {faces} faces and holds "
            f"{len(self.filled)} lines; copy or export it again"
        )

    def _points(self) -> tuple[int, Floats]:
        """How many lines the vertices take, and their positions."""
        count, dimension = self.layout.vertices, 3 + self.layout.homogeneous
        if count + self.layout.faces <= len(self.filled):
            numbers, sizes = self._numbers(self.filled[:count])
            if not count or sizes.min() >= dimension:
                odd = np.flatnonzero(sizes != sizes[0]) if count else sizes
                if len(odd):
                    number = self.lines.number(int(self.filled[odd[0]]))
                    raise BadInputError(
                        f"{self.name}: vertex {odd[0] + 1} in line {number} has {sizes[odd[0]]} numbers, and the first "
                        f"one {sizes[0]}; export the mesh again"
                    )
                return count, _flat(self.name, numbers.reshape(count, -1), self.layout.homogeneous)
        return self._wrapped_points(count)

    def _wrapped_points(self, count: int) -> tuple[int, Floats]:
        """The same where a line is not one vertex: as many numbers as the header says make one."""
        if count > self.lines.text.size:
            raise self._cut_short()
        numbers, sizes = self._numbers(self.filled)
        ends = np.cumsum(sizes)
        wanted = count * self.layout.width
        at = int(np.searchsorted(ends, wanted))
        if at >= len(ends) or ends[at] != wanted:
            raise self._cut_short()
        return at + 1, _flat(self.name, numbers[:wanted].reshape(count, -1), self.layout.homogeneous)

    def _faces(self, filled: Ints) -> tuple[Lists, int]:
        """Vertices of each face, and how many lines they take; after them a line may hold a colour."""
        count = self.layout.faces
        if count <= len(filled):
            which = filled[:count]
            numbers, sizes = self._numbers(which)
            first = np.cumsum(sizes) - sizes
            corners = numbers[first]
            wrong = np.flatnonzero(~((corners >= 0.0) & (corners == np.floor(corners)) & (corners < 2.0**53)))
            more = sizes - 1 - np.where(np.isfinite(corners), corners, 0.0)
            wrong = np.union1d(wrong, np.flatnonzero(more > _MAX_COLOUR))
            if not len(wrong) and more.min(initial=0.0) >= 0.0:
                length = corners.astype(np.int64)
                return Lists(length, numbers[spread(first + 1, length)]), count
            wrong = np.union1d(wrong, np.flatnonzero(more < 0.0))
            if len(filled) == count:
                face = int(wrong[0])
                raise BadInputError(
                    f"{self.name}: face {face + 1} in line {self.lines.number(int(which[face]))} announces "
                    f"{corners[face]:g} corners and is followed by {sizes[face] - 1} numbers; export the mesh again"
                )
        return self._wrapped_faces(count, filled)

    def _wrapped_faces(self, count: int, filled: Ints) -> tuple[Lists, int]:
        """The same where a face is not one line: without colours, numbers are counted."""
        numbers, sizes = self._numbers(filled)
        try:
            walked = walk(numbers.tolist(), count, [Step(1, list_length, 1)], 0)
        except BrokenRow:
            raise self._cut_short() from None
        used = int(np.searchsorted(np.cumsum(sizes), walked.end)) + 1
        return Lists(walked.sizes[0], numbers[spread(walked.begins[0], walked.sizes[0])]), used


def _binary(name: str, content: bytes, keyword: "re.Match[bytes]") -> FileMesh:
    """Vertices and triangles of a binary file: numbers of four bytes, the first one first."""
    options, at = keyword[1].decode(), keyword.end()
    if "n" in options:
        _check_dimension(name, str(int.from_bytes(content[at : at + 4], "big")).encode())
        at += 4
    counts = np.frombuffer(content[at : at + 12], ">i4", min(3, len(content[at : at + 12]) // 4))
    if len(counts) < 3 or counts[:2].min() < 0:
        raise ValueError("its first numbers do not count vertices and faces")
    layout = _with_options(options, int(counts[0]), int(counts[1]))
    data, at = Binary(content, ">"), at + 12
    vertex = Element("vertex", layout.vertices, [Property(f"{k}", "f4") for k in range(layout.width)])
    face = Element("face", layout.faces, [Property("corners", "i4", "i4"), Property("colour", "f4", "i4")])
    try:
        points = data.table(vertex, at)
        faces = data.table(face, points.end)
    except CutShort:
        raise BadInputError(
            f"{name}: is cut short: it announces {layout.vertices} vertices and {layout.faces} faces and holds fewer; "
            "copy or export it again"
        ) from None
    columns = np.column_stack([points.columns[f"{k}"].astype(np.float64) for k in range(3 + layout.homogeneous)])
    blocks, warnings = face_blocks(faces.columns["corners"], layout.vertices)
    after = data.after(faces.end)
    return surface_mesh(_flat(name, columns, layout.homogeneous), blocks, "", (*warnings, *((after,) if after else ())))
