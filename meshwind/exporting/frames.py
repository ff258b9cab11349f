"""Frames for a robot to follow: one CSV file per path, and one of all; `ordered_frames` has filaments and layers."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats, frozen
from meshwind.core.checks import number
from meshwind.core.errors import BadInputError
from meshwind.core.units import millimetres
from meshwind.results.legends import write_legend
from meshwind.results.reading import Results
from meshwind.results.schema import ALL_FRAMES, FRAMES_FOLDER, FRAMES_LEGEND, frames_of

LEGEND = {
    "index": ("", "number of the frame, from 0"),
    "arc_length": ("{u}", "length of the fibre from its start"),
    "parameter_s": ("", "the same over the whole length"),
    **dict.fromkeys("xyz", ("{u}", "point of the fibre")),
    **{f"t{axis}": ("", "unit tangent, in the direction of laying") for axis in "xyz"},
    **{f"n{axis}": ("", "unit normal, out of the part and square to the tangent") for axis in "xyz"},
    **{f"s{axis}": ("", "normal x tangent: to the left, looking along the fibre") for axis in "xyz"},
    "width": ("{u}", "width of the band"),
    **{f"left_{axis}": ("{u}", "left edge of the band") for axis in "xyz"},
    **{f"right_{axis}": ("{u}", "right edge of the band") for axis in "xyz"},
}
"""What the columns of the files are."""
LABELS = {
    "filament": ("", "number of the filament, from 0; in files of filaments"),
    "path": ("", "path in paths.vtp, from 0, -1 where it is none; in all.csv and in files of filaments and layers"),
    "family": ("", "sense of turning of the path, 1 or -1; in all.csv"),
    "layer": ("", "number of the layer, from 0; in files of filaments and layers"),
    "circuit": ("", "number of the circuit, from 0; likewise"),
    "pass": ("", "number of the pass, from 0; likewise"),
    "kind": ("", "0 laid on the part, 1 bridge, 2 turnaround, 3 dwell, 4 join between layers; likewise"),
    "bridge": ("", "1 where the fibre is off the part, 0 where it lies on it; likewise"),
}
"""What the columns before these are."""
HEADER = ",".join(LEGEND)
STEP, ANGLE = 0.02, 5.0
"""Default of the longest step, over the part's diagonal, and of the largest turn, in degrees."""
_SHORTEST = 0.02
"""Shortest step that turning may cause, over the longest: very short steps make robots move roughly."""

_SAFE = 0.99
"""Planned turn over the largest: between two particles a frame does not turn quite evenly."""


@dataclass(frozen=True)
class Frames:
    """Frames of a path at m points: all (m, 3) but arc_length and width (m,), in the mesh's units, and length.

    tangent, normal and side are orthonormal, side = normal x tangent: to the left when looking along the fibre
    with the part below.  left and right are the edges of the band.
    """

    arc_length: Floats
    length: float
    point: Floats
    tangent: Floats
    normal: Floats
    side: Floats
    width: Floats

    @property
    def left(self) -> Floats:
        """Left edge of the band (m, 3)."""
        return np.asarray(self.point + 0.5 * self.width[:, None] * self.side)

    @property
    def right(self) -> Floats:
        """Right edge of the band (m, 3)."""
        return np.asarray(self.point - 0.5 * self.width[:, None] * self.side)


def frames(points: Floats, normals: Floats, width: float, step: float, angle: float) -> Frames:
    """Frames along a path of points (n, 3) with outward normals (n, 3).

    Steps are at most `step` long and turn the frame by at most `angle` radians; there are as few as possible.
    Positions and tangents are those of the cubic spline through the points, arc_length that of the polyline as in
    paths.vtp.
    """
    from scipy.interpolate import CubicSpline

    chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
    moved = np.concatenate([[True], chords > 1e-12 * chords.sum()])  # coincident particles count as one
    points, normals = points[moved], normals[moved]
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    spline = CubicSpline(arc, points)
    at = _stations(arc, *_square(spline(arc, 1), normals)[:2], step, angle)
    near = np.stack([np.interp(at, arc, normals[:, axis]) for axis in range(3)], axis=1)
    tangent, normal, side = _square(spline(at, 1), near)
    point = spline(at)
    point[0], point[-1] = points[0], points[-1]
    at, point, tangent, normal, side = map(frozen, (at, point, tangent, normal, side))
    return Frames(at, float(arc[-1]), point, tangent, normal, side, frozen(np.full(len(at), float(width))))


def _square(tangent: Floats, normal: Floats) -> tuple[Floats, Floats, Floats]:
    """Orthonormal tangent, normal and side; the direction of the tangent is kept."""
    t = tangent / np.linalg.norm(tangent, axis=1, keepdims=True)
    side = np.cross(normal, t)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    return t, np.cross(t, side), side


def _stations(arc: Floats, tangent: Floats, normal: Floats, step: float, angle: float) -> Floats:
    """Arc lengths (m,) of frames that divide length and turning evenly, each measured in units of its limit."""
    turns = np.maximum(turns_of(tangent), turns_of(normal)) / (_SAFE * angle)
    chords = np.diff(arc)
    effort = np.maximum(chords / step, np.minimum(turns, chords / (_SHORTEST * step)))
    spent = np.concatenate([[0.0], np.cumsum(effort)])
    count = max(int(np.ceil(spent[-1] * (1.0 - 1e-12))), 1)
    at = np.interp(np.linspace(0.0, spent[-1], count + 1), spent, arc)
    at[0], at[-1] = 0.0, arc[-1]
    return at


def turns_of(directions: Floats) -> Floats:
    """Angles (n - 1,) between consecutive unit vectors (n, 3)."""
    apart = np.linalg.norm(np.diff(directions, axis=0), axis=1)
    return np.asarray(2.0 * np.arcsin(np.minimum(0.5 * apart, 1.0)))


@dataclass(frozen=True)
class Limits:
    """Longest step in the mesh's units, largest turn in radians, the width of the band, and the mesh's unit in mm.

    width: None where it is each layer's own.
    """

    step: float
    turn: float
    width: float | None
    scale: float

    @classmethod
    def of(
        cls, results: Results, step: float | None = None, angle: float | None = None, width: float | None = None
    ) -> "Limits":
        """The limits that are given, others by default; raises BadInputError if one is none."""
        longest = number(STEP * results.diagonal if step is None else step, "step", 0.0, above=True)
        turn = np.radians(number(ANGLE if angle is None else angle, "angle", 0.0, above=True))
        wide = None if width is None else number(width, "band width", 0.0, above=True)
        return cls(longest, float(turn), wide, millimetres(results.units))

    def sharp(self, found: Frames) -> int:
        """Steps that turn by more."""
        turns = np.maximum(turns_of(found.tangent), turns_of(found.normal))
        return int((turns > self.turn * (1.0 + 1e-6)).sum())


def write_frames(
    folder: Path, results: Results, step: float | None = None, angle: float | None = None, width: float | None = None
) -> list[str]:
    """Write frames/path_000.csv and so on, one per converged path, and frames/all.csv; lengths in mm.

    A continuous winding has frames/filament.csv as well, and layers that are not one filament frames/layer_000.csv and
    so on.  step: longest step in the mesh's units, 2 % of the part's diagonal by default; angle: largest turn from
    frame to frame in degrees, 5 by default; width of the band in the mesh's units, by default the run's own, or that
    of each layer.  Returns what the user should know.  Raises BadInputError if no path converged, or a limit is none.
    """
    limits = Limits.of(results, step, angle, width)
    wide = number(results.band_width if width is None else width, "band width", 0.0, above=True)
    rest = np.flatnonzero(results.at_rest)
    if not len(rest):
        raise BadInputError(f"no path of {results.folder} came to rest, so there is none to follow; wind it otherwise")
    (folder / FRAMES_FOLDER).mkdir()
    write_legend(folder / FRAMES_FOLDER / FRAMES_LEGEND, LABELS | LEGEND, "mm")
    paths, sharp = results.paths, 0
    with (folder / FRAMES_FOLDER / ALL_FRAMES).open("w", encoding="ascii") as every:
        every.write(f"path,family,{HEADER}\n")
        for k in rest:
            found = frames(paths.points[k], paths.normal[k], wide, limits.step, limits.turn)
            rows = table(found, limits.scale)
            with (folder / FRAMES_FOLDER / frames_of(int(k))).open("w", encoding="ascii") as file:
                np.savetxt(file, rows, fmt=FORMAT, delimiter=",", header=HEADER, comments="")
            both = np.column_stack([np.broadcast_to([k, paths.family[k]], (len(rows), 2)), rows])
            np.savetxt(every, both, fmt=["%d", "%d", *FORMAT], delimiter=",")
            sharp += limits.sharp(found)
    return [f"{FRAMES_FOLDER}: {note}" for note in _notes(results, len(rest), sharp)]


FORMAT = ["%d"] + 21 * ["%.15g"]
"""How the columns of a file are written."""


def table(found: Frames, scale: float) -> Floats:
    """The rows (m, 22) of a CSV file, lengths times `scale`."""
    m = len(found.point)
    share = found.arc_length / max(found.length, 1e-300)
    edges = [scale * edge for edge in (found.left, found.right)]
    return np.column_stack(
        [np.arange(m), scale * found.arc_length, share, scale * found.point, found.tangent, found.normal, found.side]
        + [scale * found.width, *edges]
    )


def _notes(results: Results, written: int, sharp: int) -> list[str]:
    notes = []
    if written < len(results.paths):
        notes.append(f"left out as not at rest: {len(results.paths) - written} of {len(results.paths)} paths")
    if sharp:
        notes.append(too_sharp(sharp))
    if not results.units:
        notes.append("the run names no unit, so its lengths are taken as mm")
    return notes


def too_sharp(steps: int) -> str:
    """Note on steps that turn by more than the limit."""
    return f"{steps} steps turn by more than the limit, as no step is made tiny for a sharp edge"
