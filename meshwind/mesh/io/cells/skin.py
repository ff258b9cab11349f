"""The surface of cells: of volume cells the skin, and surface cells that are not their sides."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from meshwind.core.cast import Bools, Ints
from meshwind.mesh.io.cells.faces import FaceList


@dataclass(frozen=True)
class _Uses:
    """Keys of sides, in order and each once, and how many cells have that side."""

    keys: Ints
    counts: Ints

    @classmethod
    def of(cls, keys: Ints) -> "tuple[_Uses, Ints]":
        """The uses, and that of each of the keys."""
        order = np.argsort(keys)
        held = keys[order]
        begins = np.concatenate([[True], held[1:] != held[:-1]])[: len(held)]
        group = np.cumsum(begins) - 1
        counts = np.bincount(group) if len(group) else np.empty(0, dtype=np.int64)
        of_each = np.empty(len(keys), dtype=np.int64)
        of_each[order] = counts[group]
        return cls(held[begins], counts), of_each

    def times(self, keys: Ints) -> Ints:
        """How many cells have each of these sides."""
        if len(self.keys) == 0:
            return np.zeros(len(keys), dtype=np.int64)
        at = np.minimum(np.searchsorted(self.keys, keys), len(self.keys) - 1)
        return np.where(self.keys[at] == keys, self.counts[at], 0)


def without_copies(solids: list[tuple[FaceList, Ints]], points: int) -> FaceList:
    """Sides of volume cells of several kinds, without cells that have the sides of one before.

    Each kind comes with the number of sides of each of its cells (c,), which is 1 or more.
    """
    mixed = _mixed(points)
    keys = [np.add.reduceat(_mix(faces.keys(mixed)), np.cumsum(counts) - counts) for faces, counts in solids
            if len(counts)]  # fmt: skip
    kept = np.zeros(sum(map(len, keys)), dtype=np.bool_)
    if len(kept):
        kept[np.unique(np.concatenate(keys), return_index=True)[1]] = True
    lists, at = [], 0
    for faces, counts in solids:
        of_cell = kept[at : at + len(counts)]
        at += len(counts)
        lists.append(faces if of_cell.all() else faces.where(np.repeat(of_cell, counts)))
    return FaceList.joined([faces.without_repeats() for faces in lists])


def surface_faces(sides: FaceList, shells: FaceList, points: int) -> tuple[FaceList, list[str]]:
    """Sides of only one volume cell, and shells that are none of the sides; and words on what is left out.

    Sides are the same if they have the same corners.  A quadrangle is also the same as two triangles on its corners.
    """
    mixed = _mixed(points)
    keys = sides.keys(mixed)
    uses, of_side = _Uses.of(keys)
    skin, skin_keys = sides.where(of_side == 1), keys[of_side == 1]
    halved, half = _halves(skin, mixed, skin, skin_keys)
    skin = skin.where(~halved & ~half)
    shell_keys = shells.keys(mixed)
    of_shell = uses.times(shell_keys)
    _, of_quads = _halves(skin, mixed, shells, shell_keys)
    in_two, _ = _halves(shells, mixed, None, uses.keys)
    words = []
    if inside := int((of_shell > 1).sum()):
        words.append(f"surface cells inside the solid are left out: {inside}")
    if several := int(((uses.counts > 2) & (uses.counts % 2 == 1)).sum()):
        words.append(f"sides that more than two volume cells share are taken as inside: {several}")
    return FaceList.joined([skin, shells.where((of_shell == 0) & ~of_quads & ~in_two)]), words


def _halves(quads: FaceList, mixed: Ints, triangles: FaceList | None, keys: Ints) -> tuple[Bools, Bools]:
    """Which quadrangles have both triangles of a diagonal among faces of these keys, and which faces those are.

    triangles: the faces, None if the keys may be those of other faces, too.
    """
    found, used = np.zeros(len(quads.sizes), dtype=np.bool_), np.zeros(len(keys), dtype=np.bool_)
    four = np.flatnonzero(quads.sizes == 4)
    three = np.ones(len(keys), dtype=np.bool_) if triangles is None else triangles.sizes == 3
    if len(four) == 0 or not three.any():
        return found, used
    first = (np.cumsum(quads.sizes) - quads.sizes)[four]
    parts = mixed[quads.corners[first[:, None] + np.arange(4)]]
    without = parts.sum(axis=1)[:, None] - parts  # key of the triangle that lacks a corner
    held = np.isin(without, keys[three])
    pairs = np.stack([held[:, 0] & held[:, 2], held[:, 1] & held[:, 3]], axis=1)
    found[four] = pairs.any(axis=1)
    chosen = without[np.column_stack([pairs, pairs])]
    used[three] = np.isin(keys[three], chosen)
    return found, used


def _mixed(points: int) -> Any:
    """A random number for each node (SplitMix64): their sums over two different sets agree once in 2^64."""
    return _mix((np.arange(points, dtype=np.uint64) + np.uint64(1)) * np.uint64(0x9E3779B97F4A7C15))


def _mix(mixed: Any) -> Any:
    """The same numbers with their bits mixed, so that their sums tell sets of them apart."""
    mixed = (mixed ^ (mixed >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    mixed = (mixed ^ (mixed >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return mixed ^ (mixed >> np.uint64(31))
