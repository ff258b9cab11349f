"""Scalar fields on the points and cells of a file, as they are found."""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.mesh.io.cells.kinds import has_no_surface, is_known
from meshwind.mesh.io.cells.surface import CellBlock
from meshwind.mesh.io.in_subprocess import Arrays

_NONE = np.empty(0)


class Field(NamedTuple):
    """Values (n,) at points (n, 3), None for those of the whole file; `problem`: words on why it cannot be used."""

    points: Floats | None = None
    values: Floats = _NONE
    problem: str = ""


Fields = dict[str, Field]
"""Scalars by their names."""


def packed(points: Floats, fields: Fields) -> Arrays:
    """Arrays by name for `in_subprocess`, with points of its own only for a field that has them."""
    arrays: Arrays = {
        "points": points,
        "names": np.array(list(fields), dtype=np.str_),
        "problems": np.array([field.problem for field in fields.values()], dtype=np.str_),
    }
    for number, field in enumerate(fields.values()):
        arrays[f"values {number}"] = field.values
        if field.points is not None:
            arrays[f"points {number}"] = field.points
    return arrays


def add_scalar(fields: Fields, name: str, values: object, points: Floats | None) -> None:
    """Add a field if it is a scalar."""
    array = np.asarray(values)
    if array.ndim == 1 and array.dtype.kind in "fiub":
        fields[str(name)] = Field(points, array.astype(np.float64))


def has_surface(kind: str) -> bool:
    """Whether the cells of a kind are read as a surface or a volume."""
    return is_known(kind) and not has_no_surface(kind)


def used_points(count: int, blocks: list[CellBlock]) -> Bools:
    """Which of the points (count,) are nodes of surface or volume cells; the others need no value."""
    used = np.zeros(count, dtype=np.bool_)
    for kind, (_, nodes, *_) in blocks:
        if has_surface(kind):
            used[_checked(nodes, count)] = True
    return used


def centroids(points: Floats, block: CellBlock) -> Floats:
    """Means of the nodes of each cell (c, 3), NaN for one without nodes; of polyhedra those of all their sides."""
    _, (sizes, nodes, *counts) = block
    if counts:
        cell = np.repeat(np.arange(len(counts[0])), counts[0])
        sizes = np.bincount(cell, sizes, len(counts[0])).astype(np.int64)
    return means(points, sizes, nodes)


def means(points: Floats, sizes: Ints, nodes: Ints) -> Floats:
    """Means of the points of lists (c, 3) of these sizes, NaN of an empty one."""
    held = np.full((len(sizes), 3), np.nan)
    some = sizes > 0
    if some.any():
        sums = np.add.reduceat(points[_checked(nodes, len(points))], (np.cumsum(sizes) - sizes)[some], axis=0)
        held[some] = sums / sizes[some, None]
    return held


def _checked(nodes: Ints, count: int) -> Ints:
    if len(nodes) and (nodes.min() < 0 or nodes.max() >= count):
        raise ValueError("a cell refers to a vertex that does not exist")
    return nodes
