"""Lists of different length, as files give the corners of faces and strips, as blocks of cells."""

from typing import Any, NamedTuple

import numpy as np

from meshwind.core.cast import Ints
from meshwind.mesh.io.cells.surface import CellBlock


class Lists(NamedTuple):
    """A list of each row: the sizes (rows,), and the numbers of one list after the other."""

    sizes: Ints
    values: Any


def face_blocks(faces: Lists, points: int) -> tuple[list[CellBlock], tuple[str, ...]]:
    """Triangles and larger polygons as blocks, and words on faces that have fewer than three corners.

    points: the number of vertices.  Raises ValueError that names the first face that refers to none of them.
    """
    sizes, nodes = faces.sizes, whole(faces.values)
    if len(nodes) and (nodes.min() < 0 or nodes.max() >= points):
        at = int(np.flatnonzero((nodes < 0) | (nodes >= points))[0])
        face = int(np.searchsorted(np.cumsum(sizes), at, side="right")) + 1
        raise ValueError(f"face {face} refers to vertex {nodes[at]}, counted from 0, but there are {points}")
    if len(sizes) and (sizes == 3).all():
        return [("triangle", (sizes, nodes))], ()
    few = int(np.count_nonzero(sizes < 3))
    words = f"{few} of {len(sizes)} faces have fewer than three corners; left out"
    three = sizes == 3
    of_three = np.repeat(three, sizes)
    many = np.repeat(sizes > 3, sizes)
    blocks: list[CellBlock] = [
        ("triangle", (sizes[three], nodes[of_three])),
        ("polygon", (sizes[sizes > 3], nodes[many])),
    ]
    return [block for block in blocks if len(block[1][0])], (words,) if few else ()


def strip_block(strips: Lists) -> CellBlock:
    """Strips as a block, each cut where -1 ends it, or what an unsigned type makes of -1."""
    kind = np.asarray(strips.values).dtype
    values = whole(strips.values)
    last = (values == -1) | (values == np.iinfo(np.uint32).max)
    if kind.kind == "u" and kind.itemsize < 4:
        last |= values == np.iinfo(kind).max
    begins = np.zeros(len(values) + 1, dtype=bool)
    begins[np.cumsum(strips.sizes) - strips.sizes] = True
    begins[1:] |= last
    strip = np.cumsum(begins[:-1])[~last]
    return "triangle strip", (np.bincount(strip).astype(np.int64), values[~last])


def whole(values: Any) -> Ints:
    """Indices as whole numbers.  Raises ValueError if they are not."""
    numbers = np.asarray(values)
    if numbers.dtype.kind == "f" and not (np.isfinite(numbers) & (np.abs(numbers) < 2.0**53)).all():
        raise ValueError("a face refers to a vertex that does not exist")
    nodes = numbers.astype(np.int64)
    if numbers.dtype.kind == "f" and (nodes != numbers).any():
        raise ValueError("a face refers to a vertex by a number that is not whole")
    return nodes
