"""What a program winds: filaments on a part."""

from dataclasses import dataclass
from functools import cached_property

from meshwind.core.brief import brief
from meshwind.core.errors import BadInputError
from meshwind.core.spoken import called
from meshwind.core.units import millimetres
from meshwind.filament.filament import Filament
from meshwind.program.clear import Obstacle, Shaft, obstacle
from meshwind.program.mandrel import Mandrel
from meshwind.results.reading import Results
from meshwind.surface.grid import Grid, grid
from meshwind.surface.surface import Surface


@dataclass(frozen=True)
class Work:
    """What is to be wound.

    Attributes
    ----------
    filaments : tuple of Filament
        The filaments, in order of winding.
    surface : Surface
        The bare part.
    diagonal : float
        Diagonal of the part.
    units, name : str
        Unit of length, "" where it is not known, and the part's name.
    """

    filaments: tuple[Filament, ...]
    surface: Surface
    diagonal: float
    units: str = ""
    name: str = ""

    __repr__ = brief

    @staticmethod
    def of(results: Results) -> "Work":
        """What a run's folder has to be wound; raises BadInputError if it holds no filament."""
        if not results.filaments:
            raise BadInputError(
                f"{results.folder} holds no filament; wind it with {called('wind', 'MESH', continuous=True)}"
            )
        return Work(results.filaments, results.surface, results.diagonal, results.units, results.name)

    @cached_property
    def skin(self) -> Grid:
        """The bare part on a grid."""
        return grid(self.surface)

    @cached_property
    def bare(self) -> Obstacle:
        """The part as spans may not meet it, without a shaft."""
        return obstacle(self.skin, self.diagonal)

    def blocked(self, mandrel: Mandrel, shaft: Shaft) -> Obstacle:
        """The same with a shaft on the axis."""
        return obstacle(self.skin, self.diagonal, (mandrel, shaft)) if shaft.radius > 0.0 else self.bare

    @property
    def scale(self) -> float:
        """Millimetres in the unit of length."""
        return millimetres(self.units)

    @property
    def layers(self) -> int:
        """Number of layers."""
        return 1 + max(int(each.layer.max()) for each in self.filaments)

    @property
    def turnable(self) -> bool:
        """Whether each filament may be wound from its end: none holds several layers, of which one lies on another."""
        return all(int(each.layer.min()) == int(each.layer.max()) for each in self.filaments)
