"""Direction and thickness of each family's fibres on each element."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.export.elements import Elements
from meshwind.layup.coverage import coverage
from meshwind.layup.direction import directions, fibres_of
from meshwind.path.winding_angle import axes
from meshwind.results.reading import Results

LAYER = 1e-3
"""Default thickness of one layer of band, over the part's diagonal."""


@dataclass(frozen=True)
class Ply:
    """One family on k elements: unit tangent of the fibres (k, 3), their angle (k,), layers (k,), thickness (k,).

    The angle is in radians from the direction along the part, square to the level line of v, and positive towards s_u;
    thickness is layers times that of one layer.
    """

    family: int
    direction: Floats
    angle: Floats
    layers: Floats
    thickness: Floats


@dataclass(frozen=True)
class Plies:
    """The families on k elements, +1 first; normal (k, 3) outward; thickness of one layer and width of the band."""

    families: tuple[Ply, ...]
    normal: Floats
    layer: float
    band_width: float

    @property
    def thickness(self) -> Floats:
        """Total thickness (k,) of all families."""
        return np.asarray(sum(ply.thickness for ply in self.families))


def plies(results: Results, elements: Elements, layer: float | None = None, width: float | None = None) -> Plies:
    """Plies of the converged paths as bands of `width` and of the thickness `layer`, in mesh units.

    By default a layer is 1e-3 of the part's diagonal thick, and the band is that of the run's coverage.  Raises
    BadInputError if either is not a length above 0.
    """
    thick = _length("thickness", LAYER * results.diagonal if layer is None else layer)
    wide = _length("band width", results.band_width if width is None else width)
    present = [family for family in (1, -1) if (results.paths.family == family).any()]
    families = tuple(_ply(results, elements, family, thick, wide) for family in present)
    normal = axes(elements.surface, elements.centre)[2]
    return Plies(families, frozen(normal), thick, wide)


def _length(name: str, value: float | None) -> float:
    if value is None or not (np.isfinite(value) and value > 0.0):
        raise BadInputError(f"{name} is {value}; give a length above 0 in the mesh's units")
    return float(value)


def _ply(results: Results, elements: Elements, family: int, layer: float, width: float) -> Ply:
    paths = fibres_of(results.paths, family)
    direction, angle = directions(paths, elements.centre)
    layers = coverage(paths, width).at(elements.centre)
    return Ply(family, *map(frozen, (direction, angle, layers, layer * layers)))
