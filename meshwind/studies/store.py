"""The folder of a study: a folder per case, whole or not at all, and the table of all finished cases.

    cases/NAME/case.json     the case, its row, and its results beside it
    results.csv, .parquet    the rows in the study's order
    tradeoffs.png            the figures against the swept options

A case's folder is written under another name and renamed when it is complete: a case that has one is finished and is
not run again.
"""

import csv
import json
from collections.abc import Sequence
from pathlib import Path

from meshwind.core.errors import BadInputError
from meshwind.results.report import plain
from meshwind.results.staging import staged
from meshwind.studies.study import Case, CaseStatus, Row, Study
from meshwind.studies.work import Done

CASES, RECORD = "cases", "case.json"
CSV, PARQUET, PICTURE = "results.csv", "results.parquet", "tradeoffs.png"


class Store:
    """A study's folder."""

    def __init__(self, out: Path, study: Study) -> None:
        """Raises BadInputError where `out` cannot be a folder of results."""
        if out.exists() and not out.is_dir():
            raise BadInputError(f"{out} is a file; give a folder for the results")
        self.out, self.study = out, study
        self.rows: dict[int, Row] = {}
        for number, case in enumerate(study.cases):
            row = _stored_row(out / CASES / case.folder / RECORD, case.key)
            if row is not None:
                self.rows[number] = row

    @property
    def open(self) -> dict[int, Case]:
        """The cases that are left, by their numbers."""
        return {number: case for number, case in enumerate(self.study.cases) if number not in self.rows}

    def keep(self, number: int, done: Done) -> Row:
        """Write a finished case.  A lost one has a row but no folder, and is tried again the next time."""
        case = self.study.cases[number]
        row = _row(case, done)
        self.rows[number] = row
        if done.status == CaseStatus.LOST:
            return row
        folder = self.out / CASES / case.folder
        folder.parent.mkdir(parents=True, exist_ok=True)
        with staged(folder, lambda _: ()) as staging:
            for name, content in done.files.items():
                file = staging / name
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_bytes(content)
            record = {"key": case.key, "row": row}
            (staging / RECORD).write_text(json.dumps(record, indent=1, allow_nan=False) + "\n", encoding="utf-8")
        return row

    @property
    def table(self) -> list[Row]:
        """The rows of all finished cases, in the study's order, all with the same columns."""
        rows = [self.rows[number] for number in sorted(self.rows)]
        names = dict.fromkeys(name for row in rows for name in row)
        return [{name: row.get(name) for name in names} for row in rows]

    def write_table(self) -> None:
        """Write results.csv and results.parquet."""
        self.out.mkdir(parents=True, exist_ok=True)
        with staged(self.out, lambda _: ()) as staging:
            _write_csv(staging / CSV, self.table)
            _write_parquet(staging / PARQUET, self.table)


def _stored_row(record: Path, key: str) -> Row | None:
    """The row of a finished case, None where there is none."""
    try:
        stored = json.loads(record.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    row = stored.get("row") if isinstance(stored, dict) and stored.get("key") == key else None
    return row if isinstance(row, dict) else None


def _row(case: Case, done: Done) -> Row:
    """The options of a case, its status and its figures."""
    given = case.options.written()
    pins = None if case.options.pins is None else Path(case.options.pins).name
    row: Row = plain(
        {"case": case.key, "folder": case.folder, "mesh": case.mesh.name}
        | {"status": done.status.value, "reason": done.reason}
        | {name: given[name] for name in given if name != "paths"}
        | {"paths_a_family": case.options.paths, "pins": pins}
        | done.figures
    )
    return row


def _write_csv(path: Path, table: Sequence[Row]) -> None:
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, list(table[0]) if table else [])
        writer.writeheader()
        writer.writerows(table)


def _write_parquet(path: Path, table: Sequence[Row]) -> None:
    import pyarrow as arrow
    from pyarrow import parquet

    columns = {}
    for name in table[0] if table else ():
        values = [row[name] for row in table]
        mixed = len({isinstance(value, str) for value in values if value is not None}) > 1
        # a column has one type: one that holds both numbers and "auto" is text
        columns[name] = [None if value is None else str(value) for value in values] if mixed else values
    parquet.write_table(arrow.table(columns), path)
