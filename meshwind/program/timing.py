"""The time of each block: as short as the fibre's speed and the speeds and accelerations of the axes allow."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints

FIBRE = "fibre"
"""Name of the fibre's speed among what limits a program."""
_ROUNDS = 5000
"""Rounds in which steps are stretched; programs of machines take about two hundred."""
_OVER = 1e-3
"""Share by which an acceleration may be over its limit."""
_POWER = 0.05
"""Power of the ratio by which a step is stretched a round: larger ones are quicker, and leave the program slower."""


@dataclass(frozen=True)
class Limits:
    """What limits a program, by k names: the fibre's speed and the speed and acceleration (k,) of each axis."""

    names: tuple[str, ...]
    speed: Floats
    acceleration: Floats


@dataclass(frozen=True)
class Timing:
    """Durations (m,) of steps, and the number (m,) of the limit that each is under.

    over: share by which an acceleration is over its limit still, 0 if none is.
    """

    seconds: Floats
    limit: Ints
    over: float


class _Changes(NamedTuple):
    """At nodes between steps: acceleration over the limit, its number, and whether the steps on its sides are fast."""

    ratio: Floats
    limit: Ints
    before: Bools
    after: Bools


def timed(moves: Floats, limits: Limits) -> Timing:
    """Time m steps whose moves (m, k) are under k limits; those without any move take no time.

    Each is as short as the speeds allow.  Where an axis then changes its speed faster than it can, the step in which it
    is the faster one, or both where it turns round, is stretched by a power of the ratio, until no axis does.  The
    program starts and ends at rest.
    """
    shares = np.abs(moves) / limits.speed
    seconds, limit = shares.max(axis=1), shares.argmax(axis=1)
    going = np.flatnonzero(seconds > 0.0)
    if not len(going):
        return Timing(seconds, limit, 0.0)
    move, time, under = moves[going], seconds[going], limit[going]
    nodes, ratio = np.arange(len(move) + 1), np.zeros(len(move) + 1)
    for _ in range(_ROUNDS):
        found = _changes(move, time, limits.acceleration, nodes)
        ratio[nodes] = found.ratio
        over = found.ratio > 1.0 + _OVER
        if not over.any():
            break
        stretch = np.ones(len(move))
        # a step that is stretched for both of its nodes takes the larger factor
        for side, shift in ((found.before, -1), (found.after, 0)):
            steps = nodes[over & side] + shift
            np.maximum.at(stretch, steps, found.ratio[over & side] ** _POWER)
            under[steps] = found.limit[over & side]
        changed = stretch > 1.0
        time[changed] *= stretch[changed]
        nodes = np.flatnonzero(np.append(changed, False) | np.append(False, changed))
    seconds[going], limit[going] = time, under
    worst = float(ratio.max())
    return Timing(seconds, limit, worst - 1.0 if worst > 1.0 + _OVER else 0.0)


def _changes(move: Floats, time: Floats, acceleration: Floats, nodes: Ints) -> _Changes:
    """What changes at nodes (n,): node i lies before step i, and beyond both ends there is rest."""
    last = len(move) - 1
    one, two = np.maximum(nodes - 1, 0), np.minimum(nodes, last)
    first, end = nodes == 0, nodes > last
    before = np.where(first[:, None], 0.0, move[one] / time[one][:, None])
    after = np.where(end[:, None], 0.0, move[two] / time[two][:, None])
    mean = 0.5 * (np.where(first, 0.0, time[one]) + np.where(end, 0.0, time[two]))
    ratios = np.abs(after - before) / (mean[:, None] * acceleration)
    limit = ratios.argmax(axis=1)
    rows = np.arange(len(nodes))
    u, w = before[rows, limit], after[rows, limit]
    turns = u * w < 0.0
    fast_before, fast_after = (np.abs(u) >= np.abs(w)) | turns, (np.abs(w) >= np.abs(u)) | turns
    return _Changes(ratios[rows, limit], limit, fast_before & ~first, fast_after & ~end)
