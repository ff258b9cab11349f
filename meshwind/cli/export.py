"""`meshwind export`: from a results folder to what solvers, robots and CAD take."""

from pathlib import Path
from typing import Annotated

import typer

from meshwind.cli.arguments import AsJson, Quiet
from meshwind.cli.outcome import tell_files


def export(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder that `meshwind wind --out DIR` left.")],
    to: Annotated[
        str, typer.Option(metavar="LIST", help="What to write, by commas: inp, fibers, frames, step, viewer.")
    ] = "",
    formats: Annotated[
        str,
        typer.Option(metavar="LIST", help="Mesh formats for all results, by commas: vtu, vtk, xdmf, ply, obj, gmsh."),
    ] = "",
    out: Annotated[Path | None, typer.Option(help="Folder for the files.  [default: DIR]")] = None,
    thickness: Annotated[
        float | None,
        typer.Option(help="Of one layer of band, in the mesh's units.  [default: 1e-3 of the part's diagonal]"),
    ] = None,
    band_width: Annotated[
        float | None, typer.Option(help="Of the band, in the mesh's units.  [default: that of the run's coverage]")
    ] = None,
    shell: Annotated[
        str, typer.Option(help="Elements of inp and fibers: grid, or quads for the quad mesh on the crossings.")
    ] = "grid",
    elements: Annotated[
        int | None, typer.Option(help="Elements of the grid, about.  [default: inp 1000, fibers 10000]")
    ] = None,
    step: Annotated[
        float | None,
        typer.Option(help="Longest step of the frames, in the mesh's units.  [default: 2 % of the part's diagonal]"),
    ] = None,
    angle: Annotated[
        float | None, typer.Option(help="Largest turn from frame to frame, in degrees.  [default: 5]")
    ] = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> int:
    """Write results for other programs; nothing is wound again.

    inp: shell.inp for CalculiX, shell_s4r.inp for Abaqus.  fibers: fibers.vtu and .vtk, the fibre directions a cell.
    frames: frames/*.csv for robots, in mm.  step: surface.step for CAD (needs meshwind[cad]).
    viewer: viewer.html, one page that a browser turns offline (needs meshwind[viewer]).

    Example: meshwind export part-wound --to inp,fibers,frames
    """
    from meshwind.export.targets import Wishes
    from meshwind.export.targets import export as write

    wishes = Wishes(thickness, band_width, step, angle, shell, elements, _names(formats))
    done = write(folder, _names(to), out, wishes)
    tell_files(done.files, done.notes, as_json, quiet)
    return 0


def _names(text: str) -> list[str]:
    return [name.strip().lower() for name in text.split(",") if name.strip()]
