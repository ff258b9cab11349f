"""Run a study: what is done already stays, the rest is wound, and the table grows with each case."""

import os
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import Any

from meshwind.core.errors import BadInputError
from meshwind.sweep.charts import draw_tradeoffs
from meshwind.sweep.jobs import batches
from meshwind.sweep.store import CASES, PICTURE, Store
from meshwind.sweep.study import Study, read_study
from meshwind.sweep.work import Done

Tell = Callable[[str, int, int], None]
"""Called with a case that is done, how many are, and how many there are."""
TABLE_SECONDS = 10.0
"""So often at most the table is written while cases come in."""


@dataclass(frozen=True)
class Swept:
    """A study that was run: its rows, and how many of the cases were done anew."""

    study: Study
    rows: tuple[dict[str, Any], ...]
    anew: int
    folder: Path

    @property
    def settled(self) -> bool:
        """Whether every path of every case came to rest."""
        return all(row["status"] == "at rest" for row in self.rows)


def sweep(
    study: str | Path | Study,
    out: str | Path,
    *,
    processes: int | None = None,
    scheduler: str | None = None,
    overwrite: bool = False,
    tell: Tell | None = None,
) -> Swept:
    """Wind all cases of a study into `out`, each once, and write their table.

    study: a TOML file or what was read of one; processes: on this machine, by default one a core; scheduler: address
    of a Dask scheduler that takes the cases instead; overwrite: do anew what is done already.  A case that fails is
    a row with its reason.  Interrupted, a study goes on where it was.  Raises BadInputError for a study that makes no
    sense, or a folder that cannot be written.
    """
    if processes is not None and (isinstance(processes, bool) or not isinstance(processes, int) or processes < 1):
        raise BadInputError(f"processes is {processes}; give a whole number from 1 up")
    plan = study if isinstance(study, Study) else read_study(study)
    folder = Path(out)
    if overwrite and (folder / CASES).is_dir():
        shutil.rmtree(folder / CASES)
    store = Store(folder, plan)
    before, written = len(store.rows), monotonic()
    for number, done in _run(store, processes, scheduler):
        row = store.keep(number, done)
        if tell is not None:
            tell(row["folder"], len(store.rows), len(plan))
        if monotonic() - written > TABLE_SECONDS:
            store.write_table()
            written = monotonic()
    store.write_table()
    draw_tradeoffs(folder / PICTURE, store.table, plan.swept)
    return Swept(plan, tuple(store.table), len(store.rows) - before, folder)


def _run(store: Store, processes: int | None, scheduler: str | None) -> Iterator[tuple[int, Done]]:
    """The runner at work on what is not done yet."""
    todo = batches(store.open)
    if scheduler is not None:
        from meshwind.sweep.cluster import run_cluster

        return run_cluster(todo, scheduler)
    from meshwind.sweep.local import run_local

    return run_local(todo, min(processes or _cores(), max(len(store.open), 1)))


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
