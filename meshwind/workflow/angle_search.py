"""The revolutions at which a winding angle is met: a bracketed secant search on its tangent, which grows evenly."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

_TRIALS = 30
"""Most trials; three or four are usual."""
_SAME_TURNS = 5e-3
"""Share by which revolutions differ where a search between them ends."""
_RISE, _SHORT = 2.0, np.radians(1.0)
"""Times that the angle's tangent may rise by what it rose by on the way to a brink, and by how much an angle is to be
beyond that for the brink itself not to matter.
"""
_LEAP = 2.0
"""Factor by which one trial's revolutions may differ from those of the one before."""
_HALVED = 3
"""Every so many trials between two bounds the middle is taken, so that the bracket closes whatever the curve."""
_APART, _FEW = 1.3, 9
"""Factor between trials all over the revolutions, and how many there are at the least, ..."""
_NARROWED, _WITHIN = 3, 3
"""... and rounds of trials between two of them, and trials of a round: the way becomes a quarter each time."""


class Hunt(NamedTuple):
    """What a search found.

    revolutions: the best ones; reached: the angle there, in radians; lost: the least at which too few paths came to
    rest, or infinity; within: whether the angle is met, or is between those of two trials.
    """

    revolutions: float
    reached: float
    lost: float
    within: bool


def hunt(
    measure: Callable[[float], float | None],
    wanted: float,
    start: float,
    near: float,
    most: float,
    *,
    least: float = 0.0,
    brink: float = _SAME_TURNS,
) -> Hunt:
    """Search for the revolutions at which an angle is `wanted`, up to `near`, both in radians.

    measure: gives the angle at some revolutions, or None where too few paths come to rest; start: the first trial's;
    most, least: revolutions beyond which none are tried; brink: share to which those are found at which too few paths
    come to rest, where the angle is far beyond them.  Reached is -infinity where too few come to rest at any.
    """
    low, high, lost, best, reached, steepest = 0.0, np.inf, np.inf, 0.0, -np.inf, -np.inf
    target, before, turns, rise = float(np.tan(wanted)), (0.0, 0.0), max(min(start, most), least), 0.0
    for trial in range(_TRIALS):
        now = measure(turns)
        if now is None:
            lost = high = min(lost, turns)
            step = 0.5 * (low + high)
        else:
            steepest = max(steepest, now)
            if abs(now - wanted) < abs(reached - wanted):
                best, reached = turns, now
            if abs(now - wanted) <= near or (turns >= most and now < wanted) or (turns <= least and now > wanted):
                break
            low, high = (turns, high) if now < wanted else (low, turns)
            at = turns, float(np.tan(now))
            rise = (at[1] - before[1]) / (at[0] - before[0]) if at[0] != before[0] else 0.0
            before = at
            step = turns + (target - at[1]) / rise if rise > 0.0 else _LEAP * turns if now < wanted else 0.0
            step = max(min(max(step, turns / _LEAP), turns * _LEAP, most), least)
            if not low < step < high or (np.isfinite(high) and trial % _HALVED == _HALVED - 1 and low > 0.0):
                step = 0.5 * (low + high)
        apart = _SAME_TURNS
        if high == lost and low > 0.0 and low == before[0]:
            further = before[1] + _RISE * max(rise, before[1] / low) * (high - low)
            apart = brink if np.arctan(further) < wanted - _SHORT else _SAME_TURNS
        if high - low < apart * high:
            break
        turns = step
    return Hunt(best, reached, lost, steepest >= wanted - near)


def survey(
    measure: Callable[[float], float | None], wanted: float, near: float, span: tuple[float, float], best: Hunt
) -> Hunt:
    """The best that `hunt` found, or better from trials all over a span of revolutions.

    On bent parts the angle does not grow with every turn: it has lows, and ranges where too few paths come to rest.
    """
    low, high = span
    turns = np.geomspace(low, high, max(_FEW, 1 + int(np.ceil(np.log(high / low) / np.log(_APART)))))
    angles = [measure(float(each)) for each in turns]
    off = np.array([np.nan if each is None else each - wanted for each in angles])
    if np.isnan(off).all():
        return best
    across = np.flatnonzero(off[:-1] * off[1:] <= 0.0)
    if len(across):
        low, high = turns[across[0]], turns[across[0] + 1]
    else:
        least = int(np.nanargmin(np.abs(off)))
        low, high = turns[max(least - 1, 0)], turns[min(least + 1, len(turns) - 1)]
    tried = [*zip(turns.tolist(), off.tolist(), strict=True), (best.revolutions, best.reached - wanted)]
    for _ in range(_NARROWED):
        inner = np.linspace(low, high, _WITHIN + 2)
        found = [measure(float(each)) for each in inner[1:-1]]
        here = np.array([np.nan if each is None else each - wanted for each in found])
        tried += zip(inner[1:-1].tolist(), here.tolist(), strict=True)
        known = sorted((turn, each) for turn, each in tried if low <= turn <= high and np.isfinite(each))
        crossed = [k for k in range(len(known) - 1) if known[k][1] * known[k + 1][1] <= 0.0]
        least = crossed[0] if crossed else int(np.argmin([abs(each) for _, each in known])) if known else -1
        if least < 0 or min(abs(each) for _, each in known) <= near:
            break
        if crossed:
            low, high = known[least][0], known[least + 1][0]
        else:
            low, high = known[max(least - 1, 0)][0], known[min(least + 1, len(known) - 1)][0]
    at, least_off = min((each for each in tried if np.isfinite(each[1])), key=lambda each: abs(each[1]))
    return Hunt(at, wanted + least_off, best.lost, best.within or len(across) > 0)
