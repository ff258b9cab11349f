"""Lengths of fibre between neighbouring crossings (Fig. 6.3)."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.layup.crossings import Crossings
from meshwind.path.lengths import lengths
from meshwind.path.paths import Paths


@dataclass(frozen=True)
class CellSides:
    """Lengths of fibre from one crossing to the next, d1 (a,) along family +1 and d2 (b,) along family -1."""

    d1: Floats
    d2: Floats


def cell_sides(paths: Paths, crossings: Crossings) -> CellSides:
    """Measure between neighbouring crossings, along the fibres."""
    arc = lengths(paths).arc_length
    either = ((crossings.path_a, crossings.t_a), (crossings.path_b, crossings.t_b))
    return CellSides(*(frozen(_steps(arc, path, t)) for path, t in either))


def _steps(arc: Floats, path: Ints, t: Floats) -> Floats:
    order = np.lexsort((t, path))
    path, t = path[order], t[order]
    k = np.minimum(t.astype(np.int64), arc.shape[1] - 2)
    at = arc[path, k] + (t - k) * (arc[path, k + 1] - arc[path, k])
    return np.asarray(np.diff(at)[np.diff(path) == 0])
