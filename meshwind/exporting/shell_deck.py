"""Shell decks for CalculiX and Abaqus: each element with its own layers, directions and thickness.

`shell.inp` is for CalculiX: eight-node elements (S8R, and S6 for triangles), the only ones that can have layers there.
`shell_s4r.inp` is for Abaqus: four-node elements (S4R, S3).
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from textwrap import wrap
from typing import TextIO

import numpy as np

from meshwind.appearance.words import quantity
from meshwind.core.cast import Floats, Ints
from meshwind.core.units import millimetres
from meshwind.core.vectors import TINY
from meshwind.exporting.elements import Elements
from meshwind.exporting.material import STRENGTHS, Material
from meshwind.exporting.plies import Plies
from meshwind.exporting.shell_about import About, fingerprint, write_about
from meshwind.exporting.shell_groups import SHARES, TOLERANCE, Groups, Laid, grouped
from meshwind.exporting.shell_loads import FORCE, Loads, step
from meshwind.exporting.shell_nodes import nodes_of
from meshwind.exporting.shell_sections import Sections, listed
from meshwind.path.winding_angle import axes
from meshwind.results.schema import SHELL, SHELL_ABOUT, SHELL_S4R

LEAST = 0.05
"""Least thickness of a family, in layers, also where it has no fibres."""
_STEPS = 1.07, 1.15, 1.25, 1.4, 1.6, 2.0
"""Ratios of the steps of thickness: the finest with few enough knots, and at most so much does an element change.

CalculiX joins elements of different thickness by rigid knots.
"""
_KNOTS = 0.5
"""Largest share of the nodes that are knots: CalculiX stopped for want of room at 0.7 of them, and not at 0.58."""
_LEAST_FACE = 0.1
"""Least area of the inner face of an element that is pressed on, over its own: thick hollows have none."""
_MUCH = 0.1
"""Change of an element's thickness that is worth a note."""
_WIDE = 110
"""Characters of a line of a comment."""
_SHAPES = {3: "S3", 4: "S4R", 6: "S6", 8: "S8R"}


@dataclass(frozen=True)
class Deck:
    """Contents of a deck: mesh, plies, material, unit of length, name of the part, and loads.

    tolerance: degrees within which elements share a section, 0 for sections of their own; run: the fingerprint of the
    run that it is of.
    """

    elements: Elements
    plies: Plies
    material: Material
    units: str = ""
    name: str = "part"
    loads: Loads = field(default_factory=Loads)
    tolerance: float = TOLERANCE
    run: str = ""

    @cached_property
    def levels(self) -> Ints:
        """The step of thickness (k,) that each element is on, from 0."""
        return _levels(self.elements, _unrounded(self.plies).sum(axis=0))

    @cached_property
    def groups(self) -> Groups:
        """Which elements share a section, and what each section has."""
        angle = np.stack([ply.angle for ply in self.plies.families])
        laid = Laid(angle, thicknesses(self), self.elements.samples()[1].sum(axis=1))
        return grouped(laid, self.levels, self.tolerance)

    @cached_property
    def sections(self) -> Sections:
        """The sections where each element has axes of its own."""
        along = axes(self.elements.surface, self.elements.centre)[0]
        return Sections(self.groups, self.plies, along, self.material.name)

    @cached_property
    def fixed(self) -> Sections:
        """The sections where axes are fixed in space."""
        return self.sections.turned() if self.tolerance > 0.0 else self.sections


def write_decks(folder: Path, deck: Deck) -> list[str]:
    """Write both decks, and what they do not hold, into an existing folder; return what the user should know."""
    for name, quadratic in ((SHELL, True), (SHELL_S4R, False)):
        with (folder / name).open("w", encoding="ascii", errors="replace") as file:
            _write(file, deck, quadratic)
    about = About(deck.name, deck.units, deck.run, fingerprint(folder / SHELL), deck.material)
    write_about(folder / SHELL_ABOUT, about)
    notes = [f"{SHELL}: {note}" for note in (_of_layers(deck) if deck.plies.wound else _of_families(deck))]
    counts = f"{len(deck.fixed.groups)} sections, {SHELL_S4R} {len(deck.groups)}"
    notes.append(f"{SHELL}: {counts}: elements with angles within {deck.tolerance:g} degrees share one")
    if (change := _rounded_by(deck)) > _MUCH:
        notes.append(
            f"{SHELL}: thickness is rounded by up to {100.0 * change:.2g} %, as it varies too much for CalculiX"
        )
    if not deck.loads.given:
        notes.append(f"{SHELL}: no load is given, so there is a pull of {FORCE:g} N to begin with")
    if not deck.units:
        notes.append(f"{SHELL}: the run names no unit, so the material is in N and mm")
    return notes


def _of_families(deck: Deck) -> list[str]:
    """Notes on a run without layers."""
    notes = [f"{len(deck.elements)} elements, one layer of band {quantity(deck.plies.layer, deck.units, 4)} thick"]
    thin = int(sum((ply.layers < LEAST).sum() for ply in deck.plies.families))
    if thin:
        notes.append(f"{thin} plies of elements have less than {LEAST:g} of a layer and count as that")
    return notes


def _of_layers(deck: Deck) -> list[str]:
    """Notes on a laminate."""
    total = deck.plies.thickness
    thick = f"{total.min():.4g} to {quantity(total.max(), deck.units, 4)} thick"
    notes = [f"{len(deck.elements)} elements, {len(deck.plies.stacks)} layers, {thick} in all"]
    thin = int((total < LEAST * deck.plies.layer).sum())
    if thin:
        notes.append(f"{thin} elements are bare and count as {LEAST:g} of a band of the first layer")
    return notes


def thicknesses(deck: Deck) -> Floats:
    """Thickness (f, k) of each family on each element in the deck, 0 where a layer of a laminate is not.

    Without layers each family has at least `LEAST` of a layer.  The whole of an element is rounded: elements between
    two steps get their mean, weighted by their areas, so that the deck keeps the volume.
    """
    each = _unrounded(deck.plies)
    total, area = each.sum(axis=0), deck.elements.samples()[1].sum(axis=1)
    mean = np.bincount(deck.levels, total * area) / np.maximum(np.bincount(deck.levels, area), TINY)
    return np.asarray(each * (mean[deck.levels] / total))


def _rounded_by(deck: Deck) -> float:
    """Largest change of an element's thickness by rounding, over the thickness."""
    return float(np.abs(thicknesses(deck).sum(axis=0) / _unrounded(deck.plies).sum(axis=0) - 1.0).max())


def _unrounded(laid: Plies) -> Floats:
    each = np.stack([ply.thickness for ply in laid.families])
    least = LEAST * laid.layer
    if not laid.wound:
        return np.asarray(np.maximum(each, least))
    inner = list(laid.stacks[0])
    each[inner] += np.maximum(least - each.sum(axis=0), 0.0) / len(inner)
    return each


def _levels(elements: Elements, total: Floats) -> Ints:
    """Step (k,), from 0, that the thickness (k,) of each element is on: the finest steps with few enough knots."""
    nodes = nodes_of(elements, True)
    middle = _median(total, elements.samples()[1].sum(axis=1))
    for ratio in _STEPS:
        level = np.round(np.log(total / middle) / np.log(ratio)).astype(np.int64)
        level -= level.min()
        least, most = np.full(len(nodes.points), level.max()), np.zeros(len(nodes.points), dtype=np.int64)
        for faces, own in ((nodes.quads, level[: len(nodes.quads)]), (nodes.triangles, level[len(nodes.quads) :])):
            np.minimum.at(least, faces, own[:, None])
            np.maximum.at(most, faces, own[:, None])
        if (least < most).mean() <= _KNOTS:
            break
    return level


def _median(values: Floats, weight: Floats) -> float:
    """Value that half of the weight is below: most of a part is near it, and should not lie on both sides of a step."""
    order = np.argsort(values, kind="stable")
    passed = np.cumsum(weight[order])
    return float(values[order][np.searchsorted(passed, 0.5 * passed[-1])])


def _write(file: TextIO, deck: Deck, quadratic: bool) -> None:
    nodes = nodes_of(deck.elements, quadratic)
    file.writelines(f"{line}\n" for line in _head(deck, quadratic))
    file.write("*NODE, NSET=NALL\n")
    np.savetxt(
        file, np.column_stack([np.arange(1, len(nodes.points) + 1), nodes.points]), fmt="%d, %.12g, %.12g, %.12g"
    )
    first = 1
    for faces in (nodes.quads, nodes.triangles):
        if len(faces):
            file.write(f"*ELEMENT, TYPE={_SHAPES[faces.shape[1]]}, ELSET=SHELL\n")
            rows = np.column_stack([np.arange(first, first + len(faces)), faces + 1])
            np.savetxt(file, rows, fmt="%d", delimiter=", ")
            first += len(faces)
    for name, rim in zip(("START", "END"), nodes.rims, strict=True):
        file.write(f"*NSET, NSET={name}\n")
        file.writelines(f"{line}\n" for line in listed(rim.nodes + 1))
    file.writelines(f"{line}\n" for line in _material(deck))
    if not quadratic and deck.material.strengths:
        file.writelines(f"{line}\n" for line in _strengths(deck))
    lines = deck.fixed.fixed() if quadratic else deck.sections.distributed()
    file.writelines(f"{line}\n" for line in lines)
    file.writelines(f"{line}\n" for line in step(nodes, deck.loads, deck.units, _pressed(deck, quadratic), quadratic))


def _pressed(deck: Deck, quadratic: bool) -> Floats:
    """Area (k,) of each element's inside over that which is pressed on: in CalculiX the inner face of a solid."""
    elements = deck.elements
    if not quadratic:
        return elements.pressed
    inner = elements.offset(0.5 * thicknesses(deck).sum(axis=0))
    return np.asarray(elements.pressed / np.maximum(inner, _LEAST_FACE))


def _head(deck: Deck, quadratic: bool) -> Iterator[str]:
    laid = deck.plies
    yield "*HEADING"
    yield f"meshwind: {deck.name}, wound shell"
    yield f"** lengths in {deck.units or 'mm (assumed)'}, forces in N; {len(deck.elements)} elements, {_contents(laid)}"
    yield from _about_layers(laid) if laid.wound else _about_families(laid)
    yield f"** The whole of an element is rounded, by at most {100.0 * _rounded_by(deck):.2g} %, with its layers,"
    yield "** at unchanged volume of all, as CalculiX joins elements of different thickness by rigid knots."
    yield from _about_sections(deck, quadratic)
    yield "** Node sets: START (v=0), END (v=1), NALL; element set: SHELL."


def _about_sections(deck: Deck, quadratic: bool) -> Iterator[str]:
    count = len((deck.fixed if quadratic else deck.sections).groups)
    tolerance = deck.tolerance
    if tolerance > 0.0:
        yield f"** {count} sections: angles of elements in one are within {tolerance:g} degrees, the shares that layers"
        yield f"** have of the thickness within {100.0 * SHARES:g} %; both have their mean."
    else:
        yield f"** {count} sections: each element has its own."
    if quadratic:
        yield "** Axes: 1 along the fibre, 3 along the outward normal. CalculiX has axes of layers by section alone,"
        yield "** and fixed in space: elements that face different ways share none, as they do in the deck for Abaqus."
    else:
        yield "** Axes of an element: 1 along the part, 3 along the outward normal; a layer's angle is from 1 about 3."


def _contents(laid: Plies) -> str:
    if laid.wound:
        return f"{len(laid.stacks)} layers"
    return f"families {', '.join(f'{ply.family:+d}' for ply in laid.families)}"


def _about_families(laid: Plies) -> Iterator[str]:
    yield f"** a layer of band is {laid.layer:.9g} thick and {laid.band_width:.9g} wide; an element's"
    yield "** families are as thick as their bands fill there. The inner and the outer half of the first family hold"
    yield "** the second between them: wound layers interlace, so the stack is kept free of coupling."


def _about_layers(laid: Plies) -> Iterator[str]:
    yield "** Elements lie on the middle of the laminate. Each has its layers from the inside out as thick as they are"
    yield "** there, and lacks those that are not there. The families of a helical layer share its thickness, and the"
    yield "** inner and the outer half of the first hold the second between them: wound families interlace, so each"
    yield "** layer is kept free of coupling. A hoop has one direction."
    yield f"** A bare element has {LEAST:g} of a band of the first layer, as elements need a thickness."
    for number, layer in enumerate(laid.stacks, 1):
        turned = ", ".join(f"{np.degrees(np.median(laid.families[k].angle)):+.4g}" for k in layer)
        yield f"** layer {number}: median angle {turned} degrees from the direction along the part"


def _material(deck: Deck) -> Iterator[str]:
    stiff = ", ".join(f"{value:.9g}" for value in deck.material.moduli(deck.units)[:8])
    yield from _about_material(deck.material)
    yield "** unidirectional layer: E1, E2, E3, nu12, nu13, nu23, G12, G13, G23"
    yield f"*MATERIAL, NAME={deck.material.name}"
    yield "*ELASTIC, TYPE=ENGINEERING CONSTANTS"
    yield stiff + ","
    yield f"{deck.material.moduli(deck.units)[8]:.9g}"
    yield "*DENSITY"
    yield f"{deck.material.mass(deck.units):.9g}"


def _strengths(deck: Deck) -> Iterator[str]:
    """For the criterion of Tsai and Wu of Abaqus, where strengths in compression are below 0."""
    scale = millimetres(deck.units) ** 2
    xt, xc, yt, yc, s = (scale * deck.material.strengths[name] for name in STRENGTHS)
    yield "*FAIL STRESS"
    yield ", ".join(f"{value:.9g}" for value in (xt, -xc, yt, -yc, s, deck.material.interaction))


def _about_material(material: Material) -> Iterator[str]:
    """Comments on what the material is, on its strengths, and on where its figures are from."""
    if material.words:
        yield f"** material: {material.words}"
    if material.strengths:
        known = ", ".join(f"{name} {material.strengths[name]:.9g}" for name in STRENGTHS)
        yield f"** strengths in MPa, along the fibre, across it and in shear: {known}"
    for source in dict.fromkeys(material.sources.values()):
        of = [name for name, each in material.sources.items() if each == source]
        yield from (f"** {line}" for line in wrap(f"{', '.join(of)}: {source}", _WIDE))
