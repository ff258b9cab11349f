"""Hollows under a marched fibre: whether they are real, or no deeper than the surface is certain."""

import numpy as np

from meshwind.core.cast import Bools, Floats
from meshwind.filament.polar_rows import Stretch
from meshwind.surface.surface import Surface

_SLACK = 1e-9
"""Depth over the part's size that is round-off of a straight fibre."""


def hollows(surface: Surface, stretch: Stretch) -> Bools:
    """Which fibres (p,) that keep to the surface would leave it: over a hollow deeper than the surface's threshold."""
    rows = stretch.rows
    found = np.zeros(len(rows.slip), dtype=np.bool_)
    lifting = np.minimum.reduceat(rows.bend[:, 2], rows.first[:-1]) < 0.0
    for fibre in np.flatnonzero(lifting):  # hollows are few
        mine = slice(rows.first[fibre], rows.first[fibre + 1])
        found[fibre] = _hollow(surface, stretch.half.out_of(rows.at[mine, 1:3]), rows.at[mine, 0], rows.bend[mine, 2])
    return found


def _hollow(surface: Surface, uv: Floats, s: Floats, bent: Floats) -> bool:
    lifting: Bools = bent < 0.0
    edges = np.flatnonzero(np.diff(np.concatenate([[False], lifting, [False]]).astype(np.int8)))
    certain = surface.threshold_at(np.ascontiguousarray(uv))
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        mine = slice(max(first - 1, 0), last + 1)
        if _depth(s[mine], bent[mine]) > certain[mine].max() + _SLACK * surface.size:
            return True
    return False


def _depth(s: Floats, bent: Floats) -> float:
    """Depth half-way below the chord over a hollow of normal curvature (m,), negative, at lengths s (m,)."""
    lever = 0.5 * np.minimum(s - s[0], s[-1] - s)
    return float(np.trapezoid(lever * np.maximum(-bent, 0.0), s))
