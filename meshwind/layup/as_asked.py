"""The winding as it was asked for: paths on their straight starting curves, before they slip, slide or bridge."""

from dataclasses import replace

import numpy as np

from meshwind.core.cast import frozen
from meshwind.path.paths import Paths
from meshwind.path.solve import straight


def as_asked(paths: Paths) -> Paths:
    """The same paths, straight in (u, v) from end to end (6.2) and on the surface; statuses stay what they are."""
    p, n = paths.gap.shape
    uv = straight(paths.uv[:, 0], paths.uv[:, -1], n)
    frames = paths.surface.frames(uv.reshape(-1, 2))
    normal = np.cross(frames[:, 1], frames[:, 2])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    return replace(
        paths,
        points=frozen(frames[:, 0].reshape(p, n, 3)),
        uv=frozen(uv),
        on_surface=frozen(np.ones((p, n), dtype=bool)),
        gap=frozen(np.zeros((p, n))),
        normal=frozen(normal.reshape(p, n, 3)),
        slip=frozen(np.full((p, n), np.nan)),
    )
