"""Pictures and movies from a run's folder alone."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path

from meshwind.appearance.view import NAMED
from meshwind.core.checks import path_given, several
from meshwind.core.errors import BadInputError
from meshwind.core.units import reported_unit
from meshwind.pictures import driver
from meshwind.pictures.animation_scene import animation_scene, reel_scene
from meshwind.pictures.drawings import Drawing
from meshwind.pictures.gallery import Sheet, placed, scenes_of
from meshwind.pictures.movie import encoder
from meshwind.pictures.page import Page
from meshwind.pictures.redesign_scene import redesign_in
from meshwind.pictures.scenes import AnimationScene, ReelScene, Scene
from meshwind.pictures.subject import Subject, subject_of
from meshwind.results.folder import beside
from meshwind.results.reading import is_redesign, read_report, read_results
from meshwind.results.schema import MOVIES, PATHS, PICTURES, REDESIGN, SHEET, movie, picture

PictureProgress = Callable[[str, int, int], None]
"""Called with the name of a picture, the number of pictures and frames drawn, and their total."""

MOVIE = 960, 720
"""Width and height of a movie in pixels, where none are given."""


@dataclass(frozen=True)
class Rendered:
    """The files that were drawn."""

    files: tuple[Path, ...]


def render(
    folder: str | PathLike[str],
    only: str | Sequence[str] = (),
    page: Page | None = None,
    animate: str | Sequence[str] = (),
    seconds: float = 5.0,
    out: str | PathLike[str] | None = None,
    progress: PictureProgress | None = None,
) -> Rendered:
    """Draw pictures and movies of a results folder.

    All that is needed is read from the folder; nothing is wound again.  All files appear, or none.

    Parameters
    ----------
    folder : str or PathLike
        Folder of a run or a redesign.
    only : str or sequence of str, optional
        Pictures to draw: "winding", "crossings", "coverage", "layers", "windability", "slip", "fit", "unrolled",
        "quads", "angles", "filament", "bands", "laminate", "redesign" or "sheet".  By default all, or none
        where there is a movie to draw.
    page : Page, optional
        Size and style.  By default 1600 x 1200 pixels, and 960 x 720 for movies.
    animate : str or sequence of str, optional
        Movies to draw: "gif", "mp4", or both.
    seconds : float, default 5
        How long the fibres take to be laid in a movie.
    out : str or PathLike, optional
        Folder for the files.  By default the folder itself.
    progress : callable, optional
        Called with the name of each picture, how many pictures and frames are done, and how many there are.

    Returns
    -------
    Rendered
        The paths of the files that were drawn, as `files`.

    Raises
    ------
    BadInputError
        If a name is not known, the folder holds no results, or this machine cannot draw.

    Examples
    --------
    >>> import meshwind as mw
    >>> result = mw.wind("data/elbow.obj", paths=3, particles=51, out="out", render=False)
    >>> drawn = mw.render("out", only=["coverage"], page=mw.Page(400, 300))
    >>> [file.name for file in drawn.files]
    ['coverage.png']
    """
    if not isinstance(folder, str | PathLike):
        raise BadInputError(
            f"folder is of type {type(folder).__name__}; give a folder of results, or use result.plot()"
        )
    only, animate = several(only, "only"), several(animate, "animate")
    paper = usual_page(only, animate) if page is None else page
    _check(only, animate, paper)
    ffmpeg = encoder() if "mp4" in animate else ""
    source, target = Path(folder), path_given(folder if out is None else out, "out", "folder")
    driver.start_probe()
    of = _subject(source, paper)
    scenes = _scenes(source, of, paper)
    lacking = [name for name in only if name != SHEET and name not in scenes]
    if lacking or (animate and of is None):
        raise BadInputError(f"{source} holds nothing to draw {(lacking or list(animate))[0]} from; leave it out")
    with beside(target) as staging, tempfile.TemporaryDirectory(dir=staging) as cells:
        drawings = placed(scenes, only or (() if animate else (*scenes, SHEET)), paper, staging, Path(cells))
        whole = SHEET in only or not (only or animate)
        sheet = Sheet(list(drawings) if whole else [], paper.transparent)
        if animate and of is not None:
            movies = [staging / movie(kind) for kind in dict.fromkeys(animate)]
            drawings[movies[0]] = _animation(of, seconds, movies, ffmpeg, paper)
        _paint(drawings, sheet, progress)
        if whole:
            sheet.write(staging / picture(SHEET))
        names = sorted(path.name for path in staging.iterdir() if path.is_file())
    return Rendered(tuple(target / name for name in names))


def usual_page(only: Sequence[str], animate: Sequence[str]) -> Page:
    """The page where none is given: a smaller one for movies."""
    return Page(*MOVIE) if animate and not only else Page()


def _check(only: Sequence[str], animate: Sequence[str], page: Page) -> None:
    if not isinstance(page, Page):
        raise BadInputError(f"page is of type {type(page).__name__}; give a Page, such as Page(800, 600)")
    views = "auto", *NAMED
    choices = ("picture", only, (*PICTURES, REDESIGN, SHEET)), ("movie", animate, MOVIES), ("view", [page.view], views)
    for what, names, known in choices:
        unknown = [name for name in names if name not in known]
        if unknown:
            raise BadInputError(f"{what} {unknown[0]!r} is not known; give {', '.join(known)}")


def _subject(source: Path, page: Page) -> Subject | None:
    """The winding in a folder; None if it has only a redesign."""
    if is_redesign(source) and not (source / PATHS).is_file():
        return None
    return subject_of(read_results(source), page.view)


def _scenes(source: Path, of: Subject | None, page: Page) -> dict[str, Scene]:
    scenes = {} if of is None else scenes_of(of)
    if is_redesign(source):
        name, units = _part(source) if of is None else (of.name, of.units)
        scenes[REDESIGN] = redesign_in(source, name, units, page.view)
    return scenes


def _part(source: Path) -> tuple[str, str]:
    """Name and unit of the part from a redesign's report; without one, the folder's name."""
    try:
        part = read_report(source)["mesh"]
        return str(part["name"]), reported_unit(str(part["units"]))
    except (BadInputError, LookupError, TypeError):
        return source.name, ""


def _animation(of: Subject, seconds: float, movies: list[Path], ffmpeg: str, page: Page) -> Drawing:
    make = reel_scene if of.filaments else animation_scene
    return Drawing(make(of, seconds, movies, ffmpeg), replace(page, transparent=False))


def _paint(drawings: Mapping[Path, Drawing], sheet: Sheet, progress: PictureProgress | None) -> None:
    scenes = [drawing.scene for drawing in drawings.values()]
    total = sum(1 + (scene.motion.frames if isinstance(scene, AnimationScene | ReelScene) else 0) for scene in scenes)
    done = 0

    def count(word: str) -> None:
        nonlocal done
        done += 1
        sheet.take(word)
        if progress is not None:
            progress(word, done, total)

    missing = driver.paint(drawings, count)
    if missing:
        raise BadInputError(missing)
