"""`meshwind render`: pictures and movies from a results folder."""

from dataclasses import dataclass
from typing import Annotated

import typer

from meshwind.cli.arguments import OtherFolder, Printed, ResultsFolder
from meshwind.cli.help import one_of, some_of, split_names
from meshwind.cli.output import counter, print_files
from meshwind.cli.signature import with_records
from meshwind.results.schema import MOVIES, REDESIGN, SHEET
from meshwind.results.schema import PICTURES as DRAWN

EXAMPLES = """
    # every picture, and a contact sheet of them
    meshwind render part-wound

    # two of them, large, for a slide
    meshwind render part-wound --only winding,coverage --size 2400x1800 --transparent

    # from the side of x, in perspective, into another folder
    meshwind render part-wound --view x --perspective --out pictures

    # the winding in motion
    meshwind render part-wound --animate gif,mp4 --seconds 8
"""
PICTURES = (*DRAWN, REDESIGN, SHEET)
VIEWS = "auto", "x", "-x", "y", "-y", "z", "-z", "iso"
"""Names for help and completion: the module that defines them takes long to import."""
_WHAT, _LOOK = "What is drawn", "How it looks"


@dataclass(frozen=True)
class What:
    """What is drawn."""

    only: Annotated[
        str,
        typer.Option(
            metavar="NAMES",
            help=f"Pictures to draw, separated by commas: {', '.join(PICTURES)}.  [default: all]",
            autocompletion=some_of(*PICTURES),
            rich_help_panel=_WHAT,
        ),
    ] = ""
    animate: Annotated[
        str,
        typer.Option(
            metavar="KINDS",
            help=f"Draw the winding in motion instead, as a movie of these kinds, separated by commas: "
            f"{', '.join(MOVIES)}.",
            autocompletion=some_of(*MOVIES),
            rich_help_panel=_WHAT,
        ),
    ] = ""
    seconds: Annotated[float, typer.Option(help="Time to lay all fibres in a movie.", rich_help_panel=_WHAT)] = 5.0


@dataclass(frozen=True)
class Look:
    """How it is drawn."""

    size: Annotated[
        str,
        typer.Option(
            metavar="WxH",
            help="Width and height in pixels.  [default: 1600x1200, movies 960x720]",
            rich_help_panel=_LOOK,
        ),
    ] = ""
    view: Annotated[
        str,
        typer.Option(
            metavar="SIDE",
            help="Side to look from: x, -x, y, -y, z, -z, iso, or auto for the best.",
            autocompletion=one_of(*VIEWS),
            rich_help_panel=_LOOK,
        ),
    ] = "auto"
    transparent: Annotated[
        bool, typer.Option("--transparent", help="Leave the background transparent.", rich_help_panel=_LOOK)
    ] = False
    parallel: Annotated[
        bool,
        typer.Option(
            "--parallel/--perspective",
            help="Projection; lengths are true in parallel projection only.",
            rich_help_panel=_LOOK,
        ),
    ] = True
    scale_bar: Annotated[
        bool | None,
        typer.Option(
            "--scale-bar/--no-scale-bar",
            help="Draw a scale bar.  [default: with --parallel]",
            rich_help_panel=_LOOK,
        ),
    ] = None


@with_records
def render(*, folder: ResultsFolder, what: What, look: Look, out: OtherFolder = None, printed: Printed) -> int:
    """Draw the pictures of a run; nothing is wound again.

    NAME.png for each picture, sheet.png with all of them, winding.gif and winding.mp4 with --animate.
    """
    from meshwind.pictures.painter import start_probe

    start_probe()  # it loads its libraries while this process loads its own
    from meshwind.pictures.page import Page, parse_size
    from meshwind.pictures.render import render as draw
    from meshwind.pictures.render import usual_page

    kinds, names = split_names(what.animate), split_names(what.only)
    usual = usual_page(names, kinds)
    width, height = parse_size(look.size) if look.size else (usual.width, usual.height)
    page = Page(width, height, look.transparent, not look.parallel, look.scale_bar, look.view.strip().lower())
    with counter("drawing", printed) as progress:
        done = draw(folder, names, page, kinds, what.seconds, out, progress)
    print_files(done.files, (), printed)
    return 0
