"""Elements of Abaqus and CalculiX decks: the cells that the names of their types stand for, and their nodes."""

import re
from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.deck.blocks import Block
from meshwind.mesh.io.deck.numbers import Numbers, ints_of, line_of

_SURFACES = {3: "triangle", 4: "quad", 6: "triangle6", 8: "quad8", 9: "quad9"}
_SOLIDS = {
    4: "tetra", 5: "pyramid", 6: "wedge", 8: "hexahedron", 10: "tetra10", 13: "pyramid13", 15: "wedge15",
    20: "hexahedron20", 27: "hexahedron27",
}  # fmt: skip
"""Kinds of cells by the number of nodes."""
_FEWER = {"hexahedron27": (21, 26, 20), "wedge15": (16, 18, 15)}
"""Cells that may have fewer or more nodes amid their sides: from how many to how many, and how many are then taken."""
_SHELL = re.compile(r"(?:D?S|M3D|SFM3D|R3D)(?P<n>[34689])R?(?:5|S|SW|T|HT|P)?|STRI(?P<m>3|35|65)|F3D(?P<k>3)")
_PLANE = re.compile(r"(?:CPS|CPEG?|DC2D|DCC2D|AC2D)(?P<n>[3468])[DEHIMPRT]*")
"""Plane elements: programs that mesh surfaces, as Gmsh, write these for triangles and quadrangles in space."""
_SOLID = re.compile(
    r"(?:A?C3D|DCC?3D|FC3D|EMC3D|Q3D|CSS|SC)(?P<n>4|5|6|8|10|13|15|20|27)[DEHIMPRSTV]*"
    r"|COH3D(?P<m>6|8)|GK3D(?P<k>6|8)N?|F3D(?P<j>6|8)R?"
)
_NO_FACES = re.compile(
    r"MASS|ROTARYI|HEATCAP|CAPPOINT|SPRING\w|DASHPOT\w|CONN[23]D2|B[23][123](?:H|OS|OSH|R|T)*|[AD]?C1D\w+|DCC1D\w+"
    r"|T[23]D[23]\w*|PIPE[23][12]H?|ELBOW3\w+|FRAME[23]D|GAP\w+|DGAP|IT[ST]\w*|ISL\w+|IRS\w+|LS[36]S?|RB[23]D2|R2D2|F2D2"
    r"|DCOUP[23]D|JOINT(?:C|2D|3D)|P[CD]3D|DRAG[23]D|D|FLINK|FPC?[23]D\w*|PSI[23]\w+|GK[23]D2N?|GK3D(?:4|6)LN?|TRUSS"
)
_SECTION = re.compile(r"[A-Z]*AXA?\d\w*")
"""Elements of an axisymmetric section, such as CAX4 and SAX1."""
SECTION = "section"
_HEXAHEDRON27 = [*range(20), 26, 24, 23, 25, 21, 22, 20]
"""Middle nodes: Abaqus has that of the cell first, then those of its sides 1 to 6; VTK the sides by axis, then it."""


def cell_kind(element_type: str) -> str | None:
    """Kind of the cells of a type such as C3D10M, "" without faces, `SECTION` if axisymmetric, None if not known."""
    name = "".join(element_type.upper().split())
    if found := _SHELL.fullmatch(name) or _PLANE.fullmatch(name):
        return _SURFACES[_count(found)]
    if found := _SOLID.fullmatch(name):
        return _SOLIDS[_count(found)]
    if _NO_FACES.fullmatch(name):
        return ""
    return SECTION if _SECTION.fullmatch(name) else None


def _count(found: re.Match[str]) -> int:
    digits = next(each for each in found.groups() if each)
    return {"35": 3, "65": 6}.get(digits, int(digits))


def node_count(kind: str) -> int:
    """Number of nodes of a cell."""
    return next(count for kinds in (_SURFACES, _SOLIDS) for count, name in kinds.items() if name == kind)


@dataclass(frozen=True)
class Cells:
    """Cells of one kind: their numbers (c,) and nodes (c, nodes), by the numbers of the deck.

    shortened: whether nodes amid their sides are left out.
    """

    kind: str
    ids: Ints
    nodes: Ints
    shortened: bool = False


def cells_of(block: Block, kind: str) -> list[Cells]:
    """Cells of *ELEMENT.  Raises BadInputError if an element has too few or too many nodes."""
    if block.value("OFFSET") is not None:
        raise block.refusal("has nodes by an OFFSET, which is not read; write the deck with all nodes listed")
    given = ints_of(block)
    width = node_count(kind) + 1
    is_start = np.zeros(max(len(given.values), width) + 1, dtype=np.bool_)
    is_start[given.start] = True
    ends = np.arange(width, len(given.values) + width, width)
    short = np.flatnonzero(~is_start[np.minimum(ends, len(given.values))] | (ends > len(given.values)))
    if len(short) == 0:
        return [_cells(kind, given.values.reshape(-1, width))] if len(given.values) else []
    if kind in _FEWER:
        return _by_commas(block, given, kind)
    raise _wrong_count(block, int(np.searchsorted(given.start, int(short[0]) * width)), kind)


def _by_commas(block: Block, given: Numbers, kind: str) -> list[Cells]:
    """Cells of varied numbers of nodes: each goes on while its lines end with a comma."""
    first = np.flatnonzero(~np.concatenate([[False], given.continued[:-1]]))
    start = given.start[first]
    count = np.diff(np.append(start, given.start[-1])) - 1
    all_of, least, most, taken = node_count(kind), *_FEWER[kind]
    wrong = np.flatnonzero((count != all_of) & ((count < least) | (count > most)))
    if len(wrong):
        raise _wrong_count(block, int(first[wrong[0]]), kind)
    found = []
    for size in np.unique(count).tolist():
        kept = all_of if size == all_of else taken
        table = given.values[start[count == size][:, None] + np.arange(kept + 1)]
        found.append(_cells(_SOLIDS[kept], table, shortened=size > kept + 1))
    return found


def _cells(kind: str, table: Ints, shortened: bool = False) -> Cells:
    nodes = table[:, 1:]
    return Cells(kind, table[:, 0], nodes[:, _HEXAHEDRON27] if kind == "hexahedron27" else nodes, shortened)


def _wrong_count(block: Block, row: int, kind: str) -> BadInputError:
    line, shown = line_of(block, row)
    return BadInputError(
        f"{block.file}: line {line}, {shown}, below *ELEMENT, TYPE={block.name('TYPE')[:20]} begins an element that "
        f"does not have {node_count(kind)} nodes; mend it, or export the deck again"
    )
