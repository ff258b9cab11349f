"""Wind a mesh and write the results with their pictures into a folder."""

from dataclasses import dataclass, fields, replace
from os import PathLike, fspath
from pathlib import Path
from tempfile import TemporaryDirectory

from meshwind.core.errors import BadInputError
from meshwind.core.version import version
from meshwind.mesh import check_file
from meshwind.path import Paths, Status
from meshwind.pictures import driver
from meshwind.pictures.fit_scene import fit_scene
from meshwind.pictures.gallery import placed, scenes_of, write_sheet
from meshwind.pictures.page import Page
from meshwind.pictures.revolutions_picture import draw_revolutions
from meshwind.pictures.scenes import Drawing
from meshwind.pictures.subject import subject_in
from meshwind.planning.pins import check_pins
from meshwind.results import folder
from meshwind.results.config_file import write_config
from meshwind.results.layup_figures import parted
from meshwind.results.laminate_files import write_laminate
from meshwind.results.report import RunFacts, report, write_report
from meshwind.results.report_types import Report
from meshwind.results.schema import CONFIG, FIT_PICTURE, REPORT, REVOLUTIONS_PICTURE, SHEET, WINDING, picture
from meshwind.results.write import write_files
from meshwind.surface import Surface
from meshwind.workflow.clock import Clock, Progress
from meshwind.workflow.layer_plans import read_layers
from meshwind.workflow.notes import Note
from meshwind.workflow.options import Options
from meshwind.workflow.part import MeshLike, fit_part, read_source
from meshwind.workflow.winding import Winding, wind_part


@dataclass(frozen=True, repr=False)
class Result(Winding):
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
    layered : Layered or None
        The layers one on another, with `layers`.

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
    def of(cls, winding: Winding) -> "Result":
        """The result whose winding is given."""
        return cls(**{each.name: getattr(winding, each.name) for each in fields(winding)})

    def __repr__(self) -> str:
        at_rest = int((self.paths.status == Status.CONVERGED).sum())
        return f"<meshwind Result: {self.mesh.name}, {at_rest} of {len(self.paths)} paths at rest>"

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
        """Revolutions from end to end, as chosen where they were "auto"."""
        return float(self.options.revolutions) if self.chosen is None else self.chosen.choice

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
            linear_density=self.options.linear_density,
            laminate=None if self.layered is None else self.layered.laminate,
        )
        return report(self.layup, self.mesh, self.chart, run)

    def write(self, out: str | PathLike[str], render: bool = True, overwrite: bool = False) -> "Result":
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
        return _write(self, folder.named(out), render, overwrite, Clock())


def wind(  # noqa: PLR0913
    mesh: MeshLike,
    *,
    paths: int = Options.paths,
    revolutions: float | str = Options.revolutions,
    friction: float | str = Options.friction,
    component: int | None = Options.component,
    ends: str = Options.ends,
    opening: float | None = Options.opening,
    side: str = Options.side,
    opening_by: str = Options.opening_by,
    tolerance: float = Options.tolerance,
    threshold: float | None = Options.threshold,
    worst_fit: float = Options.worst_fit,
    units: str | None = Options.units,
    particles: int | None = Options.particles,
    spacing: float | None = Options.spacing,
    band_width: float | None = Options.band_width,
    linear_density: float | None = Options.linear_density,
    pins: str | PathLike[str] | None = Options.pins,
    layers: str | PathLike[str] | None = None,
    out: str | PathLike[str] | None = None,
    overwrite: bool = False,
    render: bool = True,
    command: str = "",
    progress: Progress | None = None,
) -> Result:
    """Wind a part: lay two families of taut paths on a triangle mesh.

    The mesh is read and repaired, opened at its two ends, flattened to the periodic rectangle and fitted with a
    B-spline surface; the paths are laid on the surface and assessed.

    Parameters
    ----------
    mesh : str, PathLike, Mesh, trimesh.Trimesh, pyvista.PolyData, meshio.Mesh or tuple of two arrays
        Mesh, or the path of its file; see `read` for those of other libraries.
    paths : int, default 12
        Number of paths per family; the two families turn in opposite senses.
    revolutions : float or str, default 0.5
        Turns of a path from end to end; "auto" picks the value with stable paths and least bridging.
    friction : float or str, default 0
        Coefficient of friction between fibre and part, or "field:NAME" for a scalar of the mesh file.
    component : int, optional
        Piece of the mesh file to take, by decreasing area; 0 is the largest.  By default the largest, with a warning
        if another one is large.
    ends : str, default "auto"
        Where the ends are: "auto", "x", "y", "z", two points "x,y,z x,y,z", or two open rims "loops 0 1"; see
        `annulus`.
    opening : float, optional
        Radius of the opening at a closed end, in the mesh's units.  By default it follows from the part.
    side : {"outer", "inner"}, default "outer"
        Skin of a part with a wall that is wound; see `annulus`.
    opening_by : {"auto", "level", "plane"}, default "auto"
        How a closed end is opened: along a level line of the distance to its pole, or by a plane square to the axis;
        see `annulus`.
    tolerance : float, default 1e-5
        Largest distance of a mesh vertex from the fitted surface, over the part's diagonal.
    threshold : float, optional
        Largest gap between fibre and surface that is no bridge, in the mesh's units; 0 counts every gap.  By default
        the surface's uncertainty.
    worst_fit : float, default 0.1
        Largest distance between surface and mesh that is accepted at all, over the part's diagonal.
    units : str, optional
        Unit of the mesh: "mm", "cm", "m", "um", "in" or "ft"; "" if it is not known.  Nothing is converted.  By
        default that of the mesh: the one that its file names, or "mm" for a file that names none.
    particles : int or None, default 401
        Number of particles per path.  None picks as many as an error of the lengths of 1e-5 needs.
    spacing : float, optional
        Largest distance between neighbouring paths, in the mesh's units: paths are added until it is kept.
    band_width : float, optional
        Width of the fibre band, in the mesh's units, for the coverage.  By default one layer per family.
    linear_density : float, optional
        Mass of the fibre per unit of its length, from which its mass is computed.
    pins : str or PathLike, optional
        CSV file of the paths' ends, see `read_pins`.  By default they are spread evenly over the rims.
    layers : str or PathLike, optional
        TOML file of a laminate, whose layers are wound one on another; the paths are then those of its first helical
        layer on the bare part.  By default there is none.
    out : str or PathLike, optional
        Folder for the results.  By default nothing is written.
    overwrite : bool, default False
        Whether to replace results that the folder holds already.
    render : bool, default True
        Whether to draw pictures into the folder as well.
    command : str, default ""
        Command line, for the report.
    progress : callable, optional
        Called with the name of each stage as it starts.

    Returns
    -------
    Result
        Paths, layup and figures.

    Raises
    ------
    BadInputError
        If the mesh cannot be wound, an argument cannot be used, or, without `overwrite`, the folder holds results.

    See Also
    --------
    solve : Lay paths between given ends on any surface.
    redesign : Change a part so that no path bridges.

    Examples
    --------
    >>> import meshwind as mw
    >>> result = mw.wind("data/tank.ply", paths=4, revolutions=0.3, particles=51)
    >>> result.settled, result.paths.points.shape
    (True, (8, 51, 3))
    """
    pinned = fspath(pins) if isinstance(pins, PathLike) else pins
    options = Options(
        paths, revolutions, particles, friction, component, ends, opening, side, opening_by,
        tolerance, threshold, worst_fit, units, spacing, band_width, linear_density, pinned,
    )  # fmt: skip
    plans = None if layers is None else read_layers(layers, options)
    clock = Clock(progress)
    target = None if out is None else folder.named(out)
    check_file(mesh)
    if pinned is not None:
        check_pins(pinned)  # before all the work
    if target is not None:
        folder.prepare(target, overwrite)
        if render:
            driver.start_probe()
    with clock.stage("read"):
        source = read_source(mesh, options)
    result = Result.of(wind_part(fit_part(source, options, clock), options, command, clock, plans))
    return result if target is None else _write(result, target, render, overwrite, clock)


def _write(result: Result, out: Path, render: bool, overwrite: bool, clock: Clock) -> Result:
    notes = result.notes
    with folder.writing(out, overwrite) as staging:
        with clock.stage("write"):
            wall = result.chart.annulus.wall
            measured = result.mesh if wall is None else wall.skin
            write_files(staging, result.layup, measured, result.mesh.units)
            if result.layered is not None:
                write_laminate(staging, result.layered.laminate, result.mesh.units)
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
    with TemporaryDirectory(dir=out) as cells:  # within, so that a killed run leaves nothing elsewhere
        pictures = placed(scenes_of(of), (WINDING, SHEET), Page(), out, Path(cells))
        work = dict(pictures)
        if any(note.picture == FIT_PICTURE for note in result.notes):
            work[out / FIT_PICTURE] = Drawing(fit_scene(result.surface, result.chart.annulus, name, units))
        missing = driver.paint(work)
        if not missing:
            write_sheet(out / picture(SHEET), list(pictures))
    return missing
