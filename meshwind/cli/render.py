"""`meshwind render`: pictures and movies from a results folder."""

from typing import Annotated

import typer

from meshwind.cli.arguments import AsJson, OtherFolder, Quiet, ResultsFolder
from meshwind.cli.display import counter
from meshwind.cli.help import one_of, some_of
from meshwind.cli.names import MOVIES, PICTURES, VIEWS
from meshwind.cli.outcome import tell_files

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
_WHAT, _LOOK = "What is drawn", "How it looks"


def render(
    folder: ResultsFolder,
    only: Annotated[
        str,
        typer.Option(
            metavar="NAMES",
            help="By commas: winding, crossings, coverage, windability, slip, fit, unrolled, quads, redesign, sheet.  "
            "[default: all]",
            autocompletion=some_of(*PICTURES),
            rich_help_panel=_WHAT,
        ),
    ] = "",
    animate: Annotated[
        str,
        typer.Option(
            metavar="KINDS",
            help="Draw the winding in motion instead, by commas: gif, mp4.",
            autocompletion=some_of(*MOVIES),
            rich_help_panel=_WHAT,
        ),
    ] = "",
    seconds: Annotated[
        float, typer.Option(help="How long the fibres take to be laid in a movie.", rich_help_panel=_WHAT)
    ] = 5.0,
    size: Annotated[
        str,
        typer.Option(metavar="WxH", help="Pixels.  [default: 1600x1200, of movies 960x720]", rich_help_panel=_LOOK),
    ] = "",
    view: Annotated[
        str,
        typer.Option(
            metavar="SIDE",
            help="Side to look from: auto for the best, x, -x, y, -y, z, -z, iso.",
            autocompletion=one_of(*VIEWS),
            rich_help_panel=_LOOK,
        ),
    ] = "auto",
    transparent: Annotated[
        bool, typer.Option("--transparent", help="Without paper behind the part.", rich_help_panel=_LOOK)
    ] = False,
    parallel: Annotated[
        bool,
        typer.Option(
            "--parallel/--perspective",
            help="Projection; lengths are true in parallel only.",
            rich_help_panel=_LOOK,
        ),
    ] = True,
    scale_bar: Annotated[
        bool | None,
        typer.Option(
            "--scale-bar/--no-scale-bar",
            help="A bar of a round length.  [default: with --parallel]",
            rich_help_panel=_LOOK,
        ),
    ] = None,
    out: OtherFolder = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> int:
    """Draw the pictures of a run; nothing is wound again.

    NAME.png for each picture, sheet.png with all of them, winding.gif and winding.mp4 with --animate.
    """
    from meshwind.pictures.page import Page, parse_size
    from meshwind.pictures.render import render as draw

    kinds, names = _names(animate), _names(only)
    width, height = parse_size(size) if size else ((960, 720) if kinds and not names else (1600, 1200))
    page = Page(width, height, transparent, not parallel, scale_bar, view.strip().lower())
    with counter("drawing", quiet or as_json) as tell:
        done = draw(folder, names, page, kinds, seconds, out, tell)
    tell_files(done.files, (), as_json, quiet)
    return 0


def _names(text: str) -> list[str]:
    return [name.strip().lower() for name in text.split(",") if name.strip()]
