"""`meshwind export`: from a results folder to files for solvers, robots and CAD."""

from dataclasses import asdict, dataclass
from typing import Annotated

import typer

from meshwind.cli.arguments import OtherFolder, Printed, ResultsFolder
from meshwind.cli.help import one_of, some_of, split_names
from meshwind.cli.output import print_files
from meshwind.cli.signature import with_records
from meshwind.results.schema import SUFFIXES

EXAMPLES = """
    # a shell deck for CalculiX and Abaqus, fibre directions for ParaView
    meshwind export part-wound --to inp,fibers --thickness 0.4

    # the same under a pressure of 10 MPa inside, with what it pulls at the end
    meshwind export part-wound --to inp --thickness 0.4 --pressure 10

    # a shaft with a torque of 50 N m on either end
    meshwind export part-wound --to inp --thickness 0.4 --torque 50 --held none

    # robot frames at most 2 long and 3 degrees apart
    meshwind export part-wound --to frames --step 2 --angle 3

    # for CAD, and a page to turn in a browser, in another folder
    meshwind export part-wound --to step,viewer --out for-colleagues

    # all results as Gmsh and PLY
    meshwind export part-wound --formats gmsh,ply
"""
TARGETS = "inp", "fibers", "frames", "step", "viewer"
FORMATS = tuple(SUFFIXES)
SHELLS = "grid", "quads"
MATERIALS = "aramid-epoxy", "as4-epoxy", "dry-tow", "e-glass-epoxy", "epoxy", "t300-epoxy", "t700-epoxy"
RIMS = "start", "end", "both", "none"
"""Names for help and completion: the modules that define them take long to import."""
_WHAT, _SHELL, _LOADS, _FRAMES = "What is written", "Elements of inp and fibers", "Loads of inp", "Frames"


@dataclass(frozen=True)
class What:
    """What is written."""

    to: Annotated[
        str,
        typer.Option(
            metavar="LIST",
            help=f"Exports to write, separated by commas: {', '.join(TARGETS)}.",
            autocompletion=some_of(*TARGETS),
            rich_help_panel=_WHAT,
        ),
    ] = ""
    formats: Annotated[
        str,
        typer.Option(
            metavar="LIST",
            help=f"Mesh formats to write all results in, separated by commas: {', '.join(FORMATS)}.",
            autocompletion=some_of(*FORMATS),
            rich_help_panel=_WHAT,
        ),
    ] = ""
    band_width: Annotated[
        float | None,
        typer.Option(
            help="Width of the fibre band, in the mesh's units; of inp and fibers layers of --layers have their own.  "
            "[default: that of the run's coverage, or of the layer]",
            rich_help_panel=_WHAT,
        ),
    ] = None


@dataclass(frozen=True)
class Shell:
    """The elements of a shell deck and of a field of fibre directions, and loads of the deck."""

    thickness: Annotated[
        float | None,
        typer.Option(
            help="Thickness of one layer of band, in the mesh's units; layers of --layers have their own.  "
            "[default: that of the run's band; without one inp needs it, fibers has 1e-3 of the part's diagonal]",
            rich_help_panel=_SHELL,
        ),
    ] = None
    shell: Annotated[
        str,
        typer.Option(
            metavar="KIND",
            help="Elements: grid for a regular grid, quads for the quad mesh on the crossings.",
            autocompletion=one_of(*SHELLS),
            rich_help_panel=_SHELL,
        ),
    ] = "grid"
    elements: Annotated[
        int | None,
        typer.Option(
            help="Approximate number of elements of the grid.  [default: inp 1000, fibers 10000]",
            rich_help_panel=_SHELL,
        ),
    ] = None
    pressure: Annotated[
        float | None,
        typer.Option(
            metavar="MPA",
            help="Pressure inside, in MPa, with what it has on closed ends; below 0 outside.  [default: none]",
            rich_help_panel=_LOADS,
        ),
    ] = None
    axial: Annotated[
        float | None,
        typer.Option(
            metavar="N",
            help="Axial force, in N, on rims that are not held; below 0 it pushes.  "
            "[default: 1000 if there is no other load]",
            rich_help_panel=_LOADS,
        ),
    ] = None
    torque: Annotated[
        float | None,
        typer.Option(
            metavar="NM",
            help="Torque, in N m, on rims that are not held; above 0 counterclockwise seen from outside the end.  "
            "[default: none]",
            rich_help_panel=_LOADS,
        ),
    ] = None
    held: Annotated[
        str,
        typer.Option(
            metavar="RIMS",
            help=f"Rims that are clamped: {', '.join(RIMS)}; with none the loads on both balance.",
            autocompletion=one_of(*RIMS),
            rich_help_panel=_LOADS,
        ),
    ] = "start"
    material: Annotated[
        str,
        typer.Option(
            metavar="NAME|FILE",
            help=f"Material of inp: {', '.join(MATERIALS)}, or a TOML file.",
            autocompletion=one_of(*MATERIALS),
            rich_help_panel=_SHELL,
        ),
    ] = "t700-epoxy"
    section_tolerance: Annotated[
        float,
        typer.Option(
            metavar="DEGREES",
            help="Angles of elements of inp that share a section are within this; at 0 each element has its own.",
            rich_help_panel=_SHELL,
        ),
    ] = 2.0


@dataclass(frozen=True)
class Frames:
    """The frames for robots."""

    step: Annotated[
        float | None,
        typer.Option(
            help="Largest distance between frames, in the mesh's units.  [default: 2 % of the part's diagonal]",
            rich_help_panel=_FRAMES,
        ),
    ] = None
    angle: Annotated[
        float | None,
        typer.Option(help="Largest turn from frame to frame, in degrees.  [default: 5]", rich_help_panel=_FRAMES),
    ] = None


@with_records
def export(
    *, folder: ResultsFolder, what: What, shell: Shell, frames: Frames, out: OtherFolder = None, printed: Printed
) -> int:
    """Write the results of a run for other programs; nothing is wound again.

    inp: shell.inp for CalculiX, shell_s4r.inp for Abaqus.  fibers: fibers.vtu and .vtk, the fibre directions per cell.
    Both have the layers of a run with --layers.  frames: frames/*.csv for robots, in mm: filament.csv in the order of
    winding for a run with --continuous, and layer_000.csv and so on for layers that are not one filament.
    step: surface.step for CAD (needs meshwind[cad]).
    viewer: viewer.html, a page for any browser with WebGL 2, without a network.
    """
    from meshwind.run.export import export as write

    done = write(
        folder, split_names(what.to), formats=split_names(what.formats), out=out, band_width=what.band_width,
        **asdict(shell), **asdict(frames),
    )  # fmt: skip
    print_files(done.files, done.notes, printed)
    return 0
