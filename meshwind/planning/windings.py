"""Windings that are to hold from every start: both families, with more starts where paths fail first.

Where few neighbouring starts fail, as beside a tip, paths that are spread evenly can all miss them.

Whether a path holds is settled on the fewest particles that `solve` begins with: numbers are looked for with these, and
only those that are stated are tried with all particles.
"""

from dataclasses import dataclass, field

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.defaults import PARTICLES
from meshwind.path import Status, solve
from meshwind.path.friction import Friction, friction_of
from meshwind.path.kernels.lay import FEWEST, halvings, turn_of
from meshwind.path.kernels.state import EVALUATIONS
from meshwind.path.levels import segments
from meshwind.path.limit import Search, Way
from meshwind.path.nested import solve_with
from meshwind.path.search import failing
from meshwind.path.solver import COARSE, Solver
from meshwind.planning.trials import ITERATIONS, PATHS
from meshwind.surface.rims import rim_parameters
from meshwind.surface.surface import Surface

_STARTS = 24
"""Least number of paths per family, so that what holds between those asked for is seen as well."""
_FEW = 4
"""The same where the number is about."""
_HALVINGS = 5
"""Times that starts are put between those where paths fail first and their neighbours."""
_LOOKED_AT = 4
"""Paths that fail first beside which starts are put, at most."""
_SPREAD = 8
"""Paths that are tried first, spread over both families' starts."""
_THIRD = 3
"""Numbers within the interval have so many times fewer paths, others from one number to the next."""
_LEAST = 0.05
"""Least share of a number that fails that is tried in its stead."""
_STEP = 0.01
"""First relative step back from a number with which a path beside others failed."""
_DEAR = 500
"""Evaluations a particle above which a path without friction counts as failing: one that is looked for so long catches
on edges, and mostly fails with all particles."""
_AT_ONCE = 8
"""Paths that are tried at once, before others are."""
_BUDGET = 3
"""Solves of each path that an end of the interval may cost."""


@dataclass
class Windings:
    """Windings from shares (p,) of the start rim's length, family (p,), as `solve` lays them with so many particles.

    starts: number per family that are spread evenly, a multiple of 4; those beside paths that failed come after them.
    halvings: times that starts are put beside those.  held: by the way of a search, up or down, and by path, the number
    next to the failing one with which it held on few particles; it is not tried with those behind that again.
    """

    surface: Surface
    friction: float | Friction
    particles: int | None
    starts: int
    share: Floats
    family: Ints
    halvings: int = _HALVINGS
    held: dict[bool, dict[int, float]] = field(default_factory=dict)

    def holds(self, revolutions: float, coarse: bool = False) -> bool:
        """Whether every path converges.  coarse: with the fewest particles."""
        return not len(self._lost(revolutions, self._in_order(), coarse))

    def holds_some(self, revolutions: float, turn: int) -> bool:
        """Whether every third path converges, and all that were put beside others, with the fewest particles.

        turn: which ones, so that three numbers next to each other have all of them.
        """
        even, beside = np.arange(turn % _THIRD, 2 * self.starts, _THIRD), np.arange(2 * self.starts, len(self.share))
        return bool(self.which(revolutions, np.concatenate([even, beside]), True).all())

    def which(self, revolutions: float, index: Ints, coarse: bool = False) -> Bools:
        """Which of some paths converge."""
        share, family = self.share[index], self.family[index]
        first = rim_parameters(self.surface, 0.0, share)
        last = rim_parameters(self.surface, 1.0, share + family * revolutions)
        start, end = (np.stack([u, np.full(len(u), v)], axis=1) for u, v in ((first, 0.0), (last, 1.0)))
        if coarse:
            return self._settle(np.stack([start, end], axis=1))
        laid = solve(self.surface, start, end, particles=self.particles, family=family, friction=self.friction)
        return np.asarray(laid.status == Status.CONVERGED)

    def _settle(self, curves: Floats) -> Bools:
        """Which paths rest from starting curves (p, 2, 2) on the lowest level of `solve`, where that is settled."""
        if not len(curves):
            return np.zeros(0, np.bool_)
        longest = curves[np.abs(curves[:, 1, 0] - curves[:, 0, 0]).argmax()]
        particles = int(FEWEST * max(1.0, turn_of(longest))) + 1
        if self.particles is not None:
            particles = segments(self.particles, halvings(longest, self.particles)) + 1
        friction = friction_of(self.surface, self.friction)
        solver = Solver(self.surface, friction, True, COARSE, ITERATIONS, final=False)
        batch = solve_with(solver, curves, particles)
        return ~failing(batch) & (np.bool_(not friction.none) | (batch.counters[:, EVALUATIONS] <= _DEAR * particles))

    def limit(self, failed: float, first: float, last: float) -> float:
        """The number nearest to one that fails, on the way to the last one, with which all paths hold; 0 for none.

        It is that of the fewest particles.  first: a number that is likely to hold.
        """
        last = max(last, _LEAST * failed) if first < failed else last
        found, order = self._search(Way(failed, last, abs(first - failed) / failed if failed > 0.0 else 1.0), True)
        apart = 1.0 / self.starts
        for _ in range(self.halvings):
            if found == 0.0:
                break
            apart *= 0.5
            before = len(self.share)
            self._put_beside(order[:_LOOKED_AT], apart)
            if not self.which(found, np.arange(before, len(self.share)), True).all():
                found, order = self._search(Way(found, last, _STEP), True)
        return found

    def confirmed(self, number: float, last: float, inward: float) -> float:
        """A number, moved inward until all paths hold with all their particles; 0 where that is past the last one.

        inward: the first step, which is doubled each time.
        """
        order = self._in_order()
        while inward * (last - number) > 0.0:
            lost = self._lost(number, order, False)
            if not len(lost):
                return number
            order = np.concatenate([lost, order[~np.isin(order, lost)]])
            number += inward
            inward *= 2.0
        return 0.0

    def _lost(self, revolutions: float, order: Ints, coarse: bool) -> Ints:
        """Some of the paths that do not converge, none where all do: one that does not is enough."""
        together = self.particles is None and not coarse  # how a path is solved depends on the others
        many = max(len(order), 1) if together else _AT_ONCE
        for k in range(0, len(order), many):
            part = order[k : k + many]
            lost = part[~self.which(revolutions, part, coarse)]
            if len(lost):
                return lost
        return order[:0]

    def _in_order(self) -> Ints:
        """The paths in the order in which they are tried: those put beside others first, then the spread ones."""
        every = np.arange(len(self.share))
        even, beside = every[: 2 * self.starts], every[: 2 * self.starts - 1 : -1]
        return np.concatenate([beside, even.reshape(_SPREAD, -1).T.ravel()])

    def _search(self, way: Way, coarse: bool) -> tuple[float, Ints]:
        """The number found, and the paths in order: those that failed last first."""
        order = self._in_order()
        together = self.particles is None and not coarse

        best = self.held.setdefault(way.down, {})

        def attempt(number: float, paths: Ints) -> Bools:
            if not coarse:
                return self.which(number, paths)
            new = paths[[not way.nearer(best.get(path, way.last), number) for path in paths.tolist()]]
            which = self.which(number, new, True)
            best.update(dict.fromkeys(new[which].tolist(), number))
            return ~np.isin(paths, new[~which])

        search = Search(attempt, way, order, _BUDGET * len(order), together=together)
        return search.run(), search.order

    def _put_beside(self, paths: Ints, apart: float) -> None:
        """Add starts on both sides of some paths."""
        beside = (self.share[paths][:, None] + apart * np.array([-1.0, 1.0])).ravel()
        self.share = np.concatenate([self.share, np.mod(beside, 1.0)])
        self.family = np.concatenate([self.family, np.repeat(self.family[paths], 2)])


def spread(
    surface: Surface, friction: float | Friction = 0.0, paths: int = PATHS, particles: int | None = PARTICLES
) -> Windings:
    """Windings with at least twice as many starts as are asked for, with friction as many: a slide costs ten paths."""
    least = max(2 * paths, _STARTS) if friction_of(surface, friction).none else max(paths, _STARTS // 2)
    starts = 4 * (-(-least // 4))  # both families are then divided evenly
    return _spread(surface, friction, particles, starts, _HALVINGS)


def few(windings: Windings, friction: float | Friction) -> Windings:
    """As few windings as show about what another friction holds."""
    return _spread(windings.surface, friction, windings.particles, _FEW, 0)


def _spread(
    surface: Surface, friction: float | Friction, particles: int | None, starts: int, halvings: int
) -> Windings:
    turn = np.arange(starts) / starts
    return Windings(surface, friction, particles, starts, np.tile(turn, 2), np.repeat([1, -1], starts), halvings)
