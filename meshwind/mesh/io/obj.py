"""Reading of OBJ files: vertices and faces of all objects and groups, by the format's specification (Wavefront, B1).

No reader at hand counts relative indices from the face's own line and takes tabs, indents, comments after statements,
line ends of all kinds, and continued lines.
"""

import re
from collections import Counter
from pathlib import Path

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.cells.surface import surface_mesh
from meshwind.mesh.io.face_lists import Lists, face_blocks
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.lines import JOINED, Lines, NotANumber, Rows, without_comments
from meshwind.mesh.io.text import own_unit, text_of
from meshwind.mesh.io.unused import words_on_unused

_FREE_FORM = ("surf", "curv", "curv2", "bzp", "bsp", "cdp", "cdc")
"""Statements that make free-form surfaces and curves; the last four are those of older files."""
_OTHER_FILES = ("call", "csh", "-csh")
_NO_SURFACE = (
    "v", "vt", "vn", "vp", "f", "fo", "l", "p", "g", "o", "s", "mg", "usemtl", "mtllib", "usemap", "maplib", "bevel",
    "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj", "ctech", "stech", "cstype", "deg", "bmat", "step", "parm",
    "trim", "hole", "scrv", "sp", "end", "con", "res",
)  # fmt: skip
"""Statements on looks, names and curves, those that belong to a free-form surface, and those that are read."""
_CONTINUED = re.compile(
    rb"\\[ \t]*\n(?![ \t]*(?:v[tnp]?|fo?|l|p|o|g|s|usemtl|mtllib)[ \t])"
)  # a name may end in a backslash, as that of a folder does: what then follows is a statement
_CORNER = re.compile(rb"[+-]?\d+(?:/(?:[+-]?\d+)?)*")
_SLASH = ord("/")


def read_obj(path: Path) -> FileMesh:
    """Vertices and triangles of an OBJ file."""
    content = text_of(path)
    plain = without_comments(content.replace(bytes([JOINED]), b"?"))
    if b"\\" in plain:
        plain = _CONTINUED.sub(bytes([JOINED]), plain)
    lines = Lines.of(plain)
    vertex = lines.begin_with(b"v") | lines.begin_with(b"V")
    face, old = lines.begin_with(b"f") | lines.begin_with(b"F"), lines.begin_with(b"fo")
    warnings = _left_out(path.name, lines, vertex, face | old)
    points = _points(path.name, lines, vertex)
    faces = [_faces(path.name, lines, vertex, kind, width) for kind, width in ((face, 1), (old, 2)) if kind.any()]
    joined = Lists(
        np.concatenate([each.sizes for each in faces] or [np.zeros(0, dtype=np.int64)]),
        np.concatenate([each.values for each in faces] or [np.zeros(0, dtype=np.int64)]),
    )
    blocks, more = face_blocks(joined, len(points))
    cut = words_on_unused(_unused(lines, joined, len(points)), len(points), ("vertices", "face"))
    return surface_mesh(points, blocks, own_unit(content), warnings + more + cut)


def _unused(lines: Lines, faces: Lists, count: int) -> int:
    """Vertices that are in no face, without those that lines and points may have."""
    others = lines.begin_with(b"l") | lines.begin_with(b"p")
    used = np.count_nonzero(np.bincount(faces.values, minlength=count))
    return count - int(used) - int(lines.rows(others, 1).sizes.sum())


def _left_out(name: str, lines: Lines, vertex: Bools, face: Bools) -> tuple[str, ...]:
    """Words on statements that may be part of the surface and are not read; refuses those that need another file."""
    rest, faces = lines.filled() & ~(vertex | face), int(np.count_nonzero(face))
    for often in (b"vn", b"vt", b"vp", b"usemtl", b"s", b"g"):
        rest &= ~lines.begin_with(often)
    counts: Counter[str] = Counter()
    for line in np.flatnonzero(rest).tolist():
        key = lines.words(line)[0].decode("latin-1").lower()
        if key in _OTHER_FILES:
            raise BadInputError(
                f"{name}: {key} in line {lines.number(line)} takes in another file or command, which is not read; "
                "export all in one file"
            )
        if key not in _NO_SURFACE:
            counts[key] += 1
    parts = ", ".join(f"{counts.pop(key)} {key}" for key in _FREE_FORM if key in counts)
    if parts and not faces:
        raise BadInputError(f"{name}: holds free-form geometry ({parts}) and no faces; export it as polygons")
    words = [f"free-form geometry ({parts}) is not read; left out beside {faces} faces"] if parts else []
    if counts:
        known = ", ".join(repr(key[:20]) for key, _ in counts.most_common(3))
        words.append(f"{counts.total()} lines begin with what is no statement of OBJ ({known}); left out")
    return tuple(words)


def _points(name: str, lines: Lines, vertex: Bools) -> Floats:
    """Positions (n, 3).  A fourth number is a weight, which only free-form geometry has; three more are a colour."""
    rows = lines.rows(vertex, 1)
    sizes = rows.sizes
    short = np.flatnonzero(sizes < 3)
    try:
        numbers = rows.floats()
    except NotANumber as error:
        raise BadInputError(f"{name}: {_place(lines, vertex, 'vertex', error.row)} {error.words}") from None
    if len(short):
        place = _place(lines, vertex, "vertex", int(short[0]))
        raise BadInputError(f"{name}: {place} has fewer than three coordinates; export the mesh again")
    if not len(sizes) or (sizes == sizes[0]).all():
        return np.ascontiguousarray(numbers.reshape(len(sizes), -1)[:, :3]) if len(sizes) else np.zeros((0, 3))
    first = np.cumsum(sizes) - sizes
    return numbers[first[:, None] + np.arange(3)]


def _place(lines: Lines, which: Bools, what: str, row: int) -> str:
    """Number of a vertex or face and its line, for messages."""
    return f"{what} {row + 1} in line {lines.number(int(np.flatnonzero(which)[row]))}"


def _faces(name: str, lines: Lines, vertex: Bools, face: Bools, width: int) -> Lists:
    """Vertices of the faces, from 0; a number below 0 counts back from the face's own line."""
    rows = lines.rows(face, width)
    sizes = rows.sizes
    index = _indices(rows)
    if index is None:
        words = (lines.words(line)[1:] for line in np.flatnonzero(face).tolist())
        wrong = next((k for k, corners in enumerate(words) if not all(map(_CORNER.fullmatch, corners))), 0)
        place = _place(lines, face, "face", wrong)
        raise BadInputError(f"{name}: {place} has no vertex numbers; export the mesh again")
    total = int(np.count_nonzero(vertex))
    if index.min(initial=1) < 0:
        before = np.repeat(np.cumsum(vertex)[face], sizes)
        nodes = np.where(index < 0, before + index, index - 1)
    else:
        nodes = index - 1
    bad = np.flatnonzero((index == 0) | (nodes < 0) | (nodes >= total))
    if len(bad):
        at = int(bad[0])
        why = ": OBJ counts from 1" if index[at] <= 0 else f", but there are {total}"
        place = _place(lines, face, "face", int(np.searchsorted(np.cumsum(sizes), at, side="right")))
        raise BadInputError(f"{name}: {place} refers to vertex {index[at]}{why}; export the mesh again")
    return Lists(sizes, nodes)


def _indices(rows: Rows) -> Ints | None:
    """The first number of each corner, as in 7/1/2; None if a corner has none."""
    text = rows.text
    slash = text == _SLASH
    if not slash.any():
        try:
            return rows.ints()
        except NotANumber:
            return None
    blank = text <= 32
    apart = blank | slash
    begins = ~apart
    begins[1:] &= apart[:-1]
    begins = np.flatnonzero(begins)
    of_corner = blank[begins - 1]  # a row begins with its keyword, which is blank by now
    corners = np.count_nonzero(blank[:-1] & ~blank[1:])
    try:
        numbers = Rows(np.where(slash, np.uint8(32), text), rows.start).ints()
    except NotANumber:
        return None
    return numbers[of_corner] if int(np.count_nonzero(of_corner)) == corners else None
