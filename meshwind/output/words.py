"""Figures as a person wants to read them."""

import math

import numpy as np

from meshwind.cast import Floats

_FINEST = 1e-4
"""Places are told to this part of the part's size."""


def quantity(length: float, units: str = "", digits: int = 4) -> str:
    """A length with its unit, if there is one, to so many digits."""
    told = f"{float(f'{length:.{digits}g}'):,.10g}"
    return f"{told} {units}" if units else told


def place(point: Floats, size: float) -> str:
    """Coordinates (3,) to 1e-4 of the part's size: no round-off about 0, digits enough far from the origin."""
    return "(" + ", ".join(_coordinate(float(x), _FINEST * size) for x in point) + ")"


def _coordinate(x: float, step: float) -> str:
    step = 10.0 ** math.floor(math.log10(step) + 1e-9)
    digits = math.floor(math.log10(abs(x) / step)) + 1 if abs(x) >= 0.5 * step else 0
    return f"{x:.{digits}g}" if digits > 0 else "0"


def power(value: float) -> str:
    """The power of ten that is not below value, as one types it: 1e-3."""
    return f"1e{math.ceil(math.log10(value) - 1e-9)}"


def ratio(value: float) -> str:
    """A small number without dimension, as one types it: 1.3e-4."""
    if not (np.isfinite(value) and value > 0.0):
        return f"{value:g}"
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa.removesuffix('.0')}e{int(exponent)}"
