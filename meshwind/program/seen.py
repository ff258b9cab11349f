"""A program for the eye: the chart of its axes, the movie of the machine, and the page for a browser."""

from collections.abc import Callable, Sequence
from pathlib import Path

from meshwind.core.errors import BadInputError
from meshwind.pictures import driver
from meshwind.pictures.animation_scene import Reel
from meshwind.pictures.axes_picture import draw_axes
from meshwind.pictures.drawings import Drawing
from meshwind.pictures.movie import encoder
from meshwind.pictures.page import Page
from meshwind.pictures.subject import subject_of
from meshwind.program.axes_chart import axes_chart
from meshwind.program.machine_scene import machine_scene
from meshwind.program.page import write_page
from meshwind.program.program import Program
from meshwind.results.reading import Results
from meshwind.results.schema import AXES_PICTURE, MOVIES, program_movie

SECONDS = 10.0
"""How long the movie of a program takes, where nothing else is said."""
_SIZE = 960, 720
"""Pixels of a movie, as of the movies of a run."""
AXES, VIEWER = "axes", "viewer"
SEEN = AXES, VIEWER, *MOVIES
"""Names of what can be made."""


def write_seen(
    folder: Path,
    results: Results,
    made: Program,
    names: Sequence[str],
    seconds: float = SECONDS,
    progress: Callable[[str], None] | None = None,
) -> None:
    """Write some of `SEEN` into an existing folder; progress: called for each frame of a movie.

    Raises BadInputError if this machine cannot draw or encode a movie, or the seconds are out of range.
    """
    movies = [folder / program_movie(kind) for kind in MOVIES if kind in names]
    if AXES in names:
        draw_axes(folder / AXES_PICTURE, axes_chart(made))
    if VIEWER in names:
        write_page(folder, results, made)
    if movies:
        reel = Reel(float(made.blocks.arc_length[-1]), seconds, movies, encoder() if "mp4" in names else "")
        scene = machine_scene(subject_of(results), made, reel)
        missing = driver.paint({movies[0]: Drawing(scene, Page(*_SIZE))}, progress)
        if missing:
            raise BadInputError(missing)
