"""Units of length: names, sizes, and how files name them."""

from dataclasses import dataclass, replace

from meshwind.core.errors import BadInputError
from meshwind.core.parsing import shortened

UNKNOWN = "unknown"
"""Unit in a report if it is not known."""
ASSUMED = "mm"
"""Unit of a file that names none: that of most meshes of parts."""
GIVEN, BY_FILE, BY_DEFAULT = "given", "file", "default"
"""Who named the unit of a mesh: the user, its file, or nobody, so that it is assumed."""

MILLIMETRES = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "um": 1e-3, "in": 25.4, "inch": 25.4, "ft": 304.8}
"""Length of a unit in mm."""


@dataclass(frozen=True)
class Unit:
    """Unit of a mesh: its name, "" if it is not known, who named it, and a warning if it outranks another."""

    name: str = ""
    named_by: str = ""
    warning: str = ""

    @classmethod
    def of(cls, given: str | None, in_file: str, assumed: str = "") -> "Unit":
        """The unit that a user gives, or else the one that the file names, or else the one that is assumed.

        given is None if none is given; the others are "" if there is none.  Raises BadInputError for an unknown unit.
        """
        if given is None:
            return cls(in_file, BY_FILE) if in_file else cls(assumed, BY_DEFAULT if assumed else "")
        check_units(given)
        unit = cls(given, GIVEN if given else "")
        if not in_file or (given and millimetres(given) == millimetres(in_file)):
            return unit
        taken = given or "an unknown unit"
        text = f"lengths are taken in {taken}, as given, though the file says {in_file}; nothing is converted"
        return replace(unit, warning=text)


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
