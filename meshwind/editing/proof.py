"""A mesh fitted and wound as a run from its file does: the proof of a redesign, and what it starts from."""

from dataclasses import dataclass

from meshwind.chart import Chart, flatten
from meshwind.core.cast import Bools
from meshwind.editing.edit import threshold_of
from meshwind.mesh import Mesh, annulus
from meshwind.path import Paths, solve
from meshwind.path.lengths import lifted_share
from meshwind.path.paths import converged_or_all
from meshwind.planning.families import families
from meshwind.surface import Surface, fit


def fitted(mesh: Mesh, ends: str, opening: float | None, tolerance: float) -> tuple[Chart, Surface]:
    """A mesh's chart and surface."""
    chart = flatten(annulus(mesh, ends=ends, opening=opening))
    return chart, fit(chart, tolerance)


@dataclass(frozen=True)
class Winding:
    """What is wound on each mesh, and how it is opened and fitted: as in `wind`; threshold as in `redesign`."""

    revolutions: float
    paths: int
    particles: int
    threshold: float | None
    ends: str
    opening: float | None
    tolerance: float

    def fitted(self, mesh: Mesh) -> tuple[Chart, Surface]:
        """The mesh's chart and surface."""
        return fitted(mesh, self.ends, self.opening, self.tolerance)

    def wound(self, chart: Chart, surface: Surface) -> "Wound":
        """The paths on a surface."""
        rims = families(surface, self.paths, self.revolutions)
        laid = solve(surface, rims.start, rims.end, family=rims.family, particles=self.particles)
        return Wound(chart, surface, laid, threshold_of(surface, self.threshold))


@dataclass(frozen=True)
class Wound:
    """A mesh's chart, surface and paths; a gap up to the threshold is none."""

    chart: Chart
    surface: Surface
    paths: Paths
    threshold: float

    @property
    def counted(self) -> Bools:
        """The paths (p,) whose gaps count: those at rest, or all where none is."""
        return converged_or_all(self.paths.status)

    @property
    def gap(self) -> float:
        """Largest gap of the paths that count."""
        return float(self.paths.gap[self.counted].max())

    @property
    def bridged(self) -> float:
        """Share of those paths' particles whose gap is above the threshold."""
        return lifted_share(self.paths.gap[self.counted], self.threshold)

    @property
    def sound(self) -> bool:
        """Whether no such path bridges."""
        return self.gap <= self.threshold
