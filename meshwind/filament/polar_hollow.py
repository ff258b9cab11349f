"""Hollows under a marched fibre: whether they are real, or no deeper than the surface is certain."""

import numpy as np

from meshwind.core.cast import Bools, Floats
from meshwind.filament.polar_rows import Stretch
from meshwind.surface.surface import Surface

_SLACK = 1e-9
"""Depth over the part's size that is round-off of a straight fibre."""


def hollow(surface: Surface, fibre: list[Stretch]) -> bool:
    """Whether a fibre that keeps to the surface would leave it: over a hollow deeper than the surface's threshold."""
    return any(_hollow(surface, stretch) for stretch in fibre)


def _hollow(surface: Surface, stretch: Stretch) -> bool:
    bent = stretch.trace.normal_curvature
    lifting: Bools = bent < 0.0
    if not lifting.any():
        return False
    edges = np.flatnonzero(np.diff(np.concatenate([[False], lifting, [False]]).astype(np.int8)))
    s = stretch.trace.arc_length
    certain = surface.threshold_at(np.ascontiguousarray(stretch.half.out_of(stretch.trace.uv)))
    for first, last in zip(edges[::2], edges[1::2], strict=True):  # hollows are few
        mine = slice(max(first - 1, 0), last + 1)
        if _depth(s[mine], bent[mine]) > certain[mine].max() + _SLACK * surface.size:
            return True
    return False


def _depth(s: Floats, bent: Floats) -> float:
    """Depth half-way below the chord over a hollow of normal curvature (m,), negative, at lengths s (m,)."""
    lever = 0.5 * np.minimum(s - s[0], s[-1] - s)
    return float(np.trapezoid(lever * np.maximum(-bent, 0.0), s))
