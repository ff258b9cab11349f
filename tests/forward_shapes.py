"""Surfaces to march over: some that the spline holds exactly, some with visible kinks at the knots."""

from functools import cache

import numpy as np

from meshwind.core.cast import Floats
from meshwind.march import Trace
from meshwind.surface import Surface, shapes


@cache
def fine_barrel() -> Surface:
    return shapes.revolution(lambda z: 1.0 - 0.3 * (z - 1.0) ** 2, 0.0, 2.0, (512, 128))


@cache
def coarse_barrel() -> Surface:
    """Few spans, so that the third derivative jumps visibly at the knots."""
    return shapes.revolution(lambda z: 1.0 - 0.3 * (z - 1.0) ** 2, 0.0, 2.0, (24, 8))


@cache
def gutter(turn: float = 0.0) -> Surface:
    """z = -x^2 / 2 + turn x^3 / 6 over x in [-1, 1], y in [0, 2]: a cubic, so the spline is the shape itself."""

    def formula(u: Floats, v: Floats) -> Floats:
        x = 2 * u - 1
        return np.stack([x, 2 * v, -(x**2) / 2 + turn * x**3 / 6], -1)

    return shapes.parametric(formula, (5, 4), periodic=False)


@cache
def dome() -> Surface:
    """A doubly curved polynomial, without a kink at any knot: what a method does on a smooth surface."""

    def formula(u: Floats, v: Floats) -> Floats:
        x, y = 2 * u - 1, 2 * v - 1
        return np.stack([x + 0.1 * y**2, y, -(x**2) / 2 - y**2 / 3 + x * y**3 / 10], -1)

    return shapes.parametric(formula, (5, 4), periodic=False)


def parabola(x: float) -> float:
    """Arc length of z = -x^2 / 2 from 0."""
    return float((x * np.hypot(1, x) + np.arcsinh(x)) / 2)


@cache
def tube(spans: int = 512) -> Surface:
    return shapes.cylinder(1.5, 4.0, (spans, 8))


def apart(a: Trace, b: Trace) -> float:
    return float(np.linalg.norm(a.points[-1] - b.points[-1]))
