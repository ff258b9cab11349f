"""`meshwind redesign`: mesh in, the nearest mesh that can be wound out."""

import shlex
import sys
from pathlib import Path
from time import perf_counter
from typing import Annotated, Any

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
from meshwind.cli.help import FIBRES, FILES
from meshwind.cli.outcome import tell
from meshwind.cli.summary import note_line
from meshwind.cli.wind import UNSETTLED
from meshwind.core.parsing import turns
from meshwind.core.units import check_units, unit_told

EXAMPLES = """
    # the nearest part that can be wound, into part-redesigned/
    meshwind redesign part.stl

    # at most 5 mm away, and the rims stay as they are
    meshwind redesign part.stl --revolutions 0.3 --bound 5 --freeze "v<0.05, v>0.95"

    # keep a part of four arms the same on each
    meshwind redesign part.stl --symmetry 4 --out four-arms
"""
_EDIT = "The edit"


def redesign(
    mesh: MeshFile,
    component: Component = 0,
    ends: Ends = "auto",
    opening: Opening = None,
    units: Units = "mm",
    bound: Annotated[
        float | None,
        typer.Option(help="Largest displacement, in the mesh's units.  [default: none]", rich_help_panel=_EDIT),
    ] = None,
    freeze: Annotated[
        str | None,
        typer.Option(
            metavar="WHERE",
            help='What must not move: "v<0.1, z>20", or field:NAME for a scalar of MESH.',
            rich_help_panel=_EDIT,
        ),
    ] = None,
    symmetry: Annotated[
        int, typer.Option(help="Order of rotation about the part that is kept.", rich_help_panel=_EDIT)
    ] = 1,
    threshold: Annotated[
        float | None,
        typer.Option(
            help="A gap up to this is none, in the mesh's units.  [default: the fit's error]", rich_help_panel=_EDIT
        ),
    ] = None,
    rounds: Annotated[int, typer.Option(help="Edit and wind again at most so often.", rich_help_panel=_EDIT)] = 10,
    paths: Paths = 12,
    revolutions: Turns = "auto",
    particles: Annotated[int, typer.Option(help="Particles a path.", rich_help_panel=FIBRES)] = 401,
    tolerance: Tolerance = 1e-5,
    out: Annotated[
        str | None,
        typer.Option(help="Folder for the results.  [default: MESH's name + -redesigned]", rich_help_panel=FILES),
    ] = None,
    overwrite: Overwrite = False,
    render: Drawn = True,
    config: Config = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> int:
    """Change MESH as little as possible until no fibre bridges, and write the edited mesh, pictures and a report.

    The edited mesh has the vertices and faces of MESH, in their order.  It is fitted and wound anew: only where
    nothing bridges then is it said to be windable.

    Exit status: 0 nothing bridges; 1 the summary could not be printed; 2 bad input or usage; 3 some fibres still
    bridge, or slide off (the report says which, and what would help).
    """
    # the numerical libraries are imported late: --help and usage errors must not wait for them
    from meshwind.editing import redesign as edit_mesh
    from meshwind.results import folder
    from meshwind.run.redesign import write_redesign

    del config  # its values have become those of the others
    check_units(units)
    edit: dict[str, Any] = {"bound": bound, "symmetry": symmetry, "threshold": threshold, "rounds": rounds}
    winding: dict[str, Any] = {
        "paths": paths,
        "revolutions": turns(revolutions),
        "particles": particles,
        "tolerance": tolerance,
    }
    part: dict[str, Any] = {"component": component, "ends": ends, "opening": opening}
    target = Path(out if out is not None else f"{mesh.stem}-redesigned")
    folder.prepare(target, overwrite)
    begin = perf_counter()
    with display(quiet or as_json) as progress:
        edited = edit_mesh(
            mesh,
            frozen=freeze,
            progress=progress,
            **edit,
            **winding,
            **part,
        )
        progress("write")
        report = write_redesign(
            edited,
            target,
            units=units,
            overwrite=overwrite,
            render=render,
            command=shlex.join(["meshwind", *sys.argv[1:]]),
            seconds={"redesign": perf_counter() - begin},
            options={"mesh": mesh, "out": target, "freeze": freeze, "units": units, "render": render}
            | edit
            | winding
            | part,
        )
    tell([*described(report), f"files     {target}"], report | {"folder": str(target)}, as_json, quiet)
    return 0 if edited.windable and edited.settled else UNSETTLED


def described(report: dict[str, Any]) -> list[str]:
    """A redesign's report in a few lines; raises LookupError or TypeError where a figure is missing."""
    from meshwind.appearance.words import quantity

    part, told, wound = report["mesh"], report["redesign"], report["wound"]
    units = unit_told(part["units"])
    moved, volume = told["displacement"], told["volume"]
    lines = [
        f"part      {part['name']}: {part['vertices']} vertices, {part['faces']} faces",
        f"winding   {report['winding']['revolutions']:.4g} revolutions, {report['winding']['why']}; "
        f"{report['winding']['paths_per_family']} paths a family",
    ]
    lines += [
        f"round {each['stage']}.{each['round']} bridged {100 * each['bridged']['before']:.2g} % to "
        f"{100 * each['bridged']['after']:.2g} %, gap {quantity(each['max_gap']['before'], units, 3)} to "
        f"{quantity(each['max_gap']['after'], units, 3)}"
        for each in report["rounds"]
    ]
    lines += [
        f"wound     from the edited mesh: bridged {100 * told['bridged']['before']:.3g} % before, "
        f"{100 * told['bridged']['after']:.3g} % after; largest gap {quantity(told['max_gap']['before'], units, 3)} "
        f"before, {quantity(told['max_gap']['after'], units, 3)} after (below {quantity(told['threshold'], units, 2)} "
        "is none)",
        f"moved     up to {quantity(moved['max'], units, 3)}, {quantity(moved['mean'], units, 3)} on average; "
        + (f"volume {100 * volume['relative']:+.2g} %" if volume["relative"] is not None else "volume unknown"),
    ]
    if told["faces_turned_over"]:
        lines.append(f"warning   the edit turned {told['faces_turned_over']} faces over; give a --bound")
    loose = wound["after"]["not_converged"]
    if loose:
        lines.append(f"warning   {len(loose)} paths do not hold on the edited part: {loose[0]['why']}")
    lines += [note_line(note) for note in report["notes"]]
    lines.append(f"{'outcome' if told['windable'] else 'warning'}   {told['advice']}")
    return lines
