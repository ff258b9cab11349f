"""A shell deck for CalculiX as it was written by an export: nodes, elements, layers and their axes."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.core.vectors import unit
from meshwind.exporting.shell_about import again

_NUMBER_OF_NODES = {"S8R": 8, "S6": 6}
_AXES = re.compile(r"(?:L(\d+))?([PM])\d+")
"""Name of the axes of a layer: number of the layer where there are several, and family."""


@dataclass(frozen=True)
class Layer:
    """A layer of a section: thickness, number of the wound layer from 1, family, and name of its axes."""

    thickness: float
    layer: int
    family: int
    axes: str


@dataclass(frozen=True)
class ReadDeck:
    """A deck: points (n, 3), quads (q, 8) and triangles (t, 6) from 0, in the order of their numbers in the deck.

    sections: the layers of each from the inside out; section (k,): the section of each element; axes: the directions
    1 and 2 (2, 3) of each layer's axes by name; rims: nodes of the start and of the end rim; curved: whether a step is
    geometrically nonlinear.
    """

    points: Floats
    quads: Ints
    triangles: Ints
    sections: tuple[tuple[Layer, ...], ...]
    section: Ints
    axes: dict[str, Floats]
    rims: tuple[Ints, Ints]
    curved: bool

    def __len__(self) -> int:
        return len(self.section)

    @property
    def plies(self) -> list[tuple[int, int]]:
        """Numbers of layer and family of all plies there are, layer by layer, family +1 first."""
        found = {(each.layer, each.family) for section in self.sections for each in section}
        return sorted(found, key=lambda ply: (ply[0], -ply[1]))

    @cached_property
    def layers(self) -> Ints:
        """Number of layers (k,) of each element."""
        return np.array([len(section) for section in self.sections], dtype=np.int64)[self.section]

    @cached_property
    def faces(self) -> Ints:
        """Corners (k, 4) of all elements, those of triangles with the last one twice."""
        return np.concatenate([self.quads[:, :4], self.triangles[:, [0, 1, 2, 2]]])

    @cached_property
    def centre(self) -> Floats:
        """Middle (k, 3) of each element's corners."""
        middle = [self.points[faces].mean(axis=1) for faces in (self.quads[:, :4], self.triangles[:, :3])]
        return np.concatenate(middle)

    @cached_property
    def normal(self) -> Floats:
        """Outward unit normal (k, 3) of each element."""
        corner = self.points[self.faces]
        return unit(np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1]))

    @cached_property
    def normal_at(self) -> Floats:
        """Outward unit normal (n, 3) at corners, the mean of their elements'."""
        total = np.zeros_like(self.points)
        np.add.at(total, self.faces, self.normal[:, None])
        return unit(total)

    def direction(self, axes: str) -> Floats:
        """Unit vector (3,) along the fibres of axes by name."""
        return unit(self.axes[axes][:1])[0]


def read_deck(file: Path) -> ReadDeck:
    """Read a deck that was exported; raises BadInputError if it is not one."""
    try:
        text = file.read_text(encoding="ascii", errors="replace")
    except OSError as error:
        raise BadInputError(f"cannot read {file}: {error.strerror or error}; write it first: {again()}") from error
    try:
        return _of(list(_cards(text)))
    except (ValueError, LookupError, TypeError) as error:
        raise BadInputError(
            f"{file} is no deck as it is exported, or was changed beyond its step; write it again: {again()}"
        ) from error


@dataclass(frozen=True)
class _Card:
    """A card: its keyword, its parameters, and its data lines."""

    keyword: str
    parameters: dict[str, str]
    lines: list[str]


def _cards(text: str) -> Iterator[_Card]:
    for part in re.split(r"^(?=\*[A-Za-z])", text, flags=re.MULTILINE)[1:]:
        head, *lines = part.splitlines()
        keyword, *given = (word.strip().upper() for word in head[1:].split(","))
        named = [word.partition("=") for word in given]
        parameters = {name.strip(): value.strip() for name, _, value in named}
        yield _Card(keyword, parameters, [line for line in lines if line.strip() and not line.startswith("**")])


def _of(cards: list[_Card]) -> ReadDeck:
    nodes = _rows(next(card for card in cards if card.keyword == "NODE"))
    if not np.array_equal(nodes[:, 0], np.arange(1, len(nodes) + 1)):
        raise ValueError("numbers of nodes")
    faces = {count: np.zeros((0, count), dtype=np.int64) for count in _NUMBER_OF_NODES.values()}
    first = 1
    for card in (card for card in cards if card.keyword == "ELEMENT"):
        rows = _rows(card).astype(np.int64)
        faces[_NUMBER_OF_NODES[card.parameters["TYPE"]]] = rows[:, 1:] - 1
        if not np.array_equal(rows[:, 0], np.arange(first, first + len(rows))):
            raise ValueError("numbers of elements")
        first += len(rows)
    section, sections = _sections(cards, first - 1)
    axes = {card.parameters["NAME"]: _axes(card) for card in cards if card.keyword == "ORIENTATION"}
    if {each.axes for layers in sections for each in layers} - axes.keys():
        raise ValueError("axes")
    start, end = (_members(_sets(cards, "NSET", name)) for name in ("START", "END"))
    curved = any("NLGEOM" in card.parameters for card in cards if card.keyword == "STEP")
    return ReadDeck(nodes[:, 1:], faces[8], faces[6], sections, section, axes, (start, end), curved)


def _rows(card: _Card) -> Floats:
    return np.array([line.rstrip(", ").split(",") for line in card.lines], dtype=np.float64)


def _axes(card: _Card) -> Floats:
    return np.array(card.lines[0].split(","), dtype=np.float64).reshape(2, 3)


def _sets(cards: list[_Card], kind: str, name: str) -> _Card:
    return next(card for card in cards if card.keyword == kind and card.parameters.get(kind) == name)


def _members(card: _Card) -> Ints:
    """Numbers of a set, from 0."""
    words = ",".join(card.lines).split(",")
    return np.array([int(word) - 1 for word in words if word.strip()], dtype=np.int64)


def _sections(cards: list[_Card], count: int) -> tuple[Ints, tuple[tuple[Layer, ...], ...]]:
    """The section (k,) of each element, and the layers of each section."""
    members = {card.parameters["ELSET"]: card for card in cards if card.keyword == "ELSET"}
    section = np.full(count, -1)
    sections: list[tuple[Layer, ...]] = []
    for card in (card for card in cards if card.keyword == "SHELL SECTION"):
        section[_members(members[card.parameters["ELSET"]])] = len(sections)
        sections.append(tuple(map(_layer, card.lines)))
    if (section < 0).any():
        raise ValueError("elements without a section")
    return section, tuple(sections)


def _layer(line: str) -> Layer:
    thickness, _, _, axes = (word.strip().upper() for word in line.split(","))
    found = _AXES.fullmatch(axes)
    if found is None:
        raise ValueError("axes")
    return Layer(float(thickness), int(found[1] or 1), 1 if found[2] == "P" else -1, axes)
