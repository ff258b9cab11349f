"""Other ways to an equilibrium without friction, for paths that a direct start misses."""

import numpy as np

from meshwind.core.cast import Bools
from meshwind.path.batch import Batch, fresh, resampled
from meshwind.path.kernels.status import Status
from meshwind.path.solver import Solver

REST, CUT = int(Status.CONVERGED), int(Status.TOO_COARSE)
SHARES = 8
"""Steps in which the turn of a path that slides off is built up."""


def failing(batch: Batch) -> Bools:
    """Which paths are not at rest; one that cuts an edge is."""
    return np.asarray((batch.status != REST) & (batch.status != CUT))


def search(solver: Solver, batch: Batch) -> None:
    """Look for equilibria that a direct start missed: try frictionless paths not at rest in other ways, in place."""
    for start in (from_few, from_back, wind_up, wind_back):
        index = np.flatnonzero(failing(batch) & ~solver.dear(batch))
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
        open_ = np.flatnonzero((share < 1.0) & (step >= 1.0 / (8 * SHARES)) & ~solver.dear(work))
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
