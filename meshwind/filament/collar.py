"""A turnaround on a collar: the rim's section continued as a prism, on which friction steers the fibre to a hoop.

On a prism the normal curvature of a fibre at angle a from its axis is kappa sin^2 a, kappa being that of the section.
With the slip |kg|/kn = lambda the angle grows by lambda sin a over the angle psi through which the section's normal
turns, so that ln tan(a/2) = ln tan(a0/2) + lambda psi: how far the fibre turns does not depend on the section.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import trapezoid

from meshwind.core.cast import Floats, floats, frozen
from meshwind.core.errors import BadInputError


def turned_to_hoop(angle: float, slip: float) -> float:
    """Angle, in radians, through which the section's normal turns until a fibre at an angle from the axis is a hoop.

    Parameters
    ----------
    angle : float
        Winding angle where the fibre comes over the rim, in radians, above 0 and up to pi/2.
    slip : float
        Slip |kg|/kn with which it is steered, above 0.

    Returns
    -------
    float
        asinh(cot(angle)) / slip.

    Examples
    --------
    There and back, in degrees:

    >>> import numpy as np
    >>> from meshwind.filament.collar import turned_to_hoop
    >>> round(2 * np.degrees(turned_to_hoop(np.radians(45.0), 0.2)), 1)
    505.0
    """
    _check(angle, slip)
    return float(np.arcsinh(1.0 / np.tan(angle)) / slip)


def angle_after(angle: float, slip: float, turned: ArrayLike) -> Floats:
    """Winding angles (n,) after the section's normal has turned by angles (n,), all in radians, at most to a hoop."""
    _check(angle, slip)
    more = floats(turned, "turned", -1)
    return frozen(np.minimum(2.0 * np.arctan(np.tan(0.5 * angle) * np.exp(slip * more)), 0.5 * np.pi))


@dataclass(frozen=True)
class Section:
    """A convex section of a prism: a closed curve on points (n, 2), the last of which is not the first again.

    turned, passed (n,): the angle of its normal, growing, and the length up to each point; perimeter.
    """

    points: Floats
    turned: Floats
    passed: Floats
    perimeter: float

    def passed_after(self, start: float, turned: Floats) -> Floats:
        """Length of the section from where its normal has the angle `start` to where it has turned on by (n,)."""
        loop, length = np.append(self.turned, self.turned[0] + 2.0 * np.pi), np.append(self.passed, self.perimeter)

        def reached(angles: Floats) -> Floats:
            whole, rest = np.divmod(angles - loop[0], 2.0 * np.pi)
            return np.asarray(whole * self.perimeter + np.interp(rest + loop[0], loop, length))

        return np.asarray(reached(start + turned) - reached(np.array([start])))


def section(points: ArrayLike) -> Section:
    """Take a convex section from points (n, 2) on it, in the sense in which it is passed.

    Raises
    ------
    BadInputError
        If there are too few points, or the section is not convex.
    """
    ring = floats(points, "points", -1, 2)
    if len(ring) < 3:
        raise BadInputError(f"a section of {len(ring)} points is no curve; give at least 3")
    way = np.roll(ring, -1, axis=0) - ring
    size = np.hypot(way[:, 0], way[:, 1])
    if not (size > 0.0).all():
        raise BadInputError("two points of the section coincide; give each once")
    heading = np.arctan2(way[:, 1], way[:, 0])
    bend = (heading - np.roll(heading, 1) + np.pi) % (2.0 * np.pi) - np.pi
    if abs(bend.sum() - 2.0 * np.pi) > 1e-6:
        raise BadInputError("the section is not passed once against the clock; give its points in that sense")
    if bend.min() < -1e-9:
        raise BadInputError("the section is hollow somewhere; a fibre that turns on its collar would not press there")
    # the normal at a point is half-way between those of its two edges
    at_edge = heading[0] - 0.5 * np.pi + np.concatenate([[0.0], np.cumsum(bend[1:])])
    return Section(frozen(ring), frozen(at_edge - 0.5 * bend), frozen(np.append(0.0, np.cumsum(size[:-1]))), size.sum())


@dataclass(frozen=True)
class Overrun:
    """How far a fibre runs over a rim until it is a hoop: along the axis, and its own length."""

    axial: float
    fibre: float


def overrun(curve: Section, start: float, angle: float, slip: float, samples: int = 20001) -> Overrun:
    """Overrun of a fibre that comes over the rim where the section's normal has the angle `start`.

    Parameters
    ----------
    curve : Section
        Section of the collar.
    start : float
        Angle of its normal there, in radians.
    angle, slip : float
        As for `turned_to_hoop`.
    samples : int, default 20001
        Points along the turnaround that the integrals are taken over, by the trapezoidal rule.

    Returns
    -------
    Overrun
        Lengths in the section's unit; on a circle of radius R they are (R / slip) (1 / sin(angle) - 1) and
        (R / slip) cot(angle).
    """
    turned = np.linspace(0.0, turned_to_hoop(angle, slip), samples)
    around = curve.passed_after(start, turned)
    along = angle_after(angle, slip, turned)
    axial, fibre = (float(trapezoid(1.0 / ratio(along), around)) for ratio in (np.tan, np.sin))
    return Overrun(axial, fibre)


def _check(angle: float, slip: float) -> None:
    if not 0.0 < angle <= 0.5 * np.pi:
        raise BadInputError(f"a winding angle of {np.degrees(angle):g} degrees has no turn on a collar; give 0 to 90")
    if not 0.0 < slip < np.inf:
        raise BadInputError(f"a slip of {slip:g} does not steer a fibre; give a number above 0, at most the friction")
