"""Passes between two caps from given touch points: the slips with which exact half-legs meet half-way."""

from dataclasses import dataclass
from functools import partial
from typing import TypeAlias

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.threads import side_by_side
from meshwind.filament.polar_legs import End, Legs
from meshwind.filament.polar_natural import Tables, slips
from meshwind.march.forward import Marched

_Pair: TypeAlias = tuple[Marched, Marched]
"""The half-legs that leave and those that arrive, of as many passes."""

MEETS = 1e-10
"""Miss of two half-legs, in turns and in radians, that is round-off of their marches."""
_MOVED = 1e-9
"""Change of a slip from which two marches give a derivative, as each is good to 1e-12."""
_STEPS = 12
"""Most steps in which half-legs are brought to meet; two or three do from a smooth table."""
_STRAIGHT = 2e-11
"""By how much, in turns and over the part's size, two marches may be run on beside the curve that a third gives."""


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
    ways = (ends, touch[:, :2], first[:, :2], rates[:, 0]), (ends[::-1], touch[:, 1:], first[:, 2:], rates[:, 1])
    there, back = side_by_side(*(partial(_meet, *way) for way in ways))
    return Met(np.stack([there[0], back[0]]), (there[1], back[1]), np.stack([there[2], back[2]]))


def _meet(ends: tuple[End, End], touch: Floats, slip: Floats, rates: Floats) -> tuple[Floats, _Pair, Floats]:
    """Slips (n, 2), half-legs and misses (n,) of passes from one end to the other.

    One round is marched.  In the second half-legs are moved beside the first, from the third on run on from the two
    rounds before, in a straight line, and marched only where that would not be as good.
    """
    best, off = slip.copy(), np.full(len(touch), np.inf)
    open_: Ints = np.arange(len(touch))
    slip, rates = slip.copy(), rates.copy()
    kept: list[Marched] = []
    rounds: list[list[Marched]] = [[], []]
    before, step, share = np.empty((len(touch), 2, 2)), np.zeros_like(slip), np.zeros_like(slip)
    for turn in range(_STEPS):
        legs = [
            _legs(end, (touch[open_, k], slip[open_, k]), k == 0, (rounds[k], share[:, k]))
            for k, end in enumerate(ends)
        ]
        # by quantity, u or angle, and leg
        at = np.stack([np.stack([leg.u, leg.angle], axis=1) for leg in legs], axis=2) * [1.0, -1.0]
        miss = at.sum(axis=2)
        size = np.abs(miss).max(axis=1)
        size = np.where(np.isfinite(size), size, np.inf)
        if turn:
            moved = np.abs(step) > _MOVED
            secant = (at - before) / np.where(moved, step, 1.0)[:, None]
            rates = np.where(moved[:, None], secant, rates)
        nearer = np.flatnonzero(size < off[open_]) if turn else open_
        paths = open_[nearer]
        kept = [kept[k].put(paths, legs[k].marched, nearer) if turn else legs[k].marched for k in range(2)]
        best[paths], off[paths] = slip[paths], size[nearer]
        going = np.flatnonzero(np.isfinite(size) & (size > MEETS))
        if not len(going):
            break
        open_, rates, before = open_[going], rates[going], at[going]
        after = np.asarray(-np.linalg.solve(rates, miss[going][..., None])[..., 0])
        share = np.where(np.abs(step[going]) > 0.0, after / np.where(step[going] == 0.0, 1.0, step[going]), np.inf)
        step = after
        slip[open_] += step
        rounds = [[_chosen(run, going) for run in [*rounds[k][-1:], legs[k].marched]] for k in range(2)]
    return best, (kept[0], kept[1]), off


def _legs(end: End, at: tuple[Floats, Floats], leaving: bool, last: tuple[list[Marched], Floats]) -> Legs:
    """Half-legs from touch points with slips (n,) each, by the easiest way that is good enough.

    They are run on by shares (n,) of the last step, or moved beside those of the round before, or else marched.
    """
    (touch, slip), (rounds, share) = at, last
    if not rounds:
        return end.march(touch, slip, leaving)
    run, good = _run_on(rounds[0], rounds[1], share) if len(rounds) > 1 else (rounds[0], np.zeros(len(slip), np.bool_))
    bent = np.flatnonzero(~good)
    if len(bent):
        near, good[bent] = end.beside(_chosen(rounds[-1], bent), slip[bent], leaving, _STRAIGHT)
        run = run.put(bent, near, np.arange(len(bent)))
        bent = np.flatnonzero(~good)
    if len(bent):
        run = run.put(bent, end.march(touch[bent], slip[bent], leaving).marched, np.arange(len(bent)))
    return end.crossing(run, leaving)


def _run_on(first: Marched, second: Marched, share: Floats) -> tuple[Marched, Bools]:
    """The half-legs that follow after two rounds, the slip having moved on by shares (n,), and which are good.

    A half-leg is a smooth function of its slip, row by row where it has as many rows: beyond the straight line through
    two rounds it bends by about the share of their change squared.
    """
    size = np.array([first.surface.size, 1.0, 1.0, first.surface.size, first.surface.size])
    rows, good = list(second.rows), np.zeros(len(share), dtype=np.bool_)
    for k, (one, two) in enumerate(zip(first.rows, second.rows, strict=True)):
        if len(one) != len(two):
            continue
        change = two - one
        wide = float(np.abs(change / size).max())
        good[k] = abs(share[k]) * wide * wide < _STRAIGHT
        if good[k]:
            rows[k] = two + share[k] * change
    slip = second.slip + np.where(good, share, 0.0) * (second.slip - first.slip)
    return Marched(second.surface, tuple(rows), slip, second.counts), good


def _chosen(found: Marched, which: Ints) -> Marched:
    """The half-legs of numbers `which` (k,)."""
    return Marched(found.surface, tuple(found.rows[k] for k in which), found.slip[which], found.counts[which])
