"""Windings that are to hold from every start: both families, with more starts where paths fail first.

Where few neighbouring starts fail, as beside a tip, paths that are spread evenly can all miss them.
"""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.defaults import PARTICLES
from meshwind.path import Status, solve
from meshwind.path.friction import Friction
from meshwind.path.limit import Search, Way
from meshwind.planning.trials import PATHS
from meshwind.surface.rims import rim_parameters
from meshwind.surface.surface import Surface

_STARTS = 24
"""Least number of paths per family, so that what holds between those asked for is seen as well."""
_HALVINGS = 5
"""Times that starts are put between those where paths fail first and their neighbours."""
_LOOKED_AT = 4
"""Paths that fail first beside which starts are put, at most."""
_SPREAD = 8
"""Paths that are tried first, spread over both families' starts."""
_LEAST = 0.05
"""Least share of a number that fails that is tried in its stead."""
_STEP = 0.01
"""First relative step back from a number with which a path beside others failed."""
_BUDGET = 10
"""Solves of each path that an end of the interval may cost."""


@dataclass
class Windings:
    """Windings from shares (p,) of the start rim's length, family (p,), as `solve` lays them with so many particles.

    starts: number per family that are spread evenly; those beside paths that failed come after them.
    """

    surface: Surface
    friction: float | Friction
    particles: int | None
    starts: int
    share: Floats
    family: Ints

    def holds(self, revolutions: float) -> bool:
        """Whether every path converges."""
        return bool(self.which(revolutions, np.arange(len(self.share))).all())

    def which(self, revolutions: float, index: Ints) -> Bools:
        """Which of some paths converge."""
        share, family = self.share[index], self.family[index]
        first = rim_parameters(self.surface, 0.0, share)
        last = rim_parameters(self.surface, 1.0, share + family * revolutions)
        start, end = (np.stack([u, np.full(len(u), v)], axis=1) for u, v in ((first, 0.0), (last, 1.0)))
        laid = solve(self.surface, start, end, particles=self.particles, family=family, friction=self.friction)
        return np.asarray(laid.status == Status.CONVERGED)

    def limit(self, failed: float, first: float, last: float) -> float:
        """The number nearest to one that fails, on the way to the last one, with which all paths hold; 0 for none.

        first: a number that is likely to hold.
        """
        last = max(last, _LEAST * failed) if first < failed else last
        found, order = self._search(Way(failed, last, abs(first - failed) / failed if failed > 0.0 else 1.0))
        apart = 1.0 / self.starts
        for _ in range(_HALVINGS):
            if found == 0.0:
                break
            apart *= 0.5
            before = len(self.share)
            self._put_beside(order[:_LOOKED_AT], apart)
            if not self.which(found, np.arange(before, len(self.share))).all():
                found, order = self._search(Way(found, last, _STEP))
        return found

    def _search(self, way: Way) -> tuple[float, Ints]:
        """The number found, and the paths in order: those that failed last first."""
        every = np.arange(len(self.share))
        even, beside = every[: 2 * self.starts], every[: 2 * self.starts - 1 : -1]
        order = np.concatenate([beside, even.reshape(_SPREAD, -1).T.ravel()])
        search = Search(self.which, way, order, _BUDGET * len(order), together=self.particles is None)
        return search.run(), search.order

    def _put_beside(self, paths: Ints, apart: float) -> None:
        """Add starts on both sides of some paths."""
        beside = (self.share[paths][:, None] + apart * np.array([-1.0, 1.0])).ravel()
        self.share = np.concatenate([self.share, np.mod(beside, 1.0)])
        self.family = np.concatenate([self.family, np.repeat(self.family[paths], 2)])


def spread(
    surface: Surface, friction: float | Friction = 0.0, paths: int = PATHS, particles: int | None = PARTICLES
) -> Windings:
    """Windings with at least twice as many starts as are asked for."""
    starts = 4 * (-(-max(2 * paths, _STARTS) // 4))  # both families are then divided evenly
    turn = np.arange(starts) / starts
    return Windings(surface, friction, particles, starts, np.tile(turn, 2), np.repeat([1, -1], starts))
