"""A part of a deck: nodes and cells with numbers of their own."""

from dataclasses import dataclass, field

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.deck.elements import Cells


@dataclass(frozen=True)
class Numbered:
    """Positions (n, 3) of a part's nodes, and its cells by the rows of their nodes."""

    points: Floats
    cells: list[tuple[str, Ints]]


@dataclass
class Part:
    """What a deck says of a part, in the order of the deck; of a node or element that is given twice the last counts.

    others: numbers of the elements that are not read, by their type; twice: how many nodes were given again at another
    place, and how many cells were given again.
    """

    name: str = ""
    ids: list[Ints] = field(default_factory=list)
    points: list[Floats] = field(default_factory=list)
    cells: list[Cells] = field(default_factory=list)
    others: list[tuple[str, Ints]] = field(default_factory=list)
    twice: tuple[int, int] = (0, 0)

    def joined(self, other: "Part") -> "Part":
        """This part, and what an instance of it adds."""
        return Part(
            self.name, self.ids + other.ids, self.points + other.points, self.cells + other.cells,
            self.others + other.others,
        )  # fmt: skip

    def nodes(self) -> tuple[Ints, Floats]:
        """Numbers of the nodes, ascending, and their positions."""
        ids = np.concatenate([*self.ids, np.empty(0, dtype=np.int64)])
        points = np.concatenate([*self.points, np.empty((0, 3))])
        if (np.diff(ids) > 0).all():
            return ids, points
        known, last = np.unique(ids[::-1], return_index=True)
        places = points[::-1][last]
        if len(known) < len(ids):
            moved = (points != places[np.searchsorted(known, ids)]).any(axis=1)
            self.twice = (len(np.unique(ids[moved])), self.twice[1])
        return known, places

    def last_cells(self) -> list[Cells]:
        """The cells without those that are given again later."""
        ids = np.concatenate([*(cells.ids for cells in self.cells), np.empty(0, dtype=np.int64)])
        if (np.diff(ids) > 0).all():
            return self.cells
        _, last = np.unique(ids[::-1], return_index=True)
        if len(last) == len(ids):
            return self.cells
        self.twice = (self.twice[0], len(ids) - len(last))
        keep = np.zeros(len(ids), dtype=np.bool_)
        keep[len(ids) - 1 - last] = True
        parts = np.split(keep, np.cumsum([len(cells.ids) for cells in self.cells])[:-1])
        return [Cells(c.kind, c.ids[k], c.nodes[k], c.shortened) for c, k in zip(self.cells, parts, strict=True)]

    def numbered(self, file: str) -> Numbered:
        """Positions, and cells by their rows.  Raises BadInputError if a cell has a node that is not defined."""
        if not self.cells:
            return Numbered(np.empty((0, 3)), [])
        known, points = self.nodes()
        tables = []
        for cells in self.last_cells():
            rows, found = rows_of(known, cells.nodes)
            if not found.all():
                cell, column = np.argwhere(~found)[0]
                where = f" in part {self.name[:40]}" if self.name else ""
                raise BadInputError(
                    f"{file}: element {cells.ids[cell]} refers to node {cells.nodes[cell, column]}, which is not "
                    f"defined{where}; export the deck again"
                )
            tables.append((cells.kind, rows))
        return Numbered(points, tables)


def rows_of(known: Ints, wanted: Ints) -> tuple[Ints, Bools]:
    """Where numbers are among those known, which ascend, and whether they are."""
    if len(known) == 0:
        return np.zeros_like(wanted), np.zeros(wanted.shape, dtype=np.bool_)
    if known[-1] - known[0] == len(known) - 1:
        found = (wanted >= known[0]) & (wanted <= known[-1])
        return np.where(found, wanted - known[0], 0), found
    rows = np.minimum(np.searchsorted(known, wanted), len(known) - 1)
    return rows, known[rows] == wanted
