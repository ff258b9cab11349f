"""Reading of OBJ files: vertices and faces of all objects and groups, by the format's specification (Wavefront, B1).

No reader at hand counts relative indices from the face's own line and takes tabs, indents and continued lines.
"""

from collections import Counter
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.cells_to_triangles import surface_mesh
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.text import own_unit, text_of

_FREE_FORM = (b"surf", b"curv", b"curv2", b"bzp", b"bsp", b"cdc", b"cdp", b"res")
_OTHER_FILES = (b"call", b"csh")
_JOINED = b"\x01"
"""Stands for the end of a line that is continued."""


@dataclass
class _Statements:
    """Lines of a file that matter: words of the vertices, and of the faces with the line and the vertices before it."""

    vertices: list[list[bytes]] = field(default_factory=list)
    faces: list[list[bytes]] = field(default_factory=list)
    lines: list[int] = field(default_factory=list)
    before: list[int] = field(default_factory=list)
    free_form: Counter[bytes] = field(default_factory=Counter)


def read_obj(path: Path) -> FileMesh:
    """Vertices and triangles of an OBJ file."""
    content = text_of(path)
    found = _statements(path.name, content)
    warnings = _left_out(path.name, found)
    points = _points(path.name, found.vertices)
    sizes = np.fromiter(map(len, found.faces), dtype=np.int64, count=len(found.faces))
    nodes = _nodes(path.name, found, sizes)
    units = own_unit(content)
    return surface_mesh(points, [("polygon", (sizes, nodes))], units, warnings)


def _statements(name: str, content: bytes) -> _Statements:
    found = _Statements()
    joined = content.replace(b"\\\n", _JOINED) if b"\\\n" in content else content
    continued = 0
    for number, line in enumerate(joined.split(b"\n"), 1):
        if _JOINED in line:
            continued += line.count(_JOINED)
            line = line.replace(_JOINED, b" ")
        words = (line.partition(b"#")[0] if b"#" in line else line).split()
        if not words:
            continue
        key = words[0]
        if key == b"v":
            found.vertices.append(words)
        elif key in (b"f", b"fo"):
            found.faces.append(words[1:])
            found.lines.append(number + continued)
            found.before.append(len(found.vertices))
        elif key in _FREE_FORM:
            found.free_form[key] += 1
        elif key in _OTHER_FILES:
            raise BadInputError(
                f"{name}: takes another file in by {key.decode()} in line {number + continued}, which is not read; "
                "join them into one"
            )
    return found


def _left_out(name: str, found: _Statements) -> tuple[str, ...]:
    """Words on curves and surfaces, which are no mesh."""
    count = found.free_form.total()
    if not count:
        return ()
    if not found.faces:
        raise BadInputError(f"{name}: holds {count} free-form curves or surfaces and no faces; export it as polygons")
    return (f"{count} free-form curves or surfaces are left out, beside {len(found.faces)} faces",)


def _points(name: str, lines: list[list[bytes]]) -> Floats:
    """Positions (n, 3); a fourth number and more are a weight or a colour."""
    short = next((number for number, words in enumerate(lines, 1) if len(words) < 4), 0)
    if short:
        raise BadInputError(f"{name}: vertex {short} has fewer than three coordinates; export the mesh again")
    numbers = chain.from_iterable(words[1:4] for words in lines)
    try:
        return np.fromiter(map(float, numbers), dtype=np.float64, count=3 * len(lines)).reshape(-1, 3)
    except ValueError:
        wrong = next(number for number, words in enumerate(lines, 1) if not all(map(_is_number, words[1:4])))
        words = b" ".join(lines[wrong - 1][1:4]).decode("latin-1")[:40]
        raise BadInputError(f"{name}: vertex {wrong} is {words!r}; its coordinates must be numbers") from None


def _is_number(word: bytes) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _nodes(name: str, found: _Statements, sizes: Ints) -> Ints:
    """Vertices of one face after the other, from 0; those below 0 count back from the face's own line."""
    words = chain.from_iterable(found.faces)
    try:
        index = np.fromiter((int(word.partition(b"/")[0]) for word in words), dtype=np.int64, count=int(sizes.sum()))
    except (ValueError, OverflowError):
        wrong = next(k for k, face in enumerate(found.faces) if not all(map(_is_index, face)))
        raise BadInputError(
            f"{name}: face {wrong + 1} in line {found.lines[wrong]} has no vertex numbers; export the mesh again"
        ) from None
    before = np.repeat(np.array(found.before, dtype=np.int64), sizes)
    nodes = np.where(index < 0, before + index, index - 1)
    bad = np.flatnonzero((index == 0) | (nodes < 0) | (nodes >= len(found.vertices)))
    if len(bad):
        at = int(bad[0])
        face = int(np.searchsorted(np.cumsum(sizes), at, side="right"))
        total = len(found.vertices)
        why = ": OBJ counts from 1" if index[at] <= 0 else f", but there are {total}"
        where = f"face {face + 1} in line {found.lines[face]}"
        raise BadInputError(f"{name}: {where} refers to vertex {index[at]}{why}; export the mesh again")
    return nodes


def _is_index(word: bytes) -> bool:
    try:
        return abs(int(word.partition(b"/")[0])) < 2**63
    except ValueError:
        return False
