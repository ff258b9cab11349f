"""The files of the fibres: paths.vtp, bridges.vtp and crossings.vtp."""

from pathlib import Path

import numpy as np

from meshwind.layup.crossings import Crossings
from meshwind.path.lengths import bridges, lengths
from meshwind.path.paths import Paths
from meshwind.results.vtk_files import write_lines, write_vertices


def write_paths(path: Path, paths: Paths, units: str = "") -> None:
    """Write one polyline a path, with all that is known at its particles."""
    p, n = paths.gap.shape
    figures = lengths(paths)
    point_data = {
        "uv": paths.uv.reshape(-1, 2),
        "on_surface": paths.on_surface.ravel(),
        "gap": paths.gap.ravel(),
        "normal": paths.normal.reshape(-1, 3),
        "slip": paths.slip.ravel(),
        "arc_length": figures.arc_length.ravel(),
    }
    cell_data = {
        "path": np.arange(p),
        "family": paths.family,
        "length": figures.polyline_length,
        "fibre_length": paths.length,
        "bridged_length": figures.bridged_length,
        "max_gap": figures.max_gap,
        "max_slip": figures.max_slip,
        "status": paths.status,
    }
    write_lines(path, paths.points.reshape(-1, 3), np.arange(p + 1) * n, point_data, cell_data, units)


def write_bridges(path: Path, paths: Paths, units: str = "") -> None:
    """Write one polyline a span off the surface, its two ends on the surface, with the gap along it."""
    spans = bridges(paths)
    sizes = spans.last - spans.first + 1
    starts = np.concatenate([[0], np.cumsum(sizes)])
    row = np.repeat(spans.path, sizes)
    column = np.arange(starts[-1]) - np.repeat(starts[:-1] - spans.first, sizes)
    cell_data = {"path": spans.path, "length": spans.length, "max_gap": spans.max_gap}
    points = paths.points[row, column]
    points[starts[:-1]], points[starts[1:] - 1] = spans.ends[:, 0], spans.ends[:, 1]
    write_lines(path, points, starts, {"gap": paths.gap[row, column]}, cell_data, units)


def write_crossings(path: Path, crossings: Crossings, units: str = "") -> None:
    """Write one vertex a crossing; the angle in degrees."""
    write_vertices(
        path,
        crossings.points,
        {
            "path_a": crossings.path_a,
            "path_b": crossings.path_b,
            "angle": np.degrees(crossings.angle),
            "quality": np.abs(np.cos(crossings.angle)),
            "uv": crossings.uv,
            "on_surface": crossings.on_surface,
        },
        units,
    )
