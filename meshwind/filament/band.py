"""The band of fibre: how thick the laminate is that it leaves, and what fibre and resin weigh."""

from dataclasses import dataclass

from meshwind.core.checks import whole
from meshwind.core.errors import BadInputError

_DENSEST = 25.0
"""In g/cm3: osmium has 22.6, so that more is a density in kg/m3."""


@dataclass(frozen=True)
class Roving:
    """What a band is made of.

    Parameters
    ----------
    tex : float
        Mass of one tow in grams per kilometre.
    tows : int, default 1
        Tows side by side in the band.
    fibre_density : float, default 1.8
        Density of the fibre in g/cm3: 1.8 for carbon, 2.6 for E-glass.
    resin_density : float, default 1.2
        Density of the resin in g/cm3.
    fibre_volume : float, default 0.6
        Share of the fibre in the laminate's volume, above 0 and up to 1.

    Raises
    ------
    BadInputError
        If a number is out of range.

    Examples
    --------
    >>> from meshwind.filament.band import Roving
    >>> carbon = Roving(tex=800.0, resin_density=1.1)
    >>> round(carbon.thickness(4.0), 6), round(carbon.fibre_mass(424245.5), 2)
    (0.185185, 339.4)
    """

    tex: float
    tows: int = 1
    fibre_density: float = 1.8
    resin_density: float = 1.2
    fibre_volume: float = 0.6

    def __post_init__(self) -> None:
        for name in ("tex", "fibre_density", "resin_density"):
            value = getattr(self, name)
            if not 0.0 < value < float("inf"):
                raise BadInputError(f"{name} is {value:g}; give a number above 0")
            if name.endswith("density") and value > _DENSEST:
                raise BadInputError(
                    f"{name} is {value:g} g/cm3, more than any solid; give {value / 1000.0:g} for kg/m3"
                )
        whole(self.tows, "tows", 1)
        if not 0.0 < self.fibre_volume <= 1.0:
            raise BadInputError(f"fibre_volume is {self.fibre_volume:g}; give a share above 0 and up to 1, as in 0.6")

    @property
    def section(self) -> float:
        """Area of the laminate in a band's cross-section, in mm2."""
        return 1e-3 * self.tex * self.tows / self.fibre_density / self.fibre_volume

    @property
    def fibre_share(self) -> float:
        """Share of the fibre in the laminate's mass."""
        fibre = self.fibre_volume * self.fibre_density
        return fibre / (fibre + (1.0 - self.fibre_volume) * self.resin_density)

    def thickness(self, width: float) -> float:
        """Mean thickness, in mm, of a band of a width in mm."""
        if not width > 0.0:
            raise BadInputError(f"width is {width:g}; give the band's width in mm, above 0")
        return self.section / width

    def fibre_mass(self, length: float) -> float:
        """Mass, in g, of the fibre in so many mm of band."""
        return 1e-6 * self.tex * self.tows * length

    def resin_mass(self, length: float) -> float:
        """Mass, in g, of the resin in so many mm of band."""
        return self.fibre_mass(length) * (1.0 / self.fibre_share - 1.0)
