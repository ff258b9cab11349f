"""Reading a run's folder; exports and pictures need nothing else."""

import json
import zipfile
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshwind.core.brief import brief
from meshwind.core.cast import Bools, Floats, Ints, floats, frozen
from meshwind.core.checks import path_given
from meshwind.core.errors import BadInputError
from meshwind.core.geometry import Block
from meshwind.core.spoken import called
from meshwind.core.units import reported_unit
from meshwind.filament.filament import Filament
from meshwind.layup.layup import Layup, assess
from meshwind.path.paths import Counters, Paths, Status
from meshwind.results import schema
from meshwind.results.filament_file import read_filaments
from meshwind.results.laminate_reading import widths
from meshwind.results.laminate_types import LayerFigures
from meshwind.results.pattern_types import PatternFigures
from meshwind.results.redesign_report_types import RedesignReport
from meshwind.results.report_types import Report
from meshwind.results.schema import EDITED, FILAMENT, PATHS, REPORT, SPLINE, SURFACE
from meshwind.results.staging import settle
from meshwind.results.vtk_reading import read_faces, read_lines
from meshwind.results.wound_layers import WoundLayers, read_wound_layers
from meshwind.surface.grid import grid
from meshwind.surface.surface import FitError, Surface

_NEEDED = PATHS, SPLINE, REPORT
_AT_PARTICLES = schema.UV, schema.ON_SURFACE, schema.GAP, schema.NORMAL, schema.SLIP
_OF_PATHS = schema.FAMILY, schema.STATUS
_FARTHEST, _MOST_TURNS = 1e100, 1e6
"""Largest coordinate of a surface, and largest u; a file with larger values is damaged."""
_OFF, _OFF_GRID = 1e-5, 1e-9
"""Largest distance from the surface, over its size, of particles on it and of points of its grid."""


@dataclass(frozen=True)
class Results:
    """Results of a run in `folder`: its paths on their fitted surface, and its report.

    The files lack some fields of `paths`: nothing is known of what was asked for, so that their advice names no
    numbers.
    """

    folder: Path
    paths: Paths
    report: Report

    __repr__ = brief

    @property
    def surface(self) -> Surface:
        """The fitted surface."""
        return self.paths.surface

    @property
    def name(self) -> str:
        """Name of the part's file."""
        return str(_under(self.report, "mesh", "name") or self.folder.name)

    @property
    def units(self) -> str:
        """Name of the unit of length, "" where it is not known."""
        return reported_unit(str(_under(self.report, "mesh", "units") or ""))

    @property
    def diagonal(self) -> float:
        """Diagonal of the part, in the mesh's units."""
        return float(_under(self.report, "mesh", "diagonal") or self.surface.size)

    @property
    def revolutions(self) -> float | None:
        """Revolutions from end to end, None if the report has none."""
        turns = _under(self.report, "winding", "revolutions")
        return None if turns is None else float(turns)

    @property
    def band_width(self) -> float | None:
        """Width of the band for the coverage, None if the report has none."""
        width = _under(self.report, "coverage", "band_width")
        return float(width) if width else None

    @property
    def band_widths(self) -> tuple[float, ...]:
        """Width of the band of each layer: that for the coverage where the run has no layers."""
        return widths(self.layers, self.layup.coverage.width)

    @property
    def band_thickness(self) -> float | None:
        """Thickness of the band, None if the report has none."""
        thickness = _under(self.report, "fibre", "band_thickness")
        return float(thickness) if thickness else None

    @property
    def partings(self) -> Ints:
        """Pairs (k, 2) of neighbours that part round a body; none if the report does not say."""
        pairs = _under(self.report, "spacing", "partings")
        try:
            known = np.array(pairs or [], dtype=np.int64).reshape(-1, 2)
        except (TypeError, ValueError, OverflowError) as error:
            raise _spoilt(self.folder / REPORT, error) from error
        return known[((known >= 0) & (known < len(self.paths))).all(axis=1)]

    @cached_property
    def filaments(self) -> tuple[Filament, ...]:
        """The filaments of a continuous winding; none of another."""
        file = self.folder / FILAMENT
        return tuple(read_filaments(file)) if file.is_file() else ()

    @property
    def patterns(self) -> list[PatternFigures]:
        """The report's figures of the pattern, an entry a layer; none where the winding is not continuous."""
        found = _under(self.report, "pattern")
        return found if isinstance(found, list) else []

    @property
    def layers(self) -> list[LayerFigures]:
        """The report's figures of the laminate, an entry a layer; none where the run has no layers."""
        found = _under(self.report, "laminate")
        return found if isinstance(found, list) else []

    @cached_property
    def wound_layers(self) -> WoundLayers | None:
        """The layers of a laminate, None where the run has none."""
        return read_wound_layers(self.folder, self.surface, self.layers)

    @property
    def at_rest(self) -> Bools:
        """Which paths (p,) converged; no fibre stays on the others."""
        return np.asarray(self.paths.status == Status.CONVERGED)

    @cached_property
    def layup(self) -> Layup:
        """Crossings, quad mesh and coverage, computed again."""
        return assess(self.paths, self.band_width)


def read_results(folder: str | PathLike[str]) -> Results:
    """Read the folder of a run; raises BadInputError if it is none or its files do not belong together."""
    source = _folder(folder, _NEEDED)
    report = _report(source / REPORT)
    try:
        surface = _surface(source / SPLINE, report)
        paths = _paths(source / PATHS, surface, report)
    except BadInputError:
        raise
    except (ArithmeticError, LookupError, TypeError, ValueError) as error:
        raise _spoilt(source, error) from error
    return Results(source, paths, report)


def read_report(folder: str | PathLike[str]) -> Report | RedesignReport:
    """Read the report of a run or of a redesign; raises BadInputError if it is missing or cannot be read."""
    return _report(_folder(folder, (REPORT,)) / REPORT)


def read_surface_grid(folder: Path, surface: Surface) -> Block:
    """Read surface.vtu, the grid of a folder's surface with its maps.

    Raises BadInputError if it is damaged or of another surface.
    """
    read, on = read_faces(folder / SURFACE), grid(surface)
    if (
        read.points.shape != on.points.shape
        or not np.array_equal(read.quads, on.quads)
        or not np.isfinite(read.points).all()
        or np.abs(read.points - on.points).max() > _OFF_GRID * surface.size
        or not np.array_equal(read.point_data.get(schema.UV, on.points), on.uv)
        or read.point_data.get(schema.NORMAL, on.uv).shape != on.points.shape
    ):
        raise _spoilt(folder / SURFACE, "it is of another surface")
    return read


def is_redesign(folder: Path) -> bool:
    """Whether a folder holds the results of a redesign."""
    return (folder / EDITED).is_file()


def read_edited(folder: Path) -> tuple[Floats, Floats, Ints]:
    """Read vertices (n, 3) before a redesign, their displacement (n, 3), and the faces (m, 3).

    Raises BadInputError if the folder's edited mesh cannot be used.
    """
    read = read_faces(folder / EDITED)
    moves = read.point_data.get(schema.DISPLACEMENT)
    if moves is None or not len(read.triangles):
        raise BadInputError(f"{folder / EDITED} holds no triangles with a displacement; run {called('redesign')} again")
    return read.points - moves, moves, read.triangles


def _folder(folder: str | PathLike[str], needed: tuple[str, ...]) -> Path:
    """Path of a folder, checked to exist and to hold the needed files."""
    path = path_given(folder, "the run", "folder of results")
    if not path.is_dir():
        raise BadInputError(f"{path} is no folder; give one that {called('wind', 'MESH', out='DIR')} left")
    with suppress(OSError):  # a folder that cannot be written is read as it is
        settle(path)
    missing = [name for name in needed if not (path / name).is_file()]
    if missing:
        raise BadInputError(
            f"{path} holds no {' and no '.join(missing)}; give a folder that {called('wind', 'MESH', out='DIR')} left"
        )
    return path


def _report(path: Path) -> Any:
    try:
        read = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise _spoilt(path, error) from error
    if not isinstance(read, dict):
        raise _spoilt(path, "no figures in it")
    return read


def _surface(path: Path, report: Report) -> Surface:
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as held:
            control, periodic = held[schema.CONTROL_POINTS], bool(held[schema.PERIODIC_U])
            doubt, threshold = held.get(schema.UNCERTAINTY), held.get(schema.THRESHOLD)
            limit = None if threshold is None else float(threshold)
    except (OSError, EOFError, ValueError, LookupError, TypeError, AttributeError, zipfile.BadZipFile) as error:
        raise _spoilt(path, error) from error
    points = floats(control, f"{schema.CONTROL_POINTS} of {path.name}", -1, -1, 3)
    if np.abs(points).max(initial=0.0) > _FARTHEST:
        raise _spoilt(path, f"it reaches beyond {_FARTHEST:g}")
    table = None if doubt is None else frozen(floats(doubt, f"{schema.UNCERTAINTY} of {path.name}", -1, -1))
    return Surface(points, periodic, _fit_error(report), table, limit)


def _fit_error(report: Report) -> FitError | None:
    diagonal = _under(report, "mesh", "diagonal")
    found = {
        f"{side}_{what}": _under(report, "surface", "fit_error", side, what)
        for side in ("to_surface", "to_mesh")
        for what in ("rms", "max")
    }
    if diagonal is None or None in found.values():
        return None
    distances = {name: float(value) for name, value in found.items()}
    evidence = _under(report, "surface", "evidence") or {"data": "vertices", "noise": 0.0, "sagitta": 0.0}
    return FitError(
        diagonal=float(diagonal),
        data=str(evidence["data"]),
        noise=float(evidence["noise"]),
        sagitta=float(evidence["sagitta"]),
        to_surface_rms=distances["to_surface_rms"],
        to_surface_max=distances["to_surface_max"],
        to_mesh_rms=distances["to_mesh_rms"],
        to_mesh_max=distances["to_mesh_max"],
    )


def _paths(path: Path, surface: Surface, report: Report) -> Paths:
    lines = read_lines(path)
    sizes = np.diff(lines.starts)
    lacking: list[str] = [name for name in _AT_PARTICLES if name not in lines.point_data]
    lacking += [name for name in _OF_PATHS if name not in lines.line_data]
    if lacking or not len(sizes) or (sizes != sizes[0]).any():
        raise _spoilt(path, f"no {' or '.join(lacking)} in it" if lacking else "its lines are not the paths of one run")
    held = {name: _shaped(lines, name, len(sizes)) for name in _AT_PARTICLES}
    known = (values for name, values in held.items() if name != schema.SLIP)
    if not all(np.isfinite(values).all() for values in (lines.points, *known)):
        raise _spoilt(path, "it holds NaN or infinite values")
    on = held[schema.ON_SURFACE].astype(bool).ravel()
    uv, points = np.ascontiguousarray(held[schema.UV].reshape(-1, 2)[on]), lines.points[on]
    if np.abs(uv).max(initial=0.0) > _MOST_TURNS or np.abs(surface.points(uv) - points).max(initial=0.0) > (
        _OFF * surface.size
    ):
        raise _spoilt(path, f"its paths do not lie on the surface of {SPLINE}")
    status = lines.line_data[schema.STATUS].astype(np.int64)
    worst = _under(report, "paths", "max_residual")
    known_for_all = np.where(status == Status.CONVERGED, np.inf if worst is None else float(worst), np.inf)
    residual = np.asarray(lines.line_data.get(schema.RESIDUAL, known_for_all), dtype=np.float64)  # old runs have none
    return Paths(
        surface=surface,
        points=frozen(lines.points.reshape(len(sizes), -1, 3)),
        uv=held[schema.UV],
        on_surface=frozen(held[schema.ON_SURFACE].astype(bool)),
        gap=held[schema.GAP],
        normal=held[schema.NORMAL],
        slip=held[schema.SLIP],
        family=frozen(lines.line_data[schema.FAMILY].astype(np.int64)),
        status=frozen(status),
        residual=frozen(residual),
        friction=float(_under(report, "winding", "friction") or 0.0),
        counters=_counters(report),
    )


def _shaped(lines: Block, field: schema.Field, count: int) -> NDArray[Any]:
    shape = (field.columns,) if field.columns > 1 else ()
    return frozen(lines.point_data[field].reshape(count, len(lines.points) // count, *shape))


def _counters(report: Report) -> Counters:
    names = "surface_evaluations", "foot_points", "block_solves", "iterations"
    return Counters(*(int(_under(report, "model", name) or 0) for name in names))


def _under(report: Report, *names: str) -> Any:
    """Value under nested keys of the report, None if any is missing: the file may lack any of them."""
    here: Any = report
    for name in names:
        here = here.get(name) if isinstance(here, dict) else None
    return here


def _spoilt(path: Path, why: object) -> BadInputError:
    return BadInputError(f"{path} cannot be used ({why}); run {called('wind')} again")
