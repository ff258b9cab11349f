"""Advice that was tried: numbers with which all paths of a run hold, each solved as a user would do it.

A number is looked for with the paths that failed last, and then tried with all paths, as it is printed: fewer
revolutions, more friction, or more particles.
"""

from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Bools, Floats, Ints
from meshwind.path.asked import Asked, Options
from meshwind.path.friction import Friction, uniform
from meshwind.path.kernels.status import Status
from meshwind.path.limit import DIGITS, Attempt, Search, Way
from meshwind.path.turning import Turning, turning
from meshwind.surface.surface import Surface

ROUGHEST = 1.0
"""Largest coefficient of friction that is looked at: fibres on a part rarely have more."""
_SMOOTHEST = 1e-3
"""A coefficient of friction that nobody can tell from none."""
_FEWEST = 1.0 / 64.0
"""Least share of the revolutions asked for that is looked at."""
_BUDGET = 96, 6
"""Most solves of a path that a number may cost: so many, and so many more for each path."""
_FINER = 2, 4
"""Factors of the particles that are tried ..."""
_MOST = 6401
"""... up to so many."""
_FIRST = 0.5, 1.0
"""First relative steps from the revolutions and from the friction asked for."""


@dataclass(frozen=True)
class Advice:
    """What holds all paths of a run, with one number changed; 0 where none was found, or none was needed.

    Attributes
    ----------
    paths : int
        Number of paths.
    asked : float
        Revolutions asked for, 0 where paths turn by different numbers.
    revolutions : float
        Fewer revolutions that hold all paths, where they turn by one number.
    turns : float
        Share of each path's own turn that holds all paths, where they turn by different numbers.
    friction : float
        Coefficient of friction that holds all paths.
    rougher : float
        Factor of the friction that holds all paths, where friction is not the same everywhere.
    particles : int
        Number of particles with which all paths come to rest.
    """

    paths: int
    asked: float = 0.0
    revolutions: float = 0.0
    turns: float = 0.0
    friction: float = 0.0
    rougher: float = 0.0
    particles: int = 0

    __repr__ = brief

    @property
    def text(self) -> str:
        """All that holds the paths in one sentence, "" where nothing was found."""
        every = "it" if self.paths == 1 else f"all {self.paths} paths"
        found = []
        if self.revolutions > 0.0:
            found.append(f"{_printed(self.revolutions)} revolutions hold {every}")
        if self.turns > 0.0:
            found.append(f"ends turned by {_printed(self.turns)} times as much hold {every}")
        if found and self.paths > 1:
            every = "all"
        at = f" at {self.asked:.6g} revolutions" if self.asked > 0.0 else ""
        if self.friction > 0.0:
            found.append(f"friction {_printed(self.friction)} would hold {every}{at}")
        if self.rougher > 0.0:
            found.append(f"{_printed(self.rougher)} times the friction would hold {every}{at}")
        if self.particles > 0:
            found.append(f"{self.particles} particles bring {every} to rest")
        return "; ".join(found)


def advise(surface: Surface, asked: Asked, status: Ints) -> Advice:
    """Find what holds all paths that were asked for, by trials; status (p,): how they ended, as `Status`.

    A search costs about 96 solves of a path, and 6 more for each path, at most.
    """
    rest, coarse = status == Status.CONVERGED, status == Status.TOO_COARSE
    if rest.all() or not len(asked):
        return Advice(len(asked))
    turned = turning(surface, asked)
    found = Advice(len(asked), turned.revolutions if turned is not None else 0.0)
    runs = _Runs(surface, asked, np.concatenate([np.flatnonzero(~rest), np.flatnonzero(rest)]))
    if not (rest | coarse).all():
        if turned is not None:
            fewer = runs.fewer(turned)
            found = replace(found, revolutions=fewer) if turned.revolutions > 0.0 else replace(found, turns=fewer)
        more = runs.rougher()
        even = asked.options.friction.table.size == 1
        found = replace(found, friction=more) if even else replace(found, rougher=more)
    if (rest | coarse | (status == Status.STALLED)).all():
        found = replace(found, particles=runs.finer())
    return found


@dataclass(frozen=True)
class _Runs:
    """Runs of the same paths with one thing changed; order (p,): the paths that failed first."""

    surface: Surface
    asked: Asked
    order: Ints

    def fewer(self, turned: Turning) -> float:
        """The most revolutions, or the largest share of each path's turn, that hold all paths; 0 for none."""
        asked = turned.revolutions or 1.0

        def attempt(number: float, paths: Ints) -> Bools:
            return self._hold(self.asked.options, paths, turned.ends(number))

        def also(number: float, paths: Ints) -> Bools:
            return self._hold(self.asked.options, paths, turned.ends_by_u(number))

        return self._search(attempt, Way(asked, _FEWEST * asked, _FIRST[0]), also if turned.by_length else None)

    def rougher(self) -> float:
        """The least friction, or the least factor of it, that holds all paths; 0 for none."""
        options = self.asked.options
        table, largest = options.friction.table, options.friction.largest
        even = table.size == 1
        if largest >= ROUGHEST:
            return 0.0

        def attempt(number: float, paths: Ints) -> Bools:
            friction = uniform(number) if even else Friction(table * number)
            return self._hold(replace(options, friction=friction), paths)

        if even:
            return self._search(attempt, Way(largest, ROUGHEST, _FIRST[1], _SMOOTHEST))
        most = Way(np.inf, 0.0, 0.0).rounded(ROUGHEST / largest) if largest > 0.0 else 0.0
        return self._search(attempt, Way(1.0, most, _FIRST[1])) if most > 1.0 else 0.0

    def finer(self) -> int:
        """A number of particles with which all paths come to rest; 0 for none."""
        options = self.asked.options
        for factor in _FINER:
            particles = factor * (options.particles - 1) + 1 if options.particles is not None else _MOST + 1
            if particles <= _MOST and self._hold(replace(options, particles=particles), self.order).all():
                return particles
        return 0

    def _search(self, attempt: Attempt, way: Way, also: Attempt | None = None) -> float:
        budget = _BUDGET[0] + _BUDGET[1] * len(self.order)
        return Search(attempt, way, self.order, budget, also, self.asked.options.particles is None).run()

    def _hold(self, options: Options, paths: Ints, end: Floats | None = None) -> Bools:
        """Which of some paths come to rest with other options or other ends."""
        return np.asarray(self.asked.again(self.surface, options, paths, end).status == Status.CONVERGED)


def _printed(number: float) -> str:
    return f"{number:.{DIGITS}g}"
