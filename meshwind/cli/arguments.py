"""Arguments that several subcommands share: one wording for each."""

from pathlib import Path
from typing import Annotated

import typer

from meshwind.cli.help import FIBRES, FILES, PART, SURFACE, TOLD, one_of
from meshwind.cli.names import ENDS, UNITS

MeshFile = Annotated[
    Path, typer.Argument(help="Triangle mesh: STL, OBJ, PLY, OFF, GLB, 3MF, VTK, MSH, INP.", metavar="MESH")
]
Ends = Annotated[
    str,
    typer.Option(
        metavar="ENDS",
        help='Where the ends are: auto, x, y, z, two points "x,y,z x,y,z", two rims "loops 0 1".',
        autocompletion=one_of(*ENDS),
        rich_help_panel=PART,
    ),
]
Opening = Annotated[
    float | None,
    typer.Option(
        help="Radius of the opening at a closed end, in the mesh's units.  [default: from the part]",
        rich_help_panel=PART,
    ),
]
Component = Annotated[
    int, typer.Option(help="Which piece of MESH, by its rank of area; 0 is the largest.", rich_help_panel=PART)
]
Units = Annotated[
    str,
    typer.Option(
        metavar="UNIT",
        help="Unit of the mesh: mm, cm, m, um, in, ft; nothing is converted.",
        autocompletion=one_of(*UNITS),
        rich_help_panel=PART,
    ),
]
Paths = Annotated[int, typer.Option(help="Paths a family.", rich_help_panel=FIBRES)]
Turns = Annotated[
    str,
    typer.Option(
        metavar="TURNS",
        help="Turns of a path from end to end, as in 0.5 or 5/12, or auto: those that hold and bridge least.",
        autocompletion=one_of("auto"),
        rich_help_panel=FIBRES,
    ),
]
Tolerance = Annotated[
    float,
    typer.Option(
        help="Largest distance of a vertex from the surface, over the part's diagonal.", rich_help_panel=SURFACE
    ),
]
Overwrite = Annotated[
    bool, typer.Option("--overwrite", help="Replace results that DIR holds already.", rich_help_panel=FILES)
]
Drawn = Annotated[bool, typer.Option("--render/--no-render", help="Draw the pictures.", rich_help_panel=FILES)]
ResultsFolder = Annotated[Path, typer.Argument(metavar="DIR", help="Folder that `meshwind wind --out DIR` left.")]
OtherFolder = Annotated[Path | None, typer.Option(help="Folder for the files.  [default: DIR]", rich_help_panel=FILES)]
AsJson = Annotated[
    bool,
    typer.Option("--json", help="Print what there is to tell as JSON, and nothing else.", rich_help_panel=TOLD),
]
Quiet = Annotated[
    bool, typer.Option("--quiet", help="No progress and no summary: only warnings and errors.", rich_help_panel=TOLD)
]
