"""Nodes and elements that a deck makes from others: *NGEN along lines and arcs, *ELGEN in rows, layers and blocks."""

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.io.deck.blocks import Block
from meshwind.mesh.io.deck.elements import Cells
from meshwind.mesh.io.deck.numbers import floats_of
from meshwind.mesh.io.deck.part import Part, rows_of
from meshwind.mesh.io.deck.places import Place, cartesian

_MOST = 1_000_000
"""Largest number of nodes or elements that a deck may make."""
_ROUND = 1e-3
"""Largest difference of the radii of an arc, as a share: by so much are ends rounded in decks."""


class Generation:
    """Makes nodes and elements of a deck, up to a limit for the whole deck."""

    def __init__(self) -> None:
        self._made = 0

    def _count(self, number: int, block: Block) -> None:
        self._made += number
        if self._made > _MOST:
            raise block.refusal(f"makes more than {_MOST} nodes or elements; write the deck with all of them listed")

    def nodes(self, block: Block, part: Part, system: Place) -> None:
        """Add the nodes of *NGEN: between two nodes, by equal steps along a line or an arc of a circle."""
        kind = (block.value("LINE") or "").strip().upper()
        if kind not in ("", "C"):
            raise block.refusal(f"with LINE={kind[:9]} is not read; write the deck with all nodes listed")
        lines = _Lines(block, part)
        for given in floats_of(block).rows():
            first, last, step, middle, *rest = [*given, *[0.0] * (10 - len(given))]
            count, ids = _steps(first, last, abs(step) or 1.0, block)
            self._count(count, block)
            a, b = lines.place(first), lines.place(last)
            share = np.arange(1, count) / count
            if kind == "C":
                spot = cartesian(np.array([rest[:3]]), block.value("SYSTEM") or "", block)
                centre = lines.place(middle) if middle else system.moved(spot)[0]
                new = _arc(a - centre, b - centre, np.array(rest[3:6]), share, block) + centre
            else:
                new = a + share[:, None] * (b - a)
            lines.made.update(zip(ids.tolist(), new, strict=True))
        if lines.made:
            part.ids.append(np.array(list(lines.made), dtype=np.int64))
            part.points.append(np.array(list(lines.made.values())))

    def elements(self, block: Block, part: Part) -> None:
        """Add the elements of *ELGEN: copies of a master in a row, of the row in a layer, and of the layer in a block.

        A line has the number of the master, and for each of the three a count with it and the increments of the node
        and element numbers.
        """
        cells = part.last_cells()
        all_ids = np.concatenate([*(each.ids for each in cells), np.empty(0, dtype=np.int64)])
        order = np.argsort(all_ids, kind="stable")
        starts = np.cumsum([0] + [len(each.ids) for each in cells])
        for line in floats_of(block).rows():
            if len(line) > 10 or not all(abs(each) < 2**53 and each == int(each) for each in line):
                raise block.refusal("has a line that is not up to 10 whole numbers; mend it")
            master, *given = [int(each) for each in line]
            given += [0] * (9 - len(given))
            count = [given[k] or 1 for k in (0, 3, 6)]
            if min(count) < 1:
                raise block.refusal("has a count below 1; mend it")
            self._count(count[0] * count[1] * count[2] - 1, block)
            steps = np.array([[given[k + 1] or 1, given[k + 2] or 1] for k in (0, 3, 6)], dtype=np.int64)
            places = np.column_stack(np.unravel_index(np.arange(1, count[0] * count[1] * count[2]), count))
            of_node, of_element = (places @ steps).T
            row, found = rows_of(all_ids[order], np.array([master]))
            if found[0]:
                at = int(order[row[0]])
                which = int(np.searchsorted(starts, at, side="right")) - 1
                source = cells[which]
                nodes = source.nodes[at - starts[which]]
                part.cells.append(Cells(source.kind, master + of_element, nodes + of_node[:, None], source.shortened))
            else:
                part.others.append((_other(block, part, master), master + of_element))


class _Lines:
    """Places of the nodes before *NGEN, and of those that its lines have made."""

    def __init__(self, block: Block, part: Part) -> None:
        self._block, self.made = block, dict[int, Floats]()
        self._known, self._points = part.nodes()

    def place(self, number: float) -> Floats:
        """Place of a node (3,).  Raises BadInputError if it is not defined."""
        if number in self.made:
            return self.made[int(number)]
        row, found = rows_of(self._known, np.array([int(number) if abs(number) < 2**53 else 0]))
        if not found[0]:
            raise self._block.refusal(f"refers to node {number:.0f}, which is not defined; export the deck again")
        return np.asarray(self._points[row[0]])


def _steps(first: float, last: float, step: float, block: Block) -> tuple[int, Ints]:
    """Number of equal steps from one node to another, and the numbers of the nodes between."""
    if not all(abs(each) < 2**53 and each == int(each) for each in (first, last, step)):
        raise block.refusal("has node numbers that are not whole; mend it")
    if last == first or (last - first) % step or abs(last - first) / step > _MOST:
        raise block.refusal(f"goes from {first:.0f} to {last:.0f} by steps of {step:.0f}, which is not read; mend it")
    count = int(abs(last - first) / step)
    return count, int(first) + int(np.sign(last - first)) * int(step) * np.arange(1, count)


def _other(block: Block, part: Part, master: int) -> str:
    """Type of an element that is not read."""
    for name, ids in reversed(part.others):
        if (ids == master).any():
            return name
    raise block.refusal(f"refers to element {master}, which is not defined; export the deck again")


def _arc(a: Floats, b: Floats, normal: Floats, share: Floats, block: Block) -> Floats:
    """Points between a and b about the origin: the short way, or with a normal, counterclockwise about it."""
    size = np.linalg.norm([a, b], axis=1)
    if not abs(size[0] - size[1]) <= _ROUND * size.max():
        raise block.refusal("has an arc whose ends are not as far from its centre; mend it")
    axis = normal if normal.any() else np.cross(a, b)
    length = float(np.linalg.norm(axis))
    if not (length > 1e-12 * size[0] * size[1] and size.min() > 0.0):
        raise block.refusal("has an arc whose ends lie in a line with its centre, and no normal; mend it")
    x = a / size[0]
    angle = np.arctan2(np.cross(a, b) @ (axis / length), a @ b)
    if normal.any() and angle <= 1e-9:
        angle += 2.0 * np.pi
    if not np.abs(axis @ x) <= 1e-6 * length:
        raise block.refusal("has an arc whose normal is not square to it; mend it")
    turn = (share * angle)[:, None]
    turned = np.cos(turn) * x + np.sin(turn) * np.cross(axis / length, x)
    return np.asarray(turned * (size[0] + share * (size[1] - size[0]))[:, None])
