"""The main job, mesh in and paths out.  Each stage is a library call; this file only strings them together."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from os import PathLike, fsencode, fspath
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any

from meshwind.chart import Chart, flatten
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import AUTO
from meshwind.core.version import version
from meshwind.layup.layup import Layup, assess
from meshwind.mesh import Mesh, annulus, read
from meshwind.mesh.io.scalars import Scalars, read_scalars
from meshwind.notes import FIT_ERROR, Note, about_choice, about_fit, about_layup, about_paths, about_spacing
from meshwind.options import FIELD, Options
from meshwind.path import Paths, Status, solve
from meshwind.path.friction import Friction, friction_from
from meshwind.pictures import driver
from meshwind.pictures.fit_scene import fit_scene
from meshwind.pictures.kinds import SHEET, scenes_of
from meshwind.pictures.page import Page
from meshwind.pictures.render import placed
from meshwind.pictures.revolutions_picture import draw_revolutions
from meshwind.pictures.sheet import write_sheet
from meshwind.pictures.subject import subject_in
from meshwind.planning.families import Families, families
from meshwind.planning.pins import read_pins
from meshwind.planning.revolutions import Revolutions, choose_revolutions
from meshwind.planning.spacing import Spaced, space_out
from meshwind.results import folder
from meshwind.results.config_file import NAME as CONFIG
from meshwind.results.config_file import write_config
from meshwind.results.report import report, write_report
from meshwind.results.write import write_files
from meshwind.surface import Surface, fit

Tell = Callable[[str], None]
"""Called with a stage's name as it starts."""


@dataclass(frozen=True, repr=False)
class Result:
    """A wound part: what every stage made, and what the run cost.

    options are those it was wound with; seconds holds each stage's wall time; notes say what the user should
    know beside the figures; chosen and spaced: how revolutions and spacing were found, where that was asked for;
    source: the mesh's file, if it came from one.
    """

    mesh: Mesh
    chart: Chart
    layup: Layup
    options: Options
    command: str
    seconds: dict[str, float]
    notes: tuple[Note, ...] = ()
    chosen: Revolutions | None = None
    spaced: Spaced | None = None
    source: Path | None = None

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
        return _write(self, _folder(out), render, overwrite, Clock(None))


class Clock:
    """Tells each stage as it starts and adds up what it took."""

    def __init__(self, tell: Tell | None) -> None:
        self.tell = tell
        self.seconds: dict[str, float] = {}

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Time what is done within it."""
        if self.tell is not None:
            self.tell(name)
        start = perf_counter()
        yield
        self.seconds[name] = self.seconds.get(name, 0.0) + perf_counter() - start


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
    progress: Tell | None = None,
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
    result = wind_part(fit_part(mesh, options, clock), options, command, clock)
    return result if target is None else _write(result, target, render, overwrite, clock)


@dataclass(frozen=True)
class Part:
    """A mesh with all that its windings share: the scalars of its friction field, chart, surface, and its file."""

    mesh: Mesh
    field: Scalars | None
    chart: Chart
    surface: Surface
    source: Path | None = None


def fit_part(mesh: str | PathLike[str] | Mesh, options: Options, clock: Clock, field: Scalars | None = None) -> Part:
    """Read, open, flatten and fit; field: of a mesh that is no file."""
    with clock.stage("read"):
        part = mesh if isinstance(mesh, Mesh) else read(mesh, options.component)
    held = _field(mesh, options.friction) if field is None else field
    with clock.stage("ends"):
        opened = annulus(part, ends=options.ends, opening=options.opening)
    with clock.stage("flatten"):
        chart = flatten(opened)
    with clock.stage("fit"):
        surface = fit(chart, options.tolerance)
    return Part(part, held, chart, surface, None if isinstance(mesh, Mesh) else Path(mesh))


def wind_part(part: Part, options: Options, command: str, clock: Clock) -> Result:
    """Lay the paths on a part that was fitted with the same options, and assess them."""
    surface = part.surface
    with clock.stage("fit"):
        notes = about_fit(surface, part.chart, options.tolerance, options.worst_fit, options.units)
        rough: float | Friction = 0.0
        if isinstance(options.friction, float):
            rough = options.friction
        elif part.field is not None:
            rough = friction_from(surface, part.field.points, part.field.values)
    chosen = _chosen(surface, options, rough, clock)
    turns = float(options.revolutions) if chosen is None else chosen.choice
    with clock.stage("wind"):
        rims = _rims(surface, options, turns)
        laid = solve(
            surface, rims.start, rims.end, family=rims.family, particles=options.particles, friction=rough
        )  # fmt: skip
        spaced = None if options.spacing is None else space_out(laid, turns, options.spacing, rough)
        laid = laid if spaced is None else spaced.paths
        notes = (*notes, *about_paths(laid), *about_choice(chosen), *about_spacing(spaced, options.units))
    with clock.stage("assess"):
        layup = assess(laid, options.band_width)
        notes = (*notes, *about_layup(layup))
    return Result(
        part.mesh, part.chart, layup, options, command, clock.seconds, notes, chosen, spaced, part.source
    )  # fmt: skip


def _rims(surface: Surface, options: Options, turns: float) -> Families:
    """Where the paths end: on the user's pins, or spread evenly over the rims."""
    if options.pins is not None:
        return read_pins(options.pins, surface, turns)
    return families(surface, options.paths, turns)


def _chosen(surface: Surface, options: Options, friction: float | Friction, clock: "Clock") -> Revolutions | None:
    """The revolutions, where they are to be chosen."""
    if options.revolutions != AUTO:
        return None
    with clock.stage("choose"):
        return choose_revolutions(surface, paths=options.paths, particles=options.particles, friction=friction)


def _field(mesh: str | PathLike[str] | Mesh, friction: float | str) -> Scalars | None:
    """The friction field of the mesh's file, if one is asked for."""
    if not isinstance(friction, str):
        return None
    if isinstance(mesh, Mesh):
        raise BadInputError(f"friction is {friction!r} but the mesh is no file; solve(..., friction=...) takes a table")
    return read_scalars(fspath(mesh), friction.removeprefix(FIELD).strip())


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
        write_config(staging / CONFIG, out, _told(result, out, render), version())
        write_report(staging / "report.json", result.report())
    return result


def _told(result: Result, out: Path, render: bool) -> dict[str, object]:
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
