"""Shell decks for CalculiX and Abaqus: each element with its own layers, directions and thickness.

`shell.inp` is for CalculiX: eight-node elements (S8R, and S6 for triangles), the only ones that can have layers there.
`shell_s4r.inp` is for Abaqus: four-node elements (S4R, S3).
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.units import millimetres
from meshwind.export.elements import Elements
from meshwind.export.plies import Plies
from meshwind.results.schema import SHELL, SHELL_S4R

LEAST = 0.05
"""Least thickness of a family, in layers, also where it has no fibres."""
FORCE = 1000.0
"""Load of the step, in N."""
_STEPS = 1.15
"""Thicknesses are rounded to powers of this, as CalculiX joins elements of different thickness by rigid knots."""
_SHAPES = {3: "S3", 4: "S4R", 6: "S6", 8: "S8R"}


@dataclass(frozen=True)
class Material:
    """A transversely isotropic layer, fibres along 1: moduli in MPa (N/mm2), density in t/mm3.

    By default carbon fibre of standard modulus in epoxy, 60 % fibre by volume, with typical values of data sheets.
    """

    name: str = "CARBON_EPOXY"
    e1: float = 135000.0
    e2: float = 9000.0
    nu12: float = 0.3
    nu23: float = 0.4
    g12: float = 4800.0
    density: float = 1.6e-9

    @property
    def g23(self) -> float:
        """Shear modulus of the isotropic plane across the fibres, e2 / (2 (1 + nu23))."""
        return self.e2 / (2.0 * (1.0 + self.nu23))

    def moduli(self, units: str) -> tuple[float, ...]:
        """E1, E2, E3, nu12, nu13, nu23, G12, G13, G23; moduli in N over the unit of length squared."""
        scale = millimetres(units) ** 2
        stiff = self.e1, self.e2, self.e2
        shear = self.g12, self.g12, self.g23
        return (*(scale * e for e in stiff), self.nu12, self.nu12, self.nu23, *(scale * g for g in shear))

    def mass(self, units: str) -> float:
        """Density in N s2 over the unit of length to the fourth: consistent with newtons and that unit."""
        return self.density * millimetres(units) ** 4


@dataclass(frozen=True)
class Deck:
    """Contents of a deck: mesh, plies, material, unit of length and name of the part."""

    elements: Elements
    plies: Plies
    material: Material
    units: str = ""
    name: str = "part"


@dataclass(frozen=True)
class _Nodes:
    """Points (n, 3) and the elements' nodes, quads (q, 4 or 8) and triangles (t, 3 or 6), from 0; rims with shares.

    A rim is its nodes and the share of its load on each.
    """

    points: Floats
    quads: Ints
    triangles: Ints
    rims: tuple[tuple[Ints, Floats], tuple[Ints, Floats]]


def write_decks(folder: Path, deck: Deck) -> list[str]:
    """Write both decks into an existing folder; return what the user should know."""
    for name, quadratic in ((SHELL, True), (SHELL_S4R, False)):
        with (folder / name).open("w", encoding="ascii", errors="replace") as file:
            _write(file, deck, _nodes(deck.elements, quadratic))
    thin = int(sum((_layers(deck, k) < LEAST).sum() for k in range(len(deck.plies.families))))
    notes = [f"{SHELL}: {len(deck.elements)} elements, one layer of band {deck.plies.layer:.4g} thick"]
    if thin:
        notes.append(f"{SHELL}: {thin} plies of elements have less than {LEAST:g} of a layer and count as that")
    if not deck.units:
        notes.append(f"{SHELL}: the run names no unit, so the material is in N and mm")
    return notes


def thicknesses(deck: Deck) -> Floats:
    """Thickness (f, k) of each family on each element in the deck: rounded, and at least `LEAST` of a layer."""
    layers = np.stack([np.maximum(_layers(deck, k), LEAST) for k in range(len(deck.plies.families))])
    return np.asarray(deck.plies.layer * _STEPS ** np.round(np.log(layers) / np.log(_STEPS)))


def _layers(deck: Deck, family: int) -> Floats:
    return deck.plies.families[family].layers


def _nodes(elements: Elements, quadratic: bool) -> _Nodes:
    """Number the nodes; mid-side nodes lie on the surface."""
    edges = elements.edges
    number = len(elements.points) + np.arange(len(edges))
    rims = elements.rims
    if not quadratic:
        ends = tuple(_shares(elements, edges, rim, None) for rim in rims)
        return _Nodes(elements.points, elements.quads, elements.triangles, (ends[0], ends[1]))
    points = np.concatenate([elements.points, elements.surface.points(elements.between(edges))])
    faces = [_with_middles(faces, edges, number) for faces in (elements.quads, elements.triangles)]
    ends = tuple(_shares(elements, edges, rim, number) for rim in rims)
    return _Nodes(points, faces[0], faces[1], (ends[0], ends[1]))


def _with_middles(faces: Ints, edges: Ints, number: Ints) -> Ints:
    """Faces (m, 2 c): corners, then mid-side nodes, of faces (m, c)."""
    most = edges.max(initial=0) + 1
    sides = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2), axis=2)
    at = np.searchsorted(edges[:, 0] * most + edges[:, 1], sides[..., 0] * most + sides[..., 1])
    return np.concatenate([faces, number[at]], axis=1)


def _shares(elements: Elements, edges: Ints, rim: Ints, number: Ints | None) -> tuple[Ints, Floats]:
    """Nodes of a rim and the share of a uniform load on each: Simpson's weights if there are mid-side nodes."""
    along = np.isin(edges, rim).all(axis=1)
    mine = edges[along]
    length = np.linalg.norm(np.diff(elements.points[mine], axis=1)[:, 0], axis=1)
    length = length / length.sum()
    corner = 0.5 if number is None else 1.0 / 6.0
    nodes = mine.ravel() if number is None else np.concatenate([mine.ravel(), number[along]])
    weight = np.repeat(corner * length, 2)
    if number is not None:
        weight = np.concatenate([weight, 2.0 / 3.0 * length])
    unique, where = np.unique(nodes, return_inverse=True)
    return unique.astype(np.int64), np.bincount(where, weight).astype(np.float64)


def _write(file: TextIO, deck: Deck, nodes: _Nodes) -> None:
    file.writelines(f"{line}\n" for line in _head(deck))
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
    for name, (members, _) in zip(("START", "END"), nodes.rims, strict=True):
        file.write(f"*NSET, NSET={name}\n")
        file.writelines(f"{line}\n" for line in _listed(members + 1))
    file.writelines(f"{line}\n" for line in _material(deck))
    file.writelines(_sections(deck))
    file.writelines(f"{line}\n" for line in _step(nodes))


def _head(deck: Deck) -> Iterator[str]:
    names = ", ".join(f"{ply.family:+d}" for ply in deck.plies.families)
    unit = deck.units or "mm (assumed)"
    yield "*HEADING"
    yield f"meshwind: {deck.name}, wound shell"
    yield f"** lengths in {unit}, forces in N; {len(deck.elements)} elements, families {names}"
    yield f"** a layer of band is {deck.plies.layer:.9g} thick and {deck.plies.band_width:.9g} wide; an element's"
    yield "** families are as thick as their bands fill there. The inner and the outer half of the first family hold"
    yield "** the second between them: wound layers interlace, so the stack is kept free of coupling."
    yield "** Each element has its own orientation: 1 along the fibre, 3 along the outward normal."
    yield "** Node sets: START (v=0), END (v=1), NALL; element set: SHELL."


def _material(deck: Deck) -> Iterator[str]:
    stiff = ", ".join(f"{value:.9g}" for value in deck.material.moduli(deck.units)[:8])
    yield "** unidirectional layer: E1, E2, E3, nu12, nu13, nu23, G12, G13, G23"
    yield f"*MATERIAL, NAME={deck.material.name}"
    yield "*ELASTIC, TYPE=ENGINEERING CONSTANTS"
    yield stiff + ","
    yield f"{deck.material.moduli(deck.units)[8]:.9g}"
    yield "*DENSITY"
    yield f"{deck.material.mass(deck.units):.9g}"


def _sections(deck: Deck) -> Iterator[str]:
    """Set, orientations and layers of each element."""
    thick = thicknesses(deck)
    families = deck.plies.families
    across = [np.cross(deck.plies.normal, ply.direction) for ply in families]
    for k in range(len(deck.elements)):
        e = k + 1
        for ply, side in zip(families, across, strict=True):
            a, b = ply.direction[k], side[k]
            yield (
                f"*ORIENTATION, NAME={_axes(ply.family, e)}, SYSTEM=RECTANGULAR\n"
                f"{a[0]:.9g}, {a[1]:.9g}, {a[2]:.9g}, {b[0]:.9g}, {b[1]:.9g}, {b[2]:.9g}\n3, 0.\n"
            )
        yield f"*ELSET, ELSET=E{e}\n{e},\n*SHELL SECTION, ELSET=E{e}, COMPOSITE\n"
        for which, share in _stack(len(families)):
            name = _axes(families[which].family, e)
            yield f"{share * thick[which, k]:.9g}, 3, {deck.material.name}, {name}\n"


def _stack(families: int) -> tuple[tuple[int, float], ...]:
    """Layers from the inside out: number of the family and share of its thickness."""
    return ((0, 0.5), (1, 1.0), (0, 0.5)) if families > 1 else ((0, 1.0),)


def _axes(family: int, element: int) -> str:
    return f"{'P' if family > 0 else 'M'}{element}"


def _step(nodes: _Nodes) -> Iterator[str]:
    """Load step: start rim fixed, end rim pulled along the line between the centres of the rims."""
    (start, _), (end, shares) = nodes.rims
    axis = nodes.points[end].mean(axis=0) - nodes.points[start].mean(axis=0)
    axis = axis / np.linalg.norm(axis)
    yield f"** load to begin with, replace it by your own: START held, END pulled by {FORCE:g} N in all"
    yield "*STEP"
    yield "*STATIC"
    yield "*BOUNDARY"
    yield "START, 1, 6"
    yield "*CLOAD"
    for node, share in zip(end + 1, shares, strict=True):
        for direction, part in enumerate(axis, start=1):
            if abs(part) > 1e-12:
                yield f"{node}, {direction}, {FORCE * share * part:.9g}"
    yield "*NODE PRINT, NSET=END"
    yield "U"
    yield "*NODE FILE"
    yield "U"
    yield "*EL FILE"
    yield "S"
    yield "*END STEP"


def _listed(numbers: Iterable[int]) -> Iterator[str]:
    """Numbers in lines of at most twelve."""
    each = [str(number) for number in numbers]
    for first in range(0, len(each), 12):
        yield ", ".join(each[first : first + 12]) + ","
