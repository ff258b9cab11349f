"""The tables of results that the documentation rests on, as they are kept, and which of their lines were read."""

import csv
from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path

RESULTS = Path(__file__).parents[1] / "benchmarks" / "results"
"""Folder of the tables that are kept."""


class Row(dict[str, str]):
    """A line of a table: texts by column, and numbers."""

    def __call__(self, column: str) -> float:
        """The number in a column."""
        return float(self[column])

    def has(self, column: str, wanted: object) -> bool:
        """Whether a column holds a text, a number, or one of several."""
        if isinstance(wanted, tuple):
            return any(self.has(column, each) for each in wanted)
        if isinstance(wanted, int | float) and not isinstance(wanted, bool):
            return self[column] != "" and float(self[column]) == wanted
        return self[column] == str(wanted)


class Kept:
    """The tables of a folder; notes the lines that are read, so that a figure can be traced to them."""

    def __init__(self, folder: Path = RESULTS) -> None:
        self._folder = folder
        self._tables: dict[str, list[Row]] = {}
        self.lines: dict[str, set[int]] = defaultdict(set)
        """Numbers of the lines that were read, by table; the one with the names of the columns is 1."""

    def rows(self, table: str, **where: object) -> list[Row]:
        """The lines whose columns hold what is wanted."""
        if table not in self._tables:
            with (self._folder / f"{table}.csv").open(encoding="utf-8", newline="") as file:
                self._tables[table] = [Row(row) for row in csv.DictReader(file)]
        rows = self._tables[table]
        found = [k for k, row in enumerate(rows) if all(row.has(*each) for each in where.items())]
        self.lines[table] |= {k + 2 for k in found}
        return [rows[k] for k in found]

    def row(self, table: str, **where: object) -> Row:
        """The only such line."""
        found = self.rows(table, **where)
        if len(found) != 1:
            raise LookupError(f"{table}.csv has {len(found)} lines with {where}")
        return found[0]

    def has(self, table: str) -> bool:
        """Whether the folder has a table."""
        return (self._folder / f"{table}.csv").is_file()


def spans(lines: Sequence[int]) -> str:
    """Numbers of lines in short: "2-5 8"."""
    out: list[list[int]] = []
    for line in sorted(lines):
        if out and line == out[-1][1] + 1:
            out[-1][1] = line
        else:
            out.append([line, line])
    return " ".join(str(a) if a == b else f"{a}-{b}" for a, b in out)
