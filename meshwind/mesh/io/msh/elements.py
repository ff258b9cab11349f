"""Types of elements of MSH files (Gmsh reference manual, "MSH file format" and "Node ordering")."""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Ints

_SECOND_ORDER = {
    8: "line3", 9: "triangle6", 10: "quad9", 11: "tetra10", 12: "hexahedron27", 13: "wedge18", 14: "pyramid14",
    16: "quad8", 17: "hexahedron20", 18: "wedge15", 19: "pyramid13",
}  # fmt: skip
_TYPES = {
    "vertex": {15: 1},
    "line": {1: 2, 8: 3, 26: 4, 27: 5, 28: 6, 62: 7, 63: 8, 64: 9, 65: 10, 66: 11},
    "triangle": {2: 3, 9: 6, 20: 9, 21: 10, 22: 12, 23: 15, 24: 15, 25: 21, 42: 28, 43: 36, 44: 45, 45: 55, 46: 66,
                 52: 18, 53: 21, 54: 24, 55: 27, 56: 30},
    "quad": {3: 4, 10: 9, 16: 8, 36: 16, 37: 25, 38: 36, 39: 12, 40: 16, 41: 20, 47: 49, 48: 64, 49: 81, 50: 100,
             51: 121, 57: 24, 58: 28, 59: 32, 60: 36, 61: 40},
    "tetra": {4: 4, 11: 10, 29: 20, 30: 35, 31: 56, 32: 22, 33: 28, 71: 84, 72: 120, 73: 165, 74: 220, 75: 286, 79: 34,
              80: 40, 81: 46, 82: 52, 83: 58, 137: 16},
    "hexahedron": {5: 8, 12: 27, 17: 20, 92: 64, 93: 125, 94: 216, 95: 343, 96: 512, 97: 729, 98: 1000, 99: 32, 100: 44,
                   101: 56, 102: 68, 103: 80, 104: 92, 105: 104},
    "wedge": {6: 6, 13: 18, 18: 15, 90: 40, 91: 75, 106: 126, 107: 196, 108: 288, 109: 405, 110: 550, 111: 24, 112: 33,
              113: 42, 114: 51, 115: 60, 116: 69, 117: 78},
    "pyramid": {7: 5, 14: 14, 19: 13, 118: 30, 119: 55, 120: 91, 121: 140, 122: 204, 123: 285, 124: 385, 125: 21,
                126: 29, 127: 37, 128: 45, 129: 53, 130: 61, 131: 69},
}  # fmt: skip
"""Numbers of nodes by the number of the type."""
_CORNERS = {"vertex": 1, "line": 2, "triangle": 3, "quad": 4, "tetra": 4, "hexahedron": 8, "wedge": 6, "pyramid": 5}
_ORDERS = {
    "tetra10": [*range(8), 9, 8],
    "hexahedron20": [*range(8), 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15],
    "hexahedron27": [*range(8), 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26],
    "wedge15": [*range(6), 6, 9, 7, 12, 14, 13, 8, 10, 11],
    "wedge18": [*range(6), 6, 9, 7, 12, 14, 13, 8, 10, 11, 15, 17, 16],
    "pyramid13": [*range(5), 5, 8, 10, 6, 7, 9, 11, 12],
    "pyramid14": [*range(5), 5, 8, 10, 6, 7, 9, 11, 12, 13],
}  # fmt: skip
"""Places, in Gmsh's order, of the nodes in the order of `cells.kinds`, which is VTK's."""


class ElementType(NamedTuple):
    """Kind of cells, as in `cells.kinds`, the number of their nodes, and the order in which these are taken."""

    kind: str
    nodes: int
    order: Ints


def _element_types() -> dict[int, ElementType]:
    types = {}
    for shape, sizes in _TYPES.items():
        for number, nodes in sizes.items():
            linear = nodes == _CORNERS[shape]
            kind = shape if linear else _SECOND_ORDER.get(number, f"{shape}{nodes}")
            types[number] = ElementType(kind, nodes, np.array(_ORDERS.get(kind, range(nodes))))
    return types


TYPES = _element_types()


def element_type(number: int) -> ElementType:
    """The type of a number.  Raises ValueError if it is not known, as its number of nodes is not, either."""
    if number not in TYPES:
        raise ValueError(f"its elements of the type {number} are not known; save it without them")
    return TYPES[number]
