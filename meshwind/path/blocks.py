"""Paths and their bridges as polylines and as tables, with the fields that files, PyVista and pandas have."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwind.core.errors import BadInputError
from meshwind.core.geometry import Block, Data
from meshwind.path.kernels.status import Status
from meshwind.path.lengths import bridges, lengths

if TYPE_CHECKING:
    from meshwind.path.paths import Paths


def paths_block(paths: Paths) -> Block:
    """One polyline per path, with the data of its particles."""
    p, n = paths.gap.shape
    each = lengths(paths)
    point_data = {
        "uv": paths.uv.reshape(-1, 2),
        "on_surface": paths.on_surface.ravel(),
        "gap": paths.gap.ravel(),
        "normal": paths.normal.reshape(-1, 3),
        "slip": paths.slip.ravel(),
        "arc_length": each.arc_length.ravel(),
    }
    line_data = {
        "path": np.arange(p),
        "family": paths.family,
        "length": each.polyline_length,
        "fibre_length": paths.length,
        "bridged_length": each.bridged_length,
        "max_gap": each.max_gap,
        "max_slip": each.max_slip,
        "status": paths.status,
        "residual": paths.residual,
    }
    starts = np.arange(p + 1) * n
    return Block(paths.points.reshape(-1, 3), starts, point_data=point_data, line_data=line_data)


def bridges_block(paths: Paths) -> Block:
    """One polyline per span off the surface, its two ends on the surface, with the gap along it."""
    spans = bridges(paths)
    sizes = spans.last - spans.first + 1
    starts = np.concatenate([[0], np.cumsum(sizes)])
    row = np.repeat(spans.path, sizes)
    column = np.arange(starts[-1]) - np.repeat(starts[:-1] - spans.first, sizes)
    line_data: Data = {
        "path": spans.path,
        "length": spans.length,
        "max_gap": spans.max_gap,
        "resolved": spans.resolved.astype(np.uint8),
    }
    points = paths.points[row, column]
    points[starts[:-1]], points[starts[1:] - 1] = spans.ends[:, 0], spans.ends[:, 1]
    return Block(points, starts, point_data={"gap": paths.gap[row, column]}, line_data=line_data)


def paths_table(paths: Paths, of: str) -> Data:
    """Columns of a table with a row for each of the "paths", or for each of their "points"."""
    block = paths_block(paths)
    if of == "paths":
        names = np.array([Status(int(status)).name.lower() for status in paths.status], dtype=object)
        return {**block.line_data, "outcome": names}
    if of == "points":
        p, n = paths.gap.shape
        return {"path": np.repeat(np.arange(p), n), "family": np.repeat(paths.family, n), **block.columns()}
    raise BadInputError(f"of is {of!r}; give paths or points")
