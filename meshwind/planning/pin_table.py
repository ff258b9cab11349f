"""Tables of pins in text: CSV as spreadsheets of any language write it."""

import codecs
import csv
import re
from collections.abc import Collection
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import shortened

_SEPARATORS = {";": "semicolons", "\t": "tabs", ",": "commas", "|": "bars", " ": "blanks"}
"""What may part the columns, with its name; the row of names determines which one does."""
_UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
_SEP_LINE = re.compile(r'"?sep=(.)"?', re.IGNORECASE)
"""First line by which a file tells a spreadsheet its separator."""
_GROUPED = re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+")
"""A number whose commas may group its digits by thousands."""
_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(\.\d{3})+,\d*")
"""A number whose points group its digits by thousands, before a decimal comma."""


@dataclass(frozen=True)
class PinTable:
    """Column names, the cells of all rows, and the line of the file that each row is on, from 1.

    separator: what parts the columns.
    """

    file: str
    names: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    lines: Ints
    separator: str

    @property
    def parted(self) -> str:
        """What parts the columns, in words."""
        return _SEPARATORS.get(self.separator, repr(self.separator))

    def has(self, names: Collection[str]) -> bool:
        """Whether there are columns of all these names."""
        return set(names) <= set(self.names)

    def numbers(self, names: Collection[str]) -> Floats:
        """The columns of these names, (rows, columns).  Raises BadInputError where a cell is not a number."""
        at = [self.names.index(name) for name in names]
        cells = [[row[k] for k in at] for row in self.rows]
        if any("," in cell for row in cells for cell in row):
            self._check_commas(cells)
        values = np.empty((len(cells), len(at)))
        for number, row in enumerate(cells):
            try:
                values[number] = [_number(cell) for cell in row]
            except ValueError as error:
                raise self.not_numbers(int(self.lines[number])) from error
        wrong = np.flatnonzero(~np.isfinite(values).all(axis=1))
        if len(wrong):
            raise BadInputError(f"{self.file}: row {self.lines[wrong[0]]} holds NaN or infinite values; mend it")
        return values

    def not_numbers(self, line: int) -> BadInputError:
        """Error on a row whose cells are not numbers, or too few."""
        return BadInputError(
            f"{self.file}: row {line} is not {len(self.names)} numbers, parted by {self.parted} like the names; mend it"
        )

    def _check_commas(self, cells: list[list[str]]) -> None:
        """Refuse commas in numbers, where they may be something else than the decimal sign."""
        which = {
            sign: int(self.lines[next(k for k, row in enumerate(cells) if any(sign in cell for cell in row))])
            for sign in ",."
            if any(sign in cell for row in cells for cell in row)
        }
        both = next((cell for row in cells for cell in row if _THOUSANDS.fullmatch(cell)), None)
        if both is not None:
            raise BadInputError(
                f"{self.file}: {both!r} has a point between its thousands; save the numbers without a sign of thousands"
            )
        if "." in which:
            raise BadInputError(
                f"{self.file}: row {which[',']} has a comma in a number and row {which['.']} a point, with columns "
                f"parted by {self.parted}; write all decimals with points"
            )
        # where semicolons part the columns, the comma is the decimal sign of the spreadsheet's language
        grouped = all(_GROUPED.fullmatch(cell) for row in cells for cell in row if "," in cell)
        if grouped and self.separator != ";":
            raise BadInputError(
                f"{self.file}: row {which[',']} has a comma in a number, which may part decimals or thousands; write "
                "decimals with points, and thousands without a sign"
            )


def read_table(path: Path, kinds: Collection[Collection[str]]) -> PinTable:
    """Read a file of rows below a row of names, which has all columns of one of the kinds.

    Columns are parted by what parts the names: commas, semicolons, tabs or blanks.  Unless it parts the columns, a
    comma may be the decimal sign.  Blank lines and lines that begin with # are left out, but the names may follow a #.
    """
    none = f"{path.name}: holds no pins; give a row of column names, then a row per path"
    lines = _lines(path)
    separators = list(_SEPARATORS)
    if lines and (named := _SEP_LINE.fullmatch(lines[0].strip(" "))):
        lines[0], separators = "", [named[1]]
    filled = [(number, line.strip(" ")) for number, line in enumerate(lines, start=1) if line.strip(" \t;,|")]
    rows = [(number, line) for number, line in filled if not line.startswith("#")]
    # the row of names may be a comment; what is above it is none of the pins
    above = [(number, line.removeprefix("#")) for number, line in filled if not rows or number < rows[0][0]]
    for _, line in above + rows[:1]:
        found = _header(line, separators, kinds)
        if found is not None:
            break
    else:
        raise _no_names(path.name, rows[0][1], separators, kinds) if rows else BadInputError(none)
    names, separator = found
    rest = rows[1:] if rows and line is rows[0][1] else rows
    doubled = next((name for name in names if name and names.count(name) > 1), "")
    if doubled:
        raise BadInputError(f"{path.name}: two columns are named {doubled}; leave one of them out")
    if not rest:
        raise BadInputError(none)
    table = PinTable(path.name, names, (), np.array([at for at, _ in rest], dtype=np.int64), separator)
    return replace(table, rows=tuple(_row(table, at, line) for at, line in rest))


def _lines(path: Path) -> list[str]:
    """The lines of a text file, in UTF-8 or, with a byte order mark, in UTF-16."""
    try:
        data = path.read_bytes()
    except FileNotFoundError as error:
        raise BadInputError(f"{path}: there is no such file; give a CSV file of pins") from error
    except (OSError, ValueError) as error:
        raise BadInputError(f"{path}: cannot be read as CSV; give a text file of comma-separated numbers") from error
    try:
        text = data.decode("utf-16" if data.startswith(_UTF_16) else "utf-8-sig")
        if "\0" in text:
            raise ValueError("no text")
    except ValueError as error:
        raise BadInputError(
            f"{path.name}: cannot be read as CSV, as it is not text in UTF-8; save it as 'CSV UTF-8'"
        ) from error
    return re.split("\r\n|\r|\n", text)


def _header(line: str, separators: list[str], kinds: Collection[Collection[str]]) -> tuple[tuple[str, ...], str] | None:
    """Column names and what parts them, None if it is not a row of names of any kind."""
    for separator in separators:
        cells = _cells(line, separator)
        names = tuple(cell.lower() for cell in cells or ())
        if any(set(kind) <= set(names) for kind in kinds):
            return names, separator
    return None


def _cells(line: str, separator: str) -> list[str] | None:
    """The cells of a line without trailing separators; None if its quotation marks are wrong."""
    try:
        rows = csv.reader([line.strip(" ")], delimiter=separator, skipinitialspace=True, strict=True)
        cells = [cell.strip() for cell in next(rows)]
    except (csv.Error, TypeError, ValueError):  # the latter two of a separator that cannot be one
        return None
    while cells and not cells[-1]:
        cells.pop()
    return cells


def _row(table: PinTable, line: int, text: str) -> tuple[str, ...]:
    """The cells of a row, as many as there are names; those of trailing separators are empty."""
    cells, count = _cells(text, table.separator), len(table.names)
    if cells is not None and len(cells) == count:
        return tuple(cells)
    other = next((sign for sign in _SEPARATORS if len(_cells(text, sign) or ()) == count and count > 1), "")
    if other and other != " ":
        raise BadInputError(
            f"{table.file}: row {line} is parted by {_SEPARATORS[other]}, but the names by "
            f"{table.parted}; part all by the same sign"
        )
    if table.separator == "," and cells is not None and count < len(cells) <= 2 * count:
        raise BadInputError(
            f"{table.file}: row {line} is not {count} numbers, as commas part both columns and decimals; write "
            "decimals with points, or part columns by semicolons"
        )
    if cells is not None and 1 < len(cells) < count:
        return (*cells, *[""] * (count - len(cells)))  # the last ones, such as remarks, may be empty
    raise table.not_numbers(line)


def _no_names(name: str, line: str, separators: list[str], kinds: Collection[Collection[str]]) -> BadInputError:
    """Why the first row is not one of names."""
    columns = " or ".join(",".join(kind) for kind in kinds)
    for separator in separators:
        try:
            if [_number(cell.replace(",", ".")) for cell in _cells(line, separator) or ()]:
                return BadInputError(f"{name}: its first row is numbers; name the columns above: {columns}")
        except ValueError:
            pass
    return BadInputError(f"{name}: its first row is {shortened(line)!r}; name the columns {columns}")


def _number(cell: str) -> float:
    """A number as spreadsheets write it: with the decimal sign of their language and any minus sign."""
    if "_" in cell:
        raise ValueError("an underscore is no digit")
    return float(cell.replace(",", ".").replace("\N{MINUS SIGN}", "-"))
