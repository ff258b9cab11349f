"""The tables that CalculiX writes (.dat): displacements of nodes, stresses and strains at integration points."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.exporting.shell_about import again
from meshwind.solving.deck import ReadDeck

_HEAD = re.compile(rb"^ (displacements|stresses|strains) \(.*\) for set (\S+) and time +(\S+)\s*$", re.MULTILINE)
_POINTS = {8: 8, 6: 6}
"""Integration points of a layer of an element with so many nodes."""
_ASKED = {"displacements": "*NODE PRINT, NSET=NALL, U", "stresses": "*EL PRINT, ELSET=SHELL, S", "strains": "E"}


@dataclass(frozen=True)
class Tables:
    """Displacement (n, 3) of all nodes; stress and strain (m, 6) at all integration points, 11, 22, 33, 12, 13, 23.

    element, place (m,): of each point, from 0, the latter the layer from the inside out.  Units are those of the deck;
    shear strains are half the engineering ones.
    """

    displacement: Floats
    stress: Floats
    strain: Floats
    element: Ints
    place: Ints


def read_tables(file: Path, deck: ReadDeck) -> Tables:
    """Read the last step's tables; raises BadInputError where one is missing, or is not what the deck asks for."""
    held = _last(file.read_bytes())
    lacking = [name for name in _ASKED if name not in held]
    if lacking:
        raise BadInputError(
            f"CalculiX wrote no {lacking[0]} of all nodes and elements, for which the deck has to ask "
            f"({_ASKED[lacking[0]]}); write it again: {again()}"
        )
    moved, stress, strain = (_rows(held[name], 4 if name == "displacements" else 9) for name in _ASKED)
    nodes = _numbers(moved[:, 1:4])
    if not np.array_equal(moved[:, 0].astype(np.int64), np.arange(1, len(deck.points) + 1)):
        raise _mismatch(f"displacements of {len(moved)} nodes, and the deck has {len(deck.points)}")
    element, place = _expected(deck)
    for table in (stress, strain):
        if len(table) != len(element) or not np.array_equal(table[:, 0].astype(np.int64), element + 1):
            raise _mismatch(f"{len(table)} points with stresses, and the deck's layers have {len(element)}")
        _check_axes(table[:, 8], deck, element, place)
    return Tables(nodes, _numbers(stress[:, 2:8]), _numbers(strain[:, 2:8]), element, place)


def _mismatch(what: str) -> BadInputError:
    return BadInputError(f"CalculiX's results are not of this deck: {what}; write it again: {again()}")


def _last(text: bytes) -> dict[str, bytes]:
    """The last table of each kind, of the set of all."""
    heads = list(_HEAD.finditer(text))
    found: dict[str, bytes] = {}
    ends = [*(head.start() for head in heads), len(text)][1:]
    for head, end in zip(heads, ends, strict=True):
        if head[2] in (b"NALL", b"SHELL"):
            found[head[1].decode()] = text[head.end() : end]
    return found


def _rows(table: bytes, cells: int) -> NDArray[np.bytes_]:
    """The cells (m, cells) of a table's rows as text."""
    rows = [row for line in table.splitlines() if (row := line.split())]
    if not rows or set(map(len, rows)) != {cells}:
        raise _mismatch(f"a table with rows of {len(rows[0]) if rows else 0} cells where {cells} are expected")
    return np.array(rows, dtype=np.bytes_)


def _numbers(cells: NDArray[np.bytes_]) -> Floats:
    """Numbers from text; raises BadInputError where one is none."""
    values = cells.astype(np.float64)
    if not np.isfinite(values).all():
        raise BadInputError(
            "CalculiX's results are not numbers (NaN or infinity): something of the part is not held, or has next to "
            "no stiffness; look at what the deck holds and at its thinnest elements"
        )
    return values


def _expected(deck: ReadDeck) -> tuple[Ints, Ints]:
    """Element and layer of each integration point, in CalculiX's order."""
    each = np.repeat([_POINTS[8], _POINTS[6]], [len(deck.quads), len(deck.triangles)])
    element = np.repeat(np.arange(len(deck)), each * deck.layers)
    place = np.concatenate([np.repeat(np.arange(n), p) for n, p in zip(deck.layers, each, strict=True)])
    return element, place


def _check_axes(names: NDArray[np.bytes_], deck: ReadDeck, element: Ints, place: Ints) -> None:
    """Raise BadInputError where stresses are in other axes than those of the layer that they are taken for."""
    wanted = [[f"{each.axes}_".encode() for each in section] for section in deck.sections]
    for name, section, at in zip(names.tolist(), deck.section[element].tolist(), place.tolist(), strict=True):
        if not name.upper().startswith(wanted[section][at]):
            raise _mismatch(f"axes {name.decode(errors='replace')} of a layer with {wanted[section][at].decode()[:-1]}")
