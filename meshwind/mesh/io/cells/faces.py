"""Faces of cells in one list, and which of them are the surface: the skin of volume cells, and shells beside it."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Bools, Ints
from meshwind.core.lists import spread
from meshwind.mesh.io.cells.kinds import POLYGONS, SECOND_ORDER_POLYGON, STRIP, Faces, faces_of, polygon_of


@dataclass(frozen=True)
class FaceList:
    """Faces of any size (f,): the corners of one after the other (n,), and the nodes amid sides and faces.

    middles (n,): the node between a corner and the next, centres (f,): the one amid the face; -1 where there is none,
    and both are empty if there is none at all.
    """

    sizes: Ints
    corners: Ints
    middles: Ints
    centres: Ints

    @classmethod
    def of_rows(cls, corners: Ints, middles: Ints, centres: Ints) -> "FaceList":
        """From tables (f, w) that are filled with -1 after the last corner."""
        used = corners >= 0
        some = bool((middles >= 0).any() or (centres >= 0).any())
        none = np.empty(0, dtype=np.int64)
        return cls(used.sum(axis=1), corners[used], middles[used] if some else none, centres if some else none)

    @classmethod
    def joined(cls, lists: "list[FaceList]") -> "FaceList":
        """All faces of the lists in turn."""
        some = any(len(each.centres) for each in lists)
        none = [np.empty(0, dtype=np.int64)]

        def of(values: Ints, count: int) -> Ints:
            return values if len(values) or not some else np.full(count, -1, dtype=np.int64)

        return cls(
            np.concatenate(none + [each.sizes for each in lists]),
            np.concatenate(none + [each.corners for each in lists]),
            np.concatenate(none + [of(each.middles, len(each.corners)) for each in lists]),
            np.concatenate(none + [of(each.centres, len(each.sizes)) for each in lists]),
        )

    def where(self, kept: Bools) -> "FaceList":
        """The faces that are kept (f,)."""
        of = np.repeat(kept, self.sizes)
        middles = self.middles[of] if len(self.middles) else self.middles
        centres = self.centres[kept] if len(self.centres) else self.centres
        return FaceList(self.sizes[kept], self.corners[of], middles, centres)

    def next(self) -> Ints:
        """Place of the corner after each one (n,)."""
        after = np.arange(1, len(self.corners) + 1)
        some = self.sizes > 0
        last = np.cumsum(self.sizes)
        after[last[some] - 1] = (last - self.sizes)[some]
        return after

    def without_repeats(self) -> "FaceList":
        """The same with each corner that equals the next taken out, with the node between them; so of collapsed cells.

        Faces that have less than three corners left are taken out, too: they have no area.
        """
        repeats = self.corners == self.corners[self.next()]
        if not repeats.any():
            return self if self.sizes.min(initial=3) > 2 else self.where(self.sizes > 2)
        of = np.repeat(np.arange(len(self.sizes)), self.sizes)
        sizes = self.sizes - np.bincount(of[repeats], minlength=len(self.sizes))
        middles = self.middles[~repeats] if len(self.middles) else self.middles
        left = FaceList(sizes, self.corners[~repeats], middles, self.centres)
        return left.where(sizes > 2)

    def keys(self, mixed: Ints) -> Ints:
        """A number of each face that depends on its set of corners only: the sum of random numbers of the nodes."""
        if len(self.sizes) == 0:
            return np.empty(0, dtype=np.uint64)
        return np.add.reduceat(mixed[self.corners], np.cumsum(self.sizes) - self.sizes)


def faces_of_cells(kind: str, sizes: Ints, nodes: Ints, points: int) -> FaceList:
    """Faces of cells of a known kind.  Raises ValueError if a node does not exist.

    Nodes amid sides may be missing: they are negative, or repeat a corner.
    """
    if kind == STRIP:
        _check(nodes, points)
        return _from_table(_strips(sizes, nodes), faces_of("triangle"), points)
    if kind == SECOND_ORDER_POLYGON:
        of = np.repeat(sizes, sizes)
        tables = [(size, nodes[of == size].reshape(-1, size)) for size in np.unique(sizes).tolist()]
        return FaceList.joined([_from_table(table, polygon_of(size), points) for size, table in tables])
    if kind in POLYGONS:
        _check(nodes, points)
        none = np.empty(0, dtype=np.int64)
        return FaceList(sizes, nodes, none, none)
    faces = faces_of(kind)
    if len(sizes) and (sizes.min() != sizes.max() or sizes[0] < faces.least):
        raise ValueError(f"{kind} cells have the wrong number of nodes")
    return _from_table(nodes.reshape(len(sizes), -1), faces, points)


def with_area(sides: FaceList, counts: Ints) -> tuple[FaceList, Ints]:
    """Sides of polyhedra, given with the number of those of each cell, without sides of fewer than three corners."""
    if len(sides.sizes) != counts.sum():
        raise ValueError("its polyhedra are damaged")
    kept = sides.sizes > 2
    if not kept.all():
        cell = np.repeat(np.arange(len(counts)), counts)
        sides, counts = sides.where(kept), np.bincount(cell[kept], minlength=len(counts))
    return sides, counts[counts > 0]


def _from_table(table: Ints, faces: Faces, points: int) -> FaceList:
    """Faces of cells given by the table of their nodes (c, n)."""
    corners = np.unique(faces.corners[faces.corners >= 0])
    _check(table[:, corners], points)
    _check(np.maximum(table, 0), points)
    width = faces.corners.shape[1]
    padded = np.column_stack([table, np.full(len(table), -1, dtype=np.int64)])
    rows = padded[:, faces.corners].reshape(-1, width)
    none = np.empty((0, width), dtype=np.int64)
    if faces.middles.max() < 0 and faces.centres.max() < 0:
        return FaceList.of_rows(rows, none, none[:, 0])
    middles = padded[:, faces.middles].reshape(-1, width)
    middles[(middles == rows) | (middles == np.roll(rows, -1, axis=1))] = -1
    middles[middles < 0] = -1
    return FaceList.of_rows(rows, middles, np.maximum(padded[:, faces.centres].ravel(), -1))


def _check(nodes: Ints, points: int) -> None:
    if nodes.size and (nodes.min() < 0 or nodes.max() >= points):
        wrong = int(nodes[(nodes < 0) | (nodes >= points)][0])
        raise ValueError(f"a cell refers to vertex {wrong}, counted from 0, but there are {points}")


def _strips(sizes: Ints, nodes: Ints) -> Ints:
    """Triangles of strips: each node after the second makes one with the two before it, of alternating sense."""
    count = np.maximum(sizes - 2, 0)
    begins = np.cumsum(sizes) - sizes
    at = spread(begins, count)
    odd = (at - np.repeat(begins, count)) % 2
    return np.column_stack([nodes[at + odd], nodes[at + 1 - odd], nodes[at + 2]])
