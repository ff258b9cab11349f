"""`meshwind solve`: the shell deck of a folder by CalculiX, and how near its plies are to failure."""

from pathlib import Path
from typing import Annotated

import typer

from meshwind.cli.arguments import OtherFolder, Printed
from meshwind.cli.help import FILES
from meshwind.cli.output import print_report, stages
from meshwind.cli.signature import with_records

EXAMPLES = """
    # a deck under a pressure of 10 MPa inside, and what CalculiX makes of it
    meshwind export part-wound --to inp --thickness 0.4 --pressure 10
    meshwind solve part-wound

    # with a CalculiX that is not on the path
    meshwind solve part-wound --ccx /opt/calculix/ccx_2.21
"""

DeckFolder = Annotated[
    Path, typer.Argument(metavar="DIR", help="Folder with the deck of `meshwind export DIR --to inp`.")
]


@with_records
def solve(
    *,
    folder: DeckFolder,
    ccx: Annotated[
        str,
        typer.Option(metavar="PROGRAM", help="CalculiX's program: its name, or its path.", rich_help_panel=FILES),
    ] = "ccx",
    out: OtherFolder = None,
    render: Annotated[
        bool, typer.Option("--render/--no-render", help="Draw the picture.", rich_help_panel=FILES)
    ] = True,
    printed: Printed,
) -> int:
    """Solve the shell deck of a run with CalculiX, and hold its stresses against the strengths of the plies.

    solved.vtu: displacements, and for each ply stresses and strains in the axes of its fibres, with the exposure of the
    worst ply of each element: the load over that which makes it fail, by Tsai and Wu.  solved.json, solved.png: the
    same in figures and as a picture.
    """
    from meshwind.run.solve import solve_deck

    with stages(printed) as progress:
        done = solve_deck(folder, ccx=ccx, out=out, render=render, progress=progress)
    notes = [f"note      {note}" for note in done.notes]
    lines = [*done.summary.splitlines(), *notes, *(f"file      {file}" for file in done.files)]
    print_report(lines, {**done.figures, "files": [str(file) for file in done.files]}, printed)
    return 0
