"""Rims by arc length: shares of a rim's length and its parameter u, both unwrapped and without a mean shift."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline, PPoly

from meshwind.core.brief import brief
from meshwind.core.cast import Floats
from meshwind.surface.evaluate import SU
from meshwind.surface.surface import Surface

_SAMPLES = 16
"""Samples of the rim's speed per span: its length and points on it are then exact to round-off's square root."""
_NEWTON_STEPS = 4
"""Newton's steps on a smooth growing function from a start good to 1e-4: convergence is quadratic."""


@dataclass(frozen=True)
class Rim:
    """A ring of a surface that closes in u: passed (n,), the share of its length up to u (n,); ahead: passed minus u.

    shift: the mean of `ahead`, by which shares are moved, so that none are ahead of u on average.
    """

    u: Floats
    passed: Floats
    ahead: PPoly
    shift: float

    __repr__ = brief

    def parameters(self, share: Floats) -> Floats:
        """The u at shares (n,) of the length."""
        wanted = np.asarray(share) + self.shift
        whole = np.floor(wanted)
        rest = wanted - whole
        at = np.interp(rest, self.passed, self.u)
        for _ in range(_NEWTON_STEPS):
            at -= (at + self.ahead(at) - rest) / (1.0 + self.ahead(at, 1))
        return np.asarray(whole + at)

    def shares(self, u: Floats) -> Floats:
        """The shares of the length at u (n,)."""
        whole = np.floor(u)
        return np.asarray(u + self.ahead(u - whole) - self.shift)


def rim(surface: Surface, v: float) -> Rim:
    """The ring of a surface at v, measured once."""
    if v not in surface.rims:
        surface.rims[v] = _measured(surface, v)
    return surface.rims[v]


def _measured(surface: Surface, v: float) -> Rim:
    u = np.linspace(0.0, 1.0, _SAMPLES * surface.spans[0] + 1)
    speed = np.linalg.norm(surface.frames(np.stack([u, np.full_like(u, v)], axis=1))[:, SU], axis=1)
    speed[-1] = speed[0]
    length = CubicSpline(u, speed, bc_type="periodic").antiderivative()
    passed = length(u) / length(1.0)
    ahead = CubicSpline(u, passed - u, bc_type="periodic")
    return Rim(u, passed, ahead, float(ahead.integrate(0.0, 1.0)))


def rim_parameters(surface: Surface, v: float, share: Floats) -> Floats:
    """The u on the rim v at shares (n,) of its length, both unwrapped, without a mean shift against each other."""
    return rim(surface, v).parameters(share)
