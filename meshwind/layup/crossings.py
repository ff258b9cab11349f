"""Where paths of one family cross those of the other, and the lengths of fibre between neighbouring crossings."""

from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.core.geometry import Block, Geometric
from meshwind.core.vectors import TINY
from meshwind.layup.curve_meetings import curve_meetings
from meshwind.layup.meetings import Meetings, meet
from meshwind.path.lengths import lengths
from meshwind.path.paths import Paths
from meshwind.surface.evaluate import SU, SV, S

SHARED = 4e-9
"""Ends of paths this close in (u, v) are one point of the rim."""
_AT_RIM = 1e-5
"""A meeting this close to such a shared end, in (u, v), is the end itself rather than a crossing."""
_NEXT = 0.5
"""Meetings of a path with itself this close, in particle spacings, are the particle that two segments share."""


@dataclass(frozen=True)
class Crossings(Geometric):
    """The k crossings of family +1 (path_a) with family -1 (path_b), ordered by path_a, then along it.

    path_a, path_b (k,) indices of paths; t_a, t_b (k,) where their chords cross, as fractional particle indices;
    sense (k,) +1 where b passes a to its left in (u, v), else -1; uv (k, 2) with u in [0, 1); angle (k,) in
    radians, 0 to pi/2; points (k, 3) on the surface, or midway between the two fibres where either bridges;
    on_surface (k,) where neither bridges; compared (p,) the paths that took part; own (j, 2) pairs of these of one
    family that cross, see `own_crossings`.
    """

    path_a: Ints
    path_b: Ints
    t_a: Floats
    t_b: Floats
    sense: Ints
    uv: Floats
    angle: Floats
    points: Floats
    on_surface: Bools
    compared: Bools
    own: Ints

    __repr__ = brief

    @property
    def block(self) -> Block:
        """The points, with the fields of crossings.vtp; angles in degrees."""
        data = {
            "path_a": self.path_a,
            "path_b": self.path_b,
            "angle": np.degrees(self.angle),
            "quality": np.abs(np.cos(self.angle)),
            "uv": self.uv,
            "on_surface": self.on_surface,
        }
        return Block(self.points, point_data=data)

    def __len__(self) -> int:
        return len(self.path_a)


def crossings(paths: Paths, among: Bools | None = None) -> Crossings:
    """Find all crossings of the two families, among all paths or those where `among` (p,) holds.

    Points on a rim that paths share as ends are not crossings, nor are those of stretches where paths coincide.
    """
    compared = _mask(paths, among)
    met = meet(paths, compared & (paths.family > 0), compared & (paths.family < 0))
    met = met.chosen(~(_at_shared_end(paths, met) | _coincide(paths, met)))
    strands = [_Strand.at(paths, met.a, met.t_a), _Strand.at(paths, met.b, met.t_b)]
    on_surface = strands[0].on_surface & strands[1].on_surface
    curve = curve_meetings(paths, met)
    valid = curve.valid & on_surface & (np.abs(curve.uv[:, 1] - 0.5) <= 0.5)
    along = curve.along_a, curve.along_b
    strands = [strand.on_curve(curve.uv, step, valid) for strand, step in zip(strands, along, strict=True)]
    frames = paths.surface.frames(strands[0].uv)
    midway = 0.5 * (strands[0].points + strands[1].points)
    angle = _angle(*(strand.tangent(frames) for strand in strands))
    uv = strands[0].uv - np.floor(strands[0].uv) * [1.0, 0.0]
    points = np.where(on_surface[:, None], frames[:, S], midway)
    return Crossings(*map(frozen, (*met, uv, angle, points, on_surface, compared, own_crossings(paths, compared))))


def own_crossings(paths: Paths, among: Bools | None = None) -> Ints:
    """Pairs (k, 2) of paths of one family that cross each other, or of a path with itself; one row per crossing.

    Fibres of a family should not cross: one that does lies under or over its neighbour, and leaves the quad mesh.
    """
    compared = _mask(paths, among)
    pairs = [np.zeros((0, 2), dtype=np.int64)]
    for family in (1, -1):
        mine = compared & (paths.family == family)
        met = meet(paths, mine, mine)
        inner = ~(_at_shared_end(paths, met) | _coincide(paths, met))
        apart = (met.a < met.b) | ((met.a == met.b) & (met.t_b - met.t_a > _NEXT))
        pairs.append(np.stack([met.a, met.b], axis=1)[apart & inner])
    return np.concatenate(pairs)


def counts(crossings: Crossings, around: int, along: int) -> Ints:
    """Number of crossings (around, along) in each of the equal regions of the (u, v) rectangle."""
    u = np.minimum((crossings.uv[:, 0] * around).astype(np.int64), around - 1)
    v = np.clip((crossings.uv[:, 1] * along).astype(np.int64), 0, along - 1)
    return np.bincount(u * along + v, minlength=around * along).reshape(around, along)


@dataclass(frozen=True)
class CellSides:
    """Lengths of fibre from one crossing to the next, d1 (a,) along family +1 and d2 (b,) along family -1 (Fig. 6.3).

    They are measured along the polylines through the particles, in the mesh's units.
    """

    d1: Floats
    d2: Floats

    __repr__ = brief


def cell_sides(paths: Paths, crossings: Crossings) -> CellSides:
    """Measure along the paths, from each crossing to the next."""
    arc = lengths(paths).arc_length
    either = ((crossings.path_a, crossings.t_a), (crossings.path_b, crossings.t_b))
    return CellSides(*(frozen(_between_neighbours(arc, path, t)) for path, t in either))


def _between_neighbours(arc: Floats, path: Ints, t: Floats) -> Floats:
    """Differences of the arc length between neighbouring points t, as fractional particle indices, of each path."""
    order = np.lexsort((t, path))
    path, t = path[order], t[order]
    k = np.minimum(t.astype(np.int64), arc.shape[1] - 2)
    at = arc[path, k] + (t - k) * (arc[path, k + 1] - arc[path, k])
    return np.asarray(np.diff(at)[np.diff(path) == 0])


def _mask(paths: Paths, among: Bools | None) -> Bools:
    """The paths (p,) that take part: all of them by default."""
    return np.ones(len(paths), dtype=bool) if among is None else np.asarray(among, dtype=bool)


def _at_shared_end(paths: Paths, met: Meetings) -> Bools:
    """Whether each meeting is a rim point that both paths start from or end at."""
    last = paths.uv.shape[1] - 1
    end_a, end_b = (np.where(t < 0.5 * last, 0, last) for t in (met.t_a, met.t_b))
    apart = paths.uv[met.a, end_a] - paths.uv[met.b, end_b]
    apart[:, 0] -= np.round(apart[:, 0])
    ends = ((met.a, met.t_a, end_a), (met.b, met.t_b, end_b))
    reach = [_between(paths.uv, path, t) - paths.uv[path, end] for path, t, end in ends]
    near = np.abs(np.concatenate(reach, axis=1)).max(axis=1) < _AT_RIM
    return np.asarray(near & (end_a == end_b) & (np.abs(apart).max(axis=1) <= SHARED))


def _coincide(paths: Paths, met: Meetings) -> Bools:
    """Whether each meeting is of segments that lie on each other but for round-off, as on paths without a turn."""
    n = paths.uv.shape[1]
    far = np.zeros(len(met.a))
    at_a, at_b = (np.minimum(t.astype(np.int64), n - 2) for t in (met.t_a, met.t_b))
    for a, k, b, j in ((met.a, at_a, met.b, at_b), (met.b, at_b, met.a, at_a)):
        way = paths.uv[a, k + 1] - paths.uv[a, k]
        for end in (j, j + 1):
            gap = paths.uv[b, end] - paths.uv[a, k]
            gap[:, 0] -= np.round(gap[:, 0])
            side = np.abs(way[:, 0] * gap[:, 1] - way[:, 1] * gap[:, 0])
            far = np.maximum(far, side / np.maximum(np.linalg.norm(way, axis=1), TINY))
    return np.asarray(far <= SHARED)


def _between(values: Floats, path: Ints, t: Floats) -> Floats:
    """Linear interpolation of per-particle `values` (p, n, d) at fractional indices t."""
    k = np.minimum(t.astype(np.int64), values.shape[1] - 2)
    f = (t - k)[:, None]
    return np.asarray((1.0 - f) * values[path, k] + f * values[path, k + 1])


@dataclass(frozen=True)
class _Strand:
    """One of the two fibres at each crossing."""

    uv: Floats
    duv: Floats
    points: Floats
    chord: Floats
    on_surface: Bools

    @staticmethod
    def at(paths: Paths, path: Ints, t: Floats) -> "_Strand":
        k = np.minimum(t.astype(np.int64), paths.uv.shape[1] - 2)
        return _Strand(
            uv=_between(paths.uv, path, t),
            duv=_between(np.gradient(paths.uv, axis=1), path, t),
            points=_between(paths.points, path, t),
            chord=paths.points[path, k + 1] - paths.points[path, k],
            on_surface=paths.on_surface[path, k] & paths.on_surface[path, k + 1],
        )

    def on_curve(self, uv: Floats, duv: Floats, where: Bools) -> "_Strand":
        """The strand with a better position and direction where there is one."""
        mask = where[:, None]
        return replace(self, uv=np.where(mask, uv, self.uv), duv=np.where(mask, duv, self.duv))

    def tangent(self, frames: Floats) -> Floats:
        """The fibre's direction: in the tangent plane where it touches, along its chord where it bridges."""
        touching = frames[:, SU] * self.duv[:, :1] + frames[:, SV] * self.duv[:, 1:]
        return np.where(self.on_surface[:, None], touching, self.chord)


def _angle(a: Floats, b: Floats) -> Floats:
    """Angle between lines along a and b (n, 3), 0 to pi/2, accurate at both ends of the range."""
    return np.asarray(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), np.abs((a * b).sum(axis=1))))
