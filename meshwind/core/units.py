"""Units of length: names, sizes, and how files name them."""

from meshwind.core.errors import BadInputError
from meshwind.core.parsing import shortened

UNKNOWN = "unknown"
"""Unit in a report if it is not known."""

MILLIMETRES = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "um": 1e-3, "in": 25.4, "inch": 25.4, "ft": 304.8}
"""Length of a unit in mm."""


def check_units(units: object) -> None:
    """Raise BadInputError unless `units` is the name of a unit, or "" for an unknown one."""
    if not isinstance(units, str) or (units and units.lower() not in MILLIMETRES):
        raise BadInputError(
            f'units is {shortened(repr(units))}; give {", ".join(MILLIMETRES)}, or "" where the unit is not known'
        )


def millimetres(units: str) -> float:
    """Length of a unit in mm; "" counts as mm.  Raises BadInputError for any other name."""
    if not units:
        return 1.0
    if units.lower() not in MILLIMETRES:
        raise BadInputError(
            f"the run's unit {units!r} has no known length; wind with --units {' or '.join(sorted(MILLIMETRES))}"
        )
    return MILLIMETRES[units.lower()]


def reported_unit(units: str) -> str:
    """Unit as a report names it, "" if it is not known."""
    return "" if units == UNKNOWN else units


def lengths_in(units: str) -> str:
    """Words on the unit for a file's header."""
    return f"lengths in {units}" if units else "lengths in an unknown unit"
