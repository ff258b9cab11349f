"""What is to be seen on winding.png, gathered as arrays for the process that draws it."""

from typing import Any

import numpy as np

from meshwind.cast import Floats
from meshwind.layup.layup import Layup
from meshwind.layup.lengths import bridges, lengths
from meshwind.output.maps import grid
from meshwind.output.view import best_view
from meshwind.path.paths import Paths, Status

_MOST_POINTS = 250
"""Points of a path that are drawn; more do not show."""


def scene(layup: Layup, name: str, units: str = "mm") -> dict[str, Any]:
    """All that the renderer needs: the part, the fibres, the bridges, the view and the words."""
    on = grid(layup.paths.surface)
    paths = layup.paths
    stride = -(-paths.gap.shape[1] // _MOST_POINTS)
    kept = np.unique(np.r_[np.arange(0, paths.gap.shape[1], stride), paths.gap.shape[1] - 1])
    view = best_view(on.points, on.quads, paths.points.reshape(-1, 3), paths.normal.reshape(-1, 3), paths.gap.ravel())
    normals = np.cross(on.frames[:, 1], on.frames[:, 2])
    return {
        "title": _title(paths, name),
        "subtitle": _subtitle(layup, units),
        "units": units,
        "points": on.points,
        "quads": on.quads,
        "normals": normals,
        "paths": paths.points[:, kept],
        "path_normals": paths.normal[:, kept],
        "family": paths.family,
        "taut": paths.status == Status.CONVERGED,
        "max_gap": bridges(paths).max_gap.max(initial=0.0),
        "pitch": _pitch(layup),
        "right": view.right,
        "up": view.up,
        "eye": view.eye,
        "centre": view.centre,
        "extent": np.array([view.width, view.height]),
    } | _bridges(paths, stride)


def _pitch(layup: Layup) -> float:
    """Mean distance from fibre to fibre of a family, in mesh units."""
    each = lengths(layup.paths).length.sum() / len(np.unique(layup.paths.family))
    return float(layup.coverage.area.sum() / max(each, 1e-300))


def _bridges(paths: Paths, stride: int) -> dict[str, Floats]:
    """The bridges as polylines one after the other: every stride-th point and both ends."""
    spans = bridges(paths)
    whole = spans.last - spans.first + 1
    begin = np.cumsum(whole) - whole
    step = np.arange(whole.sum()) - np.repeat(begin, whole)
    keep = (step % stride == 0) | (step == np.repeat(whole - 1, whole))
    row, column = np.repeat(spans.path, whole)[keep], (np.repeat(spans.first, whole) + step)[keep]
    sizes = np.add.reduceat(keep.astype(np.int64), begin) if len(begin) else begin
    return {
        "bridges": paths.points[row, column],
        "bridge_normals": paths.normal[row, column],
        "bridge_gap": paths.gap[row, column],
        "bridge_sizes": sizes,
    }


def _title(paths: Paths, name: str) -> str:
    count = " + ".join(str(int((paths.family == family).sum())) for family in (1, -1))
    turns = float(np.abs(paths.uv[:, -1, 0] - paths.uv[:, 0, 0]).mean())
    return f"{name}: {count} fibres, {turns:.4g} revolutions"


def _subtitle(layup: Layup, units: str) -> str:
    figures = lengths(layup.paths)
    total = float(figures.length.sum())
    parts = [f"{float(f'{total:.4g}'):,.10g} {units} of fibre", f"{len(layup.crossings)} crossings"]
    failed = int((layup.paths.status != Status.CONVERGED).sum())
    share = float(figures.bridged.sum()) / total if total > 0.0 else 0.0
    parts.append(f"{100.0 * share:.1f} % of the length bridges" if share > 0.0 else "no bridging")
    if failed:
        parts.append(f"{failed} paths not in equilibrium")
    return "  ·  ".join(parts)
