"""Where a program has its blocks: as few as its longest steps allow, on the path itself."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import reduce

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.program.blocks import Blocks
from meshwind.program.eye import Poses
from meshwind.program.track import AIR, LAY, PIVOT, Track

_AIM = 0.95
"""Planned step over the longest: between two places of the fibre the axes do not move quite evenly."""
_TINY = 1e-4
"""Step over the longest that is none: no controller tells two such blocks apart."""
_MOST = 0.99
"""Step over the longest above which it is halved: steps are a little longer once blocks that hardly differ are gone."""
_ROUNDS = 12
"""Rounds in which steps are halved; a step that is still too long is at a place where the axes have no limit."""
_FINE = np.radians(1.0)
"""Turn of the fibre between two looks at it."""
_SHARE = 0.25
"""Length between two looks over the longest step of the eye."""
_EVEN = 1e-6
"""Share of a look by which it may come early: round-off must not move it."""
_STEEP, _ROUND_OFF = 85.0, 1.0 + 1e-9
"""Yaw in degrees above which the roll has no limit, and a step over the longest that is longer by round-off alone."""
_TOLD = np.radians(3.0)
"""Turn about a point from which its start and end have blocks of their own."""


@dataclass(frozen=True)
class Steps:
    """Longest steps between blocks: of mandrel, roll, yaw, in radians, of the eye along the axis and from it, laid."""

    mandrel: float
    roll: float
    yaw: float
    x: float
    r: float
    laid: float

    def effort(self, poses: Poses) -> Floats:
        """The steps (n - 1,) between poses, in units of the longest."""
        shares = (np.abs(np.diff(getattr(poses, name))) / value for name, value in vars(self).items())
        return reduce(np.maximum, shares)

    def of(self, track: Track, poses: Poses) -> Floats:
        """The same on a track, where a bridge lands at once, however long it is."""
        between = track.piece(0.5 * (poses.at[:-1] + poses.at[1:]))[0]
        return np.where(track.motion[between] == AIR, self.motion(poses), self.effort(poses))

    def motion(self, poses: Poses) -> Floats:
        """The same without what is laid: what the machine does."""
        return replace(self, laid=np.inf).effort(poses)


def stepped(track: Track, solve: Callable[[Floats], Poses], steps: Steps) -> Poses:
    """The poses of the blocks of a track, the axes being solved anew at every place that is looked at."""
    at, effort = _resolved(track, solve, steps, _whole(track, steps))
    wanted = _spread(at, effort, kept(track, at))
    for _ in range(_ROUNDS):
        # solved among all places that were looked at, so that no fibre is slack between two blocks
        every = np.union1d(at, wanted)
        found = _chosen(solve(every), np.searchsorted(every, wanted))
        halves = _halves(wanted, steps.of(track, found))
        if not len(halves):
            break
        wanted = np.union1d(wanted, halves)
    return _chosen(found, np.flatnonzero(_told(steps.motion(found))))


def smooth(blocks: Blocks, steps: Steps, near: float) -> bool:
    """Whether no step is longer than it may be: an eye that is moved off what is nearest jumps as that changes.

    near: distance from the axis below which the mandrel's angle has no limit.
    """
    away = (blocks.eye_r > near) & (np.abs(blocks.yaw) < _STEEP)
    longest = {"mandrel": np.degrees(steps.mandrel), "roll": np.degrees(steps.roll), "eye_x": steps.x, "eye_r": steps.r}
    moves = ((np.abs(np.diff(getattr(blocks, name))), most) for name, most in longest.items())
    return all(move[away[1:] & away[:-1]].max(initial=0.0) <= most * _ROUND_OFF for move, most in moves)


def _whole(track: Track, steps: Steps) -> Floats:
    """Places at which a track is looked at first: where pieces begin to differ, and as dense between as it bends."""
    lays = track.motion == LAY
    ends = np.concatenate([[0], np.flatnonzero(~lays), np.flatnonzero(~lays) + 1, [len(track)]])
    every = np.arange(len(track) + 1.0)
    dense = np.where(lays, track.corner / _FINE + np.diff(track.arc, axis=1)[:, 0] / (_SHARE * steps.x), 0.0)
    marks = kept(track, every)
    total = np.concatenate([[0.0], np.cumsum(dense)])
    run = np.cumsum(marks) - 1  # counted anew from each place that is kept, so that equal circuits have equal blocks
    mark = np.floor(total - total[marks][run] + _EVEN)
    chosen = np.append(True, np.diff(mark) > 0.0) | marks
    chosen[ends] = True
    turns = np.flatnonzero(track.motion == PIVOT)
    parts = np.maximum(np.ceil(track.corner[turns] / _FINE), 1.0).astype(np.int64)
    within = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
    return np.union1d(every[chosen], np.repeat(turns, parts) + within / np.repeat(parts, parts))


def _told(effort: Floats) -> Bools:
    """Which blocks (n,) to keep, given the steps (n - 1,) between them: of two that hardly differ the later one."""
    keep = np.append(effort > _TINY, True)
    if not keep[0]:  # the first stays, and the next goes
        keep[:2] = True, len(keep) == 2
    return keep


def kept(track: Track, at: Floats) -> Bools:
    """Which places (n,) have a block: the ends, those of bridges, and where the fibre begins to do something else."""
    index, share = track.piece(at)
    before = np.maximum(index - 1, 0)
    new = np.zeros(len(at), dtype=bool)
    for values in (
        track.layer, track.passed, track.kind, track.motion == AIR, (track.motion == PIVOT) & (track.corner > _TOLD)
    ):  # fmt: skip
        new |= values[index] != values[before]
    new &= (share == 0.0) & (index > 0)
    return np.asarray(new | track.landing(at) | _ends(at))


def _ends(at: Floats) -> Bools:
    """The first and the last of places (n,)."""
    return np.asarray((at == at[0]) | (at == at[-1]))


def _halves(at: Floats, effort: Floats) -> Floats:
    """Places halfway through steps (n - 1,) that are too long."""
    long = np.flatnonzero(effort > _MOST)
    return np.asarray(0.5 * (at[long] + at[long + 1]))


def _resolved(track: Track, solve: Callable[[Floats], Poses], steps: Steps, at: Floats) -> tuple[Floats, Floats]:
    """Places between which no step is too long, where more places help, and the steps between them."""
    effort = steps.of(track, solve(at))
    for _ in range(_ROUNDS):
        halves = _halves(at, effort)
        if not len(halves):
            break
        at = np.union1d(at, halves)
        effort = steps.of(track, solve(at))
    return at, effort


def _spread(at: Floats, effort: Floats, keep: Bools) -> Floats:
    """Places that divide the steps evenly between those that are kept."""
    run = np.cumsum(keep)[:-1] - 1
    total = np.bincount(run, effort)
    count = np.maximum(np.ceil(total / _AIM), 1.0)
    scale = np.divide(count, total, out=np.zeros_like(total), where=total > 0.0)
    passed = np.concatenate([[0.0], np.cumsum(effort * scale[run])])
    # each run ends at a whole number; round-off must not move it from there
    ends = np.concatenate([[0.0], np.cumsum(np.where(total > 0.0, count, 0.0))])
    marks = np.flatnonzero(keep)
    passed[marks] = ends[: len(marks)]
    inner = np.setdiff1d(np.arange(1.0, ends[-1]), ends)
    passed = np.maximum.accumulate(passed)
    return np.union1d(np.interp(inner, passed, at), at[keep])


def _chosen(poses: Poses, index: Ints) -> Poses:
    """Some of the poses."""
    return Poses(*(values[index] for values in vars(poses).values()))
