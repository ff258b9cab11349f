"""Nested iteration: a path is found with few particles, then refined; what fails is tried in other ways.

On every level the answer of the one below is the start, so that the many particles of the last level take a few steps
only.  Which equilibrium a path takes, and whether there is one, is settled on the lowest level.
"""

from dataclasses import replace

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.path.batch import Batch, fresh, resampled
from meshwind.path.kernels.lay import FEWEST, halvings, turn_of
from meshwind.path.length import Laid, Measured, measured
from meshwind.path.paths import Status
from meshwind.path.solver import Solver

REST, CUT = int(Status.CONVERGED), int(Status.TOO_COARSE)
MOST = 6401
"""Particles of the highest level where their number is left open."""
FINER = 3
"""Number of times that particles are doubled for paths that cut an edge."""
A_RADIAN = 4.0, 16.0
"""Particles that a turn by a radian is worth where few of them have to follow a fibre: it is tried in this order."""
SHARES = 8
"""Steps in which the turn of a path that slides off is built up."""


def solve_nested(solver: Solver, curves: Floats, particles: int | None, accuracy: float) -> Batch:
    """Bring paths to rest from their starting curves (p, k, 2), with `particles` or as many as `accuracy` needs."""
    if particles is None:
        return choose(solver, curves, accuracy)
    batch = solve_with(solver, curves, particles)
    if not solver.friction.none:
        slide_finer(solver, batch, curves)
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
        rest = np.flatnonzero(failing(batch))
    levels = np.array([halvings(curve, particles) for curve in curves[rest]], np.int64)
    for level in np.unique(levels):
        index = rest[levels == level]
        batch.put(index, solve_from_level(solver, batch.rows(index)._replace(starts=curves[index]), int(level)))
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
        if solver.friction.none:
            fine = ascend(solver, fine, 2 * fine.particles - 1)
        else:  # the law says how they come to rest
            before = fine.counters
            fine = solve_with(solver, curves[index], 2 * fine.particles - 1)
            fine.counters[:] += before
        few = follow(solver, fine, n)
        batch.counters[index] = fine.counters[:] = few.counters
        gone = failing(fine) & (fine.status != Status.STALLED)
        done = gone | (few.status == REST)
        batch.put(index[done], few.rows(np.flatnonzero(done)))
        index, fine = index[~done], fine.rows(np.flatnonzero(~done))


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


def slide_finer(solver: Solver, batch: Batch, curves: Floats) -> None:
    """Slide paths that stall with twice the particles, and leave them every second, in place."""
    index = np.flatnonzero(batch.status == Status.STALLED)
    if not len(index):
        return
    fine = solve_with(solver, curves[index], 2 * batch.particles - 1)
    few = fine.halved()
    few.counters[:] += batch.counters[index]
    rest, gone = fine.status == REST, failing(fine) & (fine.status != Status.STALLED)
    taut = few.rows(np.flatnonzero(rest))
    solver.relax(taut, resume=True)
    few.put(np.flatnonzero(rest), taut)
    done = (rest & (few.status == REST)) | gone
    batch.counters[index] = few.counters
    batch.put(index[done], few.rows(np.flatnonzero(done)))


def solve_from_level(solver: Solver, batch: Batch, level: int, last: bool = False) -> Batch:
    """Solve a batch anew, at first with its particles halved `level` times; try again what stalls, unless `last`."""
    n = batch.particles
    work = fresh(batch.starts, ((n - 1) >> level) + 1)
    work.counters[:] = batch.counters
    first = solver.coarse if level else solver
    if solver.friction.none:
        first.relax(work, resume=False)
        search(first, work)
        return climb(solver, work, n, level)
    held, own = first.slide(work)  # the law decides where they rest: there is nothing to search for
    done = work.refined(n).curves_sampled()
    done.status[:], done.residual[:] = work.status, work.residual
    slid = work.status != Status.STALLED
    for which, curves in ((own & slid, work.starts), (~own & slid, held)):
        index = np.flatnonzero(which)
        if len(index):
            part = work.rows(index)._replace(starts=curves[index])
            part = climb(solver, part, n, level) if level else ascend(solver, part, n)
            done.put(index, part.curves_sampled())
    lost = np.flatnonzero(done.status == Status.STALLED)
    if len(lost) and not last:  # more particles follow a slide that few cannot, and few one over many small dents
        again = batch.rows(lost)
        again.counters[:] = done.counters[lost]
        done.put(lost, solve_from_level(solver, again, level - 1 if level else 1, last=not level).curves_sampled())
    elif len(lost):
        draw(solver, done, lost)
    return done


def climb(solver: Solver, batch: Batch, particles: int, level: int) -> Batch:
    """The batch, from the answer with the particles halved `level` times, with all of them."""
    for k in range(level - 1, -1, -1):
        batch = ascend(solver.coarse if k else solver, batch, ((particles - 1) >> k) + 1)
    return batch


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


def failing(batch: Batch) -> Bools:
    """Which paths are not at rest; one that cuts an edge is."""
    return np.asarray((batch.status != REST) & (batch.status != CUT))


def search(solver: Solver, batch: Batch) -> None:
    """Look for equilibria that a direct start missed: try frictionless paths not at rest in other ways, in place."""
    for start in (from_few, from_back, wind_up, wind_back):
        index = np.flatnonzero(failing(batch))
        if len(index):
            work = start(solver, batch.rows(index))
            batch.counters[index] = work.counters
            done = np.flatnonzero(~failing(work))
            batch.put(index[done], work.rows(done))


def from_few(solver: Solver, part: Batch) -> Batch:
    """Try again from the answer with half the particles, to which small dents are nothing."""
    n = part.particles
    few = fresh(part.starts, (n - 1) // 2 + 1)
    few.counters[:] = part.counters
    solver.coarse.relax(few, resume=False)
    work = few.refined(n)
    found = np.flatnonzero(~failing(few))
    taut = work.rows(found)
    solver.relax(taut, resume=True)
    work.status[:] = few.status
    work.put(found, taut)
    return work


def from_back(solver: Solver, part: Batch) -> Batch:
    """Try again with start and end exchanged: what a search meets first can decide where it ends."""
    work = part.reversed()
    solver.relax(work, resume=False)
    return work.reversed()


def wind_up(solver: Solver, part: Batch) -> Batch:
    """Build up the paths' turn in steps, each from the answer of the one before, as far as they hold.

    Those that do not hold at full turn have no CONVERGED status.
    """
    n = part.particles
    count = part.paths
    turn = part.starts[:, -1, 0] - part.starts[:, 0, 0]
    ramp = np.linspace(0.0, 1.0, n)[None, :]
    share = np.zeros(count)
    goal = np.full(count, 1.0 / SHARES)
    work = fresh(part.starts, n)
    work.uv[:] = resampled(part.starts, n)
    work.uv[:, :, 0] -= turn[:, None] * ramp * (1.0 - goal)[:, None]
    work.counters[:] = part.counters
    best = work.rows(np.arange(count))
    best.status[:] = Status.STALLED
    step = np.full(count, 1.0 / SHARES)
    first = np.ones(count, np.bool_)
    for _ in range(3 * SHARES):
        open_ = np.flatnonzero((share < 1.0) & (step >= 1.0 / (8 * SHARES)))
        if not len(open_):
            break
        trial = best.rows(open_)
        change = (goal - share)[open_] if not first.any() else (goal - 1.0 / SHARES)[open_]
        shift = turn[open_, None] * ramp * change[:, None]
        trial.uv[:, :, 0] += shift
        trial.touching[:] = True  # from the surface again: a lifted part may not carry over
        trial.counters[:] = work.counters[open_]
        solver.relax(trial, resume=True)
        work.counters[open_] = trial.counters
        held = trial.status == Status.CONVERGED
        kept = open_[held]
        best.put(kept, trial.rows(np.flatnonzero(held)))
        share[kept] = goal[kept]
        lost = open_[~held]
        step[lost] *= 0.5
        first[:] = False
        never = lost[share[lost] == 0.0]
        step[never] = 0.0  # not even the first step holds
        goal = np.minimum(share + step, 1.0)
    best.status[share < 1.0] = part.status[share < 1.0]
    best.counters[:] = work.counters
    return best


def wind_back(solver: Solver, part: Batch) -> Batch:
    """As `wind_up`, with the start turning and the end held: on a part that is not round the way there differs."""
    return wind_up(solver, part.reversed()).reversed()
