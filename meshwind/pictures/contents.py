"""Contents that all scenes have: title and view, and the part."""

from dataclasses import dataclass

from meshwind.appearance.view import View
from meshwind.core.cast import Floats, Ints


@dataclass(frozen=True)
class Frame:
    """Title and subtitle, name of the unit of length, and view, which every picture has."""

    title: str
    subtitle: str
    units: str
    view: View


@dataclass(frozen=True)
class Part:
    """The surface: outward quads (q, 4) between points (k, 3) with normals (k, 3) of any length.

    pitch: mean distance from fibre to fibre of a family on it, in mesh units.
    """

    points: Floats
    quads: Ints
    normals: Floats
    pitch: float
