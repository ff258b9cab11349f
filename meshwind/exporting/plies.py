"""Direction and thickness of the fibres on each element: layer by layer, and in each layer family by family.

A run without layers is a laminate of one helical layer, with thickness from its coverage.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, frozen
from meshwind.core.checks import is_number, text
from meshwind.core.errors import BadInputError
from meshwind.exporting.elements import Elements
from meshwind.layup.coverage import coverage
from meshwind.layup.direction import directions, fibres_of
from meshwind.path.paths import Paths
from meshwind.path.winding_angle import axes
from meshwind.results.reading import Results
from meshwind.results.wound_layers import WoundLayer, WoundLayers
from meshwind.surface.surface import Surface

LAYER = 1e-3
"""Thickness of one layer of band, over the part's diagonal, where the run has none."""


@dataclass(frozen=True)
class Ply:
    """One family of a layer on k elements.

    Unit tangent of the fibres (k, 3), their angle (k,), layers of band (k,) and thickness (k,).  The angle is in
    radians from the direction along the part, square to the level line of v, and positive towards s_u; thickness is
    layers times that of one layer of band.  layer: number of the layer, from 1.
    """

    family: int
    direction: Floats
    angle: Floats
    layers: Floats
    thickness: Floats
    layer: int = 1


@dataclass(frozen=True)
class Plies:
    """The families on k elements, layer by layer from the inside out, +1 first; normal (k, 3) outward.

    layer, band_width: thickness of one layer of band and width of the band, in mesh units, of the first layer;
    wound: whether the run has layers.
    """

    families: tuple[Ply, ...]
    normal: Floats
    layer: float
    band_width: float
    wound: bool = False

    @property
    def thickness(self) -> Floats:
        """Total thickness (k,) of all families."""
        return np.asarray(sum(ply.thickness for ply in self.families))

    @property
    def stacks(self) -> tuple[tuple[int, ...], ...]:
        """Numbers of the families of each layer, from the inside out."""
        last = self.families[-1].layer
        return tuple(
            tuple(k for k, ply in enumerate(self.families) if ply.layer == number) for number in range(1, last + 1)
        )


def laid_on(results: Results) -> Surface:
    """The surface that elements lie on: the middle of a laminate, otherwise the fitted surface itself."""
    wound = results.wound_layers
    return results.surface if wound is None else wound.middle


def plies(results: Results, elements: Elements, layer: float | None = None, width: float | None = None) -> Plies:
    """Plies of the layers of a run, or of its converged paths as bands of `width` and of the thickness `layer`.

    Both are in mesh units.  By default a layer is as thick as the run's band, or 1e-3 of the part's diagonal where that
    is not known, and the band is that of the run's coverage; layers of a laminate have their own.  Raises BadInputError
    if either is not a length above 0, or is given for a laminate.

    In a laminate an element is as thick as the volume of each layer over it makes it, so that no volume is lost
    between the surfaces that the layers lie on and that of the elements.
    """
    normal = frozen(axes(elements.surface, elements.centre)[2])
    wound = results.wound_layers
    if wound is not None:
        return _of_laminate(wound, elements, normal, layer, width)
    by_default = results.band_thickness or LAYER * results.diagonal
    thick = _length("thickness", by_default if layer is None else layer)
    wide = _length("band width", results.band_width if width is None else width)

    def layers(paths: Paths) -> Floats:
        return coverage(paths, wide).at(elements.centre)  # its cells are a pitch wide, no finer than elements

    families = _families(results.paths, elements, layers, thick, 1)
    return Plies(families, normal, thick, wide)


def _of_laminate(
    wound: WoundLayers, elements: Elements, normal: Floats, layer: float | None, width: float | None
) -> Plies:
    for name, value in (("thickness", layer), ("band width", width)):
        if value is not None:
            raise BadInputError(f"{name} is {value}, but the layers of this run have their own; leave it out")
    area = elements.samples()[1].sum(axis=1)
    families: list[Ply] = []
    for number, each in enumerate(wound.layers, 1):
        at, below = elements.samples(each.paths.surface)
        volume = (each.thickness(at.reshape(-1, 2)).reshape(below.shape) * below).sum(axis=1)
        families += _of_layer(each, elements, volume / area, number)
    first = wound.layers[0].figures
    return Plies(tuple(families), normal, first["band_thickness"], first["band_width"], True)


def _of_layer(each: WoundLayer, elements: Elements, thickness: Floats, number: int) -> tuple[Ply, ...]:
    """The families of a layer, which share its thickness (k,) evenly."""
    band = _length("thickness of a band", each.figures["band_thickness"])
    share = thickness / band / len(np.unique(each.paths.family))
    return _families(each.paths, elements, lambda _: share, band, number)


def _families(
    paths: Paths, elements: Elements, layers: Callable[[Paths], Floats], band: float, number: int
) -> tuple[Ply, ...]:
    """The families of a layer; layers (k,): how many of band the fibres of one make."""
    along, across, _ = axes(elements.surface, elements.centre)
    found = []
    for family in (1, -1):
        if not (paths.family == family).any():
            continue
        mine = fibres_of(paths, family)
        angle = directions(mine, elements.centre)[1]
        direction = np.cos(angle)[:, None] * along + np.sin(angle)[:, None] * across
        many = layers(mine)
        found.append(Ply(family, frozen(direction), frozen(angle), frozen(many), frozen(band * many), number))
    return tuple(found)


def _length(name: str, value: float | None) -> float:
    if value is None or not (is_number(value) and value > 0.0):
        raise BadInputError(f"{name} is {text(value)}; give a length above 0 in the mesh's units")
    return float(value)
