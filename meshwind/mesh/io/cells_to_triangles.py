"""Triangles from cells of every kind: polygons are cut, and of volume cells the outer faces are taken."""

from typing import TypeAlias

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.polygons import cut_polygons

CellBlock: TypeAlias = tuple[str, tuple[Ints, Ints]]
"""Kind of the cells, their sizes (c,), and the nodes of one cell after the other."""

_CORNERS = {"triangle": 3, "quad": 4, "tetra": 4, "hexahedron": 8, "wedge": 6, "vtk-wedge": 6, "pyramid": 5}
"""Number of corners of each kind of cell; its other nodes lie on edges, on faces or inside."""
_SIDES = {
    "tetra": [[0, 2, 1, -1], [0, 1, 3, -1], [1, 2, 3, -1], [0, 3, 2, -1]],
    "hexahedron": [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]],
    "wedge": [[0, 2, 1, -1], [3, 4, 5, -1], [0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]],
    "vtk-wedge": [[0, 1, 2, -1], [3, 5, 4, -1], [0, 3, 4, 1], [1, 4, 5, 2], [2, 5, 3, 0]],  # VTK mirrors it
    "pyramid": [[0, 3, 2, 1], [0, 1, 4, -1], [1, 2, 4, -1], [2, 3, 4, -1], [3, 0, 4, -1]],
}
"""Faces of a volume cell, outward; the last corner of a triangle is -1."""


def surface_mesh(points: Floats, blocks: list[CellBlock], units: str = "", warnings: tuple[str, ...] = ()) -> FileMesh:
    """The surface of the blocks: the outer faces of the volume cells, or the surface cells if there are none.

    points (n, 3); units and warnings are those of the file.  Raises ValueError if a cell refers to a node that does not
    exist.
    """
    for _, (_, nodes) in blocks:
        if len(nodes) and (nodes.min() < 0 or nodes.max() >= len(points)):
            raise ValueError("a cell refers to a vertex that is not in the file")
    faces, crossed = _triangles(points, blocks)
    if crossed:
        warnings = (*warnings, f"polygons that cross themselves are cut by a fan: {crossed}")
    return FileMesh(points, faces, units, warnings)


def _triangles(points: Floats, blocks: list[CellBlock]) -> tuple[Ints, int]:
    """Triangles (m, 3) of the blocks, and how many polygons cross themselves."""
    sides = [_sides(kind, cells) for kind, cells in blocks if _base(kind) in _SIDES]
    if sides:
        return _cut_quads(points, _skin(np.concatenate(sides))), 0
    surfaces = [_surface(points, kind, cells) for kind, cells in blocks]
    faces = np.concatenate([*(faces for faces, _ in surfaces), np.empty((0, 3), dtype=np.int64)])
    return faces, sum(crossed for _, crossed in surfaces)


def _base(kind: str) -> str:
    """Name of the linear cell of a kind such as 'tetra10'."""
    return kind.rstrip("0123456789")


def _table(kind: str, cells: tuple[Ints, Ints]) -> Ints:
    """Corners (c, corners) of cells of one kind, without the nodes on edges and inside."""
    sizes, nodes = cells
    corners = _CORNERS[_base(kind)]
    if len(sizes) and (sizes.min() != sizes.max() or sizes[0] < corners):
        raise ValueError(f"{kind} cells have the wrong number of nodes")
    return nodes.reshape(len(sizes), -1)[:, :corners]


def _sides(kind: str, cells: tuple[Ints, Ints]) -> Ints:
    """Sides (s, 4) of volume cells; the last corner of a triangle is -1."""
    corners = _table(kind, cells)
    padded = np.column_stack([corners, np.full(len(corners), -1, dtype=np.int64)])
    return padded[:, np.array(_SIDES[_base(kind)])].reshape(-1, 4)


def _skin(sides: Ints) -> Ints:
    """Sides that belong to only one cell."""
    order = np.sort(sides, axis=1)
    _, first, count = np.unique(order, axis=0, return_index=True, return_counts=True)
    return np.asarray(sides[np.sort(first[count == 1])])


def _cut_quads(points: Floats, quads: Ints) -> Ints:
    """Two triangles for each quadrangle, one where its last corner is -1.

    The cut is from the first corner to the third, but where that leaves a concave quadrangle.
    """
    turned = _outside(points, quads) & ~_outside(points, np.roll(quads, -1, axis=1)) & (quads[:, 3] >= 0)
    quads = np.where(turned[:, None], np.roll(quads, -1, axis=1), quads)
    second = quads[quads[:, 3] >= 0][:, [0, 2, 3]]
    return np.concatenate([quads[:, :3], second])


def _outside(points: Floats, quads: Ints) -> Bools:
    """Whether the diagonal from the first corner to the third lies outside: its two triangles face opposite ways."""
    a, b, c, d = (points[quads[:, corner]] for corner in range(4))
    return np.asarray((np.cross(b - a, c - a) * np.cross(c - a, d - a)).sum(axis=1) < 0.0)


def _surface(points: Floats, kind: str, cells: tuple[Ints, Ints]) -> tuple[Ints, int]:
    """Triangles of surface cells, none for lines and points, and how many polygons cross themselves."""
    base = _base(kind)
    if base == "triangle":
        return _table(kind, cells), 0
    if base == "quad":
        return _cut_quads(points, _table(kind, cells)), 0
    if base == "triangle strip":
        return _strips(*cells), 0
    return cut_polygons(points, *cells) if base == "polygon" else (np.empty((0, 3), dtype=np.int64), 0)


def _strips(sizes: Ints, nodes: Ints) -> Ints:
    """Triangles of strips: each node after the second makes one with the two before it, of alternating sense."""
    count = np.maximum(sizes - 2, 0)
    step = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    at = np.repeat(np.cumsum(sizes) - sizes, count) + step
    odd = step % 2
    return np.column_stack([nodes[at + odd], nodes[at + 1 - odd], nodes[at + 2]])
