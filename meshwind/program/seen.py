"""A program for the eye: the chart of its axes, the movie of the machine, and the page for a browser."""

from collections.abc import Callable, Sequence
from itertools import count
from pathlib import Path

from meshwind.core.errors import BadInputError
from meshwind.pictures import driver
from meshwind.pictures.animation_scene import Reel, check_seconds
from meshwind.pictures.axes_picture import draw_axes
from meshwind.pictures.drawings import Drawing
from meshwind.pictures.movie import encoder
from meshwind.pictures.page import Page
from meshwind.pictures.subject import subject_of
from meshwind.program.axes_chart import axes_chart
from meshwind.program.hits_scene import hits_scene
from meshwind.program.machine_scene import machine_scene
from meshwind.program.page import write_page
from meshwind.program.program import Program
from meshwind.results.reading import Results
from meshwind.results.schema import AXES_PICTURE, HITS_PICTURE, MOVIES, program_movie

SECONDS = 10.0
"""How long the movie of a program takes, where nothing else is said."""
_SIZE = 960, 720
"""Pixels of a movie, as of the movies of a run."""
AXES, HITS, VIEWER = "axes", "hits", "viewer"
SEEN = AXES, HITS, VIEWER, *MOVIES
"""Names of what can be made."""
_TOLD = 10
"""Times that the progress of a movie is told: each takes up to a minute."""


def check(names: Sequence[str], seconds: float) -> None:
    """Raise BadInputError if a movie among names is too short or long, or this machine cannot encode it."""
    if any(kind in names for kind in MOVIES):
        check_seconds(seconds)
    if "mp4" in names:
        encoder()


def write_seen(
    folder: Path,
    results: Results,
    made: Program,
    names: Sequence[str],
    seconds: float = SECONDS,
    progress: Callable[[str], None] | None = None,
) -> list[str]:
    """Write some of `SEEN` into an existing folder; progress: called as each starts, and while a movie is drawn.

    Returns what the user should know: the hits are drawn where there are any and this machine can draw.  Raises
    BadInputError if this machine cannot draw or encode a movie, or the seconds are out of range.
    """
    say: Callable[[str], None] = progress or (lambda _stage: None)
    movies = [folder / program_movie(kind) for kind in MOVIES if kind in names]
    if AXES in names:
        say(AXES)
        draw_axes(folder / AXES_PICTURE, axes_chart(made))
    if VIEWER in names:
        say(VIEWER)
        write_page(folder, results, made)
    notes, of = [], subject_of(results) if movies or HITS in names else None
    if HITS in names and of is not None and (scene := hits_scene(of, made)) is not None:
        say(HITS)
        missing = driver.paint({folder / HITS_PICTURE: Drawing(scene)})
        notes += [missing] if missing else []
    if movies and of is not None:
        say("movie")
        reel = Reel(float(made.blocks.arc_length[-1]), seconds, movies, encoder() if "mp4" in names else "")
        moving = machine_scene(of, made, reel)
        done, total = count(1), moving.motion.frames

        def drawn(_word: str) -> None:
            frame = next(done)
            if frame * _TOLD // total > (frame - 1) * _TOLD // total and frame <= total:
                say(f"movie, {frame} of {total} frames")

        missing = driver.paint({movies[0]: Drawing(moving, Page(*_SIZE))}, drawn)
        if missing:
            raise BadInputError(missing)
    return notes
