"""The motion of one path by one of the literature's schemes: what a run returns."""

from dataclasses import dataclass
from enum import IntEnum, StrEnum

from meshwind.core.cast import Bools, Floats
from meshwind.path.paths import Counters


class Method(StrEnum):
    """The schemes: the first four in the parametric plane, the last two in space."""

    EXPLICIT_EULER = "explicit-euler"
    SYMPLECTIC_EULER = "symplectic-euler"
    RUNGE_KUTTA = "rk4"
    BACKWARD_EULER = "backward-euler"
    PENALTY = "penalty"
    KKT = "kkt"

    @property
    def in_space(self) -> bool:
        """Whether particles move in space and meet the surface by contact."""
        return self in (Method.PENALTY, Method.KKT)


class Ending(IntEnum):
    """How a run ended."""

    CONVERGED = 0
    STOPPED = 1
    DIVERGED = 2

    @property
    def advice(self) -> str:
        """What the ending means and what to do about it."""
        return _ADVICE[self]


_ADVICE = {
    Ending.CONVERGED: "at rest to the given tolerance",
    Ending.STOPPED: "the steps ran out before the fibre was at rest: allow more, or another step size or damping",
    Ending.DIVERGED: "the motion gained energy without bound: use a smaller step size, more damping or backward Euler",
}


@dataclass(frozen=True)
class History:
    """Measures of the state before each step and of the last one, each (steps + 1,).

    length in the surface's units; residual as in `Motion`; angle: mean over the touching particles of the angle
    between the curve's and the surface's normals (3.15), radians.
    """

    length: Floats
    residual: Floats
    angle: Floats


@dataclass(frozen=True)
class Motion:
    """One path of n particles as a scheme left it; after DIVERGED the last state of bounded energy.

    Attributes
    ----------
    method : Method
        The scheme.
    points : array (n, 3)
        Positions, in the surface's units.
    uv : array (n, 2)
        Parameters of the particles or of their feet, u unwrapped.
    on_surface : array (n,)
        Whether a particle touches the surface.
    gap : array (n,)
        Signed distance to the surface, in its units; 0 where the scheme itself keeps a particle there.
    length : float
        Length of the polyline, in the surface's units.
    residual : float
        Largest tangential force that neither springs nor friction balance, over the tension.
    status : Ending
        How the run ended.
    counters : Counters
        As for `Paths`; iterations are the steps taken.
    history : History or None
        Measures of every step, if the run was to keep them.
    """

    method: Method
    points: Floats
    uv: Floats
    on_surface: Bools
    gap: Floats
    length: float
    residual: float
    status: Ending
    counters: Counters
    history: History | None = None
