"""Numbers as text for people."""

import math
from collections.abc import Sequence

from meshwind.core.spoken import argument
from meshwind.core.units import BY_DEFAULT, BY_FILE, GIVEN, UNKNOWN, millimetres

_NAMED = {
    GIVEN: " as given",
    BY_FILE: " as the file says",
    BY_DEFAULT: " assumed; see {units}",
}
"""Who named the unit."""


def quantity(length: float, units: str = "", digits: int = 4) -> str:
    """A length with its unit, if it has one, to the given number of significant digits."""
    number = f"{float(f'{length:.{digits}g}'):,.10g}"
    return f"{number} {units}" if units else number


def duration(seconds: float) -> str:
    """A duration, as in "41 s" or "3 min 20 s"."""
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"


def size(extents: Sequence[float], units: str, units_from: str) -> str:
    """The size of a part, as in "120 mm long, 66.61 x 66.61 mm across; mm as given"; units_from as in `Mesh`."""
    length, *across = sorted(extents, reverse=True)
    long = f"{quantity(length, units)} long"
    if units and millimetres(units) != 1.0:
        long += f" ({quantity(length * millimetres(units), 'mm')})"
    words = f"{long}, {' x '.join(quantity(each) for each in across)}{f' {units}' if units else ''} across"
    if units_from in ("", UNKNOWN):
        return f"{words}; unit unknown"
    return f"{words}; {units}{_NAMED.get(units_from, f', {units_from}').format(units=argument('units'))}"


def power(value: float) -> str:
    """The smallest power of ten not below a value, as in 1e-3."""
    return f"1e{math.ceil(math.log10(value) - 1e-9)}"


def ratio(value: float) -> str:
    """A small dimensionless number, as in 1.3e-4."""
    if not (math.isfinite(value) and value > 0.0):
        return f"{value:g}"
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa.removesuffix('.0')}e{int(exponent)}"
