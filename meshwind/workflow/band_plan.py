"""The band that is wound: its own values in a layer's table, or else those of the run."""

from typing import Any, Protocol

import numpy as np

from meshwind.appearance.words import quantity
from meshwind.core.errors import BadInputError
from meshwind.core.spoken import argument
from meshwind.core.units import millimetres
from meshwind.filament.band import Roving
from meshwind.filament.levels import levels
from meshwind.filament.plain_layer import Band
from meshwind.surface import Surface
from meshwind.workflow.notes import Note

_MATERIAL = ("tex", "tows", "fibre_density", "resin_density", "fibre_volume")


class Material(Protocol):
    """What says what a band is: the options of a run, or the table of a layer; None where a value is not given."""

    @property
    def band_width(self) -> float | None:
        """In the part's units."""

    @property
    def band_thickness(self) -> float | None:
        """In the part's units."""

    @property
    def tex(self) -> float | None:
        """Of one tow, in g/km; `Roving` has the other values of the material."""


def band_plan(run: Material, units: str, layer: Material | None = None) -> Band:
    """The band of a layer of a run, or of a run without layers, on a part in these units ("" if they are not known).

    The thickness follows from tex and width where it is not given.  Raises BadInputError where the unit is needed.
    """
    both = (run,) if layer is None else (layer, run)
    width = _first("band_width", both)
    roving = roving_of(run, layer)
    if roving is None:
        return Band(width, _first("band_thickness", both), None, units)
    if not units:
        raise BadInputError(
            f"tex is in g/km, but the part's unit is not known; give {argument('units')}, or "
            f"{argument('band_thickness')}"
        )
    scale = millimetres(units)
    return Band(width, None if width is None else roving.thickness(width * scale) / scale, roving, units)


def roving_of(run: Material, layer: Material | None = None) -> Roving | None:
    """What a band is made of, where tex is given: a layer's own values, or else the run's.

    Of tex and the band's thickness the layer's own counts before the run's other one.  Raises BadInputError where both
    are given in one place, and for values that say nothing without tex.
    """
    both = (run,) if layer is None else (layer, run)
    for place in both:
        if place.band_thickness is not None and place.tex is not None:
            raise BadInputError("tex gives the band's thickness, and so does band_thickness; give one of both")
    own = both[0]
    given: dict[str, Any] = {name: value for name in _MATERIAL if (value := _first(name, both)) is not None}
    if own.band_thickness is not None:
        given.pop("tex", None)
    if "tex" in given:
        return Roving(**given)
    idle = [name for name in _MATERIAL if getattr(own, name) is not None]
    if idle:
        raise BadInputError(f"{idle[0]} says nothing without tex; give tex as well, or leave it out")
    return None


def about_band(band: Band, surface: Surface) -> tuple[Note, ...]:
    """Notes on a band wider than the part is across, and on the thickness that follows from tex and width."""
    if band.width is None:
        return _about_thickness(band)
    across = float(levels(surface).length.max()) / np.pi  # that of a round part as wide
    wide = (_too_wide(band.width, across, band.units),) if band.width > across else ()
    return (*wide, *_about_thickness(band))


def _too_wide(width: float, across: float, units: str) -> Note:
    return Note(
        f"the band is {quantity(width, units, 3)} wide, and the part at most {quantity(across, units, 3)} across: its "
        f"width, and with it cover and thickness, mean little; give {argument('band_width')} in the part's unit",
        warning=True,
    )


def _about_thickness(band: Band) -> tuple[Note, ...]:
    if band.roving is None:
        return ()
    if band.width is None or band.thickness is None:
        return (
            Note(
                f"the band's thickness follows from tex and its width, which is not known; give "
                f"{argument('band_width')}"
            ),
        )
    roving, tows = band.roving, "1 tow" if band.roving.tows == 1 else f"{band.roving.tows} tows"
    thick, wide = quantity(band.thickness, band.units, 3), quantity(band.width, band.units, 3)
    share = f"{100.0 * roving.fibre_volume:g} % of it fibre"
    return (Note(f"the band is {thick} thick: {tows} of {roving.tex:g} tex, {share}, on {wide}"),)


def check_band(run: Material) -> None:
    """Raise BadInputError where the values of a run without layers do not belong together."""
    roving_of(run)
    if run.band_thickness is not None and run.band_width is None:
        raise BadInputError(f"band_thickness needs the band's width; give {argument('band_width')} as well")


def _first(name: str, places: tuple[Material, ...]) -> float | None:
    """The value in the first of the places that has one."""
    return next((value for place in places if (value := getattr(place, name)) is not None), None)
