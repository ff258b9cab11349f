"""Stresses and strains of the plies in the axes of their fibres, and how near they are to failure."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.units import millimetres
from meshwind.exporting.shell_about import Strengths
from meshwind.solving.deck import Layer, ReadDeck
from meshwind.solving.tables import Tables
from meshwind.solving.tsai_wu import index

_IN_PLANE = (0, 1, 3)
"""Components 11, 22, 12 of those that CalculiX has."""


@dataclass(frozen=True)
class PlyFields:
    """On k elements, in the axes of the fibres: their direction (k, 3), stress (k, 3) in MPa and strain (k, 3).

    Stress and strain are means over the ply, 11, 22 and 12, the latter the engineering shear strain; NaN where it is
    not.
    """

    direction: Floats
    stress: Floats
    strain: Floats


@dataclass(frozen=True)
class Worst:
    """Of k elements the point that is nearest to failure: exposure and polynomial of `Index`, stress (k, 3) in MPa.

    place (k,): the layer there, from 0, of the element's from the inside out.
    """

    exposure: Floats
    polynomial: Floats
    stress: Floats
    place: Ints


@dataclass(frozen=True)
class Solved:
    """A deck with what came of it: displacement (n, 3) of nodes, and the worst points where strengths are known."""

    deck: ReadDeck
    displacement: Floats
    plies: Mapping[tuple[int, int], PlyFields]
    worst: Worst | None

    @cached_property
    def moved(self) -> Floats:
        """Length (n,) of the displacements."""
        return np.asarray(np.linalg.norm(self.displacement, axis=1))

    @cached_property
    def worst_layer(self) -> list[Layer]:
        """Of each element the layer that is nearest to failure."""
        if self.worst is None:
            return []
        sections = (self.deck.sections[number] for number in self.deck.section)
        return [section[at] for section, at in zip(sections, self.worst.place, strict=True)]

    @cached_property
    def thickness(self) -> Floats:
        """Thickness (k,) of the elements."""
        each = [sum(layer.thickness for layer in section) for section in self.deck.sections]
        return np.array(each)[self.deck.section]


def solved(deck: ReadDeck, tables: Tables, units: str, strengths: Strengths) -> Solved:
    """What a deck's tables mean for its plies."""
    stress = tables.stress[:, _IN_PLANE] / millimetres(units) ** 2
    strain = tables.strain[:, _IN_PLANE] * (1.0, 1.0, 2.0)
    worst = _worst(stress, tables, strengths) if strengths.of else None
    return Solved(deck, tables.displacement, _plies(deck, tables, stress, strain), worst)


def _worst(stress: Floats, tables: Tables, strengths: Strengths) -> Worst:
    """The points of the largest exposure; those of an element follow one another."""
    found = index(stress, strengths)
    starts = np.flatnonzero(np.diff(tables.element, prepend=-1))
    most = np.maximum.reduceat(found.exposure, starts)
    at = np.flatnonzero(found.exposure == most[tables.element])
    at = at[np.unique(tables.element[at], return_index=True)[1]]
    return Worst(most, found.polynomial[at], stress[at], tables.place[at])


def _plies(deck: ReadDeck, tables: Tables, stress: Floats, strain: Floats) -> dict[tuple[int, int], PlyFields]:
    """Means over each ply, whose halves count by their thickness."""
    first = np.concatenate([[0], np.cumsum(deck.layers)])
    slot = first[tables.element] + tables.place
    count = np.bincount(slot, minlength=first[-1])
    layers = [layer for number in deck.section for layer in deck.sections[number]]
    element = np.repeat(np.arange(len(deck)), deck.layers)
    weight = np.array([layer.thickness for layer in layers])
    means = [
        np.stack([np.bincount(slot, values, first[-1]) / count for values in table.T], axis=1)
        for table in (stress, strain)
    ]
    found = {}
    for ply in deck.plies:
        mine = np.array([(layer.layer, layer.family) == ply for layer in layers])
        total = np.bincount(element[mine], weight[mine], len(deck))
        total[total == 0.0] = np.nan  # where the ply is not
        direction = np.full((len(deck), 3), np.nan)
        direction[element[mine]] = [deck.direction(layers[k].axes) for k in np.flatnonzero(mine)]
        each = [
            np.stack([np.bincount(element[mine], (weight * part)[mine], len(deck)) / total for part in mean.T], axis=1)
            for mean in means
        ]
        found[ply] = PlyFields(direction, *each)
    return found
