"""Run a study: finished cases stay, the others are wound, and the table grows with each of them."""

import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from time import monotonic

from meshwind.core.brief import brief
from meshwind.core.errors import BadInputError
from meshwind.core.processes import cores
from meshwind.studies.charts import draw_tradeoffs
from meshwind.studies.store import CASES, PICTURE, Store
from meshwind.studies.study import CaseStatus, Row, Study, read_study
from meshwind.studies.work import Done, grouped

CaseProgress = Callable[[str, int, int], None]
"""Called with the name of a finished case, how many are finished, and how many there are."""
TABLE_SECONDS = 10.0
"""Least time between two writings of the table while cases come in."""


@dataclass(frozen=True)
class Swept:
    """A study that was run: its rows, and how many of the cases were wound this time."""

    study: Study
    rows: tuple[Row, ...]
    anew: int
    folder: Path

    __repr__ = brief

    @property
    def settled(self) -> bool:
        """Whether every path of every case converged."""
        return all(row["status"] == CaseStatus.AT_REST for row in self.rows)


def sweep(
    study: str | Path | Study,
    out: str | Path,
    *,
    processes: int | None = None,
    scheduler: str | None = None,
    overwrite: bool = False,
    progress: CaseProgress | None = None,
) -> Swept:
    """Wind all cases of a study into `out`, each once, and write their table.

    study: a TOML file, or a study read from one; processes: number of them on this machine, by default one per core;
    scheduler: address of a Dask scheduler that runs the cases instead; overwrite: wind finished cases again;
    progress: called after each case.  A case that fails has a row with the reason.  An interrupted study goes on where
    it stopped.  Raises BadInputError for a study that cannot be read, or a folder that cannot be written.
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
        if progress is not None:
            progress(str(row["folder"]), len(store.rows), len(plan))
        if monotonic() - written > TABLE_SECONDS:
            store.write_table()
            written = monotonic()
    store.write_table()
    draw_tradeoffs(folder / PICTURE, store.table, plan.swept)
    return Swept(plan, tuple(store.table), len(store.rows) - before, folder)


def _run(store: Store, processes: int | None, scheduler: str | None) -> Iterator[tuple[int, Done]]:
    """Run the cases that are left, here or on a cluster."""
    groups = grouped(store.open)
    if scheduler is not None:
        from meshwind.studies.cluster import run_cluster

        return run_cluster(groups, scheduler)
    from meshwind.studies.local import run_local
    from meshwind.workflow.compiling import compile_for

    if store.open:
        compile_for(case.options for case in store.open.values())  # once, and not in every process
    return run_local(groups, min(processes or cores(), max(len(store.open), 1)))
