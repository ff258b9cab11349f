"""report.json: the figures of a run as a plain dictionary."""

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from meshwind.chart.chart import Chart
from meshwind.core.units import UNKNOWN
from meshwind.core.version import version
from meshwind.layup.layup import Layup
from meshwind.mesh.geometry.mesh import Mesh
from meshwind.path.paths import Paths, Status
from meshwind.planning.revolutions import Revolutions
from meshwind.planning.spacing import Spaced
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
from meshwind.surface.surface import Surface


def report(
    layup: Layup,
    mesh: Mesh,
    chart: Chart | None,
    *,
    revolutions: float,
    command: str = "",
    units: str = "",
    tolerance: float | None = None,
    seconds: Mapping[str, float] | None = None,
    notes: Sequence[str] = (),
    model: Mapping[str, Any] | None = None,
    chosen: Revolutions | None = None,
    spaced: Spaced | None = None,
    linear_density: float | None = None,
) -> dict[str, Any]:
    """Gather all figures as plain Python values; lengths in the mesh's units, angles in degrees.

    chart is None for a surface that was given rather than fitted; `tolerance` that the fit was asked for;
    `seconds` per stage; `notes` for the user; `model` adds to or replaces what the paths themselves tell of the
    model that the scene needed; chosen and spaced: how revolutions and spacing were found; linear_density: mass over
    length of the fibre.  A figure that does not exist (NaN or infinite) is None.
    """
    paths = layup.paths
    figures = {
        "meshwind": version(),
        "command": command,
        "mesh": mesh_figures(mesh, units) | ({} if chart is None else {"ends": chart.annulus.ends}),
        "surface": _surface(paths.surface, chart, tolerance),
        "winding": {
            "revolutions": revolutions,
            "paths_per_family": int(max((paths.family == family).sum() for family in (1, -1))),
            "particles": paths.gap.shape[1],
            "friction": paths.friction,
        },
        "paths": _paths(paths),
        "crossings": crossing_figures(layup.crossings, len(layup.own_crossings)),
        "coverage": coverage_figures(layup),
        "spacing": spacing_figures(layup, spaced),
        "windability": windability_figures(layup.windability),
        "quads": quad_figures(layup),
        "fibre": fibre_figures(layup, linear_density),
        "model": _model(paths) | dict(model or {}),
        "seconds": dict(seconds or {}),
        "notes": list(notes),
    }
    if chosen is not None:
        figures["revolutions"] = revolution_figures(chosen)
    told: dict[str, Any] = plain(figures)
    return told


def write_report(path: Path, figures: Mapping[str, Any]) -> None:
    """Write figures as JSON; a figure that does not exist (NaN or infinite) is null."""
    path.write_text(json.dumps(plain(figures), indent=1, allow_nan=False) + "\n", encoding="utf-8")


def plain(value: Any) -> Any:
    """Turn mappings, sequences and NumPy values into what JSON knows, with None for what is not finite."""
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def mesh_figures(mesh: Mesh, units: str) -> dict[str, Any]:
    """What a report says of the mesh that was read."""
    return {
        "name": mesh.name,
        "vertices": len(mesh.vertices),
        "faces": len(mesh.faces),
        "read_vertices": mesh.read_vertices or len(mesh.vertices),
        "read_faces": mesh.read_faces or len(mesh.faces),
        "units": units or UNKNOWN,
        "diagonal": mesh.diagonal,
        "repairs": list(mesh.repairs),
    }


def _surface(surface: Surface, chart: Chart | None, tolerance: float | None) -> dict[str, Any]:
    error = surface.error
    fit: dict[str, Any] = {"rms": None, "max": None, "relative_max": None}
    if error is not None:
        fit |= {
            "rms": error.rms,
            "max": error.max,
            "relative_max": error.relative_max,
            "to_surface": {"rms": error.to_surface_rms, "max": error.to_surface_max},
            "to_mesh": {"rms": error.to_mesh_rms, "max": error.to_mesh_max},
        }
    return {
        "control_points": list(surface.control_points.shape[:2]),
        "tolerance": tolerance,
        "fit_error": fit,
        "flipped_triangles": 0 if chart is None else chart.flipped,
    }


def _paths(paths: Paths) -> dict[str, Any]:
    figures = path_figures(paths)
    return {
        "converged": figures.converged,
        "not_converged": unsettled(paths),
        "figures_over": figures.over,
        "length_total": figures.fibre_length,
        "bridged_fraction": figures.bridged_share,
        "bridges": len(figures.spans),
        "longest_bridge": figures.longest_bridge,
        "max_gap": figures.max_gap,
        "max_slip": figures.max_slip,
        "max_residual": figures.max_residual,
    }


def unsettled(paths: Paths) -> list[dict[str, Any]]:
    """The paths that are not at rest, each with why and what would hold it."""
    return [_failure(paths, int(k)) for k in np.flatnonzero(paths.status != Status.CONVERGED)]


def _failure(paths: Paths, path: int) -> dict[str, Any]:
    status = Status(int(paths.status[path]))
    return {"path": path, "status": int(status), "name": status.name.lower(), "why": paths.advice(path)}


def _model(paths: Paths) -> dict[str, Any]:
    cost = paths.counters
    return {
        "lifting": bool((~paths.on_surface).any()),
        "friction": paths.friction > 0.0,
        "surface_evaluations": cost.evaluations,
        "foot_points": cost.feet,
        "block_solves": cost.solves,
        "iterations": cost.iterations,
    }
