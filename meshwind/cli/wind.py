"""`meshwind wind`: mesh in, paths out."""

import shlex
import sys
from pathlib import Path
from typing import Annotated

import typer

from meshwind.cli.arguments import (
    AsJson,
    Component,
    Drawn,
    Ends,
    MeshFile,
    Opening,
    Overwrite,
    Paths,
    Quiet,
    Tolerance,
    Turns,
    Units,
)
from meshwind.cli.config import Config
from meshwind.cli.display import display
from meshwind.cli.help import FIBRES, FILES, SURFACE, one_of
from meshwind.cli.outcome import tell
from meshwind.cli.summary import described
from meshwind.core.parsing import count, turns

UNSETTLED = 3
EXAMPLES = """
    # results and pictures into part-wound/
    meshwind wind part.stl

    # more paths, 5/12 of a turn each, a part in inches
    meshwind wind part.stl --paths 24 --revolutions 5/12 --units in

    # cover a part with a band 6 mm wide; turns that hold and bridge least; friction
    meshwind wind part.stl --spacing 6 --band-width 6 --revolutions auto --friction 0.2

    # a closed part: open it at its ends in z, to a radius of 15
    meshwind wind part.stl --ends z --opening 15

    # the same again, but denser, elsewhere
    meshwind wind --config part-wound/meshwind.toml --paths 48 --out denser
"""


def wind(
    mesh: MeshFile,
    component: Component = 0,
    ends: Ends = "auto",
    opening: Opening = None,
    units: Units = "mm",
    paths: Paths = 12,
    revolutions: Turns = "0.5",
    friction: Annotated[
        str,
        typer.Option(
            metavar="MU", help="Friction of fibre on part, or field:NAME for a scalar of MESH.", rich_help_panel=FIBRES
        ),
    ] = "0",
    spacing: Annotated[
        float | None,
        typer.Option(
            help="Add paths until neighbours lie no further apart, in the mesh's units.", rich_help_panel=FIBRES
        ),
    ] = None,
    pins: Annotated[
        Path | None,
        typer.Option(help="CSV of the paths' ends: columns u0,v0,u1,v1 or x0,y0,z0,x1,y1,z1.", rich_help_panel=FIBRES),
    ] = None,
    band_width: Annotated[
        float | None,
        typer.Option(
            help="Width of the fibre, in the mesh's units.  [default: one layer a family]", rich_help_panel=FIBRES
        ),
    ] = None,
    linear_density: Annotated[
        float | None,
        typer.Option(help="Mass over length of the fibre, per unit of the mesh; for its mass.", rich_help_panel=FIBRES),
    ] = None,
    particles: Annotated[
        str,
        typer.Option(
            metavar="COUNT",
            help="Particles a path, or auto: as many as lengths right to 1e-5 need.",
            autocompletion=one_of("auto"),
            rich_help_panel=FIBRES,
        ),
    ] = "401",
    tolerance: Tolerance = 1e-5,
    worst_fit: Annotated[
        float,
        typer.Option(
            help="Largest distance between surface and mesh, over the diagonal, to wind at all.",
            rich_help_panel=SURFACE,
        ),
    ] = 0.1,
    out: Annotated[
        str | None,
        typer.Option(help="Folder for the results.  [default: MESH's name + -wound]", rich_help_panel=FILES),
    ] = None,
    overwrite: Overwrite = False,
    render: Drawn = True,
    config: Config = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> int:
    """Lay two families of taut fibres on MESH and write paths, bridges, crossings, quads, maps and a report.

    Exit status: 0 done; 1 the summary could not be printed; 2 bad input or usage; 3 done, but some paths did not
    come to rest (the report says which and why).
    """
    # the numerical libraries are imported late: --help and usage errors must not wait for them
    from meshwind.run.wind import wind as run

    del config  # its values have become those of the others
    folder = out if out is not None else f"{mesh.stem}-wound"
    with display(quiet or as_json) as progress:
        result = run(
            mesh,
            paths=paths,
            revolutions=turns(revolutions),
            friction=friction,
            component=component,
            ends=ends,
            opening=opening,
            tolerance=tolerance,
            worst_fit=worst_fit,
            units=units,
            particles=count(particles),
            spacing=spacing,
            band_width=band_width,
            linear_density=linear_density,
            pins=pins,
            out=folder,
            overwrite=overwrite,
            render=render,
            command=shlex.join(["meshwind", *sys.argv[1:]]),
            progress=progress,
        )
    report = result.report()
    tell([*described(report), f"files     {folder}"], report | {"folder": str(folder)}, as_json, quiet)
    return 0 if result.settled else UNSETTLED
