"""What a run of one of the literature's schemes gives."""

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
    Ending.CONVERGED: "at rest to the tolerance asked",
    Ending.STOPPED: "the steps ran out before the fibre was at rest: allow more, or another step size or damping",
    Ending.DIVERGED: "the motion gained energy without bound: use a smaller step size, more damping or backward Euler",
}


@dataclass(frozen=True)
class History:
    """Measures of the state before each step and of the last one, each (steps + 1,).

    length in the surface's units; residual as in `Run`; angle: mean over the touching particles of the angle
    between the curve's and the surface's normals (3.15), radians.
    """

    length: Floats
    residual: Floats
    angle: Floats


@dataclass(frozen=True)
class Run:
    """One path of n particles as a scheme left it; after DIVERGED the last state of bounded energy.

    points (n, 3); uv (n, 2) parametric position of the particle or of its foot, u unwrapped; on_surface (n,);
    gap (n,) signed distance to the surface, 0 where held on it by the scheme itself; length of the polyline;
    residual: largest tangential force that is not balanced, nor held by friction, over the tension; status an
    `Ending`; counters as for `Paths`, iterations being the steps taken; history where asked for.
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
