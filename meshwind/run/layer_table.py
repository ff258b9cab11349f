"""The table of layers in a summary, as winding reports have it: cover, circuits, fibre, masses and thickness."""

from collections.abc import Sequence
from dataclasses import dataclass

from meshwind.appearance.words import quantity
from meshwind.results.pattern_types import CoverFigures, Spread
from meshwind.results.report_types import Report

_HEAD = ("layer", "circuits", "angle", "cover", "thickness", "median", "fibre", "fibre g", "resin g", "laminate g")
_MANY = 99.0
"""Cover above which a number says nothing any more."""
_UNKNOWN = "-"


@dataclass(frozen=True)
class _Row:
    """What the table says of a layer; None where it is not known."""

    name: str
    circuits: int
    angle: Spread | None
    cover: CoverFigures | None
    thickness: Spread | None
    length: float
    fibre: float | None
    resin: float | None

    def cells(self, units: str) -> list[str]:
        """The texts of its columns."""
        return [
            self.name,
            str(self.circuits),
            _range(self.angle, ".1f"),
            _covered(self.cover),
            _range(self.thickness, ".3g"),
            _number(None if self.thickness is None else self.thickness["median"], ".3g"),
            quantity(self.length, units),
            *_masses(self.fibre, self.resin),
        ]


def layer_table(report: Report, units: str) -> list[str]:
    """Lines of the table; none for a plain run whose band is not known."""
    rows = _rows(report)
    if not rows:
        return []
    table = [list(_HEAD), *(row.cells(units) for row in rows)]
    if len(rows) > 1:
        length = quantity(sum(row.length for row in rows), units)
        table.append(["all", "", "", "", "", "", length, *_masses(_sum([row.fibre for row in rows]),
                                                                  _sum([row.resin for row in rows]))])  # fmt: skip
    widths = [max(len(cells[k]) for cells in table) for k in range(len(_HEAD))]
    lines = ["  ".join([cells[0].ljust(widths[0]), *map(str.rjust, cells[1:], widths[1:])]) for cells in table]
    return [f"{'laminate' if not at else '':<10}{line.rstrip()}" for at, line in enumerate(lines)]


def _rows(report: Report) -> list[_Row]:
    layers = report.get("laminate")
    if layers:
        return [
            _Row(f"{each['layer'] + 1} {each['kind']}", each["circuits"], each["angle"], each["cover"],
                 each["thickness"], each["fibre_length"], each["fibre_mass"], each["resin_mass"])
            for each in layers
        ]  # fmt: skip
    patterns, fibre = report.get("pattern"), report["fibre"]
    if patterns:
        return [
            _Row(f"{number} helical", each["circuits"], each["angle"], each["cover"], each["thickness"],
                 each["fibre_length"], each["fibre_mass"], each["resin_mass"])
            for number, each in enumerate(patterns, 1)
        ]  # fmt: skip
    if fibre["fibre_mass"] is None and fibre["thickness"] is None:
        return []
    return [
        _Row("1 helical", report["winding"]["paths_per_family"], fibre["angle"], fibre["cover"], fibre["thickness"],
             fibre["length"], fibre["fibre_mass"], fibre["resin_mass"])
    ]  # fmt: skip


def _masses(fibre: float | None, resin: float | None) -> list[str]:
    """Masses of fibre, of resin and of both."""
    both = None if fibre is None or resin is None else fibre + resin
    return [_number(each, ".4g") for each in (fibre, resin, both)]


def _sum(values: Sequence[float | None]) -> float | None:
    """The sum, or None where one is not known."""
    known = [value for value in values if value is not None]
    return sum(known) if len(known) == len(values) else None


def _range(spread: Spread | CoverFigures | None, form: str) -> str:
    if spread is None:
        return _UNKNOWN
    return f"{_number(spread['min'], form)} to {_number(spread['max'], form)}"


def _covered(cover: CoverFigures | None) -> str:
    """The range of the cover factor, which is beyond all bounds where fibres turn back."""
    if cover is None or cover["max"] <= _MANY:
        return _range(cover, ".3f")
    return f"{_number(cover['min'], '.3f')} to over {_MANY:g}"


def _number(value: float | None, form: str) -> str:
    return _UNKNOWN if value is None else format(value, form)
