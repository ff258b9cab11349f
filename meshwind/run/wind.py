"""Wind a mesh and write the results with their pictures into a folder."""

from dataclasses import asdict, dataclass, fields, replace
from os import PathLike, fsencode, fspath
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from meshwind.core.errors import BadInputError
from meshwind.core.version import version
from meshwind.mesh import Mesh
from meshwind.path import Paths, Status
from meshwind.pictures import driver
from meshwind.pictures.fit_scene import fit_scene
from meshwind.pictures.kinds import SHEET, scenes_of
from meshwind.pictures.page import Page
from meshwind.pictures.render import placed
from meshwind.pictures.revolutions_picture import draw_revolutions
from meshwind.pictures.sheet import write_sheet
from meshwind.pictures.subject import subject_in
from meshwind.results import folder
from meshwind.results.config_file import NAME as CONFIG
from meshwind.results.config_file import write_config
from meshwind.results.report import report, write_report
from meshwind.results.write import write_files
from meshwind.surface import Surface
from meshwind.workflow.clock import Clock, Progress
from meshwind.workflow.notes import FIT_ERROR, Note
from meshwind.workflow.options import Options
from meshwind.workflow.part import fit_part, read_source
from meshwind.workflow.winding import Winding, wind_part


@dataclass(frozen=True, repr=False)
class Result(Winding):
    """A wound part: what every stage made, and what the run cost.

    options are those it was wound with; seconds holds each stage's wall time; notes say what the user should
    know beside the figures; chosen and spaced: how revolutions and spacing were found, where that was asked for;
    source: the mesh's file, if it came from one.
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
        """Whether every path came to rest."""
        return bool((self.paths.status == Status.CONVERGED).all())

    @property
    def revolutions(self) -> float:
        """Turns from end to end: as asked for or, with "auto", as chosen."""
        return float(self.options.revolutions) if self.chosen is None else self.chosen.choice

    def report(self) -> dict[str, Any]:
        """The figures that report.json holds; lengths in the mesh's units, angles in degrees."""
        return report(
            self.layup,
            self.mesh,
            self.chart,
            revolutions=self.revolutions,
            command=self.command,
            units=self.options.units,
            tolerance=self.options.tolerance,
            seconds=self.seconds,
            notes=[str(note) for note in self.notes],
            chosen=self.chosen,
            spaced=self.spaced,
            linear_density=self.options.linear_density,
        )

    def write(self, out: str | PathLike[str], render: bool = True, overwrite: bool = False) -> "Result":
        """Write all files of the run into the folder `out`, whole or not at all.

        overwrite: whether results of an earlier run there are replaced, or removed where this one has none; without
        it they raise BadInputError.  Returns the result with the time that writing and drawing took and, where there
        is no OpenGL driver for the pictures, a note that says what to install.  fit_error.png is drawn where a note
        warns of the fit.
        """
        return _write(self, _folder(out), render, overwrite, Clock())


def wind(
    mesh: str | PathLike[str] | Mesh,
    *,
    paths: int = 12,
    revolutions: float | str = 0.5,
    friction: float | str = 0.0,
    component: int = 0,
    ends: str = "auto",
    opening: float | None = None,
    tolerance: float = 1e-5,
    worst_fit: float = 0.1,
    units: str = "",
    particles: int | None = 401,
    spacing: float | None = None,
    band_width: float | None = None,
    linear_density: float | None = None,
    pins: str | PathLike[str] | None = None,
    out: str | PathLike[str] | None = None,
    overwrite: bool = False,
    render: bool = True,
    command: str = "",
    progress: Progress | None = None,
) -> Result:
    """Lay two families of taut paths on a triangle mesh.

    mesh: a file or a `Mesh`; paths: a family; revolutions: turns from end to end, or "auto"; friction: coefficient, or
    "field:NAME" for a scalar of the mesh file; component: which piece of a file, by its rank of area; ends: "auto",
    "x", "y", "z", two points "x,y,z x,y,z" or two rims "loops 0 1"; opening: radius at a closed end in the mesh's
    units; tolerance: largest distance of a vertex from the surface over the mesh's diagonal; worst_fit: largest
    distance between surface and mesh, over the diagonal, that is wound at all; units: the name of the mesh's unit
    (mm, cm, m, um, in, ft), "" if unknown; particles: a path, None for as many as lengths right to 1e-5 need;
    spacing: paths are added until neighbours lie no further apart; band_width: of the fibre, by default one layer a
    family; linear_density: its mass over its length; pins: a CSV file of the paths' ends (`read_pins`); out: folder
    for the files; overwrite: replace the results that it holds; render: draw the pictures as well.  Raises
    BadInputError, in one line, for whatever the caller can mend.
    """
    pinned = fspath(pins) if isinstance(pins, PathLike) else pins
    options = Options(
        paths, revolutions, particles, friction, component, ends, opening, tolerance, worst_fit, units,
        spacing, band_width, linear_density, pinned,
    )  # fmt: skip
    if not isinstance(mesh, str | PathLike | Mesh):
        raise BadInputError(f"mesh is of type {type(mesh).__name__}; give the path of a mesh file or a meshwind.Mesh")
    clock = Clock(progress)
    target = None if out is None else _folder(out)
    if target is not None:
        folder.prepare(target, overwrite)
        if render:
            driver.start_probe()
    with clock.stage("read"):
        source = read_source(mesh, options)
    result = Result.of(wind_part(fit_part(source, options, clock), options, command, clock))
    return result if target is None else _write(result, target, render, overwrite, clock)


def _folder(out: str | PathLike[str]) -> Path:
    if not isinstance(out, str | PathLike) or not fspath(out).strip():
        raise BadInputError(f"out is {out!r}; give the path of a folder for the results")
    try:
        named = b"\0" not in fsencode(out)
    except UnicodeEncodeError:
        named = False
    if not named:
        raise BadInputError(f"out is {fspath(out)[:40]!r}, which no folder can be called; give another")
    return Path(out)


def _write(result: Result, out: Path, render: bool, overwrite: bool, clock: Clock) -> Result:
    notes = result.notes
    with folder.writing(out, overwrite) as staging:
        with clock.stage("write"):
            write_files(staging, result.layup, result.mesh, result.options.units)
            if result.chosen is not None and render:
                draw_revolutions(staging / "revolutions.png", result.chosen, result.mesh.name)
        if render:
            with clock.stage("render"):
                missing = _draw(result, staging)
            notes = (*notes, Note(missing, warning=True)) if missing else notes
        notes = tuple(note.shown((staging / note.picture).is_file()) for note in notes)
        result = replace(result, seconds=result.seconds | clock.seconds, notes=notes)
        write_config(staging / CONFIG, out, _used(result, out, render), version())
        write_report(staging / "report.json", result.report())
    return result


def _used(result: Result, out: Path, render: bool) -> dict[str, object]:
    """All options as used, for another run like this one."""
    options = asdict(result.options)
    pins = None if result.options.pins is None else Path(result.options.pins)
    return {"mesh": result.source, "out": out} | options | {"pins": pins, "render": render}


def _draw(result: Result, out: Path) -> str:
    """Draw the winding, what a warning wants to show and the contact sheet; return "" or what is missing and why."""
    name, units = result.mesh.name, result.options.units
    of = subject_in(out, result.layup, name, units, result.revolutions)
    with TemporaryDirectory(dir=out) as cells:  # a killed run leaves nothing elsewhere
        pictures = placed(scenes_of(of), ("winding", SHEET), Page(), out, Path(cells))
        work = dict(pictures)
        if any(note.picture == FIT_ERROR for note in result.notes):
            work[out / FIT_ERROR] = fit_scene(result.surface, result.chart.annulus, name, units)
        missing = driver.paint(work)
        if not missing:
            write_sheet(out / f"{SHEET}.png", list(pictures))
    return missing
