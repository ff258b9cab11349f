"""A mesh fitted and wound as `wind` does it: what a redesign starts from, and the proof that it worked."""

from dataclasses import dataclass

from meshwind.chart import Chart
from meshwind.core.cast import Bools
from meshwind.editing.edit import lifted, threshold_of
from meshwind.mesh import Mesh
from meshwind.path import Paths
from meshwind.path.paths import converged_or_all
from meshwind.surface import Surface
from meshwind.workflow.clock import Clock
from meshwind.workflow.options import Options
from meshwind.workflow.part import Part, Source, fit_part
from meshwind.workflow.winding import lay


@dataclass(frozen=True)
class Proof:
    """A mesh's chart, surface and paths; threshold: a usual gap that counts as none, see `threshold_of`."""

    chart: Chart
    surface: Surface
    paths: Paths
    threshold: float
    at_most: float = 0.0

    @property
    def counted(self) -> Bools:
        """Mask (p,) of the paths whose gaps count: the converged ones, or all where none is."""
        return converged_or_all(self.paths.status)

    @property
    def gap(self) -> float:
        """Largest gap of the paths that count."""
        return float(self.paths.gap[self.counted].max())

    @property
    def bridged(self) -> float:
        """Share of those paths' particles that lie off the surface by more than counts as none, and than may stay."""
        return float(lifted(self.paths, self.at_most)[self.counted].mean())

    @property
    def windable(self) -> bool:
        """Whether no such path bridges."""
        return self.bridged == 0.0


def prove(mesh: Mesh, winding: Options, threshold: float | None, at_most: float = 0.0) -> Proof:
    """Fit and wind a mesh; threshold and at_most as in `redesign`."""
    return prove_fitted(fit_part(Source(mesh), winding, Clock()).counting(threshold), winding, at_most)


def prove_fitted(part: Part, winding: Options, at_most: float = 0.0) -> Proof:
    """Wind a part that is fitted; the number of revolutions must be given."""
    surface = part.surface
    laid = lay(surface, winding, float(winding.turns))
    return Proof(part.chart, surface, laid, threshold_of(surface), at_most)
