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
from meshwind.filament.section import Section


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
    around = curve.passed_at(start + turned)
    along = angle_after(angle, slip, turned)
    axial, fibre = (float(trapezoid(1.0 / ratio(along), around)) for ratio in (np.tan, np.sin))
    return Overrun(axial, fibre)


def _check(angle: float, slip: float) -> None:
    if not 0.0 < angle <= 0.5 * np.pi:
        raise BadInputError(f"a winding angle of {np.degrees(angle):g} degrees has no turn on a collar; give 0 to 90")
    if not 0.0 < slip < np.inf:
        raise BadInputError(f"a slip of {slip:g} does not steer a fibre; give a number above 0, at most the friction")
