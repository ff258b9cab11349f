"""What a batch of paths amounts to: crossings, coverage and the quad mesh."""

from dataclasses import dataclass
from functools import cached_property

from meshwind.core.cast import Bools, Ints
from meshwind.core.errors import BadInputError
from meshwind.layup.as_asked import as_asked
from meshwind.layup.bands import Bands, bands
from meshwind.layup.cell_sides import CellSides, cell_sides
from meshwind.layup.coverage import Coverage, coverage
from meshwind.layup.crossings import Crossings, crossings, own_crossings
from meshwind.layup.quad_quality import QuadQuality, quad_quality
from meshwind.layup.quads import QuadMesh, quads
from meshwind.layup.windability import Windability, windability
from meshwind.path.neighbours import Neighbours, neighbours
from meshwind.path.paths import Paths, Status

_FEWEST = 3
"""Paths of each family below which no mesh can close around the part."""


@dataclass(frozen=True)
class Layup:
    """Paths with their crossings, the quad mesh on them and the coverage of the surface.

    crossed: the paths that crossings and quads are of; where too few come to rest for a mesh they are the windings as
    asked for.  What else can be told of them is worked out when it is first asked for.
    """

    paths: Paths
    crossings: Crossings
    quads: QuadMesh
    coverage: Coverage
    crossed: Paths

    @property
    def as_asked(self) -> bool:
        """Whether crossings and quads are of windings that do not hold, as they were asked for."""
        return self.crossed is not self.paths

    @cached_property
    def bands(self) -> Bands:
        """Bands of the coverage's width laid on the surface."""
        return bands(self.paths, self.coverage.width)

    @cached_property
    def neighbours(self) -> Neighbours:
        """How far neighbours of a family lie apart."""
        return neighbours(self.paths)

    @cached_property
    def sides(self) -> CellSides:
        """Lengths of fibre between crossings."""
        return cell_sides(self.crossed, self.crossings)

    @cached_property
    def own_crossings(self) -> Ints:
        """Pairs (k, 2) of paths of one family that cross."""
        return own_crossings(self.crossed, self.crossings.compared)

    @cached_property
    def quality(self) -> QuadQuality:
        """How well shaped the quads are."""
        return quad_quality(self.quads)

    @cached_property
    def windability(self) -> Windability:
        """Where and in which directions a fibre presses on the surface."""
        return windability(self.paths.surface)


def assess(paths: Paths, width: float | None = None) -> Layup:
    """Cross, mesh and cover: `width` of the band in mesh units, by default one layer a family on average.

    Crossings and quads are those of the converged paths, or of all where a family has fewer than three such; and where
    these give no mesh, because paths have slid off, of the windings as asked for.
    """
    if not isinstance(paths, Paths):
        raise BadInputError(f"assess takes Paths, not {type(paths).__name__}; make them with solve(...)")
    cover = coverage(paths, width)
    met = crossings(paths, _worth_crossing(paths))
    mesh = quads(paths, met)
    if not len(mesh.quads) and (paths.status != Status.CONVERGED).any():
        asked = as_asked(paths)
        planned = crossings(asked)
        if len((drawn := quads(asked, planned)).quads):
            return Layup(paths, planned, drawn, cover, asked)
    return Layup(paths, met, mesh, cover, paths)


def _worth_crossing(paths: Paths) -> Bools | None:
    taut: Bools = paths.status == Status.CONVERGED
    enough = all((taut & (paths.family == family)).sum() >= _FEWEST for family in (1, -1))
    return taut if enough else None
