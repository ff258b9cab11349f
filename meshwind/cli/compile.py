"""`meshwind compile`: compile all kernels ahead."""

import typer

from meshwind.cli.arguments import Printed
from meshwind.cli.output import print_report, stages
from meshwind.cli.signature import with_records
from meshwind.core.errors import BadInputError

NOT_KEPT = 2
EXAMPLES = """
    # once after installing, so that no run waits for it
    meshwind compile

    # in an image whose users cannot write where it is installed
    NUMBA_CACHE_DIR=/opt/kernels meshwind compile
"""


@with_records
def compile(*, printed: Printed) -> int:
    """Compile all kernels for this machine ahead, on all cores, and say where they are kept.

    Without it each run compiles what it lacks.  Kernels fit one kind of processor, one version of Python and of Numba;
    on another they are compiled again.

    Exit status: 0 done; 1 the summary could not be printed; 2 bad input or usage, or they cannot be kept.
    """
    from meshwind.core.compile_ahead import compile_ahead, left_out, table, where

    folder = where()
    if folder is None:
        raise BadInputError(
            "compiled kernels cannot be kept: no folder for them can be written; "
            "set NUMBA_CACHE_DIR to one that can"
        )  # fmt: skip
    with stages(printed) as progress:
        missing = compile_ahead(progress=progress, worth=0.0)
    left = left_out()
    if left:
        typer.echo(
            f"meshwind: error: {left} kernels could not be compiled or kept; give them a folder with room for "
            "20 MB by NUMBA_CACHE_DIR, or run it again if its processes were ended",
            err=True,
        )
    lines = [
        f"kernels   {len(table())}: {missing - left} compiled, {len(table()) - missing} kept already",
        f"folder    {folder}",
    ]
    figures = {"kernels": len(table()), "compiled": missing - left, "left_out": left, "folder": str(folder)}
    print_report(lines, figures, printed)
    return NOT_KEPT if left else 0
