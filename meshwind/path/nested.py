"""Nested iteration: a path is found with few particles, then refined; what fails is tried in other ways.

On every level the answer of the one below is the start, so that the many particles of the last level take a few steps
only.  Which equilibrium a path takes, and whether there is one, is settled on the lowest level.
"""

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.path.batch import Batch, fresh, resampled
from meshwind.path.kernels.lay import FEWEST, halvings, turn_of
from meshwind.path.length import Laid, Measured, measured
from meshwind.path.levels import ascend, climb, segments
from meshwind.path.paths import Status
from meshwind.path.search import CUT, REST, failing, search
from meshwind.path.sliding import slide_from_level
from meshwind.path.solver import Solver

MOST = 6401
"""Particles of the highest level where their number is left open."""
FINER = 3
"""Number of times that particles are doubled for paths that cut an edge."""
A_RADIAN = 4.0, 16.0
"""Particles that a turn by a radian is worth where few of them have to follow a fibre: it is tried in this order."""


def solve_nested(solver: Solver, curves: Floats, particles: int | None, accuracy: float) -> Batch:
    """Bring paths to rest from their starting curves (p, k, 2), with `particles` or as many as `accuracy` needs."""
    if particles is None:
        return choose(solver, curves, accuracy)
    batch = solve_with(solver, curves, particles)
    if np.count_nonzero(batch.status):
        resolve(solver, batch, curves)
    return batch


def solve_with(solver: Solver, curves: Floats, particles: int) -> Batch:
    """Bring paths to rest from their starting curves (p, k, 2), with so many particles, evenly or nearly so."""
    batch = fresh(curves if solver.friction.none else resampled(curves, particles), particles)
    rest = np.arange(len(curves))
    if solver.friction.none:
        solver.solve_simple(batch)
        if not np.count_nonzero(batch.status):
            return batch
        rest = np.flatnonzero(failing(batch) & ~solver.dear(batch))
    solve = solve_from_level if solver.friction.none else slide_from_level
    levels = np.array([halvings(curve, particles) for curve in curves[rest]], np.int64)
    for level in np.unique(levels):
        index = rest[levels == level]
        part = batch.rows(index)._replace(starts=curves[index])
        batch.put(index, solve(solver, part, int(level)))
    return batch


def resolve(solver: Solver, batch: Batch, curves: Floats) -> None:
    """Solve paths that cut an edge with more particles, and leave them those that follow it, in place.

    What has no equilibrium then has none.
    """
    index, n = np.flatnonzero(batch.status == CUT), batch.particles
    if not len(index):
        return
    fine = batch.rows(index)
    for _ in range(FINER):
        if not len(index):
            break
        fine = ascend(solver, fine, 2 * fine.particles - 1)
        if not solver.friction.none:
            fine = fine.curves_sampled()
            slide_anew(solver, fine, curves[index])
        few = follow(solver, fine, n)
        batch.counters[index] = fine.counters[:] = few.counters
        gone = failing(fine) & (fine.status != Status.STALLED)
        done = gone | (few.status == REST)
        batch.put(index[done], few.rows(np.flatnonzero(done)))
        left = ~done if solver.friction.none else ~done & (fine.status != Status.STALLED)  # slid in every way
        index, fine = index[left], fine.rows(np.flatnonzero(left))


def slide_anew(solver: Solver, batch: Batch, curves: Floats) -> None:
    """Slide paths under friction that stalled from their starting curves once more, in place."""
    lost = np.flatnonzero(batch.status == Status.STALLED)
    if len(lost):
        anew = solve_with(solver, curves[lost], batch.particles)
        anew.counters[:] += batch.counters[lost]
        batch.put(lost, anew)


def follow(solver: Solver, fine: Batch, particles: int) -> Batch:
    """Paths with fewer of their particles, brought to equilibrium where they have been at rest."""
    few = thinned(solver, fine, particles, A_RADIAN[0])
    rest = np.flatnonzero(fine.status == REST)
    few.status[rest] = CUT
    for weight in A_RADIAN:
        rest = rest[few.status[rest] != REST]
        if len(rest):
            taut = thinned(solver, fine.rows(rest), particles, weight)
            taut.counters[:] = few.counters[rest]
            solver.relax_as_spaced(taut)
            few.put(rest, taut)
    return few


def thinned(solver: Solver, fine: Batch, particles: int, a_radian: float) -> Batch:
    """Paths with fewer of their particles, as they lie."""
    few = fine.thinned(particles, a_radian)
    return few if solver.friction.none else few.curves_sampled()


def solve_from_level(solver: Solver, batch: Batch, level: int) -> Batch:
    """Solve a batch anew, at first with its particles halved `level` times."""
    n = batch.particles
    work = fresh(batch.starts, segments(n, level) + 1)
    work.counters[:] = batch.counters
    first = solver.coarse if level else solver
    first.relax(work, resume=False)
    search(first, work)
    return climb(solver, work, n, level)


def choose(solver: Solver, curves: Floats, accuracy: float) -> Batch:
    """As `solve_nested`, with particles doubled until the estimated relative error of lengths is below `accuracy`.

    Where the particles do not resolve the body there is no estimate, and they are doubled, too.
    """
    batch = solve_with(solver, curves, int(fewest(curves).max()) + 1)
    now = measure(solver, batch)
    while 2 * batch.particles - 1 <= MOST:
        batch = ascend(solver, batch, 2 * batch.particles - 1)
        before, now = now, measure(solver, batch)
        done = ~failing(batch)
        if (batch.status == CUT).any():
            continue
        # the polyline's error is known from the fibre's own length, as far as that, of higher order, no longer changes
        left = np.abs(now.length - lengths(batch)) + np.abs(now.length - before.length)
        if np.all(np.maximum(left, now.error)[done] <= accuracy * now.length[done]):
            break
    return batch


def measure(solver: Solver, batch: Batch) -> Measured:
    """Length of each path's fibre, and what it may be off by."""
    points = batch.X + solver.surface.middle
    return measured(solver.surface, Laid(points, batch.uv, batch.touching, batch.gap, batch.normal))


def fewest(curves: Floats) -> Ints:
    """Segments of the lowest level of each path (p,): enough for its turn."""
    return np.array([FEWEST * max(1.0, turn_of(curve)) for curve in curves], dtype=np.int64)


def lengths(batch: Batch) -> Floats:
    """Length of each path."""
    return np.asarray(np.linalg.norm(np.diff(batch.X, axis=1), axis=2).sum(axis=1))
