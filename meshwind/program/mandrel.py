"""The mandrel's axis: the line on which the part turns, and coordinates along and about it."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.core.vectors import unit
from meshwind.surface.grid import rim_frames
from meshwind.surface.surface import Surface

_RIM_SAMPLES = 4
"""Points of a rim per span of the spline, from which its middle is taken."""
_NEAR = 1e-6
"""Distance of the rims' middles, over the part's size, below which they give no axis."""


@dataclass(frozen=True)
class Mandrel:
    """The line about which the part turns.

    Attributes
    ----------
    origin, direction : ndarray of float, shape (3,)
        A point of the line, and the unit vector along it.
    zero, third : ndarray of float, shape (3,)
        The unit vector in which the eye is at mandrel angle 0, and direction x zero.
    """

    origin: Floats
    direction: Floats
    zero: Floats

    @property
    def third(self) -> Floats:
        """The third axis."""
        return np.cross(self.direction, self.zero)

    @property
    def frame(self) -> Floats:
        """Direction, zero and third as rows (3, 3)."""
        return np.stack([self.direction, self.zero, self.third])

    def inside(self, points: Floats) -> Floats:
        """Points (n, 3) in the frame of the axis: along it, and twice square to it."""
        return self.turned(points - self.origin)

    def turned(self, vectors: Floats) -> Floats:
        """Vectors (n, 3) in the frame of the axis."""
        x, y, z = vectors.T
        # threads of a matrix product cost more here than they save
        return np.stack([a * x + b * y + c * z for a, b, c in self.frame], axis=1)

    def outside(self, points: Floats) -> Floats:
        """Points (n, 3) in the mesh's coordinates, from the frame of the axis."""
        return np.asarray(self.origin + points @ self.frame)

    def towards(self, turned: Floats) -> Floats:
        """Unit vectors (n, 3) from the axis to the eye, as it stands to the part at mandrel angles (n,) in degrees."""
        angle = -np.radians(turned)[:, None]
        return np.asarray(np.cos(angle) * self.zero + np.sin(angle) * self.third)

    def eye(self, x: Floats, r: Floats, turned: Floats) -> Floats:
        """The eye (n, 3) at x (n,) along the axis and r (n,) from it, at mandrel angles (n,) in degrees."""
        return np.asarray(self.origin + x[:, None] * self.direction + r[:, None] * self.towards(turned))


def mandrel_of(surface: Surface, points: Floats) -> Mandrel:
    """The axis through the middles of a part's rims, with the mandrel's angle growing along a fibre of points (n, 3).

    Origin is the middle of the rim from which the axis leads to the other; zero is the direction from the axis to the
    start rim at u = 0.  Raises BadInputError if the middles coincide.
    """
    rims = [rim_frames(surface, v, _RIM_SAMPLES)[:, 0] for v in (0.0, 1.0)]
    origin, other = rims[0].mean(axis=0), rims[1].mean(axis=0)
    if not np.linalg.norm(other - origin) > _NEAR * surface.size:
        raise BadInputError("the middles of the rims coincide, so the part has no axis to turn on; open it elsewhere")
    along = unit((other - origin)[None])[0]
    first = rims[0][0] - origin
    zero = first - (first @ along) * along
    if not np.linalg.norm(zero) > _NEAR * surface.size:
        zero = np.eye(3)[np.argmin(np.abs(along))]
        zero = zero - (zero @ along) * along
    made = Mandrel(frozen(origin), frozen(along), frozen(unit(zero[None])[0]))
    flat = made.inside(points)[:, 1:]
    # the eye stands still while the part turns against the sense in which the fibre goes round
    turn = np.arctan2(flat[:-1, 0] * flat[1:, 1] - flat[:-1, 1] * flat[1:, 0], (flat[:-1] * flat[1:]).sum(axis=1)).sum()
    return made if turn <= 0.0 else Mandrel(frozen(other), frozen(-along), made.zero)
