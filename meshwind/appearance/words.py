"""Numbers as text for people."""

import math


def quantity(length: float, units: str = "", digits: int = 4) -> str:
    """A length with its unit, if it has one, to the given number of significant digits."""
    number = f"{float(f'{length:.{digits}g}'):,.10g}"
    return f"{number} {units}" if units else number


def power(value: float) -> str:
    """The smallest power of ten not below a value, as in 1e-3."""
    return f"1e{math.ceil(math.log10(value) - 1e-9)}"


def ratio(value: float) -> str:
    """A small dimensionless number, as in 1.3e-4."""
    if not (math.isfinite(value) and value > 0.0):
        return f"{value:g}"
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa.removesuffix('.0')}e{int(exponent)}"
