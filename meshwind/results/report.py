"""report.json: the figures of a run as plain Python values."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from meshwind.chart.chart import Chart
from meshwind.core.units import UNKNOWN
from meshwind.core.version import version
from meshwind.filament.plain_layer import PlainLayer
from meshwind.layup.layup import Layup
from meshwind.mesh.geometry.mesh import Mesh
from meshwind.path.paths import Paths, Status
from meshwind.results.figures import path_figures
from meshwind.results.layup_figures import (
    coverage_figures,
    crossing_figures,
    fibre_figures,
    quad_figures,
    revolution_figures,
    spacing_figures,
    windability_figures,
)
from meshwind.results.other_rest_figures import other_rest_figures
from meshwind.results.report_types import (
    AdviceFigures,
    Distances,
    Failure,
    FitFigures,
    MeshFigures,
    ModelFigures,
    PathsFigures,
    Report,
    SurfaceFigures,
    WindingFigures,
)
from meshwind.results.station_figures import station_figures
from meshwind.surface.surface import Surface

if TYPE_CHECKING:
    from meshwind.filament.closing import ClosedLayer
    from meshwind.filament.filament import Filament
    from meshwind.filament.laminate import Laminate
    from meshwind.planning.revolutions import Revolutions
    from meshwind.planning.spacing import Spaced


@dataclass(frozen=True)
class RunFacts:
    """Facts about a run, beside its layup, for the report.

    tolerance: that of the fit; seconds: wall time per stage; notes: messages for the user; chosen, spaced: how
    revolutions and spacing were found, if they were; plain: the layer that the paths are;
    closed: the layer, if it is wound as one filament; laminate: the layers, where the run has any.
    """

    revolutions: float
    command: str = ""
    tolerance: float | None = None
    seconds: Mapping[str, float] = field(default_factory=dict)
    notes: Sequence[str] = ()
    chosen: Revolutions | None = None
    spaced: Spaced | None = None
    plain: PlainLayer = field(default_factory=PlainLayer)
    closed: ClosedLayer | None = None
    laminate: Laminate | None = None
    filaments: Sequence[Filament] = ()


def report(layup: Layup, mesh: Mesh, chart: Chart | None, run: RunFacts) -> Report:
    """Gather all figures as plain Python values; lengths in the mesh's units, angles in degrees.

    chart is None if the surface was given rather than fitted.  NaN and infinite values become None.
    """
    paths = layup.paths
    figures: Report = {
        "meshwind": version(),
        "command": run.command,
        "mesh": mesh_figures(mesh, chart),
        "surface": _surface(paths.surface, chart, run.tolerance),
        "winding": _winding(paths, run.revolutions),
        "paths": _paths(paths),
        "crossings": crossing_figures(layup.crossings, len(layup.own_crossings)),
        "coverage": coverage_figures(layup),
        "spacing": spacing_figures(layup, run.spaced),
        "windability": windability_figures(layup.windability),
        "quads": quad_figures(layup),
        "fibre": fibre_figures(layup, run.plain),
        "model": _model(paths),
        "seconds": dict(run.seconds),
        "notes": list(run.notes),
    }
    if run.chosen is not None:
        figures["revolutions"] = revolution_figures(run.chosen)
    if run.plain.stations is not None:
        figures["angle_stations"] = station_figures(run.plain.stations)
    if run.closed is not None or run.laminate is not None:
        figures = figures | _layers(run, mesh.units)
    result: Report = plain(figures)
    return result


def _layers(run: RunFacts, units: str) -> Any:
    """Figures of a filament or a laminate: imported here, as most runs are without."""
    from meshwind.results.laminate_files import laminate_figures
    from meshwind.results.pattern_figures import pattern_figures, patterns_of_layers

    figures: dict[str, Any] = {}
    if run.laminate is not None and run.filaments:
        figures["pattern"] = patterns_of_layers(run.laminate, run.filaments, units)
    elif run.closed is not None:
        figures["pattern"] = [pattern_figures(run.closed, run.plain)]
    if run.laminate is not None:
        figures["laminate"] = laminate_figures(run.laminate, units)
    return figures


def write_report(path: Path, figures: Mapping[str, object]) -> None:
    """Write figures as JSON; NaN and infinite values become null."""
    path.write_text(json.dumps(plain(figures), indent=1, allow_nan=False) + "\n", encoding="utf-8")


def plain(value: Any) -> Any:
    """Convert mappings, sequences and NumPy values to JSON types; NaN and infinite values become None."""
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def mesh_figures(mesh: Mesh, chart: Chart | None) -> MeshFigures:
    """Figures of the mesh that was read and, if its chart is given, of the ends where it was opened."""
    figures: MeshFigures = {
        "name": mesh.name,
        "vertices": len(mesh.vertices),
        "faces": len(mesh.faces),
        "read_vertices": mesh.read_vertices or len(mesh.vertices),
        "read_faces": mesh.read_faces or len(mesh.faces),
        "units": mesh.units or UNKNOWN,
        "units_from": mesh.units_from or UNKNOWN,
        "size": list(mesh.size),
        "diagonal": mesh.diagonal,
        "repairs": list(mesh.repairs),
    }
    if chart is not None:
        figures["ends"] = chart.annulus.ends
        if chart.annulus.wall is not None:
            figures["wall"] = {"side": chart.annulus.wall.side, "thickness": chart.annulus.wall.thickness}
    return figures


def _surface(surface: Surface, chart: Chart | None, tolerance: float | None) -> SurfaceFigures:
    error = surface.error
    fit: FitFigures = {"rms": None, "max": None, "relative_max": None}
    if error is not None:
        fit = {
            "rms": error.rms,
            "max": error.max,
            "relative_max": error.relative_max,
            "to_surface": {"rms": error.to_surface_rms, "max": error.to_surface_max},
            "to_mesh": {"rms": error.to_mesh_rms, "max": error.to_mesh_max},
        }
    figures: SurfaceFigures = {
        "control_points": list(surface.control_points.shape[:2]),
        "tolerance": tolerance,
        "fit_error": fit,
        "flipped_triangles": 0 if chart is None else chart.flipped,
    }
    if error is not None and surface.uncertainty is not None:
        table = surface.uncertainty
        doubt: Distances = {"rms": float(np.sqrt(np.mean(table**2))), "max": float(table.max())}
        figures["evidence"] = {
            "data": error.data, "noise": error.noise, "sagitta": error.sagitta, "uncertainty": doubt,
        }  # fmt: skip
    return figures


def _winding(paths: Paths, revolutions: float) -> WindingFigures:
    return {
        "revolutions": revolutions,
        "paths_per_family": int(max((paths.family == family).sum() for family in (1, -1))),
        "particles": paths.gap.shape[1],
        "friction": paths.friction,
    }


def _paths(paths: Paths) -> PathsFigures:
    figures = path_figures(paths)
    result: PathsFigures = {
        "converged": figures.converged,
        "not_converged": failures(paths),
        "advice": _advice(paths),
        "figures_over": figures.over,
        "length_total": figures.fibre_length,
        "length_error": figures.length_error,
        "position_error": figures.position_error,
        "bridged_fraction": figures.bridged_share,
        "bridges": len(figures.spans),
        "longest_bridge": figures.longest_bridge,
        "unresolved": {
            "threshold": paths.surface.threshold,
            "bridges": len(figures.unresolved),
            "fraction": figures.unresolved_share,
            "max_gap": float(figures.unresolved.max_gap.max(initial=0.0)),
        },
        "max_gap": figures.max_gap,
        "max_slip": figures.max_slip,
        "max_residual": figures.max_residual,
    }
    if paths.friction > 0.0:
        result["other_rests"] = other_rest_figures(paths)
    return result


def failures(paths: Paths) -> list[Failure]:
    """Paths that did not converge, each with the reason and what holds all of them."""
    return [_failure(paths, int(k)) for k in np.flatnonzero(paths.status != Status.CONVERGED)]


def _failure(paths: Paths, path: int) -> Failure:
    status = Status(int(paths.status[path]))
    return {
        "path": path,
        "status": int(status),
        "name": status.name.lower(),
        "meaning": status.meaning,
        "why": paths.advice(path),
    }


def _advice(paths: Paths) -> AdviceFigures:
    held = paths.holding
    return {
        "text": held.text,
        "revolutions": held.revolutions or None,
        "turns": held.turns or None,
        "friction": held.friction or None,
        "rougher": held.rougher or None,
        "particles": held.particles or None,
    }


def _model(paths: Paths) -> ModelFigures:
    cost = paths.counters
    return {
        "lifting": bool((~paths.on_surface).any()),
        "friction": paths.friction > 0.0,
        "surface_evaluations": cost.evaluations,
        "foot_points": cost.feet,
        "block_solves": cost.solves,
        "iterations": cost.iterations,
    }
