"""Tables of figures as CSV, everything together as results.json, and tables of the documentation as Markdown."""

import csv
import json
import os
import platform
from collections import Counter
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict, is_dataclass
from importlib.metadata import version
from pathlib import Path
from time import perf_counter, process_time
from typing import Any

from documentation.kept import Kept
from documentation.tables import TABLES


class Results:
    """The figures of a script, by chart; every table goes to its own CSV and into results.json."""

    def __init__(self, folder: Path, script: str, quick: bool) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self.folder = folder
        self._begin = perf_counter()
        self._all: dict[str, Any] = {"script": script, "quick": quick, "machine": machine()}

    def table(self, name: str, rows: Sequence[Any]) -> None:
        """Keep rows, dictionaries or dataclasses of the same fields, under a name."""
        plain = [asdict(row) if is_dataclass(row) and not isinstance(row, type) else dict(row) for row in rows]
        self._all[name] = plain
        if plain:
            fields = list(dict.fromkeys(key for row in plain for key in row))
            with (self.folder / f"{name}.csv").open("w", newline="", encoding="utf-8") as file:
                writer = csv.DictWriter(file, fields)
                writer.writeheader()
                writer.writerows(plain)

    def cells(self, result: str, tables: Sequence[str], method: str) -> list[dict[str, Any]]:
        """Rows with this result in some tables, of one method where the table has several."""
        return [
            dict(chart=name, **row)
            for name in tables
            for row in self._all.get(name, [])
            if row["result"] == result and row.get("method", method) == method
        ]

    def outcomes(self) -> list[dict[str, Any]]:
        """How many cells of each table that is a map ended how, by method."""
        count: Counter[tuple[str, str, str]] = Counter()
        for name, rows in self._all.items():
            if isinstance(rows, list) and rows and "result" in rows[0]:
                count.update((name, row.get("method", ""), row["result"]) for row in rows)
        return [dict(chart=c, method=m, result=r, cells=cells) for (c, m, r), cells in count.items()]

    def finish(self, summary: str) -> None:
        """Write results.json with the seconds of the run, and print a line that begins with a summary."""
        wall, processor = perf_counter() - self._begin, process_time()
        self.table("run", [dict(seconds=wall, processor_seconds=processor)])
        self.write()
        if not self._all["quick"]:
            self._markdown()
        print(f"{summary}, {wall:.0f} s ({processor:.0f} s of a core); charts in {self.folder}")

    def _markdown(self) -> None:
        """Write the tables of the documentation that the folder has all results for, as they stand there."""
        for name, table in TABLES.items():
            with suppress(FileNotFoundError):
                (self.folder / f"{name}.md").write_text(table(Kept(self.folder)) + "\n", encoding="utf-8")

    def progress(self, what: str) -> None:
        """Print what is done or begun, and the seconds since the script's start."""
        print(f"{what}: {perf_counter() - self._begin:.0f} s", flush=True)

    def write(self) -> None:
        """Write results.json."""
        text = json.dumps(self._all, indent=1, default=str)
        (self.folder / "results.json").write_text(text + "\n", encoding="utf-8")


def machine() -> dict[str, Any]:
    """The processor and the libraries, on which the seconds depend."""
    names = ("numpy", "scipy", "numba", "libigl")
    return {
        "processor": processor(),
        "cores": os.cpu_count(),
        "python": platform.python_version(),
        **{name: version(name) for name in names},
    }


def processor() -> str:
    """The processor's name, where the system gives it."""
    info = Path("/proc/cpuinfo")
    if info.exists():
        for line in info.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()
