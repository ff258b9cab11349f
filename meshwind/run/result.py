"""The result of a winding, and its files with their pictures."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, fields, replace
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory

from meshwind.core.geometry import Data
from meshwind.core.version import version
from meshwind.mesh import Mesh
from meshwind.path import Paths, Status
from meshwind.results import folder
from meshwind.results.config_file import write_config
from meshwind.results.report import RunFacts, report, write_report
from meshwind.results.report_types import Report
from meshwind.results.schema import CONFIG, FILAMENT, REPORT, REVOLUTIONS_PICTURE
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
    with folder.writing(out, overwrite) as staging:
        missing = _write_all(result, staging, render, clock)
        notes = (*result.notes, Note(missing, warning=True)) if missing else result.notes
        notes = tuple(note.shown((staging / note.picture).is_file()) for note in notes)
        result = replace(result, seconds=result.seconds | clock.seconds, notes=notes)
        write_config(staging / CONFIG, out, _used(result, out, render), version())
        write_report(staging / REPORT, result.report())
    return result


def _write_all(result: Result, out: Path, render: bool, clock: Clock) -> str:
    """Write all files but those that hold the time that this takes; return "" or what is missing for drawing."""
    with ExitStack() as stack:
        pictures = None
        with clock.stage("write"):
            if render:
                # late: runs without pictures need not wait for what draws
                from meshwind.run.drawing import drawing

                pictures = stack.enter_context(drawing(result, out))
                if result.chosen is not None:
                    from meshwind.pictures.revolutions_picture import draw_revolutions

                    draw_revolutions(out / REVOLUTIONS_PICTURE, result.chosen, result.mesh.name)
            maps = result.maps
            write_files(out, result.layup, maps, result.mesh.units)
            _write_layers(result, out)
        if pictures is None:
            return ""
        with clock.stage("render"):
            pictures.go_on(maps)
            result.report()  # what it works out is kept, and this process would wait
            return pictures.finish()


def _write_layers(result: Result, out: Path) -> None:
    """Write the files of filaments and of layers."""
    units, band = result.mesh.units, result.plain.band
    if result.filaments:
        from meshwind.results.filament_file import write_filaments

        write_filaments(out / FILAMENT, result.filaments, units)
    if result.layered is not None:
        from meshwind.results.laminate_files import write_laminate

        write_laminate(out, result.layered.laminate, units)
    elif band.width is not None and result.plain.stations is not None:
        from meshwind.results.laminate_files import write_stations

        write_stations(out, [(result.plain.stations, result.plain.thickness)], units)


def _used(result: Result, out: Path, render: bool) -> dict[str, object]:
    """All options, with which the run can be repeated."""
    options, layers = result.options, None
    if result.layered is not None:
        options, layers = result.layered.options, result.layered.file
    files = {"pins": None if options.pins is None else Path(options.pins), "layers": layers}
    return {"mesh": result.source, "out": out} | options.written() | files | {"render": render}
