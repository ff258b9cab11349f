"""The counts that are kept beside this module, and what has grown since."""

import csv
from collections.abc import Mapping
from pathlib import Path

FILE = Path(__file__).with_name("counts.csv")
GROWTH = 0.02
"""Relative growth of a count up to which nothing is said.

It leaves room for another processor or library, whose last digits can cost a path a step more or less."""

Counts = Mapping[str, Mapping[str, int]]


def kept() -> dict[str, dict[str, int]]:
    """The counts of the file, by job and name; none where there is no file yet."""
    found: dict[str, dict[str, int]] = {}
    if not FILE.exists():
        return found
    with FILE.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            found.setdefault(row["job"], {})[row["count"]] = int(row["value"])
    return found


def keep(counts: Counts) -> None:
    """Write the file anew."""
    with FILE.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["job", "count", "value"])
        writer.writerows([job, name, value] for job, row in counts.items() for name, value in sorted(row.items()))


def grown(now: Counts, then: Counts) -> list[str]:
    """A line for each count that is larger than it was by more than `GROWTH`, or that was not there."""
    return [
        f"{job}: {name} {then.get(job, {}).get(name, 0)} -> {value}"
        for job, row in now.items()
        for name, value in row.items()
        if value > (1.0 + GROWTH) * then.get(job, {}).get(name, 0)
    ]
