"""Run a study: finished cases stay, the others are wound, and the table grows with each of them."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Any

from meshwind.core.brief import brief
from meshwind.core.errors import BadInputError
from meshwind.core.processes import cores
from meshwind.core.table import as_columns, data_frame
from meshwind.studies.charts import draw_tradeoffs
from meshwind.studies.store import CASES, PICTURE, Store
from meshwind.studies.study import CaseStatus, Row, Study, read_study
from meshwind.studies.work import Done, grouped

if TYPE_CHECKING:
    import pandas

CaseProgress = Callable[[str, int, int], None]
"""Called with the name of a finished case, how many are finished, and how many there are."""
TABLE_SECONDS = 10.0
"""Least time between two writings of the table while cases come in."""


@dataclass(frozen=True)
class Swept:
    """A study that was run.

    Attributes
    ----------
    study : Study
        Its cases.
    rows : tuple of dict
        Rows of the table: options, status and figures of each case.
    anew : int
        How many of the cases were wound this time.
    folder : Path
        Folder of the results.

    Examples
    --------
    >>> import meshwind as mw
    >>> swept = mw.sweep({"mesh": "data/tank.ply", "paths": 3, "particles": 51}, processes=1)
    >>> swept.anew, swept.settled, str(swept.folder)
    (1, True, 'study-swept')
    """

    study: Study
    rows: tuple[Row, ...]
    anew: int
    folder: Path

    __repr__ = brief

    @property
    def settled(self) -> bool:
        """Whether every path of every case converged."""
        return all(row["status"] == CaseStatus.AT_REST for row in self.rows)

    def to_dataframe(self) -> pandas.DataFrame:
        """Give the table to pandas.

        Returns
        -------
        pandas.DataFrame
            A row for each case, with the columns of results.csv.

        Raises
        ------
        BadInputError
            If pandas is not installed.

        Examples
        --------
        >>> import meshwind as mw
        >>> swept = mw.sweep({"mesh": "data/tank.ply", "paths": 3, "particles": 51}, processes=1)
        >>> swept.to_dataframe()["status"].tolist()
        ['at rest']
        """
        return data_frame(as_columns(self.rows))


def sweep(
    study: str | PathLike[str] | Mapping[str, Any] | Study,
    out: str | PathLike[str] | None = None,
    *,
    processes: int | None = None,
    scheduler: str | None = None,
    overwrite: bool = False,
    progress: CaseProgress | None = None,
) -> Swept:
    """Wind all cases of a study, each once, and write a table of their figures, charts, and a folder per case.

    A mesh is fitted once for all its windings.  A case that fails has a row with the reason.  An interrupted study goes
    on where it stopped when it is started again.

    Parameters
    ----------
    study : str, PathLike, mapping or Study
        TOML file of a study, or what it would hold: options of `wind` by their names, and "mesh", with lists to sweep
        over.
    out : str or PathLike, optional
        Folder for the results.  By default the file's name with "-swept", "study-swept" for a mapping.
    processes : int, optional
        Number of processes on this machine.  By default one per core.
    scheduler : str, optional
        Address of a Dask scheduler that runs the cases instead, as in "tcp://host:8786".
    overwrite : bool, default False
        Whether to wind finished cases again.
    progress : callable, optional
        Called with the name of a finished case, how many are finished, and how many there are.

    Returns
    -------
    Swept
        The rows of the table.

    Raises
    ------
    BadInputError
        If the study cannot be read, or the folder cannot be written.

    See Also
    --------
    wind : Wind one part.

    Examples
    --------
    >>> import meshwind as mw
    >>> study = {"mesh": "data/tank.ply", "paths": 3, "particles": 51, "revolutions": [0.2, 0.3]}
    >>> swept = mw.sweep(study, "swept", processes=1)
    >>> [(row["revolutions"], row["status"]) for row in swept.rows]
    [(0.2, 'at rest'), (0.3, 'at rest')]
    """
    if processes is not None and (isinstance(processes, bool) or not isinstance(processes, int) or processes < 1):
        raise BadInputError(f"processes is {processes}; give a whole number from 1 up")
    plan = study if isinstance(study, Study) else read_study(study)
    folder = Path(f"{_name(study)}-swept" if out is None else out)
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


def _name(study: str | PathLike[str] | Mapping[str, Any] | Study) -> str:
    return Path(study).stem if isinstance(study, str | PathLike) else "study"


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
