"""What a march gives: the fibre and why it stopped."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Floats
from meshwind.core.geometry import Block, Geometric
from meshwind.surface.surface import Surface


class Stop(IntEnum):
    """Why a march ended.

    0 is the full length; every other value has advice on what to do about it.

    Attributes
    ----------
    LENGTH : int
        0: the fibre has the length that was asked for.
    RIM_START : int
        1: it reached the start rim, v=0.
    RIM_END : int
        2: it reached the end rim, v=1.
    EDGE : int
        3: it reached an edge in u of a surface that does not close.
    LIFTS_OFF : int
        4: the surface curves away under it, and it would bridge from there.
    STEP_LIMIT : int
        5: the march took too many steps.

    Examples
    --------
    >>> import meshwind as mw
    >>> mw.Stop.LENGTH.advice
    'the full length'
    """

    LENGTH = 0
    RIM_START = 1
    RIM_END = 2
    EDGE = 3
    LIFTS_OFF = 4
    STEP_LIMIT = 5

    @property
    def advice(self) -> str:
        """What the stop means and what to do about it, in one line."""
        return _ADVICE[self]


_ADVICE = {
    Stop.LENGTH: "the full length",
    Stop.RIM_START: "the fibre reached the start rim (v=0): to stay on the part, start at a larger angle from the axis",
    Stop.RIM_END: "the fibre reached the end rim (v=1): to stay on the part, start at a larger angle from the axis",
    Stop.EDGE: "the fibre reached an edge in u (u=0 or u=1): start further inside, or in another direction",
    Stop.LIFTS_OFF: "the surface curves away under the fibre, which would bridge from here: change the direction, or "
    'march on regardless with press="ignore"',
    Stop.STEP_LIMIT: "too many steps, or none short enough: ask for a shorter length or a larger tolerance or step, "
    "and keep away from poles, where the surface has no tangent plane",
}


@dataclass(frozen=True)
class Trace(Geometric):
    """Fibre that was marched over a surface, with n points from the start to where it stopped.

    Attributes
    ----------
    surface : Surface
        Surface that the fibre lies on.
    points : ndarray of float, shape (n, 3)
        Positions, in the surface's units.
    uv : ndarray of float, shape (n, 2)
        Parametric positions, u in turns and unwrapped.
    uv_rate : ndarray of float, shape (n, 2)
        Derivatives of u and v by arc length: p and q of (3.22).
    tangent : ndarray of float, shape (n, 3)
        Unit tangents.
    normal : ndarray of float, shape (n, 3)
        Outward unit normals of the surface.
    arc_length : ndarray of float, shape (n,)
        Length from the start, in the surface's units.
    normal_curvature : ndarray of float, shape (n,)
        Normal curvature of the fibre, one over a length, positive where it presses on the surface.
    geodesic_curvature : ndarray of float, shape (n,)
        Geodesic curvature of the fibre, one over a length, positive where it turns to its left as seen from outside.
    slip : float
        Ratio of geodesic to normal curvature that was asked for.
    stop : Stop
        Why the march ended.
    evaluations : int
        Number of surface evaluations.

    Examples
    --------
    >>> import meshwind as mw
    >>> import numpy as np
    >>> helix = mw.trace(mw.shapes.cylinder(1.0, 3.0), start=(0.0, 0.0), direction=0.25 * np.pi, length=2.0)
    >>> np.allclose(helix.normal_curvature, 0.5, atol=1e-3)
    True
    """

    surface: Surface
    points: Floats
    uv: Floats
    uv_rate: Floats
    tangent: Floats
    normal: Floats
    arc_length: Floats
    normal_curvature: Floats
    geodesic_curvature: Floats
    slip: float
    stop: Stop
    evaluations: int

    __repr__ = brief

    def __len__(self) -> int:
        return len(self.points)

    @property
    def block(self) -> Block:
        """The fibre as a polyline, with what is known at its points."""
        names = "uv", "tangent", "normal", "arc_length", "normal_curvature", "geodesic_curvature"
        return Block(
            points=self.points,
            starts=np.array([0, len(self.points)]),
            point_data={name: getattr(self, name) for name in names},
            line_data={"slip": np.array([self.slip]), "stop": np.array([int(self.stop)])},
        )
