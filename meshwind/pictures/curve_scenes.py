"""Scenes of the pictures with curves along the part.

Importing this module loads nothing heavy, as both processes need it.
"""

from dataclasses import dataclass

from meshwind.appearance.looks import Scale
from meshwind.core.cast import Floats
from meshwind.pictures.contents import Frame, Part


@dataclass(frozen=True)
class LaminateScene:
    """The thickness of a laminate on the part, (k,) on a scale, and that of its layers along the part.

    stations (s,): lengths along the part; thickness, angles (l, s): of each layer, angles in degrees, NaN where it is
    not; names: words for each layer.
    """

    frame: Frame
    part: Part
    scale: Scale
    shares: Floats
    stations: Floats
    thickness: Floats
    angles: Floats
    names: tuple[str, ...]


@dataclass(frozen=True)
class AnglesScene:
    """Least, median and largest winding angle in degrees (s,) at stations, which are lengths (s,) along the part.

    cover (s,): layers of band of one family there, None where the band has no width.
    """

    frame: Frame
    stations: Floats
    angles: Floats
    cover: Floats | None
