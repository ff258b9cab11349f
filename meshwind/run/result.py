"""The result of a winding, and its files with their pictures."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, fields, replace
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory

from meshwind.core.geometry import Data
from meshwind.core.version import version
from meshwind.mesh import Mesh
from meshwind.path import Paths, Status
from meshwind.pictures import driver
from meshwind.pictures.drawings import Drawing
from meshwind.pictures.fit_scene import fit_scene
from meshwind.pictures.gallery import names_of, placed, scenes_of, write_sheet
from meshwind.pictures.page import Page
from meshwind.pictures.revolutions_picture import draw_revolutions
from meshwind.pictures.subject import subject_in
from meshwind.results import folder
from meshwind.results.config_file import write_config
from meshwind.results.filament_file import write_filaments
from meshwind.results.laminate_files import write_laminate, write_stations
from meshwind.results.laminate_reading import read_laminate
from meshwind.results.layup_figures import parted
from meshwind.results.report import RunFacts, report, write_report
from meshwind.results.report_types import Report
from meshwind.results.schema import (
    CONFIG,
    FILAMENT,
    FIT_PICTURE,
    REPORT,
    REVOLUTIONS_PICTURE,
    SHEET,
    WINDING,
    picture,
)
from meshwind.results.write import surface_maps, write_files
from meshwind.run.views import Views
from meshwind.surface import Surface
from meshwind.workflow.clock import Clock
from meshwind.workflow.notes import Note
from meshwind.workflow.winding import Winding


@dataclass(frozen=True, repr=False)
class Result(Winding, Views):
    """A wound part: the results of all stages.

    Attributes
    ----------
    mesh : Mesh
        Repaired mesh.
    chart : Chart
        Flattened mesh.
    layup : Layup
        Paths with crossings, quads and coverage.
    options : Options
        Options that the part was wound with.
    command : str
        Command line, for the report.
    seconds : dict of str to float
        Wall time of each stage.
    notes : tuple of Note
        What a user should know beside the figures; warnings say that the results may not be what was wanted.
    chosen : Revolutions or None
        How the revolutions were chosen, with revolutions="auto".
    spaced : Spaced or None
        How paths were added, with `spacing`.
    source : Path or None
        File of the mesh, if it came from one.
    closed : ClosedLayer or None
        The layer as one filament, with `continuous`.
    layered : Layered or None
        The layers one on another, with `layers`.
    turns : float
        Revolutions that were given, chosen, or found for an angle.
    plain : PlainLayer
        The layer that the paths are: angle and cover along the part, and thickness where that of the band is known.

    See Also
    --------
    wind : Wind a part.

    Examples
    --------
    >>> import meshwind as mw
    >>> mw.wind("data/tank.ply", paths=4, revolutions=0.3, particles=51)
    <meshwind Result: tank.ply, 8 of 8 paths at rest>
    """

    @classmethod
    def of(cls, winding: Winding) -> Result:
        """The result whose winding is given."""
        return cls(**{each.name: getattr(winding, each.name) for each in fields(winding)})

    __repr__ = Views.__repr__

    @property
    def name(self) -> str:
        """Name of the part."""
        return self.mesh.name

    @property
    def units(self) -> str:
        """Name of the unit of length, "" where it is not known."""
        return self.mesh.units

    @property
    def diagonal(self) -> float:
        """Diagonal of the part, in the mesh's units."""
        return self.mesh.diagonal

    @property
    def maps(self) -> Data:
        """The maps of surface.vtu, by name, at the points of its grid."""
        return surface_maps(self.layup, self.measured)

    @property
    def measured(self) -> Mesh:
        """The mesh that the surface's error is measured to."""
        wall = self.chart.annulus.wall
        return self.mesh if wall is None else wall.skin

    @contextmanager
    def in_folder(self) -> Iterator[Path]:
        """Yield a folder for a while, with the files of the run but its pictures.

        Yields
        ------
        Path
            The folder.

        Examples
        --------
        >>> import meshwind as mw
        >>> result = mw.wind("data/tank.ply", paths=3, particles=51)
        >>> with result.in_folder() as folder:
        ...     (folder / "report.json").is_file()
        True
        """
        with TemporaryDirectory() as folder:
            out = Path(folder) / "run"
            write_result(self, out, False, False, Clock())
            yield out

    @property
    def surface(self) -> Surface:
        """The fitted surface."""
        return self.layup.paths.surface

    @property
    def paths(self) -> Paths:
        """All paths, family +1 first."""
        return self.layup.paths

    @property
    def settled(self) -> bool:
        """Whether every path is in equilibrium."""
        return bool((self.paths.status == Status.CONVERGED).all())

    @property
    def revolutions(self) -> float:
        """Revolutions from end to end, as chosen where they were "auto", and as they close where they are to."""
        return self.turns if self.closed is None else self.closed.revolutions

    def report(self) -> Report:
        """Collect the figures of the run.

        Returns
        -------
        dict
            Contents of `report.json`: lengths in the mesh's units, angles in degrees.

        Examples
        --------
        >>> import meshwind as mw
        >>> report = mw.wind("data/tank.ply", paths=4, revolutions=0.3, particles=51).report()
        >>> report["paths"]["converged"], report["winding"]["paths_per_family"]
        (8, 4)
        """
        run = RunFacts(
            self.revolutions,
            command=self.command,
            tolerance=self.options.tolerance,
            seconds=self.seconds,
            notes=[str(note) for note in self.notes],
            chosen=self.chosen,
            spaced=self.spaced,
            plain=self.plain,
            closed=self.closed,
            laminate=None if self.layered is None else self.layered.laminate,
            filaments=self.filaments,
        )
        return report(self.layup, self.mesh, self.chart, run)

    def write(self, out: str | PathLike[str], render: bool = True, overwrite: bool = False) -> Result:
        """Write all files of the run into a folder; all appear, or none.

        `fit_error.png` is drawn where a note warns of the fit.

        Parameters
        ----------
        out : str or PathLike
            Folder for the files.
        render : bool, default True
            Whether to draw the pictures.
        overwrite : bool, default False
            Whether to replace results that the folder holds already.

        Returns
        -------
        Result
            The result, with the wall time of writing and, where pictures could not be drawn, a note on what to
            install.

        Raises
        ------
        BadInputError
            If the folder cannot be written or, without `overwrite`, holds results.

        Examples
        --------
        >>> from pathlib import Path
        >>> import meshwind as mw
        >>> result = mw.wind("data/tank.ply", paths=4, revolutions=0.3, particles=51).write("out", render=False)
        >>> Path("out/paths.vtp").is_file()
        True
        """
        return write_result(self, folder.named(out), render, overwrite, Clock())


def write_result(result: Result, out: Path, render: bool, overwrite: bool, clock: Clock) -> Result:
    """Write all files of a run into a folder; see `Result.write`."""
    notes = result.notes
    with folder.writing(out, overwrite) as staging:
        with clock.stage("write"):
            write_files(staging, result.layup, result.measured, result.mesh.units)
            if result.filaments:
                write_filaments(staging / FILAMENT, result.filaments, result.mesh.units)
            if result.layered is not None:
                write_laminate(staging, result.layered.laminate, result.mesh.units)
            elif result.plain.band.width is not None and result.plain.stations is not None:
                write_stations(staging, [(result.plain.stations, result.plain.thickness)], result.mesh.units)
            if result.chosen is not None and render:
                draw_revolutions(staging / REVOLUTIONS_PICTURE, result.chosen, result.mesh.name)
        if render:
            with clock.stage("render"):
                missing = _draw(result, staging)
            notes = (*notes, Note(missing, warning=True)) if missing else notes
        notes = tuple(note.shown((staging / note.picture).is_file()) for note in notes)
        result = replace(result, seconds=result.seconds | clock.seconds, notes=notes)
        write_config(staging / CONFIG, out, _used(result, out, render), version())
        write_report(staging / REPORT, result.report())
    return result


def _used(result: Result, out: Path, render: bool) -> dict[str, object]:
    """All options, with which the run can be repeated."""
    options, layers = result.options, None
    if result.layered is not None:
        options, layers = result.layered.options, result.layered.file
    files = {"pins": None if options.pins is None else Path(options.pins), "layers": layers}
    return {"mesh": result.source, "out": out} | options.written() | files | {"render": render}


def _draw(result: Result, out: Path) -> str:
    """Draw the winding, the picture of a warning and the contact sheet; return "" or what is missing for drawing."""
    name, units = result.mesh.name, result.mesh.units
    of = subject_in(out, result.layup, name, units, result.revolutions)
    of = replace(of, partings=parted(result.layup, result.spaced))
    if result.filaments or result.layered is not None:
        figures = result.report()
        of = of.layered(read_laminate(out, result.surface), figures.get("laminate", []))
        of = of.wound(result.filaments, figures.get("pattern", [])) if result.filaments else of
    asked = (WINDING, SHEET, *names_of(of))
    with TemporaryDirectory(dir=out) as cells:  # within, so that a killed run leaves nothing elsewhere
        pictures = placed(scenes_of(of), asked, Page(), out, Path(cells))
        work = dict(pictures)
        if any(note.picture == FIT_PICTURE for note in result.notes):
            work[out / FIT_PICTURE] = Drawing(fit_scene(result.surface, result.chart.annulus, name, units))
        missing = driver.paint(work)
        if not missing:
            write_sheet(out / picture(SHEET), list(pictures))
    return missing
