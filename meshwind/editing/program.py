"""A convex quadratic program with balls by Clarabel, an interior point method, with its certificate of optimality."""

from dataclasses import dataclass

import clarabel
import numpy as np
from scipy import sparse

from meshwind.core.cast import Bools, Floats, Ints

ACCURACY = 1e-6
"""Largest KKT residual that counts as solved, for data of order 1."""
TOLERANCE = 1e-9
"""Clarabel's own, absolute and relative: its last steps gain two digits each."""
FEW = 0.05
"""Share of the rows violated without a change, below which the program is tried with those alone: where a small change
is enough, a third of the time."""
PASSES = 4
"""Such programs, each with the rows that the last one violated; with those that it takes, most come to the end in 3."""
VIOLATED = 1e-8
"""By how much, for rows of length 1."""


@dataclass(frozen=True)
class Balls:
    """|centre + matrix x| <= radius for every three rows of the matrix (3c, n), with centre (3c,) and radius (c,)."""

    matrix: sparse.csr_array
    centre: Floats
    radius: Floats

    def at(self, x: Floats) -> Floats:
        """The vectors (c, 3) at x."""
        return np.asarray((self.centre + self.matrix @ x).reshape(-1, 3))


@dataclass(frozen=True)
class Program:
    """min x^T P x / 2 + q^T x subject to A x >= low and balls; P (n, n) is positive definite, low may be infinite."""

    P: sparse.csc_array
    q: Floats
    A: sparse.csc_array
    low: Floats
    balls: Balls | None = None


@dataclass(frozen=True)
class Solution:
    """The minimiser x (n,), the rows' multipliers (k,) and the balls' (c,), the objective, and the KKT residuals.

    primal: largest violation of a row or ball; dual: largest entry of the gradient of the Lagrangian, or of a
    multiplier times the distance to its bound.  No multiplier is negative.
    """

    x: Floats
    multipliers: Floats
    pulls: Floats
    objective: float
    primal: float
    dual: float
    iterations: int

    @property
    def solved(self) -> bool:
        """Whether the residuals are within `ACCURACY`."""
        return max(self.primal, self.dual) <= ACCURACY


def minimise(program: Program) -> Solution:
    """Solve a program; the answer is certified by itself, whatever the solver says of it."""
    rows, size = program.A.shape
    balls = program.balls or Balls(sparse.csr_array((0, size)), np.zeros(0), np.zeros(0))
    count = len(balls.radius)
    still = np.zeros(size)
    inside = (np.linalg.norm(balls.at(still), axis=1) < balls.radius).all()
    if (program.low <= 0.0).all() and not program.q.any() and inside:
        return certified(program, still, np.zeros(rows), np.zeros(count), 0)  # no row is active at the minimum
    violated: Bools = program.low > 0.0
    if violated.sum() < FEW * rows:
        found = _with_few(program, balls, violated)
        if found is not None:
            return found
    found = certified(program, *_solved(program, balls, np.arange(rows)))
    return found if found.solved else certified(program, *_solved(program, balls, np.arange(rows), refined=True))


def _with_few(program: Program, balls: Balls, violated: Bools) -> Solution | None:
    """The solution found with few of the rows, which violates none of the others; None where that takes too long."""
    kept, steps = violated, 0
    for _ in range(PASSES):
        x, multipliers, pulls, iterations = _solved(program, balls, np.flatnonzero(kept))
        steps += iterations
        more: Bools = (program.low - program.A @ x > VIOLATED) & ~kept
        if not more.any():
            return certified(program, x, multipliers, pulls, steps)
        kept = more | (kept if steps > iterations else multipliers > VIOLATED * multipliers.max(initial=0.0))
    return None


def _solved(program: Program, balls: Balls, kept: Ints, refined: bool = False) -> tuple[Floats, Floats, Floats, int]:
    """The minimiser with the rows of numbers `kept` alone, the multipliers of rows and balls, and the iterations.

    refined: whether the linear systems of its steps are refined, at a sixth of the time; the certificate says whether
    that is needed.
    """
    count = len(balls.radius)
    below = np.arange(4 * count).reshape(-1, 4)[:, 1:].ravel()  # a cone's first entry is the radius
    place = sparse.csr_array((-np.ones(3 * count), (below, np.arange(3 * count))), shape=(4 * count, 3 * count))
    cone = np.concatenate([balls.radius[:, None], balls.centre.reshape(-1, 3)], axis=1).ravel()
    A = sparse.csc_array(sparse.vstack([-program.A.tocsr()[kept], place @ balls.matrix]))
    some = (np.diff(A.indptr) > 0) | (np.diff(program.P.indptr) > 1) | (program.q != 0.0)  # the others are 0
    solver = clarabel.DefaultSolver(
        sparse.csc_matrix(sparse.triu(program.P[some][:, some])),
        program.q[some],
        sparse.csc_matrix(A[:, some]),
        np.concatenate([-program.low[kept], cone]),
        [clarabel.NonnegativeConeT(len(kept)), *[clarabel.SecondOrderConeT(4)] * count],
        _settings(refined),
    )
    found = solver.solve()
    x, multipliers, dual = np.zeros(len(some)), np.zeros(len(program.low)), np.array(found.z)
    x[some], multipliers[kept] = found.x, dual[: len(kept)]
    return x, multipliers, dual[len(kept) :: 4], int(found.iterations)


def _settings(refined: bool) -> clarabel.DefaultSettings:
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.direct_solve_method = "faer"  # supernodal: three to four times as fast as the default here
    settings.max_threads = 1  # two take longer
    settings.iterative_refinement_enable = refined
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = TOLERANCE
    return settings


def certified(program: Program, x: Floats, multipliers: Floats, pulls: Floats, iterations: int) -> Solution:
    """A point and its multipliers, of the rows (k,) and of the balls (c,), with their KKT residuals."""
    reached, low = program.A @ x, program.low
    limited = np.isfinite(low)
    beyond = np.where(limited, reached - np.where(limited, low, 0.0), 1.0)
    y = np.maximum(multipliers, 0.0)
    gradient = program.P @ x + program.q - program.A.T @ y
    primal, loose = float(np.max(-beyond, initial=0.0)), float(np.max(y * np.abs(beyond), initial=0.0))
    w = np.maximum(pulls, 0.0)
    if program.balls is not None:
        vectors = program.balls.at(x)
        far = np.linalg.norm(vectors, axis=1)
        inside = program.balls.radius - far
        outward = vectors / np.maximum(far, 1e-300)[:, None]
        gradient = gradient + program.balls.matrix.T @ (w[:, None] * outward).ravel()
        primal = max(primal, float(np.max(-inside, initial=0.0)))
        loose = max(loose, float(np.max(w * np.abs(inside), initial=0.0)))
    scale = max(1.0, float(np.max(y, initial=0.0)), float(np.max(w, initial=0.0)))
    dual = max(float(np.max(np.abs(gradient), initial=0.0)), loose) / scale
    objective = float(x @ (0.5 * (program.P @ x) + program.q))
    return Solution(x, y, w, objective, primal, dual, iterations)
