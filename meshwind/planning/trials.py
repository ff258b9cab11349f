"""Trial windings: whether a number of revolutions is feasible, and how much of the fibre bridges.

Most have few, coarse paths; some are wound at full resolution.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.path import Paths, Status, solve
from meshwind.path.batch import Batch, fresh
from meshwind.path.friction import Friction, friction_of
from meshwind.path.lengths import bridged_share, lengths
from meshwind.path.nested import fewest
from meshwind.path.paths import converged_or_all
from meshwind.path.search import search
from meshwind.path.solve import as_paths, straight
from meshwind.path.solver import Solver
from meshwind.planning.families import families
from meshwind.surface.surface import Surface

PATHS = 8
"""Paths per family: the part turns by an eighth from one to the next."""
_SEGMENTS = 72
"""Least number of segments of a path: on a barrel the bound of revolutions comes out to 1e-3."""
_REFINEMENTS = (2, 4)
"""Factors of that number, in turn, for paths that do not converge: coarse ones catch on sharp edges."""
_TOLERANCE, ITERATIONS = 1e-6, 150
"""A path that is not nearly in equilibrium after so many iterations slides: more of them only cost."""
_DEAREST = 500
"""Evaluations a particle above which a path without friction counts as failing: one that is looked for so long catches
on edges, and mostly fails with all particles."""
_SLID = Status.SLID_OFF_START, Status.SLID_OFF_END
_HOPELESS = 0.5
"""Share of the paths that fail at first above which no other way of solving is tried."""


@dataclass(frozen=True)
class Trial:
    """The outcome of a winding by a number of revolutions.

    converged: share of the paths that are known to converge: where one does not, not all others are tried to the last;
    bridged_share: share of their length off the surface; slid: number of paths that slid off the start and off the end.
    """

    revolutions: float
    converged: float
    bridged_share: float
    slid: tuple[int, int]

    @property
    def feasible(self) -> bool:
        """Whether every path converged."""
        return self.converged == 1.0


def trial(
    surface: Surface, revolutions: float, friction: float | Friction = 0.0, paths: int = PATHS, slides: bool = True
) -> Trial:
    """Wind both families with `paths` coarse paths each; those that fail are tried again with more particles.

    They are so one after another, and the others no more once one fails: that decides.  slides: whether the end is
    wanted where they slide off.
    """
    rims = families(surface, paths, revolutions)
    law = friction_of(surface, friction)
    solver = Solver(surface, law, True, _TOLERANCE, ITERATIONS, dearest=dearest(law))
    curves = straight(rims.start, rims.end, 2)
    least = max(_SEGMENTS, int(fewest(curves).max(initial=0)))
    batch = _direct(solver, curves, least + 1, slides)
    finer: list[tuple[int, Batch]] = []
    if 0 < len(_failing(batch)) <= _HOPELESS * batch.paths:
        search(solver, batch)
        finer = list(_refined(solver, batch, least))
    status = batch.status.copy()
    for path, each in finer:
        status[path] = each.status[0]
    laid = [_at_rest(solver, each) for each in (batch, *(each for _, each in finer))]
    bridged = bridged_share(*((lengths(each), np.ones(len(each), np.bool_)) for each in laid))
    return Trial(float(revolutions), float((status == Status.CONVERGED).mean()), bridged, slid_off(status))


def dearest(friction: Friction) -> float:
    """Evaluations a particle above which a path counts as failing: under friction none does by what it costs."""
    return _DEAREST if friction.none else np.inf


def _direct(solver: Solver, curves: Floats, particles: int, slides: bool) -> Batch:
    """Paths from their starting curves: all of them, unless the first ones decide that some fail.

    They do where more fail than may, or where one that is dear does and, if that is wanted, one slides off an end.
    """
    batch = fresh(curves, particles)
    batch.status[:] = Status.STALLED
    most = int(_HOPELESS * len(curves))  # may fail
    done = 0
    for index in np.split(np.arange(len(curves)), sorted({1, 2, most + 1})):
        part = fresh(curves[index], particles)
        _relax(solver, part)
        batch.put(index, part)
        done += len(index)
        lost = _failing(batch)[: -len(curves) + done or None]
        told = not slides or np.isin(batch.status[lost], _SLID).any()
        if len(lost) > most or (told and solver.dear(batch)[lost].any()):
            break
    return batch


def _refined(solver: Solver, batch: Batch, least: int) -> Iterator[tuple[int, Batch]]:
    """The paths that failed in a batch, each with more particles until it holds, up to the first that does not."""
    for path in _failing(batch).tolist():
        for factor in _REFINEMENTS:
            finer = fresh(batch.starts[path : path + 1], least * factor + 1)
            _relax(solver, finer)
            search(solver, finer)
            if finer.status[0] in (Status.CONVERGED, *_SLID):
                break  # what slides off with more particles, too, has caught on nothing
        yield path, finer
        if len(_failing(finer)):
            return


def _at_rest(solver: Solver, batch: Batch) -> Paths:
    """The paths of a batch that converged."""
    rest = batch.rows(np.flatnonzero(batch.status == Status.CONVERGED))
    return as_paths(solver, rest, np.ones(rest.paths))


def _failing(batch: Batch) -> Ints:
    """Numbers of the paths that have not converged."""
    return np.flatnonzero(batch.status != Status.CONVERGED)


def _relax(solver: Solver, batch: Batch) -> None:
    """Bring a fresh batch to equilibrium, the frictionless paths where that is simple by what is cheapest."""
    rest = np.arange(batch.paths)
    if solver.friction.none:
        solver.solve_simple(batch)
        rest = np.flatnonzero((batch.status != Status.CONVERGED) & ~solver.dear(batch))
    if len(rest):
        part = fresh(batch.starts[rest], batch.particles)
        part.counters[:] = batch.counters[rest]
        solver.relax(part, resume=False)
        batch.put(rest, part)


def full_trial(
    surface: Surface, revolutions: float, friction: float | Friction, paths: int, particles: int | None
) -> Trial:
    """Wind both families at full resolution, as `solve` does."""
    return _judged(revolutions, _laid(surface, revolutions, friction, paths, particles))


def holding_trial(
    surface: Surface, revolutions: float, friction: float | Friction, paths: int, particles: int | None
) -> Trial:
    """The same by fewer revolutions that hold all paths; by the number itself where it does, or none are known."""
    laid = _laid(surface, revolutions, friction, paths, particles)
    fewer = laid.holding.revolutions
    return full_trial(surface, fewer, friction, paths, particles) if fewer > 0.0 else _judged(revolutions, laid)


def _judged(revolutions: float, laid: Paths) -> Trial:
    bridged = bridged_share((lengths(laid), converged_or_all(laid.status)))
    return Trial(float(revolutions), float((laid.status == Status.CONVERGED).mean()), bridged, slid_off(laid.status))


def _laid(surface: Surface, revolutions: float, friction: float | Friction, paths: int, particles: int | None) -> Paths:
    rims = families(surface, paths, revolutions)
    return solve(surface, rims.start, rims.end, particles=particles, family=rims.family, friction=friction)


def slid_off(status: Ints) -> tuple[int, int]:
    """Number of paths that slid off the start and off the end."""
    start, end = ((status == each).sum() for each in _SLID)
    return int(start), int(end)
