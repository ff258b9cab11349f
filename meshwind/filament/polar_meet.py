"""Passes between two caps from given touch points: the slips with which exact half-legs meet half-way."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.filament.polar_legs import End
from meshwind.filament.polar_natural import Tables, slips
from meshwind.march.traced import Trace

MEETS = 1e-10
"""Miss of two half-legs, in turns and in radians, that is round-off of their marches."""
_STEPS = 12
"""Most steps in which half-legs are brought to meet; two or three do from a smooth table."""


@dataclass(frozen=True)
class Met:
    """Passes of n circuits there and back, in this order (2, n).

    slip (2, n, 2), legs: on the first and the second half-leg in the order of winding, and these; miss (2, n): what
    they miss each other by, turns or radians, infinite where one did not get half-way.
    """

    slip: Floats
    legs: tuple[list[tuple[Trace, Trace]], list[tuple[Trace, Trace]]]
    miss: Floats


def met(ends: tuple[End, End], tables: Tables, touch: Floats) -> Met:
    """Passes through the touch points (n, 3) of circuits: from a to b, and from b on to the next a.

    Slips start from the tables, as do their derivatives, which Broyden's method then improves pass by pass.
    """
    first = slips(tables, touch)
    rates = tables.mismatch(touch, first)[2]
    there = _meet((ends[0], ends[1]), touch[:, :2], first[:, :2], rates[:, 0])
    back = _meet((ends[1], ends[0]), touch[:, 1:], first[:, 2:], rates[:, 1])
    return Met(np.stack([there[0], back[0]]), (there[1], back[1]), np.stack([there[2], back[2]]))


def _meet(
    ends: tuple[End, End], touch: Floats, slip: Floats, rates: Floats
) -> tuple[Floats, list[tuple[Trace, Trace]], Floats]:
    """Slips (n, 2), half-legs and misses (n,) of passes from one end to the other."""
    best, off = slip.copy(), np.full(len(touch), np.inf)
    legs: list[tuple[Trace, Trace]] = [None] * len(touch)  # type: ignore[list-item]
    open_: Ints = np.arange(len(touch))
    slip, rates, step, before = slip.copy(), rates.copy(), np.zeros_like(slip), np.zeros_like(slip)
    for turn in range(_STEPS):
        leave = ends[0].march(touch[open_, 0], slip[open_, 0], True)
        arrive = ends[1].march(touch[open_, 1], slip[open_, 1], False)
        miss = np.stack([leave.u - arrive.u, leave.angle - arrive.angle], axis=1)
        size = np.abs(miss).max(axis=1)
        size = np.where(np.isfinite(size), size, np.inf)
        if turn:  # Broyden: what the miss did beyond what was expected is put down to the direction of the step
            moved = np.maximum((step * step).sum(axis=1), np.finfo(float).tiny)
            extra = miss - before - (rates @ step[..., None])[..., 0]
            rates = rates + extra[:, :, None] * step[:, None, :] / moved[:, None, None]
        for k in np.flatnonzero((size < off[open_]) | (turn == 0)):
            path = open_[k]
            legs[path], best[path], off[path] = (leave.traces[k], arrive.traces[k]), slip[path], size[k]
        going = np.isfinite(size) & (size > MEETS)
        if not going.any():
            break
        open_, rates, before = open_[going], rates[going], miss[going]
        step = np.asarray(-np.linalg.solve(rates, before[..., None])[..., 0])
        slip[open_] += step
    return best, legs, off
