"""report.json: the figures of a run as a plain dictionary."""

import json
import math
from collections.abc import Mapping
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np

from meshwind.cast import Bools, Floats
from meshwind.chart.chart import Chart
from meshwind.layup.layup import Layup
from meshwind.layup.lengths import bridges, lengths
from meshwind.mandrel.mesh import Mesh
from meshwind.path.paths import Paths, Status
from meshwind.surface.surface import Surface


def report(
    layup: Layup,
    mesh: Mesh,
    chart: Chart | None,
    *,
    revolutions: float,
    command: str = "",
    units: str = "mm",
    seconds: Mapping[str, float] | None = None,
    model: Mapping[str, Any] | None = None,
) -> dict[str, Any]:
    """Gather all figures; lengths in the mesh's units, angles in degrees.

    chart is None for a surface that was given rather than fitted; `seconds` per stage; `model` adds to or
    replaces what the paths themselves tell of the model that the scene needed.
    """
    paths = layup.paths
    return {
        "meshwind": _version(),
        "command": command,
        "mesh": _mesh(mesh, units) | ({} if chart is None else {"ends": chart.annulus.ends}),
        "surface": _surface(paths.surface, chart),
        "winding": {
            "revolutions": revolutions,
            "paths_per_family": int(max((paths.family == family).sum() for family in (1, -1))),
            "particles": paths.gap.shape[1],
            "friction": paths.friction,
        },
        "paths": _paths(paths),
        "crossings": {"count": len(layup.crossings), "angle": _spread(np.degrees(layup.crossings.angle))},
        "coverage": {
            "min": layup.coverage.min,
            "median": layup.coverage.median,
            "max": layup.coverage.max,
            "band_width": layup.coverage.width,
            "cells": list(layup.coverage.layers.shape),
        },
        "quads": _quads(layup),
        "model": _model(paths) | dict(model or {}),
        "seconds": dict(seconds or {}),
    }


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


def _version() -> str:
    try:
        return version("meshwind")
    except PackageNotFoundError:  # run from a source tree that was not installed
        return "source"


def _mesh(mesh: Mesh, units: str) -> dict[str, Any]:
    return {
        "name": mesh.name,
        "vertices": mesh.read_vertices or len(mesh.vertices),
        "faces": mesh.read_faces or len(mesh.faces),
        "units": units,
        "diagonal": mesh.diagonal,
        "repairs": list(mesh.repairs),
    }


def _surface(surface: Surface, chart: Chart | None) -> dict[str, Any]:
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
        "fit_error": fit,
        "flipped_triangles": 0 if chart is None else chart.flipped,
    }


def _paths(paths: Paths) -> dict[str, Any]:
    figures, spans = lengths(paths), bridges(paths)
    taut = paths.status == Status.CONVERGED
    told: Bools = taut if taut.any() else np.ones(len(paths), dtype=bool)
    total = figures.length[told].sum()
    return {
        "converged": int(taut.sum()),
        "not_converged": [_failure(int(k), Status(int(paths.status[k]))) for k in np.flatnonzero(~taut)],
        "length_total": figures.length.sum(),
        "bridged_fraction": figures.bridged[told].sum() / total if total > 0 else 0.0,
        "bridges": len(spans.path),
        "longest_bridge": float(spans.length.max(initial=0.0)),
        "max_gap": figures.max_gap[told].max(initial=0.0),
        "max_slip": figures.max_slip[told].max(initial=0.0),
        "max_residual": paths.residual[told].max(initial=0.0),
    }


def _failure(path: int, status: Status) -> dict[str, Any]:
    return {"path": path, "status": int(status), "name": status.name.lower(), "why": status.advice}


def _spread(values: Floats) -> dict[str, float | None]:
    if not len(values):
        return {"min": None, "median": None, "max": None}
    return {"min": float(values.min()), "median": float(np.median(values)), "max": float(values.max())}


def _quads(layup: Layup) -> dict[str, Any]:
    mesh = layup.quads
    return {
        "faces": len(mesh.quads) + len(mesh.triangles),
        "quads": len(mesh.quads),
        "triangles": len(mesh.triangles),
        "left_out": list(mesh.left_out),
        "note": mesh.note,
    }


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
