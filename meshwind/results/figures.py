"""What a batch of paths comes to, over one and the same set of paths in report, summary and picture."""

from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.cast import Bools, frozen
from meshwind.path.lengths import Bridges, bridges, lengths
from meshwind.path.paths import Paths, Status


@dataclass(frozen=True)
class PathFigures:
    """Figures of the paths at rest, or of all where none is: `told` (p,) says which.

    length is their total, bridged_fraction the share of it off the surface, spans their bridges; lengths in the
    mesh's units, max_slip as |kg| / kn, max_residual over the tension.
    """

    told: Bools
    at_rest: int
    length: float
    bridged_fraction: float
    spans: Bridges
    max_gap: float
    max_slip: float
    max_residual: float

    @property
    def longest_bridge(self) -> float:
        """Length of the longest bridge, 0 without one."""
        return float(self.spans.length.max(initial=0.0))

    @property
    def over(self) -> str:
        """In words, which paths these are the figures of."""
        return "paths at rest" if self.at_rest else "all paths, as none is at rest"


def path_figures(paths: Paths) -> PathFigures:
    """Measure the paths that came to rest, or all where none did."""
    taut = paths.status == Status.CONVERGED
    told: Bools = taut if taut.any() else np.ones(len(paths), dtype=bool)
    each = lengths(paths)
    total, bridged = float(each.length[told].sum()), float(each.bridged[told].sum())
    return PathFigures(
        told=frozen(told),
        at_rest=int(taut.sum()),
        length=float(paths.length[told].sum()),
        bridged_fraction=bridged / total if total > 0.0 else 0.0,
        spans=_of(told, bridges(paths)),
        max_gap=float(each.max_gap[told].max(initial=0.0)),
        max_slip=float(each.max_slip[told].max(initial=0.0)),
        max_residual=float(paths.residual[told].max(initial=0.0)),
    )


def _of(told: Bools, spans: Bridges) -> Bridges:
    """Those bridges that are of the told paths."""
    mine = told[spans.path]
    names = "path", "first", "last", "length", "max_gap"
    return replace(spans, **{name: frozen(getattr(spans, name)[mine]) for name in names})
