"""`meshwind export`: from a results folder to what solvers, robots and CAD take."""

from typing import Annotated

import typer

from meshwind.cli.arguments import AsJson, OtherFolder, Quiet, ResultsFolder
from meshwind.cli.help import one_of, some_of
from meshwind.cli.names import FORMATS, SHELLS, TARGETS
from meshwind.cli.outcome import tell_files

EXAMPLES = """
    # a shell deck for CalculiX and Abaqus, fibre directions for ParaView
    meshwind export part-wound --to inp,fibers

    # robot frames at most 2 long and 3 degrees apart
    meshwind export part-wound --to frames --step 2 --angle 3

    # for CAD, and a page to turn in a browser, in another folder
    meshwind export part-wound --to step,viewer --out for-colleagues

    # all results as Gmsh and PLY
    meshwind export part-wound --formats gmsh,ply
"""
_WHAT, _SHELL, _FRAMES = "What is written", "Elements of inp and fibers", "Frames"


def export(
    folder: ResultsFolder,
    to: Annotated[
        str,
        typer.Option(
            metavar="LIST",
            help="What to write, by commas: inp, fibers, frames, step, viewer.",
            autocompletion=some_of(*TARGETS),
            rich_help_panel=_WHAT,
        ),
    ] = "",
    formats: Annotated[
        str,
        typer.Option(
            metavar="LIST",
            help="Mesh formats for all results, by commas: vtu, vtk, xdmf, ply, obj, gmsh.",
            autocompletion=some_of(*FORMATS),
            rich_help_panel=_WHAT,
        ),
    ] = "",
    band_width: Annotated[
        float | None,
        typer.Option(
            help="Of the band, in the mesh's units.  [default: that of the run's coverage]", rich_help_panel=_WHAT
        ),
    ] = None,
    thickness: Annotated[
        float | None,
        typer.Option(
            help="Of one layer of band, in the mesh's units.  [default: 1e-3 of the part's diagonal]",
            rich_help_panel=_SHELL,
        ),
    ] = None,
    shell: Annotated[
        str,
        typer.Option(
            metavar="KIND",
            help="Those of a grid, or quads for the quad mesh on the crossings.",
            autocompletion=one_of(*SHELLS),
            rich_help_panel=_SHELL,
        ),
    ] = "grid",
    elements: Annotated[
        int | None,
        typer.Option(help="Elements of the grid, about.  [default: inp 1000, fibers 10000]", rich_help_panel=_SHELL),
    ] = None,
    step: Annotated[
        float | None,
        typer.Option(
            help="Longest step, in the mesh's units.  [default: 2 % of the part's diagonal]", rich_help_panel=_FRAMES
        ),
    ] = None,
    angle: Annotated[
        float | None,
        typer.Option(help="Largest turn from frame to frame, in degrees.  [default: 5]", rich_help_panel=_FRAMES),
    ] = None,
    out: OtherFolder = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> int:
    """Write results for other programs; nothing is wound again.

    inp: shell.inp for CalculiX, shell_s4r.inp for Abaqus.  fibers: fibers.vtu and .vtk, the fibre directions a cell.
    frames: frames/*.csv for robots, in mm.  step: surface.step for CAD (needs meshwind[cad]).
    viewer: viewer.html, one page that a browser turns offline (needs meshwind[viewer]).
    """
    from meshwind.export.targets import Wishes
    from meshwind.export.targets import export as write

    wishes = Wishes(thickness, band_width, step, angle, shell, elements, _names(formats))
    done = write(folder, _names(to), out, wishes)
    tell_files(done.files, done.notes, as_json, quiet)
    return 0


def _names(text: str) -> list[str]:
    return [name.strip().lower() for name in text.split(",") if name.strip()]
