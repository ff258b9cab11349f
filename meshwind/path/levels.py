"""From few particles to many: the answer of one level is the start on the next."""

from dataclasses import replace

import numpy as np

from meshwind.core.cast import Ints
from meshwind.path.batch import Batch, fresh
from meshwind.path.kernels.status import Status
from meshwind.path.search import REST, failing, search
from meshwind.path.solver import Solver


def segments(particles: int, level: int) -> int:
    """Segments of a path of so many particles where they are halved `level` times, or doubled where that is below 0."""
    return (particles - 1) >> level if level >= 0 else (particles - 1) << -level


def climb(solver: Solver, batch: Batch, particles: int, level: int) -> Batch:
    """The batch, from the answer with the particles halved `level` times, with all of them."""
    for k in range(level - 1, -1, -1):
        batch = ascend(solver.coarse if k else solver, batch, segments(particles, k) + 1)
    return batch


def ascend(solver: Solver, batch: Batch, particles: int) -> Batch:
    """The batch with more particles; a frictionless path that stalls, below or here, starts anew from its curve.

    A path that slid off is only drawn with more particles: it has no answer to refine.
    """
    fine = batch.refined(particles)
    gone = failing(batch) & (batch.status != Status.STALLED)
    stuck = (batch.status == Status.STALLED) & ~np.bool_(solver.friction.none)  # where its slide stopped may be at rest
    held, loose = np.flatnonzero(~failing(batch) | stuck), np.flatnonzero(gone)
    taut = fine.rows(held)
    taut.status[stuck[held]] = Status.STALLED
    solver.relax(taut, resume=True)
    fine.put(held, taut)
    if len(loose):
        fine.status[loose], fine.residual[loose] = batch.status[loose], batch.residual[loose]
        draw(solver, fine, loose)
    lost = np.flatnonzero((failing(fine) | (failing(batch) & ~stuck)) & ~gone)
    if not solver.friction.none:  # the law says how they come to rest: only another slide is an answer
        fine.status[lost] = Status.STALLED
    elif len(lost):
        anew = fresh(fine.starts[lost], particles)
        anew.counters[:] = fine.counters[lost]
        solver.relax(anew, resume=False)
        search(solver, anew)
        fine.put(lost, anew)
    return fine


def draw(solver: Solver, batch: Batch, index: Ints) -> None:
    """Complete paths that have no answer, as they lie, in place; how they ended stays."""
    drawn = batch.rows(index)
    drawn.status[:] = REST  # one that stalled would slide on
    if not solver.friction.none:  # held to where they lie: their anchors may be on another curve
        drawn = drawn._replace(starts=drawn.uv.copy())
        drawn.anchor[:], drawn.mode[:] = np.arange(batch.particles), 0
    replace(solver, iterations=0).relax(drawn, resume=True)
    drawn.status[:], drawn.residual[:] = batch.status[index], batch.residual[index]
    batch.put(index, drawn._replace(starts=batch.starts[index]))
