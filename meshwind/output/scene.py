"""What is to be seen on winding.png, gathered as arrays for the process that draws it."""

from typing import Any

import numpy as np

from meshwind.cast import Floats, Ints
from meshwind.layup.layup import Layup
from meshwind.layup.lengths import Bridges, bridges, lengths
from meshwind.output.figures import PathFigures, path_figures
from meshwind.output.maps import grid
from meshwind.output.view import best_view
from meshwind.output.words import quantity
from meshwind.path.paths import Paths, Status

_MOST_POINTS = 250
"""Points of a path that are drawn; more do not show."""


def scene(layup: Layup, name: str, units: str = "", revolutions: float | None = None) -> dict[str, Any]:
    """All that the renderer needs: the part, the fibres, the bridges, the view and the words.

    revolutions: what was asked for, for the title; without it the paths' mean, which bent rims shift a little.
    """
    on = grid(layup.paths.surface)
    paths = layup.paths
    figures = path_figures(paths)
    stride = -(-paths.gap.shape[1] // _MOST_POINTS)
    kept = np.unique(np.r_[np.arange(0, paths.gap.shape[1], stride), paths.gap.shape[1] - 1])
    axis = on.points.reshape(*on.shape, 3).mean(axis=0)
    marks = paths.points.reshape(-1, 3), paths.normal.reshape(-1, 3), paths.gap.ravel()
    view = best_view(on.points, on.quads, axis, *marks)
    normals = np.cross(on.frames[:, 1], on.frames[:, 2])
    lift = lifts(paths)
    return {
        "kind": "winding",
        "title": _title(paths, name, revolutions),
        "subtitle": _subtitle(layup, figures, units),
        "units": units,
        "points": on.points,
        "quads": on.quads,
        "normals": normals,
        "paths": paths.points[:, kept],
        "path_lift": lift[:, kept],
        "family": paths.family,
        "taut": paths.status == Status.CONVERGED,
        "max_gap": figures.max_gap,
        "pitch": _pitch(layup),
        "right": view.right,
        "up": view.up,
        "eye": view.eye,
        "centre": view.centre,
        "extent": np.array([view.width, view.height]),
    } | _bridges(paths, figures.spans, lift, stride)


def lifts(paths: Paths) -> Floats:
    """Where to lift the particles so that tubes lie on the part (p, n, 3), in radii of the tube.

    Along the normal on the surface.  Along a bridge evenly from one end's normal to the other's: it is straight
    and stays so, which lifting along the normals below it would bend.
    """
    spans = bridges(paths)
    row, column, share = _inside(paths, spans)
    size = spans.last - spans.first + 1
    first, last = (np.repeat(paths.normal[spans.path, end], size, axis=0) for end in (spans.first, spans.last))
    lift = np.array(paths.normal)
    lift[row, column] = (1.0 - share)[:, None] * first + share[:, None] * last
    return lift


def _inside(paths: Paths, spans: Bridges) -> tuple[Ints, Ints, Floats]:
    """Path, number and share of the way along its bridge of every particle of every bridge, ends included."""
    size = spans.last - spans.first + 1
    begin = np.cumsum(size) - size
    row = np.repeat(spans.path, size)
    column = np.arange(size.sum()) - np.repeat(begin - spans.first, size)
    arc = lengths(paths).arc_length
    start = np.repeat(arc[spans.path, spans.first], size)
    return row, column, (arc[row, column] - start) / np.repeat(spans.length, size)


def _pitch(layup: Layup) -> float:
    """Mean distance from fibre to fibre of a family, in mesh units."""
    each = lengths(layup.paths).length.sum() / len(np.unique(layup.paths.family))
    return float(layup.coverage.area.sum() / max(each, 1e-300))


def _bridges(paths: Paths, spans: Bridges, lift: Floats, stride: int) -> dict[str, Floats]:
    """The bridges as polylines one after the other: every stride-th point and both ends."""
    row, column, share = _inside(paths, spans)
    size = spans.last - spans.first + 1
    begin = np.cumsum(size) - size
    step = np.arange(len(row)) - np.repeat(begin, size)
    keep = (step % stride == 0) | (step == np.repeat(size - 1, size))
    sizes = np.add.reduceat(keep.astype(np.int64), begin) if len(begin) else begin
    row, column = row[keep], column[keep]
    return {
        "bridges": paths.points[row, column],
        "bridge_lift": lift[row, column],
        "bridge_gap": paths.gap[row, column],
        "bridge_sizes": sizes,
    }


def _title(paths: Paths, name: str, revolutions: float | None) -> str:
    count = " + ".join(str(int((paths.family == family).sum())) for family in (1, -1))
    mean = float(np.abs(paths.uv[:, -1, 0] - paths.uv[:, 0, 0]).mean())
    turns = mean if revolutions is None else revolutions
    return f"{name}: {count} fibres, {turns:.4g} revolutions"


def _subtitle(layup: Layup, figures: PathFigures, units: str) -> str:
    """The report's figures in a line."""
    bridged = f"bridged {100.0 * figures.bridged_fraction:.1f} %" if len(figures.spans) else "no bridges"
    parts = [f"fibre length {quantity(figures.length, units)}", bridged, f"{len(layup.crossings)} crossings"]
    if figures.at_rest < len(layup.paths):
        whose = "these" if figures.at_rest else "all"
        parts[0] = f"{figures.at_rest} of {len(layup.paths)} at rest; {whose}: {parts[0]}"
    return "  ·  ".join(parts)
