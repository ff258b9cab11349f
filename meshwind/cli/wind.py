"""`meshwind wind`: mesh in, paths out."""

import shlex
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from meshwind.cli.arguments import Files, MeshFile, Printed
from meshwind.cli.help import FILES
from meshwind.cli.output import print_report, stages
from meshwind.cli.signature import with_records
from meshwind.run.summary import run_lines
from meshwind.workflow.options import FIBRES, Options

NOT_CONVERGED = 3
EXAMPLES = """
    # results and pictures into part-wound/
    meshwind wind part.stl

    # more paths, 5/12 of a turn each, a part in inches
    meshwind wind part.stl --paths 24 --revolutions 5/12 --units in

    # cover a part with a band 6 mm wide; revolutions with stable paths and least bridging; friction
    meshwind wind part.stl --spacing 6 --band-width 6 --revolutions auto --friction 0.2

    # layers on layers: a helical one, hoops on it, and so on
    meshwind wind part.stl --layers laminate.toml

    # a closed part: open it at its ends in z, to a radius of 15
    meshwind wind part.stl --ends z --opening 15

    # repeat a run with more paths, in another folder
    meshwind wind --config part-wound/meshwind.toml --paths 48 --out denser
"""


@with_records
def wind(
    *,
    mesh: MeshFile,
    options: Options,
    layers: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="TOML file of a laminate: layers, helical or hoops, that are wound one on another.",
            rich_help_panel=FIBRES,
        ),
    ] = None,
    out: Annotated[
        str | None,
        typer.Option(help="Folder for the results.  [default: MESH's name + -wound]", rich_help_panel=FILES),
    ] = None,
    files: Files,
    printed: Printed,
) -> int:
    """Lay two families of taut fibres on MESH and write paths, bridges, crossings, quads, maps and a report.

    Exit status: 0 done; 1 the summary could not be printed; 2 bad input or usage; 3 done, but some paths did not
    converge (the report says which and why).
    """
    from meshwind.pictures.painter import start_probe

    if files.render:
        start_probe()  # it loads its libraries while this process loads its own
    # the numerical libraries are imported late: --help and usage errors must not wait for them
    from meshwind.run.wind import wind as run

    folder = out if out is not None else f"{mesh.stem}-wound"
    with stages(printed) as progress:
        result = run(
            mesh,
            **asdict(options),
            layers=layers,
            out=folder,
            overwrite=files.overwrite,
            render=files.render,
            command=command_line(),
            progress=progress,
        )
    report = result.report()
    print_report([*run_lines(report), f"files     {folder}"], report | {"folder": str(folder)}, printed)
    return 0 if result.settled else NOT_CONVERGED


def command_line() -> str:
    """The command as it was typed, for the report."""
    return shlex.join(["meshwind", *sys.argv[1:]])
