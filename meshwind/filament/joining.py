"""The joining of paths to filaments: which path follows which, and by how much the part dwells between them.

Positions around a rim are in turns, unwrapped in the sense of turning: the part never turns back.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import ceil, floor, gcd
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from meshwind.core.cast import Floats, Ints, floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.filament.pattern import Pattern, check_filaments

_ROUND_OFF = 1e-9
"""Turns that are round-off."""
_LONGEST = 1000.0
"""Turns of dwell that no turnaround is worth."""
Surplus: TypeAlias = Callable[[Ints, Ints, Floats], Floats]
"""Turns (N,) by which dwells (N,) are longer than needed, of paths that arrive (N,) and those that leave next (N,)."""


@dataclass(frozen=True)
class Joining:
    """The order of N paths there and N paths back.

    Attributes
    ----------
    back : ndarray of int, shape (N,)
        The path back that follows each path there, over the end rim.
    there : ndarray of int, shape (N,)
        The path there that follows each path back, over the start rim.
    end_dwell, start_dwell : ndarray of float, shape (N,)
        Turns from the end of each path there to the path back that follows, and from the end of each path back to the
        path there that follows.
    turns : int
        Turns of the whole layer.
    """

    back: Ints
    there: Ints
    end_dwell: Floats
    start_dwell: Floats
    turns: int

    @property
    def pattern(self) -> Pattern:
        """The pattern that the circuits close in."""
        return Pattern(len(self.back), self.turns)

    @cached_property
    def filaments(self) -> tuple[Ints, ...]:
        """The circuits of each filament, by their paths there, in the order of winding."""
        left, found = np.ones(len(self.back), dtype=bool), []
        after = self.there[self.back]
        for first in range(len(after)):
            if not left[first]:
                continue
            circuits, path = [], first
            while left[path]:
                left[path] = False
                circuits.append(path)
                path = int(after[path])
            found.append(frozen(np.array(circuits)))
        return tuple(found)


@dataclass(frozen=True)
class Passes:
    """N paths one way: where they start and end, in turns; of one order at both."""

    start: Floats
    end: Floats


def passes(start: ArrayLike, end: ArrayLike) -> Passes:
    """Check N paths one way.

    Parameters
    ----------
    start, end : array_like of float, shape (N,)
        Positions in turns around the two rims, unwrapped in the sense of turning.

    Returns
    -------
    Passes
        The paths.

    Raises
    ------
    BadInputError
        If there are none, shapes differ, a path turns back, or two of them cross.
    """
    first = floats(start, "start", -1)
    last = floats(end, "end", len(first))
    if not len(first):
        raise BadInputError("there is no path to join; give at least one path each way")
    if (last < first - _ROUND_OFF).any():
        turns_back = int(np.argmin(last - first))
        raise BadInputError(f"path {turns_back} turns back; give positions unwrapped in the sense of turning")
    order = _order(first)
    ends = last[order] - np.floor(first[order] - first[order[0]])
    around = np.append(ends, ends[0] + 1.0)
    crossing = np.flatnonzero(np.diff(around) < -_ROUND_OFF)
    if len(crossing):
        one, other = order[crossing[0]], order[(crossing[0] + 1) % len(order)]
        raise BadInputError(f"paths {one} and {other} of a family cross, so that they have no order; leave one out")
    return Passes(frozen(first), frozen(last))


def join(
    there: Passes,
    back: Passes,
    *,
    end_dwell: float | Surplus | None = 0.0,
    start_dwell: float | Surplus | None = 0.0,
    filaments: int | None = 1,
) -> Joining:
    """Join paths there and paths back to filaments, with as little dwell as closes them.

    All paths keep their order over both rims.  Of all ways to join them with as many turns this one has the least
    largest dwell, and the least sum of their squares.

    Parameters
    ----------
    there, back : Passes
        As many paths there, from the start rim to the end rim, as back.
    end_dwell, start_dwell : float, callable or None, default 0
        Least dwell at each rim, in turns; None where each path leaves where the one before arrives; or a function of
        the paths that arrive (N,), those that leave after them (N,) and the dwells (N,) between, that says how much
        longer than needed each dwell is, in turns.
    filaments : int or None, default 1
        Number of filaments to close the layer to, a divisor of the paths; None takes what the least dwell gives.

    Returns
    -------
    Joining
        Which path follows which.

    Raises
    ------
    BadInputError
        If there are more paths one way than the other, the filaments cannot share out the circuits, or no dwell is
        long enough.

    Examples
    --------
    >>> import numpy as np
    >>> from meshwind.filament.joining import join, passes
    >>> rim = np.arange(5) / 5
    >>> joining = join(passes(rim, rim + 0.5), passes(rim, rim + 0.5), end_dwell=0.1, start_dwell=0.1)
    >>> joining.turns, [each.tolist() for each in joining.filaments]
    (7, [[0, 2, 4, 1, 3]])
    """
    count = len(there.start)
    if len(back.start) != count:
        raise BadInputError(f"{count} paths there but {len(back.start)} back; join as many of each")
    if filaments is not None:
        check_filaments(filaments, count)
    end, start = _Rim(there.end, back.start, end_dwell), _Rim(back.end, there.start, start_dwell)
    whole = float((there.end - there.start).sum() + (back.end - back.start).sum())
    at_end, at_start = end.enough(0), start.enough(0)
    while True:
        turns = round(whole + end.total(at_end) + start.total(at_start))
        if filaments is None or gcd(turns, count) == filaments:
            break
        # one place more where less dwell is spare: it counts as one turn of the layer at either rim
        if end.fixed and start.fixed:
            raise BadInputError(f"{count} circuits in {turns} turns are not {filaments} filaments; give other circuits")
        if start.fixed or (not end.fixed and end.spare(at_end) <= start.spare(at_start)):
            at_end = end.enough(at_end + 1)
        else:
            at_start = start.enough(at_start + 1)
    (to_back, over_end), (to_there, over_start) = end.joined(at_end), start.joined(at_start)
    return Joining(frozen(to_back), frozen(to_there), frozen(over_end), frozen(over_start), turns)


class _Rim:
    """A rim at which paths arrive, at `arriving` (N,), and leave, at `leaving` (N,)."""

    def __init__(self, arriving: Floats, leaving: Floats, dwell: float | Surplus | None) -> None:
        self.into, self.out = _order(arriving), _order(leaving)
        self.at, self.off = _within_a_turn(arriving[self.into]), _within_a_turn(leaving[self.out])
        self.fixed, self.dwell = dwell is None, dwell or 0.0
        shortest = float((self.off - self.at).min())
        self.first = len(arriving) * (ceil(-shortest - _ROUND_OFF) - 1)
        """Places with which at least one path leaves where it arrived or before."""

    def _dwell(self, places: int) -> tuple[Ints, Floats]:
        """Numbers of those that leave, and dwells (N,), in the order of arrival, so many places beyond the first."""
        count = len(self.at)
        turned, index = np.divmod(np.arange(count) + self.first + places, count)
        return index, np.asarray(self.off[index] + turned - self.at)

    def total(self, places: int) -> float:
        """All dwells together."""
        return float(np.maximum(self._dwell(places)[1], 0.0).sum())

    def spare(self, places: int) -> float:
        """How much longer than needed the scarcest dwell is, in turns; negative where it is too short."""
        index, dwell = self._dwell(places)
        if not callable(self.dwell):
            return float(dwell.min()) - self.dwell
        # where a path would have to turn back, no other demand counts
        return float(np.minimum(self.dwell(self.into, self.out[index], np.maximum(dwell, 0.0)), dwell).min())

    def enough(self, places: int) -> int:
        """The least number of places, from one on, with which every dwell is long enough."""
        count = len(self.at)
        while (spare := self.spare(places)) < -_ROUND_OFF:
            if not spare > -_LONGEST:
                raise BadInputError(
                    f"a turnaround would need a dwell of more than {_LONGEST:g} turns; give another winding angle, or "
                    "another turnaround"
                )
            places += max(count * floor(-spare - 1.0), 1)  # whole turns first, then place by place
        return places

    def joined(self, places: int) -> tuple[Ints, Floats]:
        """Which path (N,) leaves after each that arrives, and the dwell (N,) between."""
        index, dwell = self._dwell(places)
        after, between = np.empty(len(index), dtype=np.int64), np.empty(len(index))
        after[self.into] = self.out[index]
        between[self.into] = np.maximum(dwell, 0.0)
        return after, between


def _order(positions: Floats) -> Ints:
    """Order of positions (N,) around a rim."""
    return np.argsort(_turned(positions), kind="stable")


def _turned(positions: Floats) -> Floats:
    """Positions (N,) within one turn; those that round-off puts just before a whole turn count as on it."""
    turned = positions - np.floor(positions)
    return np.where(turned > 1.0 - _ROUND_OFF, 0.0, turned)


def _within_a_turn(positions: Floats) -> Floats:
    """Positions (N,) within one turn, to the last digit."""
    return np.asarray(positions - np.round(positions - _turned(positions)))
