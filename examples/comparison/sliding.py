"""Fibres with friction on a cylinder, with closed forms: sliding to rest, and dragged by their ends."""

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.optimize import brentq

from comparison.problem import TURN, Kind, Problem
from meshwind.core.cast import Floats
from meshwind.surface import Surface, shapes


@cache
def tube(low: float, high: float) -> Surface:
    """A cylinder of radius 1 for z from low to high."""
    return shapes.revolution(np.ones_like, low, high, (256, 8))


@dataclass(frozen=True)
class Sliding:
    """A fibre on a cylinder of radius 1 that starts as z = k/2 (half^2 - t^2), |t| <= half, with friction mu.

    Where it slides it comes to rest as a catenary z = const - cosh(mu t) / mu, on which friction is used up
    everywhere: kg / kn = z'' / sqrt(1 + z'^2) = -mu.  The catenary leaves the untouched parabola with the same
    tangent at t = slid, or reaches the ends.
    """

    mu: float
    k: float
    half: float

    @property
    def slid(self) -> float:
        """Largest |t| of a particle that moves: 0 where none does, `half` where all do."""
        if self.k <= self.mu:
            return 0.0
        if self.k * self.half >= np.sinh(self.mu * self.half):
            return self.half
        low = np.arccosh(self.k / self.mu) / self.mu  # where k t - sinh(mu t) is largest
        return float(brentq(lambda x: self.k * x - np.sinh(self.mu * x), low, self.half, xtol=1e-15))

    @property
    def length(self) -> float:
        """Length at rest: the catenary's and twice the parabola's tail."""
        tail = self._arc(self.half) - self._arc(self.slid)
        middle = np.sinh(self.mu * self.slid) / self.mu if self.mu > 0 else self.slid
        return float(2.0 * (middle + tail))

    @property
    def middle(self) -> float:
        """z at t = 0, at rest."""
        rise = 0.5 * self.k * (self.half**2 - self.slid**2)
        return float(rise + ((np.cosh(self.mu * self.slid) - 1) / self.mu if self.mu > 0 else 0.0))

    def _arc(self, t: float) -> float:
        x = self.k * t
        return float((x * np.sqrt(1 + x * x) + np.arcsinh(x)) / (2 * self.k))

    @property
    def top(self) -> float:
        """Height of the start's middle."""
        return 0.5 * self.k * self.half**2

    def surface(self) -> Surface:
        """The cylinder, with a margin of 1 at both ends."""
        return tube(-1.0, self.top + 1.0)

    def initial(self, particles: int) -> Floats:
        """The starting parabola in (u, v), at even steps of t."""
        t = np.linspace(-self.half, self.half, particles)
        z = self.k / 2 * (self.half**2 - t * t)
        return np.stack([t / TURN, (z + 1.0) / (self.top + 2.0)], axis=1)

    def problem(self, name: str, difficulty: str) -> Problem:
        """This as an entry of the table."""
        a, b = ((s * self.half / TURN, 1.0 / (self.top + 2.0)) for s in (-1, 1))
        return Problem(name, difficulty, self.surface, a, b, self.length, kind=Kind.FRICTION, friction=self.mu,
                       initial=self.initial)  # fmt: skip


@dataclass(frozen=True)
class Dragged:
    """A fibre around a cylinder of radius 1 on z = 0, |t| <= half, whose ends are drawn up to z = rise, friction mu.

    It slides from its ends inwards, where friction is used up on z = (cosh(mu (|t| - stuck)) - 1) / mu, and has never
    moved where |t| <= stuck: there the two meet with one tangent.
    """

    mu: float
    half: float
    rise: float

    @property
    def stuck(self) -> float:
        """Largest |t| of what has never moved; negative where all of it slides."""
        return float(self.half - np.arccosh(1.0 + self.mu * self.rise) / self.mu)

    @property
    def length(self) -> float:
        """Length at rest, with the ends up."""
        return float(2.0 * (self.stuck + np.sinh(self.mu * (self.half - self.stuck)) / self.mu))

    def problem(self, name: str, difficulty: str) -> Problem:
        """This as an entry of the table."""
        low, high = 1.0 / (self.rise + 2.0), (1.0 + self.rise) / (self.rise + 2.0)
        a, b = -self.half / TURN, self.half / TURN
        return Problem(name, difficulty, self.surface, (a, high), (b, high), self.length, kind=Kind.MOVING,
                       friction=self.mu, dragged_from=((a, low), (b, low)))  # fmt: skip

    def surface(self) -> Surface:
        """The cylinder, with a margin of 1 at both ends."""
        return tube(-1.0, self.rise + 1.0)
