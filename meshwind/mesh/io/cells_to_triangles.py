"""Triangles from cells of every kind: polygons are cut, and of volume cells the outer faces are taken."""

from typing import TypeAlias

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.mid_sides import KINDS, MidSides, complete, cut_finer
from meshwind.mesh.io.polygons import cut_polygons

CellBlock: TypeAlias = tuple[str, tuple[Ints, Ints]]
"""Kind of the cells, their sizes (c,), and the nodes of one cell after the other."""

_CORNERS = {
    "triangle": 3, "quad": 4, "pixel": 4, "tetra": 4, "hexahedron": 8, "voxel": 8, "wedge": 6, "vtk-wedge": 6,
    "pyramid": 5, "pentagonal prism": 10, "hexagonal prism": 12,
}  # fmt: skip
"""Number of corners of each kind of cell; its other nodes lie on edges, on faces or inside."""
_SIDES = {
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
"""Faces of a volume cell, outward."""
SIDES_OF_POLYHEDRA = "sides of polyhedra"
"""Kind of the polygons that bound volume cells: what two of them share is inside."""
_SURFACES = ("triangle", "quad", "pixel", "polygon", "triangle strip")
_NO_SURFACE = ("vertex", "line", "polyline", "empty")
"""Kinds of cells that are left alone."""


def surface_mesh(
    points: Floats, blocks: list[CellBlock], units: str = "", warnings: tuple[str, ...] = ()
) -> FileMesh:  # fmt: skip
    """The surface of the blocks: outer faces of the volume cells, and surface cells that are none of their faces.

    points (n, 3); units and warnings are those of the file.  Raises ValueError if a cell refers to a node that does not
    exist.
    """
    for _, (_, nodes) in blocks:
        if len(nodes) and (nodes.min() < 0 or nodes.max() >= len(points)):
            raise ValueError("a cell refers to a vertex that is not in the file")
    told = [*warnings, *_not_read(blocks)]
    second = [(kind, cells[1].reshape(len(cells[0]), -1)) for kind, cells in blocks if kind in KINDS and len(cells[0])]
    middle = MidSides.of(second, len(points))
    sides = [table for kind, cells in blocks for table in _sides(kind, cells)]
    surfaces = [(kind, cells) for kind, cells in blocks if _base(kind) in _SURFACES]
    if not sides:
        cut = [_surface(points, kind, cells, middle) for kind, cells in surfaces]
        faces = np.concatenate([*(faces for faces, _ in cut), np.empty((0, 3), dtype=np.int64)])
        crossed = sum(count for _, count in cut)
    else:
        shells = [table for kind, cells in surfaces for table in _shells(kind, cells)]
        kept, inside = _outer(_padded(sides), _padded(shells))
        faces, crossed = _cut(points, kept, middle)
        told += [f"surface cells inside the solid are left out: {inside}"] if inside else []
    told += [f"polygons that cross themselves are cut by a fan: {crossed}"] if crossed else []
    return FileMesh(points, faces, units, tuple(told))


def _base(kind: str) -> str:
    """Name of the linear cell of a kind such as 'tetra10'."""
    return kind.rstrip("0123456789") or kind


def _not_read(blocks: list[CellBlock]) -> list[str]:
    """Words on cells that are not known, and on those that are read without the nodes between their corners."""
    total = sum(len(sizes) for _, (sizes, _) in blocks)
    known = {*_CORNERS, *_SURFACES, *_NO_SURFACE, SIDES_OF_POLYHEDRA}
    words = []
    for kind, (sizes, _) in blocks:
        base = _base(kind)
        if base not in known and len(sizes):
            words.append(f"{len(sizes)} of {total} cells are of the kind {kind!r}, which is not read; left out")
        elif base != kind and base not in _NO_SURFACE and kind not in KINDS and len(sizes):
            words.append(f"{len(sizes)} cells of the kind {kind!r} are taken flat between their corners")
    return words


def _table(kind: str, cells: tuple[Ints, Ints]) -> Ints:
    """Corners (c, corners) of cells of one kind, without the nodes on edges and inside."""
    sizes, nodes = cells
    corners = _CORNERS[_base(kind)]
    if len(sizes) and (sizes.min() != sizes.max() or sizes[0] < corners):
        raise ValueError(f"{kind} cells have the wrong number of nodes")
    return nodes.reshape(len(sizes), -1)[:, :corners]


def _sides(kind: str, cells: tuple[Ints, Ints]) -> list[Ints]:
    """Sides of volume cells, in tables by their number of corners; none of other cells."""
    if kind == SIDES_OF_POLYHEDRA:
        return _by_size(*cells)
    if _base(kind) not in _SIDES:
        return []
    table, sides = _table(kind, cells), _SIDES[_base(kind)]
    if len(table) == 0:
        return []
    width = max(map(len, sides))
    columns = np.array([side + [-1] * (width - len(side)) for side in sides])
    padded = np.column_stack([table, np.full(len(table), -1, dtype=np.int64)])
    return [padded[:, columns].reshape(-1, width)]


def _shells(kind: str, cells: tuple[Ints, Ints]) -> list[Ints]:
    """Corners of surface cells, in tables by their number of corners."""
    if kind == "polygon":
        return _by_size(*cells)
    if kind == "triangle strip":
        return [_strips(*cells)]
    table = _table(kind, cells)
    return [table[:, [0, 1, 3, 2]] if _base(kind) == "pixel" else table]


def _by_size(sizes: Ints, nodes: Ints) -> list[Ints]:
    """Polygons in tables by their number of corners."""
    of_node = np.repeat(sizes, sizes)
    return [nodes[of_node == size].reshape(-1, size) for size in np.unique(sizes[sizes > 2]).tolist()]


def _padded(tables: list[Ints]) -> Ints:
    """All rows in one table, filled with -1."""
    width = max((table.shape[1] for table in tables), default=0)
    parts = [np.pad(table, ((0, 0), (0, width - table.shape[1])), constant_values=-1) for table in tables]
    return np.concatenate([*parts, np.empty((0, width), dtype=np.int64)])


def _outer(sides: Ints, shells: Ints) -> tuple[Ints, int]:
    """Sides of only one volume cell, and surface cells that are no side; also how many of these lie inside."""
    rows = _padded([sides, shells])
    _, group = np.unique(np.sort(rows, axis=1), axis=0, return_inverse=True)
    group = group.ravel()
    uses = np.bincount(group[: len(sides)], minlength=int(group.max()) + 1)[group]
    kept = uses == np.where(np.arange(len(rows)) < len(sides), 1, 0)
    return rows[kept], int((uses[len(sides) :] > 1).sum())


def _cut(points: Floats, rows: Ints, middle: MidSides) -> tuple[Ints, int]:
    """Triangles of polygons in rows that are filled with -1, and how many cross themselves."""
    sizes = (rows >= 0).sum(axis=1)
    finer = []
    if middle:
        for count in (3, 4):
            of = np.flatnonzero(sizes == count)
            on = middle.on(rows[of, :count])
            of, on = of[complete(on)], on[complete(on)]
            finer.append(cut_finer(rows[of, :count], on))
            sizes[of] = 0
        rows = rows[sizes > 0]
        sizes = sizes[sizes > 0]
    few, many = rows[sizes <= 4], rows[sizes > 4]
    few = np.pad(few, ((0, 0), (0, max(0, 4 - few.shape[1]))), constant_values=-1)[:, :4]
    faces, crossed = cut_polygons(points, sizes[sizes > 4], many[many >= 0])
    return np.concatenate([*finer, _cut_quads(points, few), faces]), crossed


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


def _surface(points: Floats, kind: str, cells: tuple[Ints, Ints], middle: MidSides) -> tuple[Ints, int]:
    """Triangles of surface cells, and how many polygons cross themselves."""
    base = _base(kind)
    if middle and base in _CORNERS:
        return _cut(points, _shells(kind, cells)[0], middle)
    if base == "triangle":
        return _table(kind, cells), 0
    if base in ("quad", "pixel"):
        return _cut_quads(points, _shells(kind, cells)[0]), 0
    return (_strips(*cells), 0) if base == "triangle strip" else cut_polygons(points, *cells)


def _strips(sizes: Ints, nodes: Ints) -> Ints:
    """Triangles of strips: each node after the second makes one with the two before it, of alternating sense."""
    count = np.maximum(sizes - 2, 0)
    step = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    at = np.repeat(np.cumsum(sizes) - sizes, count) + step
    odd = step % 2
    return np.column_stack([nodes[at + odd], nodes[at + 1 - odd], nodes[at + 2]])
