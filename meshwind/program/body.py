"""The convex body of revolution round part, turnarounds and shaft on which the eye moves, and where spans leave it."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, frozen
from meshwind.core.vectors import TINY

_OCTAGON = np.linspace(0.0, np.pi, 5)
"""Directions in which points are moved by the clearance: the hull of an octagon takes the place of that of a circle."""
_THIN = 1e-12
"""Extent along the axis over the size below which points are a disc."""
_PLANE = 1e-9
"""Distance along the axis over the body's length up to which corners lie in one plane."""
_SETTLED, _STEPS = 1e-13, 100
"""Distance from the body, over its size, at which a ray is said to leave it, and most Newton steps until then."""


@dataclass(frozen=True)
class Body:
    """A convex body of revolution, closed by flat ends.

    Attributes
    ----------
    x, r : ndarray of float, shape (k,)
        Corners of its outline along the axis and from it, x growing.
    """

    x: Floats
    r: Floats

    __repr__ = brief

    @property
    def radius(self) -> float:
        """Its largest radius."""
        return float(self.r.max())

    @property
    def size(self) -> float:
        """Length of the diagonal of its outline."""
        return float(np.hypot(self.x[-1] - self.x[0], self.radius))

    def spans(self, points: Floats, rays: Floats) -> Floats:
        """Lengths (n,) from points (n, 3) inside of it along unit vectors (n, 3) to where they leave it.

        Coordinates are along the axis and twice square to it.  The distance from the axis is a convex function of the
        length and the outline a concave one, so that Newton's steps from outside come down to the one root.
        """
        x, along = points[:, 0], rays[:, 0]
        end = np.where(along > 0.0, self.x[-1], self.x[0])
        to_end = np.divide(end - x, along, out=np.full_like(x, np.inf), where=along != 0.0)
        length = np.minimum(np.maximum(to_end, 0.0), to_radius(points, rays, self.radius))
        widths = np.diff(self.x)
        slopes = np.diff(self.r) / widths
        active = np.arange(len(x))
        for _ in range(_STEPS):
            p, q, l = points[active], rays[active], length[active]
            at = p + l[:, None] * q
            rho = np.hypot(at[:, 1], at[:, 2])
            part = np.clip(np.searchsorted(self.x, at[:, 0]) - 1, 0, len(slopes) - 1)
            off = rho - (self.r[part] + slopes[part] * np.clip(at[:, 0] - self.x[part], 0.0, widths[part]))
            rate = (at[:, 1] * q[:, 1] + at[:, 2] * q[:, 2]) / np.maximum(rho, TINY) - slopes[part] * q[:, 0]
            move = np.where((off > _SETTLED * self.size) & (rate > 0.0), off / np.maximum(rate, TINY), 0.0)
            length[active] = np.maximum(l - move, 0.0)
            active = active[move > 0.0]
            if not len(active):
                break
        return length


def body_round(x: Floats, r: Floats, clearance: float) -> Body:
    """The least body whose surface keeps a clearance from points at x (n,) along the axis and r (n,) from it."""
    reach = clearance / np.cos(np.pi / 8.0)
    turn = np.pi / 8.0 + _OCTAGON[:-1]
    around = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    flat = np.stack([x, r], axis=1)
    if np.ptp(x) > _THIN * max(float(np.abs(x).max()), float(r.max())):  # only the corners of its hull count
        ends = np.array([[x.min(), -1.0], [x.max(), -1.0]])
        corners = ConvexHull(np.concatenate([flat, ends])).vertices
        flat = flat[corners[corners < len(flat)]]
    all_ = (flat[:, None] + reach * around).reshape(-1, 2)
    mirrored = np.concatenate([all_, all_ * [1.0, -1.0]])
    corners = mirrored[ConvexHull(mirrored).vertices]
    corners = corners[corners[:, 1] > 0.0]
    corners = corners[np.argsort(corners[:, 0], kind="stable")]
    # of corners in one plane, up to round-off, the outermost counts: the other is within the flat end
    first = np.flatnonzero(np.append(True, np.diff(corners[:, 0]) > _PLANE * np.ptp(corners[:, 0])))
    return Body(frozen(corners[first, 0]), frozen(np.maximum.reduceat(corners[:, 1], first)))


def to_radius(points: Floats, rays: Floats, radius: float) -> Floats:
    """Lengths (n,) along rays at which they are at a distance from the axis; infinity along the axis.

    The closed form l = (-p.q + sqrt((p.q)^2 + q^2 (r^2 - p^2)))/q^2, with p and q square to the axis.
    """
    p, q = points[:, 1:], rays[:, 1:]
    pq, qq = (p * q).sum(axis=1), (q**2).sum(axis=1)
    root = np.sqrt(np.maximum(pq**2 + qq * (radius**2 - (p**2).sum(axis=1)), 0.0))
    return np.divide(root - pq, qq, out=np.full(len(p), np.inf), where=qq > TINY)
