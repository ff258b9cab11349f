"""`meshwind render`: pictures and movies from a results folder."""

from pathlib import Path
from typing import Annotated

import typer

from meshwind.cli.arguments import AsJson, Quiet
from meshwind.cli.display import counter
from meshwind.cli.outcome import tell_files


def render(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder that `meshwind wind --out DIR` left.")],
    only: Annotated[
        str,
        typer.Option(
            metavar="NAMES",
            help="By commas: winding, crossings, coverage, windability, slip, fit, unrolled, quads, redesign, sheet.  "
            "[default: all]",
        ),
    ] = "",
    size: Annotated[str, typer.Option(metavar="WxH", help="Pixels.  [default: 1600x1200, of movies 960x720]")] = "",
    view: Annotated[str, typer.Option(help="Side to look from: auto for the best, x, -x, y, -y, z, -z, iso.")] = "auto",
    transparent: Annotated[bool, typer.Option("--transparent", help="Without paper behind the part.")] = False,
    parallel: Annotated[
        bool, typer.Option("--parallel/--perspective", help="Projection; lengths are true in parallel only.")
    ] = True,
    scale_bar: Annotated[
        bool | None,
        typer.Option("--scale-bar/--no-scale-bar", help="A bar of a round length.  [default: with --parallel]"),
    ] = None,
    animate: Annotated[
        str, typer.Option(metavar="KINDS", help="Draw the winding in motion instead, by commas: gif, mp4.")
    ] = "",
    seconds: Annotated[float, typer.Option(help="How long the fibres take to be laid in a movie.")] = 5.0,
    out: Annotated[Path | None, typer.Option(help="Folder for the files.  [default: DIR]")] = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> int:
    """Draw the pictures of a run; nothing is wound again.

    NAME.png for each picture, sheet.png with all of them, winding.gif and winding.mp4 with --animate.

    Example: meshwind render part-wound --only winding,coverage --size 2400x1800 --transparent
    """
    from meshwind.pictures.page import Page, parse_size
    from meshwind.pictures.render import render as draw

    kinds, names = _names(animate), _names(only)
    width, height = parse_size(size) if size else ((960, 720) if kinds and not names else (1600, 1200))
    page = Page(width, height, transparent, not parallel, scale_bar, view.strip().lower())
    with counter("drawing", quiet) as tell:
        done = draw(folder, names, page, kinds, seconds, out, tell)
    tell_files(done.files, (), as_json, quiet)
    return 0


def _names(text: str) -> list[str]:
    return [name.strip().lower() for name in text.split(",") if name.strip()]
