"""A results folder read back: what `meshwind wind --out DIR` left is all that an export needs."""

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

from meshwind.core.cast import Bools, floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.core.units import unit_told
from meshwind.layup.layup import Layup, assess
from meshwind.path.paths import Counters, Paths, Status
from meshwind.results.staging import REPORT, settle
from meshwind.results.vtk_reading import Lines, read_lines
from meshwind.surface.surface import FitError, Surface

_NEEDED = "paths.vtp", "surface.npz", REPORT
_FIELDS = {"uv": (2,), "on_surface": (), "gap": (), "normal": (3,), "slip": ()}
_FARTHEST, _MOST_TURNS = 1e100, 1e6
"""Of any length of a surface, and of u: beyond them a file is damaged."""
_OFF = 1e-5
"""Particles on the surface lie no further off it than this, over its size."""


@dataclass(frozen=True)
class Results:
    """What a run left in `folder`: its paths on their fitted surface, and its report as a dictionary.

    Some of `paths` is not in the files: `residual` is the report's largest at paths at rest and infinite at others,
    `holding_turns` and `holding_friction` are 0.
    """

    folder: Path
    paths: Paths
    report: dict[str, Any]

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
        """Name of the unit of length, "" where the run was told none."""
        return unit_told(str(_under(self.report, "mesh", "units") or ""))

    @property
    def diagonal(self) -> float:
        """Diagonal of the part, in its own units."""
        return float(_under(self.report, "mesh", "diagonal") or self.surface.size)

    @property
    def band_width(self) -> float | None:
        """Width of the band that coverage was counted with, None where the report has none."""
        width = _under(self.report, "coverage", "band_width")
        return float(width) if width else None

    @property
    def at_rest(self) -> Bools:
        """Which paths (p,) came to rest: the others are no places where a fibre stays."""
        return np.asarray(self.paths.status == Status.CONVERGED)

    @cached_property
    def layup(self) -> Layup:
        """Crossings, quad mesh and coverage, found anew."""
        return assess(self.paths, self.band_width)


def read_results(folder: str | PathLike[str]) -> Results:
    """Read the folder of a run; raises BadInputError where it is none, or its files do not belong together."""
    place = _place(folder, _NEEDED)
    report = _report(place / REPORT)
    try:
        surface = _surface(place / "surface.npz", report)
        paths = _paths(place / "paths.vtp", surface, report)
    except BadInputError:
        raise
    except (ArithmeticError, LookupError, TypeError, ValueError) as error:
        raise _spoilt(place, error) from error
    return Results(place, paths, report)


def read_report(folder: str | PathLike[str]) -> dict[str, Any]:
    """Read the report in the folder of a run; raises BadInputError where there is none, or it cannot be read."""
    return _report(_place(folder, (REPORT,)) / REPORT)


def _place(folder: str | PathLike[str], needed: tuple[str, ...]) -> Path:
    """The folder, once it is known to be one and to hold the needed files."""
    place = Path(folder)
    if not place.is_dir():
        raise BadInputError(f"{place} is no folder; give one that `meshwind wind MESH --out DIR` left")
    with suppress(OSError):  # a folder that cannot be written is read as it is
        settle(place)
    missing = [name for name in needed if not (place / name).is_file()]
    if missing:
        raise BadInputError(
            f"{place} holds no {' and no '.join(missing)}; give a folder that `meshwind wind MESH --out DIR` left"
        )
    return place


def _report(path: Path) -> dict[str, Any]:
    try:
        read = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise _spoilt(path, error) from error
    if not isinstance(read, dict):
        raise _spoilt(path, "no figures in it")
    return read


def _surface(path: Path, report: dict[str, Any]) -> Surface:
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as held:
            control, periodic = held["control_points"], bool(held["periodic_u"])
    except (OSError, EOFError, ValueError, LookupError, TypeError, AttributeError, zipfile.BadZipFile) as error:
        raise _spoilt(path, error) from error
    points = floats(control, f"control_points of {path.name}", -1, -1, 3)
    if np.abs(points).max(initial=0.0) > _FARTHEST:
        raise _spoilt(path, f"it reaches beyond {_FARTHEST:g}")
    return Surface(points, periodic, _fit_error(report))


def _fit_error(report: dict[str, Any]) -> FitError | None:
    diagonal = _under(report, "mesh", "diagonal")
    found = {
        f"{side}_{what}": _under(report, "surface", "fit_error", side, what)
        for side in ("to_surface", "to_mesh")
        for what in ("rms", "max")
    }
    if diagonal is None or None in found.values():
        return None
    return FitError(**{name: float(value) for name, value in found.items()}, diagonal=float(diagonal))


def _paths(path: Path, surface: Surface, report: dict[str, Any]) -> Paths:
    lines = read_lines(path)
    sizes = np.diff(lines.starts)
    lacking = [name for name in _FIELDS if name not in lines.point_data]
    lacking += [name for name in ("family", "status") if name not in lines.cell_data]
    if lacking or not len(sizes) or (sizes != sizes[0]).any():
        raise _spoilt(path, f"no {' or '.join(lacking)} in it" if lacking else "its lines are no paths of one run")
    held = {name: _shaped(lines, name, len(sizes), *shape) for name, shape in _FIELDS.items()}
    if not all(np.isfinite(values).all() for values in (lines.points, *(held[n] for n in _FIELDS if n != "slip"))):
        raise _spoilt(path, "it holds NaN or infinite values")
    on = held["on_surface"].astype(bool).ravel()
    uv, points = np.ascontiguousarray(held["uv"].reshape(-1, 2)[on]), lines.points[on]
    if np.abs(uv).max(initial=0.0) > _MOST_TURNS or np.abs(surface.points(uv) - points).max(initial=0.0) > (
        _OFF * surface.size
    ):
        raise _spoilt(path, f"its paths are none on the surface of {path.with_name('surface.npz').name}")
    status = lines.cell_data["status"].astype(np.int64)
    worst = _under(report, "paths", "max_residual")
    residual = np.where(status == Status.CONVERGED, np.inf if worst is None else float(worst), np.inf)
    nothing = frozen(np.zeros(len(sizes)))
    return Paths(
        surface=surface,
        points=frozen(lines.points.reshape(len(sizes), -1, 3)),
        uv=held["uv"],
        on_surface=frozen(held["on_surface"].astype(bool)),
        gap=held["gap"],
        normal=held["normal"],
        slip=held["slip"],
        family=frozen(lines.cell_data["family"].astype(np.int64)),
        status=frozen(status),
        residual=frozen(residual),
        friction=float(_under(report, "winding", "friction") or 0.0),
        counters=_counters(report),
        holding_turns=nothing,
        holding_friction=nothing,
    )


def _shaped(lines: Lines, name: str, count: int, *shape: int) -> NDArray[Any]:
    return frozen(lines.point_data[name].reshape(count, len(lines.points) // count, *shape))


def _counters(report: dict[str, Any]) -> Counters:
    names = "surface_evaluations", "foot_points", "block_solves", "iterations"
    return Counters(*(int(_under(report, "model", name) or 0) for name in names))


def _under(report: dict[str, Any], *names: str) -> Any:
    """What the report holds under these names, None where it holds nothing."""
    here: Any = report
    for name in names:
        here = here.get(name) if isinstance(here, dict) else None
    return here


def _spoilt(path: Path, why: object) -> BadInputError:
    return BadInputError(f"{path} cannot be used ({why}); run `meshwind wind` again")
