"""Whether paths hold, on the fewest particles that show it: with the answers of numbers of revolutions nearby."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.path.batch import Batch
from meshwind.path.friction import Friction, friction_of
from meshwind.path.kernels.lay import FEWEST, halvings, turn_of
from meshwind.path.levels import segments
from meshwind.path.nested import solve_with
from meshwind.path.search import failing
from meshwind.path.solver import COARSE, Solver
from meshwind.planning.trials import ITERATIONS, dearest, slid_off
from meshwind.surface.surface import Surface

_SOUGHT = 30
"""Evaluations a particle above which a path begins from its answer: one that is found at once is found anew as soon."""
_SMALL = 1.0 / 64.0
"""Relative step of the turn within which a path that cannot be wound on fails: `wind_up` takes none that is smaller."""


@dataclass
class Settling:
    """Settles whether paths hold, on the lowest level of `solve` with so many particles, or on fewer where they slide.

    Without friction a path that was dear is wound on from its last answer to another number of revolutions, as `solve`
    itself builds up the turn of what it does not find at once, and one without an answer from its neighbour's.  With
    friction where a path rests depends on where it began, and each is slid anew.

    least: least number of segments, and as many per turn.  answers: the last one of each path.  sought: paths that were
    dear.  neighbours: a path beside which another one starts.  slid: whether one slid off the start, and off the end.
    """

    surface: Surface
    friction: float | Friction
    particles: int | None
    least: int = FEWEST
    answers: dict[int, Batch] = field(default_factory=dict)
    sought: set[int] = field(default_factory=set)
    neighbours: dict[int, int] = field(default_factory=dict)
    slid: tuple[bool, bool] = (False, False)

    def holds(self, paths: Ints, curves: Floats) -> Bools:
        """Which of the paths of some numbers rest, from starting curves (p, 2, 2)."""
        holds = np.zeros(len(paths), np.bool_)
        if not len(paths):
            return holds
        solver, particles = self._solver(curves)
        left = np.ones(len(paths), np.bool_)
        for k, batch, small in self._wound_on(solver, paths, curves, particles):
            holds[k] = self._kept(solver, paths[k : k + 1], batch)[0]
            left[k] = not (holds[k] or small)
        rest = np.flatnonzero(left)
        if len(rest):
            batch = solve_with(solver, curves[rest], particles)
            holds[rest] = self._kept(solver, paths[rest], batch)
        return holds

    def _solver(self, curves: Floats) -> tuple[Solver, int]:
        """The solver of paths from starting curves, and their number of particles."""
        friction = friction_of(self.surface, self.friction)
        longest = curves[np.abs(curves[:, 1, 0] - curves[:, 0, 0]).argmax()]
        particles = int(self.least * max(1.0, turn_of(longest))) + 1
        if self.particles is not None:
            level = segments(self.particles, halvings(longest, self.particles)) + 1
            particles = level if friction.none else min(particles, level)
        rough = Solver(self.surface, friction, True, COARSE, ITERATIONS, final=False, dearest=dearest(friction))
        return rough, particles

    def _wound_on(
        self, solver: Solver, paths: Ints, curves: Floats, particles: int
    ) -> Iterator[tuple[int, Batch, bool]]:
        """The paths of which an answer is known, by their place, from there with the turn of other curves.

        Whether that is a small step as well.
        """
        for k, path in enumerate(paths.tolist()):
            own = self.answers.get(path)
            known = self.answers.get(self.neighbours.get(path, path)) if own is None else own
            if known is None or known.particles != particles or not (own is None or path in self.sought):
                continue
            batch = known.copied()._replace(starts=curves[k : k + 1].copy())
            ramp = np.linspace(0.0, 1.0, particles)
            first, last = curves[k, :, 0] - known.uv[0, [0, -1], 0]
            batch.uv[0, :, 0] += first + (last - first) * ramp
            batch.touching[:], batch.counters[:] = True, 0  # from the surface again, as where a turn is built up
            solver.relax(batch, resume=True)
            step = max(abs(first - round(first)), abs(last - round(first)))
            yield k, batch, bool(step <= _SMALL * turn_of(curves[k]))

    def _kept(self, solver: Solver, paths: Ints, batch: Batch) -> Bools:
        """Which paths of a batch rest; keep the answers that are worth it."""
        holds = ~failing(batch) & ~solver.dear(batch)
        off = slid_off(batch.status)
        self.slid = self.slid[0] or off[0] > 0, self.slid[1] or off[1] > 0
        if solver.friction.none:
            self.sought.update(paths[holds & batch.costlier(_SOUGHT)].tolist())
            self.answers.update((int(paths[k]), batch.rows(np.array([k]))) for k in np.flatnonzero(holds))
        return holds
