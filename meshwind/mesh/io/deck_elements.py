"""Elements of Abaqus and CalculiX decks by the names of their types."""

import re

SURFACES = {"3": "triangle", "4": "quad", "6": "triangle6", "8": "quad8", "9": "quad9"}
SOLIDS = {
    "4": "tetra", "5": "pyramid", "6": "wedge", "8": "hexahedron", "10": "tetra10", "13": "pyramid13", "15": "wedge15",
    "20": "hexahedron20", "27": "hexahedron27",
}  # fmt: skip
"""Kinds of cells by the number of nodes in the type's name."""
_SURFACE = re.compile(r"(?:D?S|STRI|M3D|R3D|SFM3D)(3|4|65|6|8|9)(?![0-9])(?:R5|R|RS|RT|RSW|RHT|T|RTS|5|C|PH|S|W)*$")
_SOLID = re.compile(r"(?:A?C3D|D[C]+3D|DC3D|SC|CSS|COH3D|GK3D|Q3D|C3DE)(4|5|6|8|10|13|15|20|27)(?![0-9])[A-Z]*$")
_NO_FACES = re.compile(
    r"(MASS|ROTARYI|HEATCAP|SPRING|DASHPOT|CONN|B[23]\d|T[23]D|DT?1D|DC1D|DCC1D|AC1D|PIPE|ELBOW|FRAME|GAP|ITT|RB[23]D|R2D2|"
    r"DCOUP|DISTRIBUTING|JOINT|PD?3D|DRAG|CAPPOINT|D$|F3D|PSI|ISL|TRUSS|DGAP|IRS|LS)"
)


def cell_kind(element_type: str) -> str | None:
    """Kind of the cells of a type such as C3D10M, "" for one without faces, None for one that is not known."""
    name = element_type.upper()
    surface = _SURFACE.match(name)
    if surface:
        return SURFACES[surface[1][0]]
    solid = _SOLID.match(name)
    if solid:
        return SOLIDS[solid[1]]
    return "" if _NO_FACES.match(name) else None


def node_count(kind: str) -> int:
    """Number of nodes of a cell."""
    named = {"triangle": 3, "quad": 4, "tetra": 4, "pyramid": 5, "wedge": 6, "hexahedron": 8}
    return named.get(kind) or int(re.sub(r"\D", "", kind))
