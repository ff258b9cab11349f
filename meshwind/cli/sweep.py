"""`meshwind sweep`: many windings from one file, as a table."""

from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from meshwind.cli.arguments import Printed
from meshwind.cli.help import FILES
from meshwind.cli.output import counter, print_report
from meshwind.cli.signature import with_records
from meshwind.cli.wind import NOT_CONVERGED

EXAMPLES = """
    # study.toml: options of wind by their long names; lists are combined
    mesh = ["vase.stl", "cast.ply"]
    revolutions = [0.3, 0.5, "5/8", "auto"]
    friction = [0, 0.2]

    # all cases, one process per core, into study-swept/
    meshwind sweep study.toml

    # the same on a Dask cluster
    meshwind sweep study.toml --scheduler tcp://host:8786
"""
_WHERE = "Where it runs"


@dataclass(frozen=True)
class Where:
    """Where the cases run."""

    processes: Annotated[
        int | None,
        typer.Option(help="Number of processes on this machine.  [default: one per core]", rich_help_panel=_WHERE),
    ] = None
    scheduler: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS",
            help="Address of a Dask scheduler that runs the cases instead, as in tcp://host:8786.",
            rich_help_panel=_WHERE,
        ),
    ] = None


@with_records
def sweep(
    *,
    study: Annotated[
        Path, typer.Argument(metavar="STUDY", help="TOML file: options of wind, with lists to sweep over.")
    ],
    where: Where,
    out: Annotated[
        Path | None,
        typer.Option(help="Folder for the results.  [default: STUDY's name + -swept]", rich_help_panel=FILES),
    ] = None,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Wind finished cases again.", rich_help_panel=FILES)
    ] = False,
    printed: Printed,
) -> int:
    """Wind every case of STUDY and write a table of their figures, charts, and a folder per case.

    A mesh is fitted once for all its windings.  A case that fails has a row with the reason.  An interrupted study
    goes on where it stopped when it is started again.

    Exit status: 0 done; 1 the summary could not be printed; 2 bad input or usage; 3 done, but some cases failed, or
    have paths that did not converge (the table says which and why).
    """
    # the numerical libraries are imported late: --help and usage errors must not wait for them
    from meshwind.studies.run import sweep as run

    with counter("cases", printed) as progress:
        swept = run(
            study,
            out,
            processes=where.processes,
            scheduler=where.scheduler,
            overwrite=overwrite,
            progress=progress,
        )
    states = Counter(row["status"] for row in swept.rows)
    reasons = Counter(row["reason"] for row in swept.rows if row["reason"])
    lines = [
        f"cases     {len(swept.rows)}: " + ", ".join(f"{many} {status}" for status, many in states.items()),
        f"done      {swept.anew} in this run, {len(swept.rows) - swept.anew} before",
        *(f"warning   {many} x {reason}" for reason, many in reasons.most_common(5)),
        f"table     {swept.folder / 'results.csv'}, {swept.folder / 'results.parquet'}",
    ]
    print_report(lines, {"folder": str(swept.folder), "anew": swept.anew, "rows": list(swept.rows)}, printed)
    return 0 if swept.settled else NOT_CONVERGED
