"""How well shaped the quads are: scaled Jacobian, aspect and planarity."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Bools, Floats, frozen
from meshwind.layup.quads import QuadMesh


@dataclass(frozen=True)
class QuadQuality:
    """Figures of q quads.

    jacobian (q,): the scaled Jacobian, the smallest sine of a corner by the quad's own normal: 1 for a rectangle, 0 or
    less where it is not convex; aspect (q,): longest over shortest side; warp (q,): distance between the diagonals over
    the mean side, 0 for a plane quad; inner (q,): no side on a rim; convex (q,).
    """

    jacobian: Floats
    aspect: Floats
    warp: Floats
    inner: Bools
    convex: Bools

    @property
    def convex_share(self) -> float:
        """Share of the inner quads that are convex; 1 where there is none."""
        return float(self.convex[self.inner].mean()) if self.inner.any() else 1.0


def quad_quality(mesh: QuadMesh) -> QuadQuality:
    """Measure every quad of a mesh."""
    corners = mesh.points[mesh.quads]
    ahead = np.roll(corners, -1, axis=1) - corners
    behind = np.roll(corners, 1, axis=1) - corners
    side = np.linalg.norm(ahead, axis=2)
    diagonals = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    normal = np.cross(*diagonals)
    size = np.linalg.norm(normal, axis=1)
    unit = np.divide(normal, size[:, None], out=np.zeros_like(normal), where=size[:, None] > 0.0)
    sine = (np.cross(ahead, behind) * unit[:, None]).sum(axis=2)
    sine /= np.maximum(side * np.roll(side, 1, axis=1), 1e-300)
    jacobian = sine.min(axis=1, initial=1.0)
    aspect = side.max(axis=1, initial=0.0) / np.maximum(side.min(axis=1, initial=np.inf), 1e-300)
    warp = np.abs(((corners[:, 1] - corners[:, 0]) * unit).sum(axis=1)) / np.maximum(side.mean(axis=1), 1e-300)
    on_rim = np.isin(mesh.uv[:, 1], (0.0, 1.0))[mesh.quads]
    inner = ~(on_rim & np.roll(on_rim, 1, axis=1)).any(axis=1)
    return QuadQuality(*map(frozen, (jacobian, aspect, warp, inner, jacobian > 0.0)))
