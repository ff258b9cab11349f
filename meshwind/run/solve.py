"""Solving the shell deck of a folder with CalculiX: fields, figures, and a picture of how near plies are to failure."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

from meshwind.core.checks import path_given
from meshwind.core.errors import BadInputError
from meshwind.exporting.shell_about import again, fingerprint, fingerprint_of_run, read_about
from meshwind.pictures import driver
from meshwind.pictures.drawings import Drawing
from meshwind.pictures.solved_scene import solved_scene
from meshwind.results.folder import beside
from meshwind.results.schema import SHELL, SHELL_ABOUT, SOLVED, SOLVED_FIGURES, SOLVED_PICTURE
from meshwind.run.loaded import LoadedResult
from meshwind.solving import calculix
from meshwind.solving.deck import read_deck
from meshwind.solving.fields import solved
from meshwind.solving.figures import SolvedFigures, figures, lines
from meshwind.solving.files import write_solved
from meshwind.solving.tables import read_tables

Stage = Callable[[str], None]
"""Called with the name of each stage as it starts."""


@dataclass(frozen=True)
class Solution:
    """What CalculiX made of a deck.

    Attributes
    ----------
    figures : dict
        What solved.json holds: the largest displacement, the ply that is nearest to failure, and the load factor.
    files : tuple of Path
        The files.
    notes : tuple of str
        What a user should know of them.

    Examples
    --------
    >>> import meshwind as mw
    >>> result = mw.wind("data/tank.ply", paths=12, out="out", render=False)
    >>> done = mw.export("out", "inp", thickness=0.4, elements=300, axial=100)
    >>> mw.solve_deck("out", render=False).figures["largest"]["load_factor"] > 1
    True
    """

    figures: SolvedFigures
    files: tuple[Path, ...]
    notes: tuple[str, ...]

    @property
    def summary(self) -> str:
        """The figures in words."""
        return "\n".join(lines(self.figures))


def solve_deck(
    run: str | PathLike[str] | LoadedResult,
    *,
    ccx: str = calculix.PROGRAM,
    out: str | PathLike[str] | None = None,
    render: bool = True,
    progress: Stage | None = None,
) -> Solution:
    """Solve the shell deck that an export left in a folder, with CalculiX.

    Stresses are taken in the axes of the fibres of each ply, and held against the strengths of the material by the
    criterion of Tsai and Wu.  All files appear, or none: solved.vtu with the fields, solved.json, solved.png.

    Parameters
    ----------
    run : str, PathLike or LoadedResult
        Folder with the deck: that of the run, or the other one that it was exported to.
    ccx : str, default "ccx"
        CalculiX's program: its name, or its path.
    out : str or PathLike, optional
        Folder for the files.  By default that of the deck.
    render : bool, default True
        Whether to draw the picture.
    progress : callable, optional
        Called with the name of each stage as it starts.

    Returns
    -------
    Solution
        The `figures`, the `files` that were written, and `notes`.

    Raises
    ------
    BadInputError
        If there is no deck or no CalculiX, the deck is of another run, or CalculiX cannot solve it.

    Examples
    --------
    >>> import meshwind as mw
    >>> result = mw.wind("data/tank.ply", paths=12, out="out", render=False)
    >>> done = mw.export("out", "inp", thickness=0.4, elements=300, axial=100)
    >>> solution = mw.solve_deck("out", render=False)
    >>> [file.name for file in solution.files]
    ['solved.json', 'solved.vtu']
    """
    say = progress or (lambda _stage: None)
    folder = run.folder if isinstance(run, LoadedResult) else path_given(run, "run", "folder of an export")
    target = folder if out is None else path_given(out, "out", "folder")
    file = folder / SHELL
    if not file.is_file():
        raise BadInputError(f"{folder} has no {SHELL} to solve; write it first: {again()}")
    about = read_about(folder / SHELL_ABOUT)
    if (here := fingerprint_of_run(folder)) and here != about.run:
        raise BadInputError(f"{file} is of another run than {folder} holds; write it again: {again()}")
    program = calculix.found(ccx)
    if render:
        driver.start_probe()
    deck, print_of_deck = read_deck(file), fingerprint(file)
    with beside(target) as staging:
        with tempfile.TemporaryDirectory(dir=staging) as work:
            say("solve")
            tables = read_tables(calculix.run(program, file, Path(work)), deck)
        say("assess")
        done = solved(deck, tables, about.units, about.strengths)
        made = figures(done, about, print_of_deck)
        notes = list(made["notes"])
        write_solved(staging / SOLVED, done, about.units)
        if render:
            say("draw")
            missing = driver.paint({staging / SOLVED_PICTURE: Drawing(solved_scene(done, made))})
            notes += [missing] if missing else []
        (staging / SOLVED_FIGURES).write_text(json.dumps(made, indent=2, allow_nan=False) + "\n", encoding="utf-8")
        names = sorted(path.name for path in staging.iterdir() if path.is_file())
    return Solution(made, tuple(target / name for name in names), tuple(notes))
