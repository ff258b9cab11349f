"""Units of length: names, spellings, sizes, and how files name them."""

import unicodedata
from dataclasses import dataclass, replace

from meshwind.core.errors import BadInputError
from meshwind.core.parsing import shortened
from meshwind.core.spoken import argument

UNKNOWN = "unknown"
"""Unit in a report if it is not known."""
ASSUMED = "mm"
"""Unit of a file that names none: that of most meshes of parts."""
GIVEN, BY_FILE, BY_DEFAULT = "given", "file", "default"
"""Who named the unit of a mesh: the user, its file, or nobody, so that it is assumed."""
OF_3MF, OF_GLTF = "the default of 3MF", "as glTF always is"
"""The same where the format names it, in words."""
_CONVERTED = "converted from "
"""The same where the lengths of the file were converted; the file's own unit follows."""

MILLIMETRES = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "um": 1e-3, "in": 25.4, "ft": 304.8}
"""Length of a unit in mm."""
_SPELLINGS = {
    "mm": "mm millimeter millimeters millimetre millimetres",
    "cm": "cm centimeter centimeters centimetre centimetres",
    "m": "m meter meters metre metres",
    "um": "um \u03bcm micron microns micrometer micrometers micrometre micrometres",
    "in": 'in inch inches " \u2032\u2032',
    "ft": "ft foot feet ' \u2032",
}
"""What units are called, in lower case and as Unicode's NFKC has it: a Greek mu, and a double prime as two."""
_NAMES = {word: name for name, words in _SPELLINGS.items() for word in words.split()}
_LEAST, _MOST = 1.0, 1e5
"""Lengths in mm of parts that are wound: bands are wider than the least, the longest blades as long as the most.

A part in metres that is taken for one in mm, or the reverse, is a thousand times off.
"""
_DOUBTED = {BY_DEFAULT: "is assumed", OF_3MF: f"is {OF_3MF}", OF_GLTF: "is the unit of glTF"}
"""Who named a unit, where the file does not itself, in words."""


@dataclass(frozen=True)
class Unit:
    """Unit of a mesh: its name, "" if it is not known, who named it, and a warning if it outranks another."""

    name: str = ""
    named_by: str = ""
    warning: str = ""

    @classmethod
    def of(cls, given: str | None, held: "Unit", assumed: str = "") -> "Unit":
        """The unit that a user gives, or else that of the file, or else the one that is assumed.

        given is None if none is given; the name of `held`, the file's unit as it is spelled there, and `assumed` are ""
        if there is none.  Raises BadInputError if the given unit is not known, or another than converted lengths have.
        """
        in_file = unit_named(held.name)
        if given is None:
            unit = cls(in_file, held.named_by) if in_file else cls(assumed, BY_DEFAULT if assumed else "")
            unknown = f"names the unit {shortened(repr(held.name))}, which is not known; give {argument('units')}"
            return replace(unit, warning=unknown) if held.name and not in_file else unit
        check_units(given)
        unit = cls(unit_named(given), GIVEN if given else "")
        if not in_file or unit.name == in_file:
            return unit
        if given and held.named_by.startswith(_CONVERTED):
            raise BadInputError(
                f"units is {given!r}, but the lengths of the file are {in_file!r}, {held.named_by!r}; leave "
                f"{argument('units')} out"
            )
        taken = repr(unit.name) if given else "an unknown unit"
        says, instead = f"the file says {in_file!r}", f"; leave {argument('units')} out for {in_file!r}"
        if held.named_by != BY_FILE:  # where programs often write another unit than the format's
            says, instead = f"the file is in {in_file!r}, {held.named_by}", ""
        text = f"lengths are taken in {taken}, as given, though {says}; nothing is converted{instead}"
        return replace(unit, warning=text)

    def doubt(self, length: float) -> str:
        """Words on a part whose length is implausible in a unit that the file does not name itself; "" if it is not."""
        if self.named_by not in _DOUBTED or _LEAST <= length * millimetres(self.name) <= _MOST:
            return ""
        return (
            f"the part is {length:.3g} {self.name} long, where {self.name} {_DOUBTED[self.named_by]}; give "
            f"{argument('units')} if its lengths are in another unit"
        )


def converted_from(unit: str) -> str:
    """Who named the unit of lengths that were converted from another one."""
    return f"{_CONVERTED}{unit}"


def unit_named(word: str) -> str:
    """The unit that a word stands for in any usual spelling, "" if it is not known."""
    return _NAMES.get(unicodedata.normalize("NFKC", word).strip().removesuffix(".").casefold(), "")


def check_units(units: object) -> None:
    """Raise BadInputError unless `units` is the name of a unit, or "" for an unknown one."""
    if not isinstance(units, str) or (units and not unit_named(units)):
        raise BadInputError(
            f'units is {shortened(repr(units))}; give {", ".join(MILLIMETRES)}, or "" where the unit is not known'
        )


def millimetres(units: str) -> float:
    """Length of a unit in mm; "" counts as mm.  Raises BadInputError for any other name."""
    if not units:
        return 1.0
    name = unit_named(units)
    if not name:
        raise BadInputError(
            f"the run's unit {units!r} has no known length; wind with {argument('units')} "
            f"{' or '.join(sorted(MILLIMETRES))}"
        )
    return MILLIMETRES[name]


def reported_unit(units: str) -> str:
    """Unit as a report names it, "" if it is not known."""
    return "" if units == UNKNOWN else units


def lengths_in(units: str) -> str:
    """Words on the unit for a file's header."""
    return f"lengths in {units}" if units else "lengths in an unknown unit"
