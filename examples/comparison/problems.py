"""The table of problems: taut paths with known answers, for tests and charts alike.

Lengths are closed forms, or quadratures to 1e-12, in the functions beside the entries.  On freeform surfaces they are
references from many particles, with error estimates.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import TypeVar

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

from comparison.problem import TURN, Kind, Problem
from comparison.sliding import Dragged, Sliding, tube
from meshwind.core.cast import Floats
from meshwind.surface import Surface, shapes

Number = TypeVar("Number", float, Floats)


def cone_length(twist: float) -> float:
    """The unrolled cone r = 1 - z / 6, z in [0, 3]: a straight line in a sector, by the law of cosines."""
    slant = float(np.hypot(3.0, 0.5))
    sine = 0.5 / slant
    far, near = 1.0 / sine, 0.5 / sine
    return float(np.sqrt(far**2 + near**2 - 2 * far * near * np.cos(twist * sine)))


CONE_LIMIT = np.pi / 3 / (0.5 / float(np.hypot(3.0, 0.5)))
"""Twist beyond which the line in the cone's sector would dip below the small rim: cos(flat angle) = 0.5."""


def barrel_radius(z: Number) -> Number:
    """The convex barrel's profile on z in [0, 2]."""
    return 1.0 - 0.3 * (z - 1.0) ** 2


def _barrel_integral(c: float, rate: Callable[[float, float], float]) -> float:
    """Integral along the geodesic with r sin(alpha) = c; z = 1 - cos(q) removes the singularity at c = 0.7."""

    def by_angle(q: float) -> float:
        rise = 0.3 * np.sin(q) ** 2
        r = 0.7 + rise
        return rate(r, np.sqrt((1 + (0.6 * np.cos(q)) ** 2) / ((0.7 - c + rise) * (r + c)))) * np.sin(q)

    return float(2.0 * quad(by_angle, 0.0, 0.5 * np.pi, epsabs=1e-13, epsrel=1e-13)[0])


def barrel_twist(c: float) -> float:
    """Twist from rim to rim of the geodesic with Clairaut's constant c, in radians."""
    return _barrel_integral(c, lambda r, q: c * q / r)


BARREL_LIMIT = barrel_twist(0.7)
"""Twist beyond which no geodesic joins the barrel's rims: c is the rims' radius."""


def barrel_clairaut(twist: float) -> float:
    """The constant c = r sin(alpha) of the geodesic that turns by `twist` from rim to rim."""
    return float(brentq(lambda c: barrel_twist(c) - twist, 1e-3, 0.7, xtol=1e-15))


def barrel_length(twist: float) -> float:
    """Clairaut's integral for the length."""
    return _barrel_integral(barrel_clairaut(twist), lambda r, q: r * q)


def vase_radius(z: Floats) -> Floats:
    """A profile with two hollows on z in [0, 4]."""
    return np.asarray(1 + 0.35 * np.cos(0.75 * np.pi * z + 0.3) + 0.1 * np.sin(2.25 * z))


@cache
def cone() -> Surface:
    """The cone of `cone_length`."""
    return shapes.cone(1.0, 0.5, 3.0, (256, 8))


@cache
def barrel() -> Surface:
    """The barrel of `barrel_radius`."""
    return shapes.revolution(barrel_radius, 0.0, 2.0, (256, 64))


@cache
def ellipsoid() -> Surface:
    """A band of the ellipsoid with semi-axes 1, 0.8 and 1.5."""
    return shapes.ellipsoid(1.0, 0.8, 1.5, 0.25 * np.pi, 0.75 * np.pi, (256, 128))


@cache
def sphere() -> Surface:
    """A band of the sphere of radius 2."""
    return shapes.sphere_band(2.0, 0.25 * np.pi, 0.75 * np.pi, (256, 128))


@cache
def hyperboloid() -> Surface:
    """The hyperboloid r^2 = 1 + z^2, |z| <= 1.5."""
    return shapes.hyperboloid(1.0, 1.0, 1.5, (256, 128))


@cache
def vase() -> Surface:
    """The vase of `vase_radius`."""
    return shapes.revolution(vase_radius, 0.0, 4.0, (64, 256))


@cache
def elbow() -> Surface:
    """A quarter bend of a pipe."""
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
    """Distance of that chord from the waist."""
    return float(np.sqrt(3.25) * np.cos(share * RULING / 2) - 1.0)


VASE_LENGTH = 4.136120597101638
"""Upper convex hull of the vase's profile, from 4 million samples."""

PROBLEMS = (
    *(Problem(f"cone-{t:g}", "flat but turned", cone, (0, 0), (t / TURN, 1), cone_length(t)) for t in (1, 3)),
    Problem("cone-6", f"a turn, near the limit of {CONE_LIMIT:.2f} rad at which the fibre slides off", cone, (0, 0),
            (6 / TURN, 1), cone_length(6), kind=Kind.LONG),
    *(Problem(f"barrel-{t:g}", "convex; near its limit the fibre wants to slide off", barrel, (0, 0), (t / TURN, 1),
              barrel_length(t)) for t in (0.5, 1.5, 2.5)),
    Problem("sphere", "positive curvature all over", sphere, (0, 0), (0.2, 1), great_circle(0.4 * np.pi)),
    Problem("ellipsoid", "no symmetry", ellipsoid, (0, 0), (0.2, 1), 2.4274658209749833),
    *(Problem(f"hyperboloid-{f:g}", "wholly in the air", hyperboloid, (0, 0), (f * RULING / TURN, 1), chord(f),
              True, waist_gap(f), Kind.BRIDGING) for f in (0.0, 0.5, 0.9)),
    Problem("vase", "two bridges and a contact between", vase, (0, 0), (0, 1), VASE_LENGTH, True, kind=Kind.BRIDGING),
    Problem("elbow", "the chord of the inner bend", elbow, (0.5, 0), (0.5, 1), 2 * np.sqrt(2.0), True,
            2 - np.sqrt(2.0), Kind.BRIDGING),
)  # fmt: skip
"""Without friction, with exact answers."""

LONG = (
    Problem("barrel-4", f"near the limit of {BARREL_LIMIT:.2f} rad at which the fibre slides off", barrel, (0, 0),
            (4 / TURN, 1), barrel_length(4.0), kind=Kind.LONG),
    Problem("helix-5", "five and a quarter turns", lambda: tube(0.0, 1.5), (0, 0), (5.25, 1),
            float(np.hypot(5.25 * TURN, 1.5)), kind=Kind.LONG),
)  # fmt: skip
"""Windings so long that they need many particles, or are close to sliding off."""

SLIDING = {
    "catenary-0.3": Sliding(0.3, 0.8, np.pi),
    "catenary-0.2": Sliding(0.2, 0.5, 0.75 * np.pi),
    "stick-slip": Sliding(0.3, 0.4, 2 * np.pi),
}
DRAGGED = Dragged(0.3, np.pi, 1.0)
FRICTION = (
    SLIDING["catenary-0.3"].problem("catenary-0.3", "all of it slides; friction 0.3"),
    SLIDING["catenary-0.2"].problem("catenary-0.2", "all of it slides; friction 0.2"),
    SLIDING["stick-slip"].problem("stick-slip", "the middle slides, the tails never move; friction 0.3"),
    DRAGGED.problem("dragged", "the ends are drawn along, the middle never moves; friction 0.3"),
)


def bottle_shape(u: Floats, v: Floats) -> Floats:
    """A bottle that is neither round nor straight, with bumps: no closed form and no symmetry."""
    t, z = TURN * u, 4.0 * v
    r = 1.0 - 0.12 * (v - 0.4) ** 2 + 0.06 * np.cos(3 * t + 1.0) * np.sin(np.pi * v) ** 2
    r = r - 0.45 / (1.0 + np.exp(-14.0 * (v - 0.72)))
    return np.stack([1.15 * r * np.cos(t) + 0.15 * np.sin(1.3 * z), 0.9 * r * np.sin(t), z], -1)


@cache
def bottle() -> Surface:
    """The bottle as a spline; the reference length is that on the spline, not on the formula's shape."""
    return shapes.parametric(bottle_shape, (96, 96))


FREEFORM = (
    Problem("bottle", "bumps all along, no symmetry", bottle, (0.1, 0), (0.5, 0.6), 3.4754768412104,
            kind=Kind.FREEFORM),
    Problem("bottle-turn", "a whole turn over the bumps", bottle, (0.1, 0.02), (1.1, 0.55), 6.6122214629035,
            kind=Kind.FREEFORM, accuracy=5e-12),
    Problem("bottle-neck", "over the neck through the air", bottle, (0.1, 0), (0.4, 1), 4.4354379168811, True,
            kind=Kind.FREEFORM, accuracy=5e-12),
)  # fmt: skip
"""References by Richardson's extrapolation from 1601 and 3201 particles; `accuracy` is its change from half as many."""

SPLINE = {
    "cone-1": 1.2e-11, "cone-3": 1.6e-10, "cone-6": 3.0e-10, "barrel-0.5": 1.1e-10, "barrel-1.5": 2.8e-10,
    "barrel-2.5": 3.4e-10, "barrel-4": 3.9e-10, "sphere": 3.9e-10, "ellipsoid": 2.3e-10, "vase": 8e-11,
    "helix-5": 5.4e-10,
}  # fmt: skip
"""Relative difference of the length on the spline from that on the exact shape, with 6401 particles, rounded up."""
TABLE = {
    problem.name: replace(problem, accuracy=max(problem.accuracy, SPLINE.get(problem.name, 0.0)))
    for problem in (*PROBLEMS, *LONG, *FRICTION, *FREEFORM)
}
"""All problems by name."""
