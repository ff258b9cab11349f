"""A mesh fitted and wound as `wind` does it: what a redesign starts from, and the proof that it worked."""

from dataclasses import dataclass

from meshwind.chart import Chart
from meshwind.core.brief import brief
from meshwind.core.cast import Bools
from meshwind.editing.edit import lifted, threshold_of
from meshwind.editing.windings import Course, marked_share
from meshwind.mesh import Mesh
from meshwind.path import Paths
from meshwind.path.paths import converged_or_all
from meshwind.surface import Surface
from meshwind.workflow.clock import Clock
from meshwind.workflow.options import Options
from meshwind.workflow.part import Part, Source, fit_part


@dataclass(frozen=True)
class Proof:
    """A mesh's chart, surface and the paths of each winding; threshold: a usual gap that counts as none."""

    chart: Chart
    surface: Surface
    wound: tuple[Paths, ...]
    threshold: float
    at_most: float = 0.0

    __repr__ = brief

    @property
    def paths(self) -> Paths:
        """The paths of the first winding."""
        return self.wound[0]

    @property
    def gaps(self) -> tuple[float, ...]:
        """Largest gap of the paths that count, of each winding: of the converged ones, or all where none is."""
        return tuple(float(paths.gap[converged_or_all(paths.status)].max()) for paths in self.wound)

    @property
    def shares(self) -> tuple[float, ...]:
        """Share of those paths' particles that lie off by more than counts as none, and than may stay, of each."""
        return tuple(float(mask.mean()) for mask in self._lifted)

    @property
    def gap(self) -> float:
        """Largest gap of all windings."""
        return max(self.gaps)

    @property
    def bridged(self) -> float:
        """The same share over all windings."""
        return marked_share(self._lifted)

    @property
    def _lifted(self) -> list[Bools]:
        return [lifted(paths, self.at_most)[converged_or_all(paths.status)] for paths in self.wound]

    @property
    def windable(self) -> bool:
        """Whether no such path bridges."""
        return self.bridged == 0.0


def prove(
    mesh: Mesh, winding: Options, courses: tuple[Course, ...], threshold: float | None, at_most: float = 0.0
) -> Proof:
    """Fit a mesh and wind each winding on it; threshold and at_most as in `redesign`."""
    return prove_fitted(fit_part(Source(mesh), winding, Clock()).counting(threshold), courses, at_most)


def prove_fitted(part: Part, courses: tuple[Course, ...], at_most: float = 0.0) -> Proof:
    """Wind a part that is fitted."""
    surface = part.surface
    laid = tuple(each.laid(surface) for each in courses)
    return Proof(part.chart, surface, laid, threshold_of(surface), at_most)
