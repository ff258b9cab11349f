"""`meshwind redesign`: mesh in, the nearest mesh that can be wound out."""

from dataclasses import asdict, fields
from pathlib import Path
from time import perf_counter
from typing import Annotated

import typer

from meshwind.cli.arguments import Files, MeshFile, Printed
from meshwind.cli.help import FILES
from meshwind.cli.output import print_report, stages
from meshwind.cli.signature import Pick, with_records
from meshwind.cli.wind import NOT_CONVERGED, command_line
from meshwind.core.option import Option
from meshwind.editing.options import EditOptions, WindingOptions
from meshwind.run.summary import redesign_lines
from meshwind.workflow.options import FIBRES, Options

EXAMPLES = """
    # the nearest part that can be wound, into part-redesigned/
    meshwind redesign part.stl

    # at most 5 mm away, and the rims stay as they are
    meshwind redesign part.stl --revolutions 0.3 --bound 5 --freeze "v<0.05, v>0.95"

    # one part for two windings, or for all layers of a laminate
    meshwind redesign part.stl --revolutions 0.3,0.8
    meshwind redesign part.stl --layers laminate.toml

    # keep a part of four arms the same on each
    meshwind redesign part.stl --symmetry 4 --out four-arms
"""
WINDING = (
    "paths", "particles", "tolerance", "component", "ends", "opening", "side", "opening_by",
)  # fmt: skip
"""Options of the winding that a redesign takes, in the order of meshwind.toml."""
RunOptions = Annotated[
    Options,
    Pick(
        (*WINDING, "units"),
        {},
        {"particles": Option("Number of particles per path", FIBRES)},
    ),
]


@with_records
def redesign(
    *,
    mesh: MeshFile,
    winding: RunOptions,
    windings: WindingOptions,
    edit: EditOptions,
    out: Annotated[
        str | None,
        typer.Option(help="Folder for the results.  [default: MESH's name + -redesigned]", rich_help_panel=FILES),
    ] = None,
    files: Files,
    printed: Printed,
) -> int:
    """Change MESH as little as possible until no fibre bridges, and write the edited mesh, pictures and a report.

    The edited mesh has the vertices and faces of MESH, in their order.  It is fitted and wound again: only where
    nothing bridges then does the report call it windable.

    Exit status: 0 nothing bridges; 1 the summary could not be printed; 2 bad input or usage; 3 some fibres still
    bridge, or slide off (the report says which, and what would help).
    """
    # the numerical libraries are imported late: --help and usage errors must not wait for them
    from meshwind.editing.redesign import redesign as edit_mesh
    from meshwind.mesh import check_file
    from meshwind.pictures.painter import start_probe
    from meshwind.results import folder
    from meshwind.run.redesign import write_redesign
    from meshwind.workflow.layer_plans import read_layers

    target = Path(out if out is not None else f"{mesh.stem}-redesigned")
    check_file(mesh)  # what does not exist is told before a folder that does
    if windings.layers is not None:
        read_layers(windings.layers, Options(continuous=True))  # of one filament or not, all the same
    folder.prepare(target, files.overwrite)
    if files.render:
        start_probe()  # it loads its libraries while this process computes
    begin = perf_counter()
    wound = {name: getattr(winding, name) for name in WINDING} | asdict(windings)
    with stages(printed) as progress:
        edited = edit_mesh(mesh, progress=progress, **wound, **asdict(edit))
        progress("write")
        report = write_redesign(
            edited,
            target,
            units=winding.units,
            overwrite=files.overwrite,
            render=files.render,
            command=command_line(),
            seconds={"redesign": perf_counter() - begin},
            options={"mesh": mesh, "out": target, "freeze": edit.frozen, "units": winding.units}
            | {"render": files.render}
            | {each.name: getattr(edit, each.name) for each in fields(edit) if each.metadata and each.name != "frozen"}
            | wound
            | windings.written(),
        )
    print_report([*redesign_lines(report), f"files     {target}"], {**report, "folder": str(target)}, printed)
    return 0 if edited.windable and edited.settled else NOT_CONVERGED
