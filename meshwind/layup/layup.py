"""What a batch of paths amounts to: crossings, coverage and the quad mesh."""

from dataclasses import dataclass

from meshwind.cast import Bools
from meshwind.errors import BadInputError
from meshwind.layup.coverage import Coverage, coverage
from meshwind.layup.crossings import Crossings, crossings
from meshwind.layup.quads import QuadMesh, quads
from meshwind.path.paths import Paths, Status

_FEWEST = 3
"""Paths of each family below which no mesh can close around the part."""


@dataclass(frozen=True)
class Layup:
    """Paths with their crossings, the quad mesh on them and the coverage of the surface."""

    paths: Paths
    crossings: Crossings
    quads: QuadMesh
    coverage: Coverage


def assess(paths: Paths, width: float | None = None) -> Layup:
    """Cross, mesh and cover: `width` of the band in mesh units, by default one layer a family on average.

    Crossings and quads are those of the converged paths, or of all where a family has fewer than three such.
    """
    if not isinstance(paths, Paths):
        raise BadInputError(f"assess takes Paths, not {type(paths).__name__}; make them with solve(...)")
    met = crossings(paths, _worth_crossing(paths))
    return Layup(paths, met, quads(paths, met), coverage(paths, width))


def _worth_crossing(paths: Paths) -> Bools | None:
    taut: Bools = paths.status == Status.CONVERGED
    enough = all((taut & (paths.family == family)).sum() >= _FEWEST for family in (1, -1))
    return taut if enough else None
