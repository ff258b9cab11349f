"""The time of each block: as short as the fibre's speed and the speeds and accelerations of the axes allow."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats, Ints

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
    """Nodes (n,) at which an axis changes its speed too fast, the ratio to what it may, and which axis it is."""

    nodes: Ints
    ratio: Floats
    limit: Ints


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
    # rest comes before the first step and after the last; node i lies between steps i and i + 1
    speed, time, under = _at_rest(moves[going].T), _at_rest(seconds[going]), _at_rest(limit[going])
    speed[:, 1:-1] /= time[1:-1]
    nodes, ratio = np.arange(len(going) + 1), np.zeros(len(going) + 1)
    for _ in range(_ROUNDS):
        found = _changes(speed, time, limits.acceleration, nodes, ratio)
        if not len(found.nodes):
            break
        before, after = speed[found.limit, found.nodes], speed[found.limit, found.nodes + 1]
        turns = before * after < 0.0
        stretch, by = np.ones(len(time)), found.ratio**_POWER
        # a step that is stretched for both of its nodes takes the larger factor
        for shift, faster, slower in ((0, before, after), (1, after, before)):
            side = (np.abs(faster) >= np.abs(slower)) | turns
            steps = found.nodes[side] + shift
            stretch[steps] = np.maximum(stretch[steps], by[side])
            under[steps] = found.limit[side]
        stretch[[0, -1]] = 1.0
        time *= stretch
        speed /= stretch
        changed = stretch > 1.0
        nodes = np.flatnonzero(changed[1:] | changed[:-1])
    seconds[going], limit[going] = time[1:-1], under[1:-1]
    worst = float(ratio.max())
    return Timing(seconds, limit, worst - 1.0 if worst > 1.0 + _OVER else 0.0)


def _at_rest(values: Floats) -> Floats:
    """Values (..., m) of steps with 0 before the first and after the last."""
    return np.pad(np.ascontiguousarray(values), [*[(0, 0)] * (values.ndim - 1), (1, 1)])


def _changes(speed: Floats, time: Floats, acceleration: Floats, nodes: Ints, ratio: Floats) -> _Changes:
    """What changes too fast at nodes (n,) between steps of speeds (k, m) and times (m,); `ratio` is renewed there."""
    if 2 * len(nodes) > len(ratio):  # slices cost a fraction of chosen columns
        nodes = np.arange(len(ratio))
        changes, sums = np.abs(speed[:, 1:] - speed[:, :-1]), time[1:] + time[:-1]
    else:
        changes = np.abs(speed.take(nodes + 1, axis=1) - speed.take(nodes, axis=1))
        sums = time[nodes + 1] + time[nodes]
    changes *= 2.0 / acceleration[:, None]
    most = changes.max(axis=0)
    ratios = most / sums
    ratio[nodes] = ratios
    over = np.flatnonzero(ratios > 1.0 + _OVER)
    limit = np.zeros(len(over), dtype=np.int64)
    for k in range(len(changes) - 1, -1, -1):  # the first of those that are equal
        limit[changes[k, over] == most[over]] = k
    return _Changes(nodes[over], ratios[over], limit)
