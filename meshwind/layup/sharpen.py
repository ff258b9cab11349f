"""Crossings on the fibres' own curves rather than on their chords: to the fourth order of the particles' spacing."""

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.path.paths import Paths

_STEPS = 4
"""Newton's steps: from the chords' crossing, two bring it to rounding."""
_FURTHEST = 0.5
"""A crossing that moves by more particles than this stays where the chords cross."""


def sharpened(paths: Paths, a: Ints, b: Ints, t_a: Floats, t_b: Floats) -> tuple[Floats, Floats, Floats, Bools]:
    """Cross cubics through four particles of each path at once.

    a, b (k,) paths and t_a, t_b (k,) where their chords cross, as fractional particles.  Returns uv (k, 2) on path a,
    the directions along a and b in (u, v) (k, 2), and whether (k,) the cubics hold: both fibres lie on the surface
    there, and the crossing is near.
    """
    count = paths.uv.shape[1]
    if count < 4:
        nothing = np.zeros((len(a), 2))
        return nothing, nothing, nothing, np.zeros(len(a), dtype=bool)
    first, second = (_stencil(paths, path, t) for path, t in ((a, t_a), (b, t_b)))
    x, y = t_a - first[0], t_b - second[0]
    start = x.copy(), y.copy()
    p, dp = _cubic(first[1], x)
    q, dq = _cubic(second[1], y)
    turn = np.round((p - q)[:, 0])
    for _ in range(_STEPS):
        off = p - q
        off[:, 0] -= turn
        det = dp[:, 1] * dq[:, 0] - dp[:, 0] * dq[:, 1]
        safe = np.where(det == 0.0, np.inf, det)
        x = x + (off[:, 0] * dq[:, 1] - off[:, 1] * dq[:, 0]) / safe
        y = y + (off[:, 0] * dp[:, 1] - off[:, 1] * dp[:, 0]) / safe
        p, dp = _cubic(first[1], np.clip(x, -1.0, 4.0))
        q, dq = _cubic(second[1], np.clip(y, -1.0, 4.0))
    holds = first[2] & second[2] & (np.abs(x - start[0]) < _FURTHEST) & (np.abs(y - start[1]) < _FURTHEST)
    return p, dp, dq, holds


def _stencil(paths: Paths, path: Ints, t: Floats) -> tuple[Ints, Floats, Bools]:
    """First of the four particles around t, their uv (k, 4, 2), and whether all four touch."""
    low = np.clip(t.astype(np.int64) - 1, 0, paths.uv.shape[1] - 4)
    four = low[:, None] + np.arange(4)
    return low, paths.uv[path[:, None], four], paths.on_surface[path[:, None], four].all(axis=1)


def _cubic(values: Floats, x: Floats) -> tuple[Floats, Floats]:
    """Value and slope (k, 2) at x of the cubics through values (k, 4, 2) at 0, 1, 2, 3."""
    a, b, c, d = x, x - 1.0, x - 2.0, x - 3.0
    weight = np.stack([-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0], axis=1)
    slope = np.stack(
        [-(c * d + b * d + b * c) / 6.0, (c * d + a * d + a * c) / 2.0, -(b * d + a * d + a * b) / 2.0,
         (b * c + a * c + a * b) / 6.0], axis=1,
    )  # fmt: skip
    return np.einsum("kj,kjd->kd", weight, values), np.einsum("kj,kjd->kd", slope, values)
