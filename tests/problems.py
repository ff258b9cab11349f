"""Taut paths with exact answers: name, what makes it hard, surface, ends, length.  One table for every test.

Lengths are closed forms or quadratures to 1e-12, worked out beside each entry.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

from meshwind.surface import Surface, shapes

TURN = 2 * np.pi


@dataclass(frozen=True)
class Problem:
    """A path whose answer is known; gap is the largest distance to the surface, None where not asked."""

    name: str
    hard: str
    surface: Callable[[], Surface]
    start: tuple[float, float]
    end: tuple[float, float]
    length: float
    bridges: bool = False
    gap: float | None = None


def cone_length(twist: float) -> float:
    """The unrolled cone r = 1 - z / 6, z in [0, 3]: a straight line in a sector, by the law of cosines."""
    slant = float(np.hypot(3.0, 0.5))
    sine = 0.5 / slant
    far, near = 1.0 / sine, 0.5 / sine
    return float(np.sqrt(far**2 + near**2 - 2 * far * near * np.cos(twist * sine)))


def barrel_radius(z: float) -> float:
    """The convex barrel's profile on z in [0, 2]."""
    return 1.0 - 0.3 * (z - 1.0) ** 2


def barrel_clairaut(twist: float) -> float:
    """The constant c = r sin(alpha) of the geodesic that turns by `twist` from rim to rim."""

    def turned(c: float) -> float:
        def rate(z: float) -> float:
            r = barrel_radius(z)
            return c * np.sqrt(1 + (0.6 * (z - 1)) ** 2) / (r * np.sqrt(r * r - c * c))

        return float(quad(rate, 0, 2, epsabs=1e-13, epsrel=1e-13, points=[1.0])[0]) - twist

    return float(brentq(turned, 1e-3, 0.699, xtol=1e-15))


def barrel_length(twist: float) -> float:
    """Clairaut's integral for the length."""
    c = barrel_clairaut(twist)

    def rate(z: float) -> float:
        r = barrel_radius(z)
        return r * np.sqrt(1 + (0.6 * (z - 1)) ** 2) / np.sqrt(r * r - c * c)

    return float(quad(rate, 0, 2, epsabs=1e-13, epsrel=1e-13, points=[1.0])[0])


def vase_radius(z: np.ndarray) -> np.ndarray:
    """A profile with two hollows on z in [0, 4]."""
    return np.asarray(1 + 0.35 * np.cos(0.75 * np.pi * z + 0.3) + 0.1 * np.sin(2.25 * z))


@cache
def cone() -> Surface:
    return shapes.cone(1.0, 0.5, 3.0, (256, 8))


@cache
def barrel() -> Surface:
    return shapes.revolution(lambda z: 1.0 - 0.3 * (z - 1.0) ** 2, 0.0, 2.0, (256, 64))


@cache
def ellipsoid() -> Surface:
    return shapes.ellipsoid(1.0, 0.8, 1.5, 0.25 * np.pi, 0.75 * np.pi, (256, 128))


@cache
def sphere() -> Surface:
    return shapes.sphere_band(2.0, 0.25 * np.pi, 0.75 * np.pi, (256, 128))


@cache
def hyperboloid() -> Surface:
    return shapes.hyperboloid(1.0, 1.0, 1.5, (256, 128))


@cache
def vase() -> Surface:
    return shapes.revolution(vase_radius, 0.0, 4.0, (64, 256))


@cache
def elbow() -> Surface:
    return shapes.elbow(3.0, 1.0, np.pi / 2, (128, 128))


def great_circle(longitude: float) -> float:
    """On a sphere of radius 2 from polar angle pi/4 to 3 pi/4 over `longitude`."""
    return float(2.0 * np.arccos(0.5 * np.cos(longitude) - 0.5))


RULING = 2 * float(np.arctan(1.5))
"""Twist of the hyperboloid's rulings between its rims."""


def chord(share: float) -> float:
    """The straight chord between the hyperboloid's rims at a share of the rulings' twist."""
    return float(np.sqrt(9.0 + 4 * 3.25 * np.sin(share * RULING / 2) ** 2))


def waist_gap(share: float) -> float:
    return float(np.sqrt(3.25) * np.cos(share * RULING / 2) - 1.0)


VASE_LENGTH = 4.136120597101638
"""Upper convex hull of the vase's profile, from 4 million samples."""

PROBLEMS = (
    *(Problem(f"cone-{t:g}", "flat but turned", cone, (0, 0), (t / TURN, 1), cone_length(t)) for t in (1, 3, 6)),
    *(Problem(f"barrel-{t:g}", "convex; near its limit the fibre wants to slide off", barrel, (0, 0), (t / TURN, 1),
              barrel_length(t)) for t in (0.5, 1.5, 2.5)),
    Problem("sphere", "positive curvature all over", sphere, (0, 0), (0.2, 1), great_circle(0.4 * np.pi)),
    Problem("ellipsoid", "no symmetry", ellipsoid, (0, 0), (0.2, 1), 2.4274658209749833),
    *(Problem(f"hyperboloid-{f:g}", "wholly in the air", hyperboloid, (0, 0), (f * RULING / TURN, 1), chord(f),
              True, waist_gap(f)) for f in (0.0, 0.5, 0.9)),
    Problem("vase", "two bridges and a contact between", vase, (0, 0), (0, 1), VASE_LENGTH, True),
    Problem("elbow", "the chord of the inner bend", elbow, (0.5, 0), (0.5, 1), 2 * np.sqrt(2.0), True,
            2 - np.sqrt(2.0)),
)  # fmt: skip
