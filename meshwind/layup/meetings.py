"""Where paths meet in the (u, v) plane, u periodic: a compiled search for the meetings of their segments."""

from math import ceil, floor
from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import copy_table
from meshwind.path.paths import Paths

REACH = 1e-9
"""How far past its ends a segment still meets another, in its own lengths; the doubles are merged later."""
_PARALLEL = 1e-14
"""Sine of the angle of two segments up to which they count as parallel: round-off of the cross product."""
_SAME = 1e-6
"""Meetings of one pair this close, in particle spacings, are one meeting found in two segments."""
_ROOM = 1024
"""Meetings that there is room for at first; the room doubles whenever it is full."""


class Meetings(NamedTuple):
    """The k meetings of two sets of paths or of segments.

    a, b (k,): which of each set; t_a, t_b (k,): where on them, in segments from their starts; sense (k,): +1 where b
    passes a to its left, else -1.
    """

    a: Ints
    b: Ints
    t_a: Floats
    t_b: Floats
    sense: Ints

    def chosen(self, index: Ints | Bools) -> "Meetings":
        """Some of the meetings, by a mask or in the order of their numbers."""
        return Meetings(self.a[index], self.b[index], self.t_a[index], self.t_b[index], self.sense[index])


class Grid(NamedTuple):
    """Cells over the rectangle [0, 1) x [0, 1], periodic in u: columns around and rows along."""

    nu: int
    nv: int


class Bins(NamedTuple):
    """Numbers of the segments in each cell, cell by cell: those of cell c are members[starts[c] : starts[c + 1]]."""

    starts: Ints
    members: Ints


def meet(paths: Paths, first: Bools, second: Bools) -> Meetings:
    """Meetings of the paths in mask `first` with those in mask `second`, each once, ordered by a, then along it."""
    (ids_a, seg_a), (ids_b, seg_b) = _segments(paths, first), _segments(paths, second)
    pieces = paths.uv.shape[1] - 1
    found = segment_meetings(seg_a, seg_b, _grid(seg_a, seg_b))
    met = Meetings(
        ids_a[found.a // pieces],
        ids_b[found.b // pieces],
        np.clip(found.a % pieces + found.t_a, 0.0, pieces),
        np.clip(found.b % pieces + found.t_b, 0.0, pieces),
        found.sense,
    )
    met = met.chosen(np.lexsort((met.t_b, met.t_a, met.b, met.a)))
    new = np.ones(len(met.a), dtype=bool)
    same_pair = (np.diff(met.a) == 0) & (np.diff(met.b) == 0)
    new[1:] = ~same_pair | (np.diff(met.t_a) > _SAME) | (np.abs(np.diff(met.t_b)) > _SAME)
    met = met.chosen(new)
    return met.chosen(np.lexsort((met.t_a, met.a)))


def _segments(paths: Paths, mask: Bools) -> tuple[Ints, Floats]:
    """Numbers of the paths in a mask, and all their segments (m, 4) as u0, v0, u1, v1."""
    uv = paths.uv[mask]
    return np.flatnonzero(mask), np.concatenate([uv[:, :-1], uv[:, 1:]], axis=2).reshape(-1, 4)


def _grid(a: Floats, b: Floats) -> Grid:
    """The search grid: cells as large as a mean segment, and no more of them than segments."""
    both = np.concatenate([a, b])
    extent = np.abs(both[:, 2:] - both[:, :2]).mean(axis=0) if len(both) else np.ones(2)
    most = int(np.sqrt(len(both))) + 1
    nu, nv = np.clip(np.ceil(1.0 / np.maximum(extent, 1.0 / most)), 1, most).astype(int)
    return Grid(int(nu), int(nv))


@njit(forceinline=True, cache=True)
def _columns(low: float, high: float, count: int) -> tuple[int, int]:
    """First column and number of columns that [low, high] covers; columns repeat with period 1."""
    first = floor((low - REACH) * count)
    return first, min(floor((high + REACH) * count) - first + 1, count)


@njit(forceinline=True, cache=True)
def _rows(low: float, high: float, count: int) -> tuple[int, int]:
    """First and last row that [low, high] covers, clipped to the grid."""
    first, last = floor((low - REACH) * count), floor((high + REACH) * count)
    return min(max(first, 0), count - 1), min(max(last, 0), count - 1)


@njit(cache=True)
def _bins(segments: Floats, grid: Grid) -> Bins:
    """The segments whose bounding boxes touch each cell."""
    nu, nv = grid
    starts = np.zeros(nu * nv + 1, np.int64)
    members = np.empty(0, np.int64)
    for filling in range(2):  # count first, then fill from the back
        for k in range(len(segments)):
            u0, v0, u1, v1 = segments[k, 0], segments[k, 1], segments[k, 2], segments[k, 3]
            first, width = _columns(min(u0, u1), max(u0, u1), nu)
            low, high = _rows(min(v0, v1), max(v0, v1), nv)
            for i in range(first, first + width):
                for j in range(low, high + 1):
                    cell = (i % nu) * nv + j
                    if filling:
                        starts[cell] -= 1
                        members[starts[cell]] = k
                    else:
                        starts[cell] += 1
        if not filling:
            starts = np.cumsum(starts)
            members = np.empty(starts[-1], np.int64)
    return Bins(starts, members)


@njit(forceinline=True, cache=True)
def _meet(a: Floats, b: Floats, turn: float) -> tuple[float, float, float]:
    """Fractions along a and along b (moved by `turn`) where they meet, and d_a x d_b; 0 where they do not."""
    du, dv, eu, ev = a[2] - a[0], a[3] - a[1], b[2] - b[0], b[3] - b[1]
    cross = du * ev - dv * eu
    if abs(cross) <= _PARALLEL * np.hypot(du, dv) * np.hypot(eu, ev):
        return 0.0, 0.0, 0.0
    wu, wv = b[0] + turn - a[0], b[1] - a[1]
    s, r = (wu * ev - wv * eu) / cross, (wu * dv - wv * du) / cross
    if s < -REACH or s > 1.0 + REACH or r < -REACH or r > 1.0 + REACH:
        return 0.0, 0.0, 0.0
    return s, r, cross


@njit(cache=True)
def _with_room(pairs: Ints, where: Floats) -> tuple[Ints, Floats]:
    """Copies of pairs (n, 3) and where (n, 2) in tables of twice as many rows."""
    more, further = np.empty((2 * len(pairs), 3), np.int64), np.empty((2 * len(where), 2))
    copy_table(pairs, more[: len(pairs)])
    copy_table(where, further[: len(where)])
    return more, further


@njit(nogil=True, cache=True)
def segment_meetings(a: Floats, b: Floats, grid: Grid) -> Meetings:
    """Every meeting of a segment of a (m, 4) with one of b (k, 4), rows u0, v0, u1, v1, modulo turns.

    The cells of the grid should be about a segment wide: then the cost is that of the meetings themselves.
    """
    bins = _bins(b, grid)
    seen = np.full(len(b), -1)
    room, found = _ROOM, 0
    pairs, where = np.empty((room, 3), np.int64), np.empty((room, 2))
    for k in range(len(a)):
        low_u, high_u = min(a[k, 0], a[k, 2]), max(a[k, 0], a[k, 2])
        first, width = _columns(low_u, high_u, grid.nu)
        low, high = _rows(min(a[k, 1], a[k, 3]), max(a[k, 1], a[k, 3]), grid.nv)
        for i in range(first, first + width):
            for j in range(low, high + 1):
                cell = (i % grid.nu) * grid.nv + j
                for m in bins.members[bins.starts[cell] : bins.starts[cell + 1]]:
                    if seen[m] == k:  # met already in another cell that both touch
                        continue
                    seen[m] = k
                    turn = ceil(low_u - max(b[m, 0], b[m, 2]) - REACH)
                    last = floor(high_u - min(b[m, 0], b[m, 2]) + REACH)
                    while turn <= last:
                        s, r, cross = _meet(a[k], b[m], float(turn))
                        if cross != 0.0:
                            if found == room:
                                pairs, where = _with_room(pairs, where)
                                room *= 2
                            pairs[found, 0], pairs[found, 1], pairs[found, 2] = k, m, 1 if cross > 0.0 else -1
                            where[found, 0], where[found, 1] = s, r
                            found += 1
                        turn += 1
    return Meetings(pairs[:found, 0], pairs[:found, 1], where[:found, 0], where[:found, 1], pairs[:found, 2])
