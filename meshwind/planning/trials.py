"""Trial windings: whether a number of revolutions is feasible, and how much of the fibre bridges.

Most have few, coarse paths; some are wound at full resolution.
"""

from dataclasses import dataclass

import numpy as np

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
_REFINEMENTS = (1, 2, 4)
"""Factors of that number, in turn, for paths that do not converge: coarse ones catch on sharp edges."""
_TOLERANCE, ITERATIONS = 1e-6, 150
"""A path that is not nearly in equilibrium after so many iterations slides: more of them only cost."""
_HOPELESS = 0.5
"""Share of the paths that fail at first above which no other way of solving is tried."""


@dataclass(frozen=True)
class Trial:
    """The outcome of a winding by a number of revolutions.

    converged: share of the paths that converged; bridged_share: share of their length off the surface; slid: number of
    paths that slid off the start and off the end.
    """

    revolutions: float
    converged: float
    bridged_share: float
    slid: tuple[int, int]

    @property
    def feasible(self) -> bool:
        """Whether every path converged."""
        return self.converged == 1.0


def trial(surface: Surface, revolutions: float, friction: float | Friction = 0.0, paths: int = PATHS) -> Trial:
    """Wind both families with `paths` coarse paths each; those that fail are tried again with more particles."""
    rims = families(surface, paths, revolutions)
    solver = Solver(surface, friction_of(surface, friction), True, _TOLERANCE, ITERATIONS)
    curves = straight(rims.start, rims.end, 2)
    least = max(_SEGMENTS, int(fewest(curves).max(initial=0)))
    left, batches = np.arange(len(curves)), []
    for factor in _REFINEMENTS:
        batch = fresh(curves[left], least * factor + 1)
        _relax(solver, batch)
        failed = float((batch.status != Status.CONVERGED).mean())
        if factor > 1 or 0.0 < failed <= _HOPELESS:
            search(solver, batch)
        batches.append(as_paths(solver, batch, rims.family[left]))
        left = left[batch.status != Status.CONVERGED]
        if not len(left) or (factor == 1 and failed > _HOPELESS):
            break
    return _outcome(batches, revolutions)


def _relax(solver: Solver, batch: Batch) -> None:
    """Bring a fresh batch to equilibrium, the frictionless paths where that is simple by what is cheapest."""
    rest = np.arange(batch.paths)
    if solver.friction.none:
        solver.solve_simple(batch)
        rest = np.flatnonzero(batch.status != Status.CONVERGED)
    if len(rest):
        part = fresh(batch.starts[rest], batch.particles)
        part.counters[:] = batch.counters[rest]
        solver.relax(part, resume=False)
        batch.put(rest, part)


def full_trial(
    surface: Surface, revolutions: float, friction: float | Friction, paths: int, particles: int | None
) -> Trial:
    """Wind both families at full resolution, as `solve` does."""
    rims = families(surface, paths, revolutions)
    laid = solve(surface, rims.start, rims.end, particles=particles, family=rims.family, friction=friction)
    return _outcome([laid], revolutions)


def _outcome(batches: list[Paths], revolutions: float) -> Trial:
    """The outcome over batches of paths, in each of which those are tried again that failed in the one before."""
    converged = sum(int((laid.status == Status.CONVERGED).sum()) for laid in batches)
    counted = converged_or_all(np.concatenate([laid.status for laid in batches]))
    masks = np.split(counted, np.cumsum([len(laid) for laid in batches[:-1]]))
    bridged = bridged_share(*zip(map(lengths, batches), masks, strict=True))
    slid = tuple(int((batches[-1].status == end).sum()) for end in (Status.SLID_OFF_START, Status.SLID_OFF_END))
    return Trial(float(revolutions), converged / len(batches[0]), bridged, (slid[0], slid[1]))
