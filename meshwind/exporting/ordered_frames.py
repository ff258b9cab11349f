"""Frames for a robot in the order of winding: of filaments, and layer by layer where the layers are none."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.core.vectors import unit
from meshwind.exporting.frames import FORMAT, HEADER, Frames, Limits, frames, table, too_sharp, turns_of
from meshwind.filament.course import Kind
from meshwind.results.reading import Results
from meshwind.results.schema import FILAMENT_FRAMES, FRAMES_FOLDER, layer_frames
from meshwind.results.wound_layers import WoundLayer

OF_FILAMENT = "filament", "layer", "circuit", "pass", "path", "kind", "bridge"
"""Columns before those of a frame in the file of filaments: numbers from 0 as in filament.vtp, bridge 1 in the air."""
OF_LAYER = "layer", "path", "family", "bridge"
"""The same in the file of a layer; path is the number of the line in layers.vtp."""
_CORNER = np.radians(20.0)
"""Turn at a point of a filament that is a corner: a spline through it would swing to both sides."""
_AT_POINT = 1e-12
"""Share of its arc length that a frame at a point may be past it by round-off."""


def write_ordered_frames(folder: Path, results: Results, limits: Limits) -> list[str]:
    """Write frames/filament.csv, or frames/layer_000.csv and so on, into a folder that has the frames of paths.

    Lengths are in mm.  Does nothing where the run is neither continuous nor of layers.  Returns what the user should
    know.
    """
    if results.filaments:
        notes = [_write_filaments(folder, results, limits)]
    elif results.wound_layers is not None:
        layers = results.wound_layers.layers
        first = np.cumsum([0, *(len(each.paths) for each in layers)])
        notes = [_write_layer(folder, each, (k, int(first[k])), limits) for k, each in enumerate(layers)]
    else:
        return []
    return [f"{FRAMES_FOLDER}/{note}" for note in notes if note]


def _write_filaments(folder: Path, results: Results, limits: Limits) -> str:
    widths = np.array(results.band_widths if limits.width is None else [limits.width] * len(results.band_widths))
    found, labels = [], []
    for number, filament in enumerate(results.filaments):
        course, layer = filament.course, filament.layer
        laid = _cornered(course.points, course.normal, limits)
        at = _ends(course.points, laid)
        bridge = _in_air(course.kind == Kind.BRIDGE, at)
        own = np.stack([layer, course.circuit, course.passed, course.path], axis=1)[at]
        kind = np.where(bridge, int(Kind.BRIDGE), course.kind[at])
        found.append(replace(laid, width=frozen(widths[layer[at]])))
        labels.append(np.column_stack([np.full(len(at), number), own, kind, bridge]))
    return _write(folder, FILAMENT_FRAMES, OF_FILAMENT, (labels, found), limits)


def _write_layer(folder: Path, layer: WoundLayer, numbers: tuple[int, int], limits: Limits) -> str:
    """Write the frames of a layer; numbers: its own and that of its first path."""
    number, first = numbers
    width = layer.figures["band_width"] if limits.width is None else limits.width
    found, labels = [], []
    paths = layer.paths
    for k in range(len(paths)):
        laid = frames(paths.points[k], paths.normal[k], width, limits.step, limits.turn)
        bridge = _in_air(~paths.on_surface[k], _ends(paths.points[k], laid))
        found.append(laid)
        own = np.broadcast_to([number, first + k, paths.family[k]], (len(bridge), 3))
        labels.append(np.column_stack([own, bridge]))
    return _write(folder, layer_frames(number), OF_LAYER, (labels, found), limits)


def _cornered(points: Floats, normals: Floats, limits: Limits) -> Frames:
    """Frames along a polyline (n, 3) with corners, as at pins: a spline from corner to corner, where two frames meet.

    Their width is 0.
    """
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    kept = np.flatnonzero(np.concatenate([[True], np.diff(arc) > _AT_POINT * arc[-1]]))
    way = unit(np.diff(points[kept], axis=0))
    corners = kept[1:-1][turns_of(way) > _CORNER]
    ends = np.unique([0, *corners, kept[-1]])
    each = [
        frames(points[first : last + 1], normals[first : last + 1], 0.0, limits.step, limits.turn)
        for first, last in pairwise(ends)
    ]
    along = np.concatenate([arc[first] + one.arc_length for first, one in zip(ends[:-1], each, strict=True)])
    along = np.maximum.accumulate(along)  # where two stretches meet, both are there but for round-off
    point, tangent, normal, side, width = (
        frozen(np.concatenate([getattr(one, name) for one in each]))
        for name in ("point", "tangent", "normal", "side", "width")
    )
    return Frames(frozen(along), float(arc[-1]), point, tangent, normal, side, width)


def _ends(points: Floats, laid: Frames) -> Ints:
    """The point (m,) at the end of the segment that each frame is on, as a segment is of the kind of its end."""
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    at = np.searchsorted(arc, laid.arc_length * (1.0 - _AT_POINT), side="left")
    return np.minimum(at, len(points) - 1).astype(np.int64)


def _in_air(air: Bools, at: Ints) -> Bools:
    """Whether frames (m,) on segments that end at points `at` are in the air; air (n,): whether points are."""
    return np.asarray(air[at] | air[np.maximum(at - 1, 0)])


def _write(
    folder: Path, name: str, before: tuple[str, ...], rows: tuple[list[Ints], list[Frames]], limits: Limits
) -> str:
    """Write frames with the columns before them; return a note, "" if there is nothing to say."""
    labels, found = rows
    written = np.concatenate([table(each, limits.scale) for each in found])
    with (folder / FRAMES_FOLDER / name).open("w", encoding="ascii") as file:
        file.write(f"{','.join(before)},{HEADER}\n")
        both = np.column_stack([np.concatenate(labels), written])
        np.savetxt(file, both, fmt=[*("%d" for _ in before), *FORMAT], delimiter=",")
    sharp = sum(limits.sharp(each) for each in found)
    return f"{name}: {too_sharp(sharp)}" if sharp else ""
