"""Reading of STL files of text, free in case, indents and line ends, and with loops of more than three vertices."""

import re

import numpy as np

from meshwind.core.cast import Bools, Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.cells.surface import surface_mesh
from meshwind.mesh.io.face_lists import Lists, face_blocks
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.lines import Lines, NotANumber
from meshwind.mesh.io.text import own_unit

_ORDER = (b"facet", b"outer", b"endloop", b"endfacet")
"""First words of the lines about each facet, in their order; those of its vertices come after the second."""
_KEYS = re.compile(rb"[ \n\t]+(facet[ \t]+normal|outer[ \t]+loop|vertex|endloop|endfacet|endsolid)(?=[ \n\t])")


def read_text_stl(name: str, content: bytes) -> FileMesh:
    """Vertices and triangles of a text, whose lines are ended by line feeds.

    Raises BadInputError if a line is missing or not as the format says.
    """
    lines = _statements(content.lower())
    vertex = lines.begin_with(b"vertex")
    sizes, strange = _checked(name, lines, vertex)
    rows = lines.rows(vertex, len(b"vertex"))
    at = np.flatnonzero(vertex)
    try:
        numbers = rows.floats()
    except NotANumber as error:
        raise BadInputError(f"{name}: line {lines.number(int(at[error.row]))} {error.words}") from None
    wrong = np.flatnonzero(rows.sizes != 3)
    if len(wrong):
        number = lines.number(int(at[wrong[0]]))
        raise BadInputError(f"{name}: the vertex in line {number} has not three coordinates; export the mesh again")
    points = numbers.reshape(-1, 3)
    blocks, warnings = face_blocks(Lists(sizes, np.arange(len(points))), len(points))
    return surface_mesh(points, blocks, own_unit(content), strange + warnings)


def _statements(low: bytes) -> Lines:
    """The lines, each of one statement."""
    if b"end " in low or b"end\t" in low:
        low = re.sub(rb"\bend[ \t]+(?=loop|facet|solid)", b"end", low)
    lines = Lines.of(low)
    names = [bytes(lines.text[lines.first[k] : lines.end[k]]) for k in np.flatnonzero(_solids(lines)).tolist()]
    in_names = sum(name.count(b"vertex") for name in names if not re.search(rb"\bfacet +normal\b", name))
    if np.count_nonzero(lines.begin_with(b"vertex")) < low.count(b"vertex") - in_names:
        return Lines.of(_KEYS.sub(rb"\n\1", b" ".join(low.split(b"\n"))))
    return lines


def _solids(lines: Lines) -> Bools:
    """Lines that begin or end a solid."""
    return lines.begin_with(b"solid") | lines.begin_with(b"endsolid")


def _checked(name: str, lines: Lines, vertex: Bools) -> tuple[Ints, tuple[str, ...]]:
    """Number of vertices of each facet, and words on unknown lines between facets.

    Refuses facets that are not whole, and unknown lines within them.
    """
    kind = np.full(len(lines.first), -1)
    for place, word in enumerate(_ORDER):
        kind[lines.begin_with(word)] = place
    about = kind >= 0
    before: Ints = np.cumsum(about) - about  # lines about facets that come before each line
    number = np.flatnonzero(about)
    wrong = number[kind[number] != before[number] % 4]
    inside = np.flatnonzero(vertex)
    outer = inside[before[inside] % 4 != 2]
    solid = np.flatnonzero(_solids(lines))
    last = max(each[-1] if len(each) else -1 for each in (number, inside, solid))
    if not lines.begin_with(b"endsolid")[last]:
        raise BadInputError(f"{name}: is cut short, its last line is not endsolid; copy or export it again")
    early = solid[before[solid] % 4 != 0]
    strange = np.flatnonzero(lines.filled() & ~about & ~vertex)
    strange = np.setdiff1d(strange, solid)
    for found, words in (
        (np.concatenate([wrong, outer, early]), "is not in its place, so that a facet is not whole"),
        (strange[before[strange] % 4 != 0], "is no statement of STL"),
    ):
        if len(found):
            line = int(found.min())
            text = b" ".join(lines.words(line)).decode("latin-1")[:40]
            raise BadInputError(f"{name}: line {lines.number(line)}, {text!r}, {words}; export the mesh again")
    words = f"{len(strange)} lines are no statements of STL, the first one in line {{}}; left out"
    told = (words.format(lines.number(int(strange[0]))),) if len(strange) else ()
    return np.bincount(before[inside] // 4, minlength=len(number) // 4).astype(np.int64), told
