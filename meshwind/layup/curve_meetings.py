"""Where fibres cross on their own curves rather than on their chords: to the fourth order of the particles' spacing."""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.layup.meetings import Meetings
from meshwind.path.paths import Paths

_STEPS = 4
"""Newton's steps: from the chords' crossing, two bring it to round-off."""
_FURTHEST = 0.5
"""A crossing that moves by more particles than this stays where the chords cross."""


class CurveMeetings(NamedTuple):
    """Meetings of fibres on their curves: uv (k, 2) on path a, and the directions along a and b in (u, v) (k, 2).

    valid (k,): whether the curves give a crossing, that is both fibres lie on the surface there, and it is near that of
    the chords.
    """

    uv: Floats
    along_a: Floats
    along_b: Floats
    valid: Bools


class _Cubic(NamedTuple):
    """Cubics through four particles each: number of the first, uv (k, 4, 2), and whether all four touch."""

    first: Ints
    uv: Floats
    touching: Bools

    @staticmethod
    def around(paths: Paths, path: Ints, t: Floats) -> "_Cubic":
        """The cubic through the four particles around t on each path."""
        first = np.clip(t.astype(np.int64) - 1, 0, paths.uv.shape[1] - 4)
        four = first[:, None] + np.arange(4)
        return _Cubic(first, paths.uv[path[:, None], four], paths.on_surface[path[:, None], four].all(axis=1))

    def at(self, x: Floats) -> tuple[Floats, Floats]:
        """Value and slope (k, 2) at x; the four particles are at 0, 1, 2 and 3."""
        a, b, c, d = x, x - 1.0, x - 2.0, x - 3.0
        weight = np.stack([-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0], axis=1)
        slope = np.stack(
            [-(c * d + b * d + b * c) / 6.0, (c * d + a * d + a * c) / 2.0, -(b * d + a * d + a * b) / 2.0,
             (b * c + a * c + a * b) / 6.0], axis=1,
        )  # fmt: skip
        return np.einsum("kj,kjd->kd", weight, self.uv), np.einsum("kj,kjd->kd", slope, self.uv)


def curve_meetings(paths: Paths, met: Meetings) -> CurveMeetings:
    """Cross cubics through four particles of each path, from where the paths' chords cross."""
    if paths.uv.shape[1] < 4:
        nothing = np.zeros((len(met.a), 2))
        return CurveMeetings(nothing, nothing, nothing, np.zeros(len(met.a), dtype=bool))
    first, second = _Cubic.around(paths, met.a, met.t_a), _Cubic.around(paths, met.b, met.t_b)
    x, y = met.t_a - first.first, met.t_b - second.first
    start_x, start_y = x.copy(), y.copy()
    p, dp = first.at(x)
    q, dq = second.at(y)
    turn = np.round((p - q)[:, 0])
    for _ in range(_STEPS):
        off = p - q
        off[:, 0] -= turn
        det = dp[:, 1] * dq[:, 0] - dp[:, 0] * dq[:, 1]
        safe = np.where(det == 0.0, np.inf, det)
        x = x + (off[:, 0] * dq[:, 1] - off[:, 1] * dq[:, 0]) / safe
        y = y + (off[:, 0] * dp[:, 1] - off[:, 1] * dp[:, 0]) / safe
        p, dp = first.at(np.clip(x, -1.0, 4.0))
        q, dq = second.at(np.clip(y, -1.0, 4.0))
    near = (np.abs(x - start_x) < _FURTHEST) & (np.abs(y - start_y) < _FURTHEST)
    return CurveMeetings(p, dp, dq, first.touching & second.touching & near)
