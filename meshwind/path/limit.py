"""The number nearest to the one asked for with which all paths hold: found by trials, and tried as it is printed."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from meshwind.core.cast import Bools, Ints

DIGITS = 3
"""Digits of a number in an advice: a step of them is at most 1 %."""
CLOSE = 0.01
"""Relative distance of numbers that hold and that do not, at which the search ends."""
BEYOND = 0.02
"""So much beyond the number found at least one path should fail."""
_LOOKED_AT = 1
"""Paths that are tried with every number: the ones that failed last, which mostly limit it."""
_AT_ONCE = 4
"""Paths that are tried at once with a number that holds these."""
_LEAST = 0.05
"""The first number that is tried above 0."""
_CAUTION = 0.05, 0.15, 0.3
"""Relative steps back from the last number, that are tried with all paths where the budget is used up."""
_STEP = 0.01
"""First relative step back from a number that holds the paths looked at, and not another one."""

Attempt = Callable[[float, Ints], Bools]
"""Which of the paths of the given numbers hold, with a number changed."""


@dataclass(frozen=True)
class Way:
    """Which way to look: from a number with which paths fail, down to `last` or up to it."""

    asked: float
    last: float
    first_step: float
    least: float = 0.0
    """A number that is next to none: where one up to it holds, none nearer to 0 is looked for."""

    @property
    def down(self) -> bool:
        """Whether smaller numbers hold."""
        return self.last < self.asked

    def rounded(self, number: float, outward: bool = False) -> float:
        """The number as it is printed: to the safe side, or outward, to the side of the one asked for."""
        unit = 10.0 ** (math.floor(math.log10(number)) - DIGITS + 1)
        steps = number / unit
        whole = math.floor(steps + 1e-9) if self.down != outward else math.ceil(steps - 1e-9)
        return float(f"{whole * unit:.{DIGITS}g}")

    def back(self, number: float, step: float) -> float:
        """A number a relative step nearer to `last`; `last` itself is not passed."""
        if self.down:
            return self.rounded(max(number * (1.0 - step), self.last))
        return min(self.rounded(number * (1.0 + step)) if number > 0.0 else _LEAST, self.last)

    def beyond(self, number: float) -> float:
        """A number a little nearer to the one asked for."""
        return number * (1.0 + BEYOND if self.down else 1.0 - BEYOND)

    def nearer(self, one: float, other: float) -> bool:
        """Whether `one` is nearer to the number asked for than `other`, or beyond it."""
        return one > other if self.down else one < other


@dataclass
class Search:
    """A search for the number with which all of `count` paths hold, in no more than `budget` solves of a path.

    order: numbers of the paths, in the order in which they are tried.  also: another reading of a number, in which all
    paths have to hold as well.  together: whether how a path is solved depends on the others, so that all have to be
    tried at once in the end.  through: whether the number may lie beyond one that fails.  step: first relative step
    back from a number that holds the paths looked at, and not another one; it is doubled each time.  close: relative
    distance of numbers that hold and that do not, at which it ends.
    """

    attempt: Attempt
    way: Way
    order: Ints
    budget: int
    also: Attempt | None = None
    together: bool = False
    through: bool = True
    step: float = _STEP
    close: float = CLOSE
    failed: list[float] = field(default_factory=list)
    lost: Ints = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    """Paths that did not hold by the other reading, the last ones first."""
    known: dict[tuple[bool, float], dict[int, bool]] = field(default_factory=dict)
    """By the reading and the number: which paths hold."""

    def run(self) -> float:
        """The number nearest to the one asked for that holds all paths; 0 where none was found.

        Paths that failed last are tried first, and the others only with a number that holds these.
        """
        way = self.way
        good, bad, step = 0.0, way.asked, way.first_step
        while self.budget > 0:
            if good == 0.0:
                number = way.back(bad, step)
                step *= 1.0 if step >= 0.5 else 2.0
                if bad == way.last or number == bad:
                    return 0.0
            else:
                number = way.rounded(0.5 * (good + bad))
                if good <= way.least or abs(bad - good) <= self.close * good or number in (good, bad):
                    number = self._beyond(good)
                    if number == 0.0:
                        if self._all_hold(good, self.order if self.together else self.order[_LOOKED_AT:]):
                            return good
                        good, bad, step = 0.0, good, self.step
                        continue
                    good, bad = number, self._next_failed(number)
                    continue
            if self._hold(number, self.order[:_LOOKED_AT]):
                good = number
            else:
                bad = number
        further = (way.back(good or bad, step) for step in _CAUTION)
        return next((number for number in further if self._all_hold(number, self.order)), 0.0)

    def _beyond(self, good: float) -> float:
        """A number further on that holds the paths looked at, although one in between did not; 0 for none.

        Numbers that hold may lie a hair apart from ones that do not: where the one a little further on holds, those
        next to it that can be printed are tried.
        """
        way = self.way
        tried = way.beyond(good)
        if not self.through or good <= way.least or not way.nearer(way.asked, tried):
            return 0.0
        if not self._hold(tried, self.order[:_LOOKED_AT]):
            return 0.0
        for number in (way.rounded(tried), way.rounded(tried, outward=True)):
            further = way.nearer(number, good) and way.nearer(way.asked, number)
            if further and self._hold(number, self.order[:_LOOKED_AT]):
                return number
        return 0.0

    def _next_failed(self, number: float) -> float:
        """The nearest number beyond one that holds, with which some path failed."""
        beyond = [each for each in (*self.failed, self.way.asked) if self.way.nearer(each, number)]
        return min(beyond) if self.way.down else max(beyond)

    def _all_hold(self, number: float, rest: Ints) -> bool:
        """Whether all paths hold with a number, of which the rest is yet to be tried."""
        every = self.order
        many = max(len(every), 1) if self.together else _AT_ONCE
        tries = [(self.attempt, rest)] + ([(self.also, every)] if self.also is not None else [])
        return all(
            self._try(number, paths[k : k + many], attempt)
            for attempt, paths in tries
            for k in range(0, len(paths), many)
        )

    def _hold(self, number: float, paths: Ints) -> bool:
        """Whether some paths hold, and those lost last by the other reading."""
        return self._try(number, self.lost[:_LOOKED_AT], self.also) and self._try(number, paths)

    def _try(self, number: float, paths: Ints, attempt: Attempt | None = None) -> bool:
        """Whether some paths hold; those that do not go to the front of the order."""
        if not len(paths):
            return True
        self.budget -= len(paths)
        lost = paths[~self._outcome(number, paths, attempt or self.attempt)]
        if len(lost):
            self.failed.append(number)
            if attempt is not None and attempt is self.also:
                self.lost = np.concatenate([lost, self.lost[~np.isin(self.lost, lost)]])
            else:
                self.order = np.concatenate([lost, self.order[~np.isin(self.order, lost)]])
        return not len(lost)

    def _outcome(self, number: float, paths: Ints, attempt: Attempt) -> Bools:
        """Which of some paths hold; what was tried before is known, as a search comes back to its numbers."""
        if self.together:
            return attempt(number, paths)
        known = self.known.setdefault((attempt is self.also, number), {})
        new = np.array([path for path in paths.tolist() if path not in known], dtype=np.int64)
        if len(new):
            known.update(zip(new.tolist(), attempt(number, new).tolist(), strict=True))
        return np.array([known[path] for path in paths.tolist()], dtype=np.bool_)
