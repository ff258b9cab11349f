"""Arguments that several subcommands share: one wording for each."""

from pathlib import Path
from typing import Annotated

import typer

MeshFile = Annotated[
    Path, typer.Argument(help="Triangle mesh: STL, OBJ, PLY, OFF, GLB, 3MF, VTK, MSH, INP.", metavar="MESH")
]
Ends = Annotated[
    str, typer.Option(help='Where the ends are: auto, x, y, z, two points "x,y,z x,y,z", two rims "loops 0 1".')
]
Opening = Annotated[
    float | None,
    typer.Option(help="Radius of the opening at a closed end, in the mesh's units.  [default: from the part]"),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print what there is to tell as JSON, and nothing else.")]
Quiet = Annotated[bool, typer.Option("--quiet", help="No progress and no summary: only warnings and errors.")]
