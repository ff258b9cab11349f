"""Legends of CSV files: a file beside each with the unit and the meaning of its columns.

The tables themselves begin with their names, as readers expect, and have no comments.
"""

import csv
from collections.abc import Mapping
from pathlib import Path
from typing import TypeAlias

from meshwind.core.units import UNKNOWN

Legend: TypeAlias = Mapping[str, tuple[str, str]]
"""Unit and meaning of each column by its name; "{u}" in a unit stands for that of lengths."""
_HEAD = "column", "unit", "meaning"


def write_legend(path: Path, legend: Legend, units: str) -> None:
    """Write a row for each column; units: the name of the unit of length, "" where it is not known."""
    with path.open("w", encoding="ascii", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(_HEAD)
        for column, (unit, meaning) in legend.items():
            writer.writerow((column, unit.format(u=units or UNKNOWN), meaning))
