"""Fibres that friction does not hold where the eye lays them: solved again from there, until they are at rest."""

import numpy as np

from meshwind.core.cast import Bools, Ints
from meshwind.path.paths import Status
from meshwind.path.solve import solve
from meshwind.program.rewinding.pull import Eyes, Relaid, Row
from meshwind.surface.surface import Surface

_PARTICLES = 401
"""Particles of a fibre that slides."""


def slide(surface: Surface, friction: float, out: Relaid, eyes: Eyes, index: Ints) -> tuple[Bools, Row]:
    """Whether some of the stretches come to rest (k,), having slid between their ends, and where they lie then."""
    share = np.linspace(0.0, 1.0, _PARTICLES)
    curves = np.empty((len(index), _PARTICLES, 2))
    for row, k in enumerate(index):
        at = slice(eyes.first[k], out.last[k] + 1)
        kept = np.isfinite(out.point[at, 0])
        laid, uv = out.laid[at][kept], out.uv[at][kept]
        for c in range(2):
            curves[row, :, c] = np.interp(laid[0] + share * (laid[-1] - laid[0]), laid, uv[:, c])
    curves[:, :, 1] = np.clip(curves[:, :, 1], 0.0, 1.0)
    paths = solve(surface, curves[:, 0], curves[:, -1], initial=curves, friction=friction, particles=_PARTICLES)
    steps = np.linalg.norm(np.diff(paths.points, axis=1), axis=2)
    along = np.concatenate([np.zeros((len(index), 1)), np.cumsum(steps, axis=1)], axis=1)
    line = Row(paths.points.reshape(-1, 3), along.ravel(), np.arange(len(index) + 1) * _PARTICLES)
    return np.asarray(paths.status == Status.CONVERGED), line
