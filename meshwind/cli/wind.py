"""`meshwind wind`: mesh in, paths out."""

import shlex
import sys
from pathlib import Path
from typing import Annotated

import typer

from meshwind.cli.display import display
from meshwind.cli.summary import summary

UNSETTLED = 3


def wind(
    mesh: Annotated[
        Path,
        typer.Argument(help="Triangle mesh: STL, OBJ, PLY, OFF, GLB, 3MF, VTK, MSH, INP.", metavar="MESH"),
    ],
    out: Annotated[Path | None, typer.Option(help="Folder for the results.  [default: MESH's name + -wound]")] = None,
    paths: Annotated[int, typer.Option(help="Paths a family.", min=1)] = 12,
    revolutions: Annotated[float, typer.Option(help="Turns of a path from end to end.", min=0.0)] = 0.5,
    friction: Annotated[float, typer.Option(help="Coefficient of friction of fibre on part.", min=0.0)] = 0.0,
    ends: Annotated[str, typer.Option(help='Where the ends are: auto, x, y, z, or two points "x,y,z x,y,z".')] = "auto",
    opening: Annotated[
        float | None,
        typer.Option(help="Radius of the opening at a closed end, in the mesh's units.  [default: from the part]"),
    ] = None,
    tolerance: Annotated[float, typer.Option(help="Largest fit error over the part's diagonal.", min=1e-12)] = 1e-5,
    render: Annotated[bool, typer.Option("--render/--no-render", help="Draw winding.png.")] = True,
) -> int:
    """Lay two families of taut fibres on MESH and write paths, bridges, crossings, quads, maps and a report.

    Exit status: 0 done; 2 bad input or usage; 3 done, but some paths did not come to rest (the report says which
    and why).

    Example: meshwind wind part.stl --paths 24 --revolutions 0.6
    """
    # the numerical libraries are imported late: --help and usage errors must not wait for them
    from meshwind import pipeline

    folder = out if out is not None else Path(f"{mesh.stem}-wound")
    with display() as progress:
        result = pipeline.wind(
            mesh,
            paths=paths,
            revolutions=revolutions,
            friction=friction,
            ends=ends,
            opening=opening,
            tolerance=tolerance,
            out=folder,
            render=render,
            command=shlex.join(["meshwind", *sys.argv[1:]]),
            progress=progress,
        )
    typer.echo(summary(result, folder))
    return 0 if result.settled else UNSETTLED
