"""Figures as a person wants to read them."""

import math


def quantity(length: float, units: str = "", digits: int = 4) -> str:
    """A length with its unit, if there is one, to so many digits."""
    told = f"{float(f'{length:.{digits}g}'):,.10g}"
    return f"{told} {units}" if units else told


def power(value: float) -> str:
    """The power of ten that is not below value, as one types it: 1e-3."""
    return f"1e{math.ceil(math.log10(value) - 1e-9)}"


def ratio(value: float) -> str:
    """A small number without dimension, as one types it: 1.3e-4."""
    if not (math.isfinite(value) and value > 0.0):
        return f"{value:g}"
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa.removesuffix('.0')}e{int(exponent)}"
