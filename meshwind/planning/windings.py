"""Windings that are to hold from every start: both families, with more starts where paths fail first.

Where few neighbouring starts fail, as beside a tip, paths that are spread evenly can all miss them.

Whether a path holds is settled on the fewest particles that `solve` begins with: numbers are looked for with these, and
only those that are stated are tried with all particles.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.defaults import PARTICLES
from meshwind.path import Status, solve
from meshwind.path.friction import Friction, friction_of
from meshwind.path.kernels.lay import FEWEST
from meshwind.path.limit import Search, Way
from meshwind.planning.settling import Settling
from meshwind.planning.trials import PATHS
from meshwind.surface.rims import rim_parameters
from meshwind.surface.surface import Surface

_STARTS = 24
"""Least number of paths per family, so that what holds between those asked for is seen as well."""
_FEW = 4
"""The same where the number is about."""
_HALVINGS = 5
"""Times that starts are put between those where paths fail first and their neighbours."""
_LOOKED_AT = 3
"""Paths that fail first beside which starts are put, at most."""
_SPREAD = 8
"""Paths that are tried first, spread over both families' starts."""
_THIRD = 3
"""Numbers within the interval have so many times fewer paths, others from one number to the next."""
_LEAST = 0.05
"""Least share of a number that fails that is tried in its stead."""
_STEP = 0.05
"""First relative step back from a number with which a path beside others failed: one that fails costs many that hold,
which are wound on from each other."""
_SAME = 1e-9
"""Shares of the rim closer than this are one."""
_AT_ONCE = 4
"""Paths that are tried at once, before others are."""
_ABOUT = FEWEST // 2
"""Least number of segments, and as many per turn, of slides where the number is about."""
_NEAR = 0.03
"""Relative distance of two numbers up to which a path that held with the further one counts as holding with both."""
_TWICE = 1.5
"""Steps from a number that fails to one that holds, above which a number between them is tried."""
_CLOSE, _ABOUT_CLOSE = 0.01, 0.05
"""Relative distance of numbers that hold and that do not, at which a search ends, and where the number is about."""
_BUDGET = 3
"""Solves of each path that an end of the interval may cost."""


@dataclass
class Windings:
    """Windings from shares (p,) of the start rim's length, family (p,), as `solve` lays them with so many particles.

    starts: number per family that are spread evenly, a multiple of 4; those beside paths that failed come after them.
    settling: how it is settled, by few particles, which paths hold.  halvings: times that starts are put beside those
    that failed.  close: relative distance of numbers that hold and that do not, at which a search ends.  held: by the
    way of a search, up or down, and by path, the number next to the failing one with which it held on few particles; it
    is not tried with those behind that again.  lost: paths that failed on few particles, the last ones first.
    """

    surface: Surface
    friction: float | Friction
    particles: int | None
    starts: int
    share: Floats
    family: Ints
    settling: Settling
    halvings: int = _HALVINGS
    close: float = _CLOSE
    held: dict[bool, dict[int, float]] = field(default_factory=dict)
    lost: Ints = field(default_factory=lambda: np.zeros(0, np.int64))

    def holds(self, revolutions: float, coarse: bool = False) -> bool:
        """Whether every path converges.  coarse: with the fewest particles."""
        return not len(self._lost(revolutions, self._in_order(), coarse))

    def holds_some(self, revolutions: float, turn: int, every: int = _THIRD) -> bool:
        """Whether every third path converges, or every so many, with the fewest particles.

        turn: which ones, so that three numbers next to each other have all of them.
        """
        return not len(self._lost(revolutions, np.arange(turn % every, len(self.share), every)[::-1], True))

    def which(self, revolutions: float, index: Ints, coarse: bool = False) -> Bools:
        """Which of some paths converge."""
        share, family = self.share[index], self.family[index]
        first = rim_parameters(self.surface, 0.0, share)
        last = rim_parameters(self.surface, 1.0, share + family * revolutions)
        start, end = (np.stack([u, np.full(len(u), v)], axis=1) for u, v in ((first, 0.0), (last, 1.0)))
        if coarse:
            holds = self.settling.holds(index, np.stack([start, end], axis=1))
            self.lost = np.concatenate([index[~holds], self.lost[~np.isin(self.lost, index[~holds])]])
            return holds
        laid = solve(self.surface, start, end, particles=self.particles, family=family, friction=self.friction)
        return np.asarray(laid.status == Status.CONVERGED)

    def limit(self, failed: float, first: float, last: float) -> float:
        """The number nearest to one that fails, on the way to the last one, with which all paths hold; 0 for none.

        It is that of the fewest particles.  first: a number that is likely to hold.
        """
        last = max(last, _LEAST * failed) if first < failed else last
        found, order = self._search(Way(failed, last, abs(first - failed) / failed if failed > 0.0 else 1.0))
        apart = 1.0 / self.starts
        for _ in range(self.halvings):
            if found == 0.0:
                break
            apart *= 0.5
            before = len(self.share)
            self._put_beside(order[:_LOOKED_AT], apart)
            if len(self._lost(found, np.arange(before, len(self.share)), True)):
                found, order = self._search(Way(found, last, _STEP))
        return found

    def confirmed(self, number: float, last: float, inward: float) -> float:
        """A number, moved inward until all paths hold with all their particles; 0 where that is past the last one.

        inward: the first step.  A path that held with a number just beyond is not tried again with the one found.
        """
        if not friction_of(self.surface, self.friction).none:  # as many as without, where it matters
            self._put_beside(np.arange(2 * self.starts), 0.5 / self.starts)
        order, held = self._in_order(), dict[int, float]()
        while inward * (last - number) > 0.0:
            near = [path for path, beyond in held.items() if abs(beyond - number) <= _NEAR * number]
            left = order[~np.isin(order, near)]
            lost = self._lost(number, left, False, held)
            if not len(lost):
                return number
            order = np.concatenate([lost, order[~np.isin(order, lost)]])
            number = self._moved(number, last, inward, lost[:1])
        return 0.0

    def _moved(self, number: float, last: float, inward: float, paths: Ints) -> float:
        """A number with which some paths fail, moved inward until these hold: no further than needed, to about a step.

        Steps are doubled until they do, and the last one is then halved.
        """
        step, outer, inner = inward, number, number
        while inward * (last - inner) > 0.0:
            outer, inner = inner, inner + step
            step *= 2.0
            if self.which(inner, paths).all():
                break
        while abs(inner - outer) > _TWICE * abs(inward) and inward * (last - inner) > 0.0:
            middle = 0.5 * (outer + inner)
            outer, inner = (outer, middle) if self.which(middle, paths).all() else (middle, inner)
        return inner

    def _lost(self, revolutions: float, order: Ints, coarse: bool, held: dict[int, float] | None = None) -> Ints:
        """Some of the paths that do not converge, none where all do: one that does not is enough.

        held: where to note for each other one that it was tried by itself, and with which number it converged.
        """
        together = self.particles is None and not coarse  # how a path is solved depends on the others
        many = max(len(order), 1) if together else _AT_ONCE
        for k in range(0, len(order), many):
            part = order[k : k + many]
            which = self.which(revolutions, part, coarse)
            if held is not None and not together:
                held.update(dict.fromkeys(part[which].tolist(), revolutions))
            if not which.all():
                return part[~which]
        return order[:0]

    def _in_order(self) -> Ints:
        """The paths in the order in which they are tried: those that failed, those beside others, then the spread ones.

        Of the first two, those that failed or were put there last come first.
        """
        every = np.arange(len(self.share))
        even, beside = every[: 2 * self.starts], every[: 2 * self.starts - 1 : -1]
        order = np.concatenate([beside, even.reshape(_SPREAD, -1).T.ravel()])
        return np.concatenate([self.lost, order[~np.isin(order, self.lost)]])

    def _search(self, way: Way) -> tuple[float, Ints]:
        """The number found on few particles, and the paths in order: those that failed last first.

        No number beyond one that fails is asked for: all of an interval are to hold.
        """
        order = self._in_order()
        best = self.held.setdefault(way.down, {})

        def attempt(number: float, paths: Ints) -> Bools:
            new = paths[[not way.nearer(best.get(path, way.last), number) for path in paths.tolist()]]
            which = self.which(number, new, True)
            best.update(dict.fromkeys(new[which].tolist(), number))
            return ~np.isin(paths, new[~which])

        search = Search(attempt, way, order, _BUDGET * len(order), through=False, step=_STEP, close=self.close)
        return search.run(), search.order

    def _put_beside(self, paths: Ints, apart: float) -> None:
        """Add starts on both sides of some paths, each once."""
        beside = np.mod((self.share[paths][:, None] + apart * np.array([-1.0, 1.0])).ravel(), 1.0)
        both = np.stack([np.repeat(self.family[paths], 2), beside], axis=1)
        there = np.stack([self.family, self.share], axis=1)
        new = [k for k in range(len(both)) if not _among(both[k], there) and not _among(both[k], both[:k])]
        numbers = range(len(self.share), len(self.share) + len(new))
        self.settling.neighbours.update(zip(numbers, np.repeat(paths, 2)[new].tolist(), strict=True))
        self.share = np.concatenate([self.share, beside[new]])
        self.family = np.concatenate([self.family, np.repeat(self.family[paths], 2)[new]])


def spread(
    surface: Surface, friction: float | Friction = 0.0, paths: int = PATHS, particles: int | None = PARTICLES
) -> Windings:
    """Windings with at least twice as many starts as are asked for.

    With friction, under which one costs ten, as many: those between are added where a number is confirmed.
    """
    least = max(2 * paths, _STARTS) if friction_of(surface, friction).none else max(paths, _STARTS // 2)
    starts = 4 * (-(-least // 4))  # both families are then divided evenly
    return _spread(surface, friction, particles, starts, _HALVINGS)


def rougher(windings: Windings, friction: float | Friction) -> Windings:
    """As many windings with more friction as `spread` has with some: where these have none, half of them."""
    none = friction_of(windings.surface, windings.friction).none
    starts = 4 * (-(-windings.starts // 8)) if none else windings.starts
    return _spread(windings.surface, friction, windings.particles, starts, 0)


def few(windings: Windings, friction: float | Friction) -> Windings:
    """As few windings as show about what another friction holds."""
    windings = _spread(windings.surface, friction, windings.particles, _FEW, 0, _ABOUT)
    return replace(windings, close=_ABOUT_CLOSE)


def _among(one: Floats, others: Floats) -> bool:
    """Whether a family and share (2,) is among others (k, 2)."""
    off = np.abs(others - one)
    return bool(np.any((off[:, 0] == 0.0) & (np.minimum(off[:, 1], 1.0 - off[:, 1]) < _SAME)))


def _spread(
    surface: Surface,
    friction: float | Friction,
    particles: int | None,
    starts: int,
    halvings: int,
    least: int = FEWEST,
) -> Windings:
    turn = np.arange(starts) / starts
    settling = Settling(surface, friction, particles, least)
    share, family = np.tile(turn, 2), np.repeat([1, -1], starts)
    return Windings(surface, friction, particles, starts, share, family, settling, halvings)
