"""Kinds of cells: which of their nodes bound which of their faces."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from meshwind.core.cast import Ints

SIDES_OF_POLYHEDRA = "sides of polyhedra"
"""Kind of the polygons that bound volume cells: what two of them share is inside."""
SECOND_ORDER_POLYGON = "quadratic polygon"
POLYGONS = ("polygon", SECOND_ORDER_POLYGON, SIDES_OF_POLYHEDRA)
STRIP = "triangle strip"
_NO_SURFACE = ("vertex", "line", "polyline", "empty")
"""Kinds of cells that are left alone."""
_SURFACES = {"triangle": [[0, 1, 2]], "quad": [[0, 1, 2, 3]], "pixel": [[0, 1, 3, 2]]}
SOLIDS = {
    "tetra": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
    "hexahedron": [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]],
    "voxel": [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]],
    "wedge": [[0, 2, 1], [3, 4, 5], [0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]],
    "vtk-wedge": [[0, 1, 2], [3, 5, 4], [0, 3, 4, 1], [1, 4, 5, 2], [2, 5, 3, 0]],  # VTK mirrors it
    "pyramid": [[0, 3, 2, 1], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
    "pentagonal prism": [
        [4, 3, 2, 1, 0], [5, 6, 7, 8, 9], *([k, (k + 1) % 5, 5 + (k + 1) % 5, 5 + k] for k in range(5)),
    ],
    "hexagonal prism": [
        [5, 4, 3, 2, 1, 0], [6, 7, 8, 9, 10, 11], *([k, (k + 1) % 6, 6 + (k + 1) % 6, 6 + k] for k in range(6)),
    ],
}  # fmt: skip
"""Sides of volume cells, outward."""
_RING3, _RING4 = [(0, 1), (1, 2), (2, 0)], [(0, 1), (1, 2), (2, 3), (3, 0)]
_TETRA = [*_RING3, (0, 3), (1, 3), (2, 3)]
_HEXAHEDRON = [*_RING4, (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
_WEDGE = [*_RING3, (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)]
_PYRAMID = [*_RING4, (0, 4), (1, 4), (2, 4), (3, 4)]
_AROUND = [(0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2)]
_LOOPS = [(0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)]
_MIDDLES: dict[str, list[tuple[int, ...]]] = {
    "triangle6": [*_RING3], "triangle7": [*_RING3, (0, 1, 2)],
    "quad6": [(0, 1), (2, 3)], "quad8": [*_RING4], "quad9": [*_RING4, (0, 1, 2, 3)],
    "tetra10": [*_TETRA], "hexahedron20": [*_HEXAHEDRON], "hexahedron24": [*_HEXAHEDRON, *_AROUND],
    "hexahedron27": [*_HEXAHEDRON, *_AROUND, (0, 3, 2, 1), (4, 5, 6, 7)],
    "wedge12": [*_WEDGE[:6]], "wedge15": [*_WEDGE], "wedge18": [*_WEDGE, *_LOOPS],
    "pyramid13": [*_PYRAMID], "pyramid14": [*_PYRAMID, (0, 1, 2, 3)],
    "pyramid19": [*_PYRAMID, (0, 1, 2, 3), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
}  # fmt: skip
"""What the nodes after the corners lie amid: edges or faces by their corners, in VTK's order (vtkCellType.h)."""


@dataclass(frozen=True)
class Faces:
    """Faces of one kind of cells, all by columns of the table of nodes: s faces of up to w corners, -1 after the last.

    corners (s, w); middles (s, w): the node amid the side from each corner to the next; centres (s,): that amid the
    face; -1 where there is none.  least: how many nodes a cell has at least.
    """

    corners: Ints
    middles: Ints
    centres: Ints
    least: int


def base_of(kind: str) -> str:
    """Name of the linear cell of a kind such as 'tetra10'."""
    return kind.rstrip("0123456789") or kind


def has_no_surface(kind: str) -> bool:
    """Whether cells of a kind are points or lines."""
    return base_of(kind) in _NO_SURFACE


def is_known(kind: str) -> bool:
    """Whether faces of the cells of a kind are known."""
    return kind in POLYGONS or kind == STRIP or base_of(kind) in _SURFACES or base_of(kind) in SOLIDS


def is_flattened(kind: str) -> bool:
    """Whether nodes of the cells of a kind are left out: those of third order and more."""
    return kind not in POLYGONS and base_of(kind) != kind and not _middles_of(kind) and not has_no_surface(kind)


def _middles_of(kind: str) -> list[tuple[int, ...]]:
    return _MIDDLES.get(kind.removeprefix("vtk-"), [])


@cache
def faces_of(kind: str) -> Faces:
    """Faces of the cells of a known kind; of those of third order and more without the nodes between the corners."""
    base = base_of(kind)
    sides = _SURFACES.get(base) or SOLIDS[base]
    first = max(map(max, sides)) + 1
    places = {frozenset(corners): first + k for k, corners in enumerate(_middles_of(kind))}
    width = max(map(len, sides))
    pairs = [[places.get(frozenset(pair), -1) for pair in zip(side, [*side[1:], side[0]], strict=True)]
             for side in sides]  # fmt: skip
    return Faces(
        np.array([side + [-1] * (width - len(side)) for side in sides]),
        np.array([pair + [-1] * (width - len(pair)) for pair in pairs]),
        np.array([places.get(frozenset(side), -1) if len(side) > 2 else -1 for side in sides]),
        first + len(places),
    )


def sides_of_solid(kind: str) -> int | None:
    """Number of sides of the volume cells of a kind, 0 if it varies; None for cells that are no volumes."""
    if kind == SIDES_OF_POLYHEDRA:
        return 0
    return len(SOLIDS[base_of(kind)]) if base_of(kind) in SOLIDS else None


@cache
def polygon_of(size: int) -> Faces:
    """The face of polygons of second order: half of the nodes are corners, then one amid each side follows."""
    if size % 2:
        raise ValueError("polygons of second order have an odd number of nodes")
    columns = np.arange(size // 2)[None, :]
    return Faces(columns, columns + size // 2, np.array([-1]), size)
