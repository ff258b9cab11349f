"""The time of each block: as short as the fibre's speed and the speeds and accelerations of the axes allow."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.vectors import TINY

FIBRE = "fibre"
"""Name of the fibre's speed among what limits a program."""
_ROUNDS = 2000
"""Rounds in which blocks are stretched; a ramp as long as a circuit takes some hundred."""
_OVER = 1e-3
"""Share by which an acceleration may be over its limit."""


@dataclass(frozen=True)
class Limits:
    """What limits a program, by k names: the fibre's speed and the speed and acceleration (k,) of each axis."""

    names: tuple[str, ...]
    speed: Floats
    acceleration: Floats


@dataclass(frozen=True)
class Timing:
    """Durations (n - 1,) of the steps between n blocks, and the number (n - 1,) of the limit that each is under.

    over: the largest acceleration over its limit that is left, 0 if none is.
    """

    seconds: Floats
    limit: Floats
    over: float


def timed(moves: Floats, limits: Limits) -> Timing:
    """Time steps whose moves (n - 1, k) are under k limits; those without any move take no time.

    Each is as short as the speeds allow.  Where the velocity then changes faster than an axis can, both steps are
    stretched by the root of the ratio, until none does; the program starts and ends at rest.
    """
    size = np.abs(moves)
    shares = size / limits.speed
    seconds = shares.max(axis=1)
    limit = shares.argmax(axis=1)
    going = np.flatnonzero(seconds > 0.0)
    if not len(going):
        return Timing(seconds, limit, 0.0)
    move, time = moves[going], seconds[going].copy()
    ratio = np.zeros(len(move) + 1)
    nodes = np.arange(len(move) + 1)
    slowed = limit[going].copy()
    for _ in range(_ROUNDS):
        ratio[nodes], axis = _ratios(move, time, limits.acceleration, nodes)
        fast = nodes[ratio[nodes] > 1.0 + _OVER]
        if not len(fast):
            break
        worst = np.maximum(ratio[:-1], ratio[1:])
        steps = np.flatnonzero(worst > 1.0 + _OVER)
        of_nodes = np.zeros(len(ratio), dtype=np.int64)
        of_nodes[nodes] = axis
        slowed[steps] = of_nodes[steps + (ratio[1:] > ratio[:-1])[steps]]
        time[steps] *= np.sqrt(worst[steps])
        # only nodes next to a changed step, or the one beside it, have changed
        nodes = np.unique(np.concatenate([steps, steps + 1]))
    seconds = seconds.copy()
    seconds[going], limit = time, limit.copy()
    limit[going] = slowed
    return Timing(seconds, limit, float(max(ratio.max() - 1.0, 0.0) if ratio.max() > 1.0 + _OVER else 0.0))


def _ratios(move: Floats, time: Floats, acceleration: Floats, nodes: Floats) -> tuple[Floats, Floats]:
    """Largest acceleration at nodes between steps, over its limit, and the number of the limit; rest beyond the ends."""
    last = len(move) - 1
    speed_before = np.where((nodes > 0)[:, None], move[np.maximum(nodes - 1, 0)], 0.0)
    time_before = np.where(nodes > 0, time[np.maximum(nodes - 1, 0)], 0.0)
    speed_after = np.where((nodes <= last)[:, None], move[np.minimum(nodes, last)], 0.0)
    time_after = np.where(nodes <= last, time[np.minimum(nodes, last)], 0.0)
    change = speed_after / np.maximum(time_after, TINY)[:, None] - speed_before / np.maximum(time_before, TINY)[:, None]
    ratios = np.abs(change) / (0.5 * (time_before + time_after))[:, None] / acceleration
    return ratios.max(axis=1), ratios.argmax(axis=1)
