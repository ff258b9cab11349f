"""Reading of Abaqus and CalculiX decks (INP): nodes, elements, parts and their instances.

No reader at hand takes parts with numbers of their own, moved instances and nodes in cylindrical coordinates.  The
rules are those of the Abaqus documentation ("Input Syntax Rules", "Node Definition", "Element Definition", "Assembly
Definition"), and of CalculiX where it allows more.
"""

import difflib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from meshwind.core.cast import Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.cells.surface import CellBlock, surface_mesh
from meshwind.mesh.io.deck.blocks import NOT_READ, READ, Block, blocks
from meshwind.mesh.io.deck.elements import SECTION, cell_kind, cells_of
from meshwind.mesh.io.deck.generation import Generation
from meshwind.mesh.io.deck.numbers import first_ints_of, floats_of
from meshwind.mesh.io.deck.part import Numbered, Part
from meshwind.mesh.io.deck.places import STILL, Place, cartesian, instance_place, local_system
from meshwind.mesh.io.deck.words import words_on_elements, words_on_parts
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.text import own_unit, text_of
from meshwind.mesh.io.unused import words_on_unused

_ENDS = ("END PART", "END INSTANCE", "END ASSEMBLY", "ASSEMBLY")
_ANALYTICAL = ("REVOLUTION", "CYLINDER", "SEGMENTS")
"""Types of *SURFACE that are given by formulas."""
_SIMILAR = 0.87
"""Ratio from which a keyword is taken for a misspelt one."""
_MOST = 100_000_000
"""Largest number of nodes of all cells that instances may make of a smaller file."""


@dataclass(frozen=True)
class _Instance:
    """A use of a part: what it adds to it, and where it is."""

    block: Block
    part: str
    own: Part
    place: Place


class _Deck:
    """What has been read of a deck."""

    def __init__(self, file: str) -> None:
        self.file, self.loose = file, Part()
        self.parts: dict[str, Part] = {}
        self.instances: list[_Instance] = []
        self.words: list[str] = []
        self._into, self._system, self._outer = self.loose, STILL, STILL
        self._generation = Generation()

    def take(self, block: Block) -> None:
        """Read a keyword."""
        key = block.key
        if key == "INCLUDE" or (key in READ and block.value("INPUT") is not None):
            raise block.refusal("includes another file, which is not read; join them into one")
        if key in NOT_READ or key.startswith("IMPORT"):
            raise block.refusal("is not read; write the deck with all nodes and elements listed")
        if key in ("PART", "INSTANCE", *_ENDS):
            self._enter(block)
        elif key == "SYSTEM":
            self._system = local_system(block)
        elif key == "NODE":
            self._nodes(block)
        elif key == "ELEMENT":
            self._elements(block)
        elif key == "NGEN":
            self._generation.nodes(block, self._into, self._system)
        elif key == "ELGEN":
            self._generation.elements(block, self._into)
        else:
            self._other(block)

    def _enter(self, block: Block) -> None:
        """Begin or end a part or an instance; *SYSTEM counts within it only."""
        if self._into is self.loose:
            self._outer = self._system
        self._into, self._system = Part(block.value("NAME") or ""), STILL
        if block.key == "PART":
            name = block.name()
            if name in self.parts:
                raise block.refusal(f"is the second of the name {name[:40]!r}; give each part its own")
            self.parts[name] = self._into
        elif block.key == "INSTANCE":
            if block.value("PART") is None:
                raise block.refusal("is of an earlier analysis, which is not read; export the deck with all its parts")
            self.instances.append(_Instance(block, block.name("PART"), self._into, instance_place(block)))
        else:
            self._into, self._system = self.loose, self._outer

    def _nodes(self, block: Block) -> None:
        table = floats_of(block).table(4)
        ids = table[:, 0]
        if not ((ids == np.floor(ids)) & (np.abs(ids) < 2**53)).all():
            raise block.refusal("has a node whose number is not whole; mend it")
        self._into.ids.append(ids.astype(np.int64))
        self._into.points.append(self._system.moved(cartesian(table[:, 1:], block.value("SYSTEM") or "", block)))

    def _elements(self, block: Block) -> None:
        name = block.name("TYPE").upper()
        kind = cell_kind(name)
        if kind and kind != SECTION:
            self._into.cells += cells_of(block, kind)
        else:
            self._into.others.append((name, first_ints_of(block)))

    def _other(self, block: Block) -> None:
        """Words on keywords that are not read but may change the surface."""
        key = block.key
        if key == "RIGID SURFACE" or (key == "SURFACE" and block.name("TYPE").upper() in _ANALYTICAL):
            self.words.append(f"*{key} in line {block.line} is a surface given by formulas; left out")
        elif key == "IMPERFECTION":
            self.words.append(f"*{key} in line {block.line} moves nodes, which is not read; they are as listed")
        elif _is_misspelt(key):
            self.words.append(f"*{key} in line {block.line} is not a keyword that is known; left out")

    def surface(self, units: str) -> FileMesh:
        """The surface of all instances, and of what belongs to no part; without instances, of all parts."""
        names = [self._name_of(instance) for instance in self.instances]
        alone = [self.loose, *([] if names else self.parts.values())]
        placed = [(part, STILL) for part in alone] + self._placed(names)
        pieces = self._pieces(placed)
        told = [*self.words, *words_on_elements([part for part, _ in placed], self.file)]
        told += words_on_parts(self.parts, set(names))
        if not any(part.others for part, _ in placed):
            told += words_on_unused(*_unused(pieces), ("nodes", "element"))
        starts = np.cumsum([0] + [len(piece.points) for piece in pieces])
        tables: dict[str, list[Ints]] = {}
        for piece, start in zip(pieces, starts[:-1], strict=True):
            for kind, rows in piece.cells:
                tables.setdefault(kind, []).append(rows + start)
        cells = [_cell_block(kind, np.concatenate(rows)) for kind, rows in tables.items()]
        return surface_mesh(np.concatenate([piece.points for piece in pieces]), cells, units, tuple(told))

    def _name_of(self, instance: _Instance) -> str:
        """Name of an instance's part; one in quotation marks may differ in capitals only."""
        name = instance.part
        alike = [other for other in self.parts if other.upper() == name.upper()]
        if name in self.parts or len(alike) == 1:
            return name if name in self.parts else alike[0]
        raise instance.block.refusal(f"is of part {name[:40]!r}, which is not in the deck; export the deck again")

    def _placed(self, names: list[str]) -> list[tuple[Part, Place]]:
        """The part of each instance, with what the instance adds to it, and its place."""
        placed = []
        for name, instance in zip(names, self.instances, strict=True):
            part, own = self.parts[name], instance.own
            placed.append((part.joined(own) if own.ids or own.cells or own.others else part, instance.place))
        return placed

    def _pieces(self, placed: list[tuple[Part, Place]]) -> list[Numbered]:
        """Nodes and cells of each part in its place."""
        held: dict[int, Numbered] = {}
        pieces, size = [], 0
        for part, place in placed:
            if id(part) not in held:
                held[id(part)] = part.numbered(self.file)
            piece = held[id(part)]
            size += piece.points.size + sum(rows.size for _, rows in piece.cells)
            if size > _MOST and self.instances:
                raise BadInputError(f"{self.file}: its {len(self.instances)} instances make too many elements; "
                                    "export one of them alone")  # fmt: skip
            pieces.append(Numbered(place.moved(piece.points), piece.cells))
        return pieces


def _unused(pieces: list[Numbered]) -> tuple[int, int]:
    """Nodes that are in no element, and all."""
    total = sum(len(piece.points) for piece in pieces)
    used = 0
    for piece in pieces:
        nodes = np.concatenate([rows.ravel() for _, rows in piece.cells] or [np.zeros(0, dtype=np.int64)])
        used += int(np.count_nonzero(np.bincount(nodes, minlength=len(piece.points))))
    return total - used, total


def _cell_block(kind: str, rows: Ints) -> CellBlock:
    return kind, (np.full(len(rows), rows.shape[1], dtype=np.int64), rows.ravel())


@cache
def _is_misspelt(key: str) -> bool:
    """Whether a keyword that is not read looks like one that is."""
    return len(key) < 30 and bool(difflib.get_close_matches(key, READ, 1, _SIMILAR))


def read_deck(path: Path) -> FileMesh:
    """Surface of a deck."""
    content = text_of(path)
    deck = _Deck(path.name)
    has_nodes = False
    for block in blocks(content, path.name):
        deck.take(block)
        has_nodes |= block.key == "NODE"
    if not has_nodes:
        raise ValueError("it has no *NODE, and is no deck of Abaqus or CalculiX")
    return deck.surface(own_unit(content))
