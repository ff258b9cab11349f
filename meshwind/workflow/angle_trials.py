"""Trials of a winding angle: paths laid with some revolutions, how many of them come to rest, and at which angle."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Ints
from meshwind.path import Paths, Status

MOST = 0.75
"""Share of the paths that are to come to rest for their angle to count: a layer is not wound with a few of them."""
_FIRST = (0.0, 0.2, 0.6, 0.9)
"""Places in the order of a trial's paths of those that go first: where one at most comes to rest, most will not."""
_LOST = 3
"""Paths that failed in the trial before and go first where every path is to hold."""


class Tried(NamedTuple):
    """A trial: its revolutions, the median angle in radians, NaN where too few come to rest, and the share that do."""

    revolutions: float
    angle: float
    held: float

    @property
    def counts(self) -> bool:
        """Whether enough paths come to rest."""
        return self.held >= MOST

    @property
    def whole(self) -> bool:
        """Whether every path comes to rest."""
        return self.held == 1.0


@dataclass
class Trials:
    """Trials with so many paths, of both families, each number of revolutions once.

    lay: lays those of some numbers, or all; tell: the angle of those at rest, in radians; made: all trials so far.
    """

    lay: Callable[[float, Ints | None], Paths]
    tell: Callable[[Paths], float]
    paths: int
    made: dict[float, Tried] = field(default_factory=dict)
    lost: Ints = field(default_factory=lambda: np.zeros(0, dtype=np.int64))

    def at(self, revolutions: float) -> Tried:
        """The trial with some revolutions."""
        if revolutions not in self.made:
            self.made[revolutions] = self._tried(revolutions)
        return self.made[revolutions]

    def angle(self, revolutions: float) -> float | None:
        """The angle at some revolutions; None where too few paths come to rest."""
        found = self.at(revolutions)
        return found.angle if found.counts else None

    def if_whole(self, revolutions: float) -> Tried | None:
        """The trial with some revolutions, if every path comes to rest: those that failed before go first."""
        few = self.lost[:_LOST]
        if revolutions not in self.made and len(few) and not self._rest(self.lay(revolutions, few)).all():
            return None
        found = self.at(revolutions)
        return found if found.whole else None

    @property
    def counted(self) -> list[Tried]:
        """Those in which enough paths came to rest."""
        return [each for each in self.made.values() if each.counts]

    def _tried(self, revolutions: float) -> Tried:
        steepest = max((each.revolutions for each in self.counted), default=np.inf)
        if self.paths > 2 * len(_FIRST) and revolutions > steepest:
            first = (np.array(_FIRST) * self.paths).astype(np.int64)
            rest = self._rest(self.lay(revolutions, first))
            if np.count_nonzero(rest) <= 1:
                return Tried(revolutions, np.nan, 0.0)
        laid = self.lay(revolutions, None)
        rest = self._rest(laid)
        if not rest.all():
            self.lost = np.flatnonzero(~rest)
        held = float(rest.mean())
        return Tried(revolutions, self.tell(laid.subset(rest)) if held >= MOST else np.nan, held)

    @staticmethod
    def _rest(laid: Paths) -> Bools:
        return np.asarray(laid.status == Status.CONVERGED)
