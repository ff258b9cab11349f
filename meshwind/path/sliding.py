"""A batch under friction: slid to rest on few particles, on more where that decides, then brought to all of them."""

import numpy as np

from meshwind.core.cast import Bools, Floats
from meshwind.core.vectors import dots
from meshwind.path.batch import Batch, fresh, resampled
from meshwind.path.kernels.lay import turn_of
from meshwind.path.kernels.status import Status
from meshwind.path.levels import ascend, climb, draw, segments
from meshwind.path.solver import Solver
from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV

ENOUGH = 250
"""Least number of segments, and as many per turn, of the slide of a fibre that bridges.

Friction just beyond the ends of a bridge decides where it rests, within a few segments: on two parts of many bridges
fibres rested 2.7e-3 of their length away with 96 to 192 segments, and 1.3e-3 with 384, where 1600 agreed with those.
"""


def slide_from_level(solver: Solver, batch: Batch, level: int) -> Batch:
    """Slide a batch to rest from its starting curves, with its particles halved `level` times, or more if it bridges.

    Each path slides as it would alone: what becomes of it does not depend on how far the others turn.  Whether it holds
    is settled by few particles, and only where its answer is final is one that bridges slid with more.
    """
    done = batch.curves_sampled().copied()
    levels = np.full(batch.paths, level)
    if solver.final:
        levels = np.array([min(fine_level(curve, batch.particles), level) for curve in batch.starts], np.int64)
    for fine in np.unique(levels):
        index = np.flatnonzero(levels == fine)
        done.put(index, _slide(solver, batch.rows(index), level, int(fine)))
    return done


def _slide(solver: Solver, batch: Batch, level: int, fine: int) -> Batch:
    """Slide a batch to rest, with its particles halved `level` times, or `fine` times where it bridges.

    More of them also follow a slide that few cannot, and fewer one over many small dents.
    """
    slides = _Slides(solver, batch)
    hollow = crosses_hollows(solver, batch.starts, segments(batch.particles, level) + 1)
    slides.attempt(hollow, fine)
    slides.attempt(slides.stalled if fine < level else ~slides.tried, level)
    if fine < level:
        slides.attempt(~hollow & (slides.stalled | ~slides.done.touching.all(axis=1)), fine)
    if fine != level - 1:
        slides.attempt(slides.stalled, level - 1)
    slides.attempt(slides.stalled, max(level, 0) + 1)
    lost = np.flatnonzero(slides.stalled)
    if len(lost):
        draw(solver, slides.done, lost)
    return slides.done


class _Slides:
    """Slides of a batch on several levels: the last answer of each path, and which have been tried."""

    def __init__(self, solver: Solver, batch: Batch) -> None:
        self.solver, self.batch = solver, batch
        self.done = batch.curves_sampled().copied()
        self.done.status[:] = Status.STALLED
        self.tried = np.zeros(batch.paths, np.bool_)

    @property
    def stalled(self) -> Bools:
        """Which paths (p,) have no answer."""
        return np.asarray(self.done.status == Status.STALLED)

    def attempt(self, which: Bools, level: int) -> None:
        """Slide some of the paths, with their particles halved `level` times; keep what comes to an end."""
        index = np.flatnonzero(which)
        if not len(index):
            return
        part = self.batch.rows(index)
        part.counters[:] = self.done.counters[index]
        again = slide_at(self.solver, part, level)
        self.done.counters[index] = again.counters
        better = np.flatnonzero((again.status != Status.STALLED) | ~self.tried[index])
        self.done.put(index[better], again.rows(better))
        self.tried[index] = True


def crosses_hollows(solver: Solver, curves: Floats, count: int) -> Bools:
    """Which starting curves (p, k, 2) bend away from the part at one of so many points: there a fibre lifts off."""
    if not solver.bridging:
        return np.zeros(len(curves), np.bool_)
    points = resampled(curves, count)
    frames = solver.surface.frames(points.reshape(-1, 2)).reshape(*points.shape[:2], 6, 3)
    way = np.gradient(points, axis=1)
    p, q = way[..., :1], way[..., 1:]
    bend = p * p * frames[:, :, SUU] + 2.0 * p * q * frames[:, :, SUV] + q * q * frames[:, :, SVV]
    return np.asarray((dots(bend, np.cross(frames[:, :, SU], frames[:, :, SV])) > 0.0).any(axis=1))


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


def fine_level(curve: Floats, particles: int) -> int:
    """The level on which a fibre that bridges slides from its starting curve (k, 2)."""
    enough = ENOUGH * max(1.0, turn_of(curve))
    level = 0
    while segments(particles, level + 1) >= enough:
        level += 1
    while segments(particles, level) < enough:
        level -= 1
    return level
