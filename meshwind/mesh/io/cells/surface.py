"""Triangles from cells of every kind: polygons are cut, and of volume cells the outer faces are taken."""

from collections import Counter
from typing import TypeAlias

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.io.cells.faces import FaceList, faces_of_cells, with_area
from meshwind.mesh.io.cells.kinds import SIDES_OF_POLYHEDRA, has_no_surface, is_flattened, is_known, sides_of_solid
from meshwind.mesh.io.cells.second_order import cut_faces
from meshwind.mesh.io.cells.skin import surface_faces, without_copies
from meshwind.mesh.io.cells.tiled_sides import without_tiled
from meshwind.mesh.io.file_mesh import FileMesh

__all__ = ["SIDES_OF_POLYHEDRA", "CellBlock", "surface_mesh"]

CellBlock: TypeAlias = tuple[str, tuple[Ints, ...]]
"""Kind of the cells, their sizes (c,), and the nodes of one cell after the other.

Of polyhedra these are the sizes and nodes of their sides, and a third array has the number of sides of each cell (c,).
"""


def surface_mesh(
    points: Floats, blocks: list[CellBlock], units: str = "", warnings: tuple[str, ...] = ()
) -> FileMesh:  # fmt: skip
    """The surface of the blocks: outer faces of the volume cells, and surface cells that are none of their faces.

    points (n, 3); units and warnings are those of the file.  Raises ValueError if a cell refers to a node that does not
    exist, or if no kind of cell is known.
    """
    told = [*warnings, *_not_read(blocks)]
    solids, shells = [], []
    for kind, (sizes, nodes, *counts) in blocks:
        if is_known(kind) and len(sizes):
            faces, sides = faces_of_cells(kind, sizes, nodes, len(points)), sides_of_solid(kind)
            if kind == SIDES_OF_POLYHEDRA:
                solids.append(with_area(faces, counts[0]))
            elif sides is None:
                shells.append(faces.without_repeats())
            else:
                solids.append((faces, np.full(len(sizes), sides)))
    surface = FaceList.joined(shells)
    if solids:
        of_cells = without_tiled(without_copies(solids, len(points)), len(points))
        surface, words = surface_faces(of_cells, surface, len(points))
        told += words
    triangles, crossed = cut_faces(points, surface)
    told += [f"polygons that cross themselves are cut by a fan: {crossed}"] if crossed else []
    return FileMesh(points, triangles, units, tuple(told))


def _not_read(blocks: list[CellBlock]) -> list[str]:
    """Words on cells that are not known, and on those that are read without the nodes between their corners."""
    total, unknown, flat = 0, Counter[str](), Counter[str]()
    for kind, (sizes, _, *counts) in blocks:
        if has_no_surface(kind) or len(sizes) == 0:
            continue
        total += len(counts[0] if counts else sizes)
        if not is_known(kind):
            unknown[kind] += len(sizes)
        elif is_flattened(kind):
            flat[kind] += len(sizes)
    if unknown and unknown.total() == total:
        kinds = ", ".join(unknown)
        raise ValueError(f"its {total} cells are of kinds that are not read: {kinds}")
    words = "{} of {} cells are of the kind {!r}, which is not read; left out"
    return [words.format(count, total, kind) for kind, count in unknown.items()] + [
        f"{count} cells of the kind {kind!r} are taken flat between their corners" for kind, count in flat.items()
    ]
