"""Figures of a batch of paths: the same, over the same paths, in report, summary and picture."""

from dataclasses import dataclass

from meshwind.core.cast import Bools, frozen
from meshwind.path.lengths import Bridges, bridged_share, bridges, lengths, unresolved_share
from meshwind.path.paths import Paths, Status, converged_or_all


@dataclass(frozen=True)
class PathFigures:
    """Figures of the paths that converged, or of all where none did: `counted` (p,) says which.

    converged: how many did; fibre_length, length_error: the total, and what the particles may make it wrong by;
    position_error: how far a fibre may be from the polyline through its particles; bridged_share: share of the
    polylines' length off the surface; spans: the resolved bridges, whose gap is above what counts as none; unresolved:
    the others, which count as contact, and unresolved_share: their share of the length.  Lengths are in the mesh's
    units, max_slip is the required friction |kg| / kn, max_residual is over the tension.
    """

    counted: Bools
    converged: int
    fibre_length: float
    length_error: float
    position_error: float
    bridged_share: float
    spans: Bridges
    unresolved: Bridges
    unresolved_share: float
    max_gap: float
    max_slip: float
    max_residual: float

    @property
    def longest_bridge(self) -> float:
        """Length of the longest bridge, 0 without one."""
        return float(self.spans.length.max(initial=0.0))

    @property
    def over(self) -> str:
        """Which paths these are the figures of, as text."""
        return "paths at rest" if self.converged else "all paths, as none is at rest"


def path_figures(paths: Paths) -> PathFigures:
    """Measure the paths that converged, or all where none did."""
    counted, each = converged_or_all(paths.status), lengths(paths)
    spans = bridges(paths)
    spans = spans.where(counted[spans.path])
    return PathFigures(
        counted=frozen(counted),
        converged=int((paths.status == Status.CONVERGED).sum()),
        fibre_length=float(paths.length[counted].sum()),
        length_error=float(paths.length_error[counted].sum()),
        position_error=float(paths.position_error[counted].max(initial=0.0)),
        bridged_share=bridged_share((each, counted)),
        spans=spans.where(spans.resolved),
        unresolved=spans.where(~spans.resolved),
        unresolved_share=unresolved_share((each, counted)),
        max_gap=float(each.max_gap[counted].max(initial=0.0)),
        max_slip=float(each.max_slip[counted].max(initial=0.0)),
        max_residual=float(paths.residual[counted].max(initial=0.0)),
    )
