"""`meshwind sweep`: many windings from one file, as a table."""

from collections import Counter
from pathlib import Path
from typing import Annotated

import typer

from meshwind.cli.arguments import AsJson, Quiet
from meshwind.cli.display import counter
from meshwind.cli.help import FILES
from meshwind.cli.outcome import tell
from meshwind.cli.wind import UNSETTLED

EXAMPLES = """
    # study.toml: options of wind by their long names; lists are combined
    mesh = ["vase.stl", "cast.ply"]
    revolutions = [0.3, 0.5, "5/8", "auto"]
    friction = [0, 0.2]

    # all cases, a process a core, into study-swept/
    meshwind sweep study.toml

    # the same on a Dask cluster
    meshwind sweep study.toml --scheduler tcp://host:8786
"""
_WHERE = "Where it runs"


def sweep(
    study: Annotated[
        Path, typer.Argument(metavar="STUDY", help="TOML file: options of wind, with lists to sweep over.")
    ],
    processes: Annotated[
        int | None, typer.Option(help="Processes on this machine.  [default: one a core]", rich_help_panel=_WHERE)
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS",
            help="Dask scheduler that takes the cases, as in tcp://host:8786.",
            rich_help_panel=_WHERE,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(help="Folder for the results.  [default: STUDY's name + -swept]", rich_help_panel=FILES),
    ] = None,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Do anew what DIR holds already.", rich_help_panel=FILES)
    ] = False,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> int:
    """Wind every case of STUDY and write a table of their figures, charts, and a folder a case.

    A mesh is fitted once for all its windings.  A case that fails is a row with its reason.  Interrupted and started
    again, it goes on where it was.

    Exit status: 0 done; 1 the summary could not be printed; 2 bad input or usage; 3 done, but some cases failed, or
    have paths that did not come to rest (the table says which and why).
    """
    # the numerical libraries are imported late: --help and usage errors must not wait for them
    from meshwind.sweep import sweep as run

    folder = out if out is not None else Path(f"{study.stem}-swept")
    with counter("cases", quiet or as_json) as progress:
        swept = run(study, folder, processes=processes, scheduler=scheduler, overwrite=overwrite, progress=progress)
    how = Counter(row["status"] for row in swept.rows)
    reasons = Counter(row["reason"] for row in swept.rows if row["reason"])
    lines = [
        f"cases     {len(swept.rows)}: " + ", ".join(f"{many} {status}" for status, many in how.items()),
        f"done      {swept.anew} in this run, {len(swept.rows) - swept.anew} before",
        *(f"warning   {many} x {reason}" for reason, many in reasons.most_common(5)),
        f"table     {folder / 'results.csv'}, {folder / 'results.parquet'}",
    ]
    tell(lines, {"folder": str(folder), "anew": swept.anew, "rows": list(swept.rows)}, as_json, quiet)
    return 0 if swept.settled else UNSETTLED
