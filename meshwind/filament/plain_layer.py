"""The layer of a run without a laminate: what it is along the part and over it."""

from dataclasses import dataclass, field

from meshwind.core.brief import brief
from meshwind.core.units import millimetres
from meshwind.filament.band import Roving
from meshwind.filament.levels import levels
from meshwind.filament.stations import Stations, helix_stations
from meshwind.filament.thickness import Laying, Thickness, deposit, tracks
from meshwind.path.paths import Paths, converged_or_all


@dataclass(frozen=True)
class Band:
    """A band: width and mean thickness in the part's units, and what it is made of; None where that is not known.

    units: those of the part, "" if they are not known.
    """

    width: float | None = None
    thickness: float | None = None
    roving: Roving | None = None
    units: str = ""

    def masses(self, length: float) -> tuple[float | None, float | None]:
        """Masses of fibre and resin, in g, in so much band, in the part's units; None where tex is not known."""
        if self.roving is None:
            return None, None
        long = length * millimetres(self.units)
        return self.roving.fibre_mass(long), self.roving.resin_mass(long)


@dataclass(frozen=True)
class PlainLayer:
    """The layer of a run without a laminate.

    Attributes
    ----------
    band : Band
        Its band.
    stations : Stations or None
        Its angle and cover along the part, or None on a part that is open in u.
    thickness : Thickness or None
        Its thickness over the part, turnarounds left out; None where that of the band is not known.
    """

    band: Band = field(default_factory=Band)
    stations: Stations | None = None
    thickness: Thickness | None = None

    __repr__ = brief


def plain_layer(paths: Paths, band: Band, width: float) -> PlainLayer:
    """The layer of the paths at rest, or of all where none is; width: of the band for the cover."""
    if not paths.surface.periodic:
        return PlainLayer(band)
    laid = paths.subset(converged_or_all(paths.status))
    stations = helix_stations(laid, levels(paths.surface), width)
    if band.width is None or band.thickness is None:
        return PlainLayer(band, stations)
    return PlainLayer(band, stations, deposit(paths.surface, tracks(laid), Laying(band.width, band.thickness)))
