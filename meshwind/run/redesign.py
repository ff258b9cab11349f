"""Write a redesign into a folder: the edited mesh, its pictures and its report, whole or not at all."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from os import PathLike
from pathlib import Path

from meshwind.appearance.view import View
from meshwind.core.checks import check_type, path_given
from meshwind.core.opencascade import is_there
from meshwind.core.version import version
from meshwind.editing.notes import about_wall
from meshwind.editing.redesign import Redesign
from meshwind.editing.report import redesign_report
from meshwind.exporting.step import write_step_of
from meshwind.layup.layup import assess
from meshwind.pictures import driver
from meshwind.pictures.drawings import Drawing
from meshwind.pictures.history_scenes import rounds_scene, slice_scene
from meshwind.pictures.redesign_scene import redesign_scene
from meshwind.pictures.scenes import RoundsScene, Scene
from meshwind.pictures.subject import subject
from meshwind.pictures.winding_scene import winding_scene
from meshwind.results import folder
from meshwind.results.config_file import write_config
from meshwind.results.redesign_report_types import RedesignReport
from meshwind.results.report import write_report
from meshwind.results.schema import AFTER, BEFORE, CONFIG, EDITED_STEP, REDESIGN, REPORT, ROUNDS, SLICE, File, picture
from meshwind.results.write import write_edited
from meshwind.workflow.clock import Clock
from meshwind.workflow.notes import Note, about_file, about_opening


def write_redesign(
    edited: Redesign,
    out: str | PathLike[str],
    *,
    units: str | None = None,
    render: bool = True,
    overwrite: bool = False,
    command: str = "",
    seconds: dict[str, float] | None = None,
    options: Mapping[str, object] | None = None,
) -> RedesignReport:
    """Write the results of a redesign into a folder.

    The folder gets `edited.ply`, `edited.vtu`, `report.json`, with `options` also `meshwind.toml`, and with `render`
    the pictures `before.png` and `after.png` of the windings, `redesign.png` of what was moved, `slice.png`, a cut
    along the worst bridge, and `rounds.png`, how the rounds went; with meshwind[cad] also `edited.step`, the surface
    fitted to the edited mesh.  All files appear, or none.

    Parameters
    ----------
    edited : Redesign
        Result of `redesign`.
    out : str or PathLike
        Folder for the files.
    units : str, optional
        Unit of the mesh; "" if it is not known.  By default that of the mesh that was edited.
    render : bool, default True
        Whether to draw the pictures.
    overwrite : bool, default False
        Whether to replace results that the folder holds already.
    command : str, default ""
        Command line, for the report.
    seconds : dict of str to float, optional
        Wall times of earlier stages, for the report.
    options : mapping of str to object, optional
        Options by their names on the command line, for `meshwind.toml`.

    Returns
    -------
    dict
        Contents of `report.json`, with a note where pictures could not be drawn.

    Raises
    ------
    BadInputError
        If the folder cannot be written or, without `overwrite`, holds results.

    Examples
    --------
    >>> import meshwind as mw
    >>> edited = mw.redesign("data/tank.ply", revolutions=0.3, paths=3, particles=51)
    >>> report = mw.write_redesign(edited, "out", units="mm", render=False)
    >>> report["redesign"]["windable"]
    True
    """
    check_type(edited, "edited", Redesign, "as redesign returns it")
    target = path_given(out, "out", "folder")
    clock = Clock()
    edited = edited if units is None else replace(edited, part=edited.part.in_units(units))
    units = edited.part.units
    opened = about_opening(edited.before.chart.annulus)
    notes = [str(note) for note in (*about_file(edited.part), *opened, *about_wall(edited, units))]
    with folder.writing(target, overwrite) as staging:
        with clock.stage("write"):
            write_edited(staging, edited.mesh, edited.displacement, units)
            if is_there():
                write_step_of(staging / EDITED_STEP, edited.after.surface, units, edited.part.name)
        if render:
            with clock.stage("render"):
                missing = driver.paint(_pictures(staging, edited, units))
            notes += [str(Note(missing, warning=True))] if missing else []
        spent = dict(seconds or {}) | clock.seconds
        report = redesign_report(edited, command=command, seconds=spent, notes=notes)
        if options is not None:
            write_config(staging / CONFIG, target, options, version(), "redesign")
        write_report(staging / REPORT, report)
    return report


def _pictures(out: Path, edited: Redesign, units: str) -> dict[Path, Drawing]:
    part, name = edited.part, edited.part.name
    which = _shown(edited)
    course, turns = edited.windings[which], edited.windings[which].revolutions
    wound = "" if len(edited.windings) == 1 else f", {course.name}"
    laid = edited.before.wound[which], edited.after.wound[which]
    before = winding_scene(subject(assess(laid[0]), f"{name}, as it was{wound}", units, turns))
    view = before.frame.view
    after = winding_scene(subject(assess(laid[1]), f"{name}, edited{wound}", units, turns, view))
    most = max(before.max_gap, after.max_gap)  # one scale for both
    moved = redesign_scene(part.vertices, edited.displacement, part.faces, name, units)
    cut = slice_scene(*laid, part.vertices, edited.displacement, part.faces, (name, units), view)
    scenes: dict[File, Scene | None] = {
        BEFORE: replace(before, max_gap=most), AFTER: replace(after, max_gap=most), picture(REDESIGN): moved,
        SLICE: cut, ROUNDS: _rounds(edited, units, view),
    }  # fmt: skip
    return {out / file: Drawing(scene) for file, scene in scenes.items() if scene is not None}


def _shown(edited: Redesign) -> int:
    """The winding that pictures show: of those of two families the one with the largest gap before."""
    helical = [k for k, course in enumerate(edited.windings) if not course.is_hoop] or [0]
    return max(helical, key=lambda k: edited.before.gaps[k])


def _rounds(edited: Redesign, units: str, view: View) -> RoundsScene | None:
    """The history of the rounds; None without any."""
    if not edited.rounds:
        return None
    first = edited.rounds[0]
    names = [(stage, number) for stage, rounds in enumerate(edited.stages, 1) for number in range(1, len(rounds) + 1)]
    return rounds_scene(
        [first.gap_before, *(each.gap_after for each in edited.rounds)],
        [first.bridged_before, *(each.bridged_after for each in edited.rounds)],
        [0.0, *(each.change for each in edited.rounds)], [(1, 0), *names], first.threshold, edited.part.name, units,
        view,
    )  # fmt: skip
