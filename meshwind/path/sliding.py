"""A batch under friction: slid to rest on few particles, on more where that decides, then brought to all of them."""

import numpy as np

from meshwind.core.cast import Floats
from meshwind.path.batch import Batch, fresh
from meshwind.path.kernels.lay import turn_of
from meshwind.path.kernels.status import Status
from meshwind.path.levels import ascend, climb, draw, segments
from meshwind.path.solver import Solver

ENOUGH = 360
"""Least number of segments, and as many per turn, of the slide of a fibre that bridges.

Friction just beyond the ends of a bridge decides where it rests, within a few segments: on two parts of many bridges
fibres rested 2.7e-3 of their length away with 96 to 192 segments, and 1.3e-3 with 384, where 1600 agreed with those.
"""


def slide_from_level(solver: Solver, batch: Batch, level: int) -> Batch:
    """Slide a batch to rest from its starting curves, at first with its particles halved `level` times.

    Where a fibre bridges it slides anew with more particles.  More of them also follow a slide that few cannot, and
    fewer one over many small dents.
    """
    done = slide_at(solver, batch, level)
    fine = fine_level(batch.starts, batch.particles)
    for way in dict.fromkeys((min(fine, level), level - 1, max(level, 0) + 1)):
        wanting = done.status == Status.STALLED
        if way == fine < level:
            wanting |= ~done.touching.all(axis=1)
        index = np.flatnonzero(wanting)
        if way == level or not len(index):
            continue
        part = batch.rows(index)
        part.counters[:] = done.counters[index]
        again = slide_at(solver, part, way)
        done.counters[index] = again.counters
        better = np.flatnonzero(again.status != Status.STALLED)
        done.put(index[better], again.rows(better))
    lost = np.flatnonzero(done.status == Status.STALLED)
    if len(lost):
        draw(solver, done, lost)
    return done


def slide_at(solver: Solver, batch: Batch, level: int) -> Batch:
    """Slide a batch with its particles halved `level` times, or doubled where that is below 0, then balance all."""
    n = batch.particles
    work = fresh(batch.starts, segments(n, level) + 1)
    work.counters[:] = batch.counters
    held, own = solver.coarse.slide(work)  # the law decides where they rest: there is nothing to search for
    for _ in range(-level):
        work = work.halved()
    done = work.refined(n).curves_sampled()
    done.status[:], done.residual[:] = work.status, work.residual
    slid = work.status != Status.STALLED
    for which, curves in ((own & slid, work.starts), (~own & slid, held)):
        index = np.flatnonzero(which)
        if len(index):
            part = work.rows(index)._replace(starts=np.ascontiguousarray(curves[index]))
            part = climb(solver, part, n, level) if level > 0 else ascend(solver, part, n)
            done.put(index, part.curves_sampled())
    return done


def fine_level(curves: Floats, particles: int) -> int:
    """The level on which fibres that bridge slide from starting curves (p, k, 2)."""
    enough = ENOUGH * max(max(1.0, turn_of(curve)) for curve in curves)
    level = 0
    while segments(particles, level + 1) >= enough:
        level += 1
    while segments(particles, level) < enough:
        level -= 1
    return level
