"""Units of length: their names, their size, and what a file says of them."""

from meshwind.core.errors import BadInputError
from meshwind.core.parsing import shortened

UNKNOWN = "unknown"
"""What a report says where the unit is not known."""

MILLIMETRES = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "um": 1e-3, "in": 25.4, "inch": 25.4, "ft": 304.8}
"""Length of a unit in mm."""


def check_units(units: object) -> None:
    """Raise BadInputError for what is neither the name of a known unit nor "", which stands for one not known."""
    if not isinstance(units, str) or (units and units.lower() not in MILLIMETRES):
        raise BadInputError(
            f'units is {shortened(repr(units))}; give {", ".join(MILLIMETRES)}, or "" where the unit is not known'
        )


def millimetres(units: str) -> float:
    """Length of a unit in mm; "" counts as mm.  Raises BadInputError for a unit that is not known."""
    if not units:
        return 1.0
    if units.lower() not in MILLIMETRES:
        raise BadInputError(
            f"the run's unit {units!r} has no known length; wind with --units {' or '.join(sorted(MILLIMETRES))}"
        )
    return MILLIMETRES[units.lower()]


def unit_told(told: str) -> str:
    """The unit that a report tells, "" where it is not known."""
    return "" if told == UNKNOWN else told


def lengths_in(units: str) -> str:
    """What a file's header says of its lengths."""
    return f"lengths in {units}" if units else "lengths in a unit that the run was not told"
