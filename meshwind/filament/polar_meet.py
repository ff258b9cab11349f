"""Passes between two caps from given touch points: the slips with which exact half-legs meet half-way."""

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.filament.polar_legs import FINEST, End
from meshwind.filament.polar_natural import Tables, slips
from meshwind.march.forward import Marched
from meshwind.march.traced import Trace

_Pair: TypeAlias = tuple[tuple[Trace, ...], tuple[Trace, ...]]
"""The half-legs that leave and those that arrive, of as many passes."""

MEETS = 1e-10
"""Miss of two half-legs, in turns and in radians, that is round-off of their marches."""
_ROUGH = 1e-9
"""Tolerance of the first marches, which are further from meeting than this."""
_MOVED = 1e-9
"""Change of a slip from which two marches give a derivative, as each is good to 1e-12."""
_STEPS = 12
"""Most steps in which half-legs are brought to meet; two or three do from a smooth table."""


@dataclass(frozen=True)
class Met:
    """Passes of n circuits there and back, in this order (2, n).

    slip (2, n, 2), legs: on the first and the second half-leg in the order of winding, and these; miss (2, n): what
    they miss each other by, turns or radians, infinite where one did not get half-way.
    """

    slip: Floats
    legs: tuple[_Pair, _Pair]
    miss: Floats


def met(ends: tuple[End, End], tables: Tables, touch: Floats) -> Met:
    """Passes through the touch points (n, 3) of circuits: from a to b, and from b on to the next a.

    Slips start from the tables, as do their derivatives; each half-leg depends on its own slip alone, so that two
    marches of it give its derivative by the secant.
    """
    first = slips(tables, touch)
    rates = tables.mismatch(touch, first)[2]
    there = _meet((ends[0], ends[1]), touch[:, :2], first[:, :2], rates[:, 0])
    back = _meet((ends[1], ends[0]), touch[:, 1:], first[:, 2:], rates[:, 1])
    return Met(np.stack([there[0], back[0]]), (there[1], back[1]), np.stack([there[2], back[2]]))


def _meet(ends: tuple[End, End], touch: Floats, slip: Floats, rates: Floats) -> tuple[Floats, _Pair, Floats]:
    """Slips (n, 2), half-legs and misses (n,) of passes from one end to the other; the first round is a rough one."""
    best, off = slip.copy(), np.full(len(touch), np.inf)
    open_: Ints = np.arange(len(touch))
    slip, rates = slip.copy(), rates.copy()
    kept: tuple[Marched, Marched] | None = None
    before, step = np.empty((len(touch), 2, 2)), np.zeros_like(slip)
    for turn in range(_STEPS):
        tolerance = FINEST if turn else _ROUGH
        leave = ends[0].march(touch[open_, 0], slip[open_, 0], True, tolerance)
        arrive = ends[1].march(touch[open_, 1], slip[open_, 1], False, tolerance)
        # by quantity, u or angle, and leg
        at = np.stack([np.stack([leg.u, leg.angle], axis=1) for leg in (leave, arrive)], axis=2) * [1.0, -1.0]
        miss = at.sum(axis=2)
        size = np.abs(miss).max(axis=1)
        size = np.where(np.isfinite(size), size, np.inf)
        if kept is None:
            kept = leave.marched, arrive.marched
            met_ = np.zeros(len(size), dtype=np.bool_)
        else:
            moved = np.abs(step) > _MOVED
            secant = (at - before) / np.where(moved, step, 1.0)[:, None]
            rates = np.where(moved[:, None], secant, rates)
            nearer = np.flatnonzero(size < off[open_])
            paths = open_[nearer]
            kept = kept[0].put(paths, leave.marched, nearer), kept[1].put(paths, arrive.marched, nearer)
            best[paths], off[paths] = slip[paths], size[nearer]
            met_ = size <= MEETS
        going = np.isfinite(size) & ~met_
        if not going.any():
            break
        open_, rates, before = open_[going], rates[going], at[going]
        step = np.asarray(-np.linalg.solve(rates, miss[going][..., None])[..., 0])
        slip[open_] += step
    assert kept is not None
    return best, (kept[0].traces(), kept[1].traces()), off
