"""Where paths of one family cross those of the other, found in the (u, v) plane with u periodic."""

from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.layup.segments import meetings
from meshwind.layup.sharpen import sharpened
from meshwind.path.paths import Paths

SHARED = 4e-9
"""Ends of paths this close in (u, v) are one point of the rim."""
_AT_RIM = 1e-5
"""A meeting this close to such a shared end, in (u, v), is the end itself rather than a crossing."""
_SAME = 1e-6
"""Meetings of one pair this close, in particle spacings, are one meeting found in two segments."""


@dataclass(frozen=True)
class Crossings:
    """The k crossings of family +1 (path_a) with family -1 (path_b), ordered by path_a, then along it.

    path_a, path_b (k,) indices of paths; t_a, t_b (k,) where their chords cross, as fractional particle indices;
    sense (k,) +1 where b passes a to its left in (u, v), else -1; uv (k, 2) with u in [0, 1); angle (k,) in
    radians, 0 to pi/2; points (k, 3) on the surface, or midway between the two fibres where either bridges;
    on_surface (k,) where neither bridges; compared (p,) the paths that took part.
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

    def __len__(self) -> int:
        return len(self.path_a)


def crossings(paths: Paths, among: Bools | None = None) -> Crossings:
    """Find all crossings of the two families, among all paths or those where `among` (p,) holds.

    Points on a rim that paths share as ends are not crossings.
    """
    compared = np.ones(len(paths), dtype=bool) if among is None else np.asarray(among, dtype=bool)
    a, b, t_a, t_b, sense = meet(paths, compared & (paths.family > 0), compared & (paths.family < 0))
    inner = ~_at_shared_end(paths, a, b, t_a, t_b)
    a, b, t_a, t_b, sense = a[inner], b[inner], t_a[inner], t_b[inner], sense[inner]
    strands = [_Strand.at(paths, a, t_a), _Strand.at(paths, b, t_b)]
    on_surface = strands[0].on_surface & strands[1].on_surface
    sharp, *along, holds = sharpened(paths, a, b, t_a, t_b)
    holds &= on_surface & (np.abs(sharp[:, 1] - 0.5) <= 0.5)
    strands = [strand.on_curve(sharp, step, holds) for strand, step in zip(strands, along, strict=True)]
    frames = paths.surface.frames(strands[0].uv)
    midway = 0.5 * (strands[0].points + strands[1].points)
    angle = _angle(*(strand.tangent(frames) for strand in strands))
    uv = strands[0].uv - np.floor(strands[0].uv) * [1.0, 0.0]
    points = np.where(on_surface[:, None], frames[:, 0], midway)
    return Crossings(*map(frozen, (a, b, t_a, t_b, sense, uv, angle, points, on_surface, compared)))


def meet(paths: Paths, first: Bools, second: Bools) -> tuple[Ints, Ints, Floats, Floats, Ints]:
    """Meetings of the paths in mask `first` with those in mask `second`, each once.

    Returns path indices a and b, fractional particle indices t_a and t_b, and the sense of the turn a to b.
    """
    (ids_a, seg_a), (ids_b, seg_b) = _segments(paths, first), _segments(paths, second)
    pieces = paths.uv.shape[1] - 1
    i, j, s, r, sign = meetings(seg_a, seg_b, *_cells(seg_a, seg_b))
    a, b = ids_a[i // pieces], ids_b[j // pieces]
    t_a = np.clip(i % pieces + s, 0.0, pieces)
    t_b = np.clip(j % pieces + r, 0.0, pieces)
    order = np.lexsort((t_b, t_a, b, a))
    a, b, t_a, t_b, sign = a[order], b[order], t_a[order], t_b[order], sign[order]
    new = np.ones(len(a), dtype=bool)
    new[1:] = (np.diff(a) != 0) | (np.diff(b) != 0) | (np.diff(t_a) > _SAME) | (np.abs(np.diff(t_b)) > _SAME)
    order = np.flatnonzero(new)
    order = order[np.lexsort((t_a[order], a[order]))]
    return a[order], b[order], t_a[order], t_b[order], sign[order].astype(np.int64)


def own_crossings(paths: Paths, among: Bools | None = None) -> Ints:
    """Pairs (k, 2) of paths of one family that cross each other, or of a path with itself; one row a crossing.

    Fibres of a family should not cross: one that does lies under or over its neighbour, and leaves the quad mesh.
    """
    compared = np.ones(len(paths), dtype=bool) if among is None else np.asarray(among, dtype=bool)
    pairs = [np.zeros((0, 2), dtype=np.int64)]
    for family in (1, -1):
        mine = compared & (paths.family == family)
        a, b, t_a, t_b, _ = meet(paths, mine, mine)
        inner = ~_at_shared_end(paths, a, b, t_a, t_b)
        apart = (a < b) | ((a == b) & (t_b - t_a > 0.5))  # neighbours on one path share a particle
        pairs.append(np.stack([a, b], axis=1)[apart & inner])
    return np.concatenate(pairs)


def counts(crossings: Crossings, around: int, along: int) -> Ints:
    """Number of crossings (around, along) in each of the equal regions of the (u, v) rectangle."""
    u = np.minimum((crossings.uv[:, 0] * around).astype(np.int64), around - 1)
    v = np.clip((crossings.uv[:, 1] * along).astype(np.int64), 0, along - 1)
    return np.bincount(u * along + v, minlength=around * along).reshape(around, along)


def _segments(paths: Paths, mask: Bools) -> tuple[Ints, Floats]:
    """Path indices and all their segments (m, 4) in the (u, v) plane."""
    uv = paths.uv[mask]
    return np.flatnonzero(mask), np.concatenate([uv[:, :-1], uv[:, 1:]], axis=2).reshape(-1, 4)


def _cells(a: Floats, b: Floats) -> tuple[int, int]:
    """Size of the search grid: cells as large as a mean segment, no more of them than segments."""
    both = np.concatenate([a, b])
    extent = np.abs(both[:, 2:] - both[:, :2]).mean(axis=0) if len(both) else np.ones(2)
    most = int(np.sqrt(len(both))) + 1
    nu, nv = np.clip(np.ceil(1.0 / np.maximum(extent, 1.0 / most)), 1, most).astype(int)
    return int(nu), int(nv)


def _at_shared_end(paths: Paths, a: Ints, b: Ints, t_a: Floats, t_b: Floats) -> Bools:
    """True where the meeting is a rim point that both paths start from or end at."""
    last = paths.uv.shape[1] - 1
    end_a, end_b = (np.where(t < 0.5 * last, 0, last) for t in (t_a, t_b))
    apart = paths.uv[a, end_a] - paths.uv[b, end_b]
    apart[:, 0] -= np.round(apart[:, 0])
    ends = ((a, t_a, end_a), (b, t_b, end_b))
    reach = [_between(paths.uv, path, t) - paths.uv[path, end] for path, t, end in ends]
    near = np.abs(np.concatenate(reach, axis=1)).max(axis=1) < _AT_RIM
    return np.asarray(near & (end_a == end_b) & (np.abs(apart).max(axis=1) <= SHARED))


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
        """The strand with a better place and direction where there is one."""
        mask = where[:, None]
        return replace(self, uv=np.where(mask, uv, self.uv), duv=np.where(mask, duv, self.duv))

    def tangent(self, frames: Floats) -> Floats:
        """The fibre's direction: in the tangent plane where it touches, along its chord where it bridges."""
        touching = frames[:, 1] * self.duv[:, :1] + frames[:, 2] * self.duv[:, 1:]
        return np.where(self.on_surface[:, None], touching, self.chord)


def _angle(a: Floats, b: Floats) -> Floats:
    """Angle between lines along a and b (n, 3), 0 to pi/2, accurate at both ends of the range."""
    return np.asarray(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), np.abs((a * b).sum(axis=1))))
