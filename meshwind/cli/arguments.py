"""Arguments and options that several subcommands share."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from meshwind.cli.config import Config
from meshwind.cli.help import FILES, PRINTED

MeshFile = Annotated[
    Path,
    typer.Argument(
        help="Mesh: STL, OBJ, PLY, OFF, GLB, 3MF, VTK, MSH, INP; STEP, IGES with the extra cad.", metavar="MESH"
    ),
]
ResultsFolder = Annotated[Path, typer.Argument(metavar="DIR", help="Results folder of `meshwind wind --out DIR`.")]
OtherFolder = Annotated[Path | None, typer.Option(help="Folder for the files.  [default: DIR]", rich_help_panel=FILES)]


@dataclass(frozen=True)
class Files:
    """How results are written, and where options are read from."""

    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Replace the results in the folder.", rich_help_panel=FILES)
    ] = False
    render: Annotated[bool, typer.Option("--render/--no-render", help="Draw the pictures.", rich_help_panel=FILES)] = (
        True
    )
    config: Config = None
    """Not used: the values of the file have become those of the other options."""


@dataclass(frozen=True)
class Printed:
    """What a command prints."""

    as_json: Annotated[
        bool, typer.Option("--json", help="Print the report as JSON, and nothing else.", rich_help_panel=PRINTED)
    ] = False
    quiet: Annotated[
        bool,
        typer.Option("--quiet", help="Print warnings and errors only.", rich_help_panel=PRINTED),
    ] = False

    @property
    def no_progress(self) -> bool:
        """Whether progress is not shown."""
        return self.quiet or self.as_json
