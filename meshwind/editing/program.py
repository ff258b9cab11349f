"""A convex quadratic program by OSQP, with its certificate of optimality."""

from dataclasses import dataclass, replace

import numpy as np
import osqp
from scipy import sparse

from meshwind.core.cast import Floats

ACCURACY = 1e-6
"""Largest KKT residual that counts as solved, for data of order 1."""
TOLERANCES = (1e-4, 1e-5, ACCURACY, 3e-7)
"""OSQP's own tolerances in turn: its polishing solves to round-off as soon as it has identified the active rows."""
MAX_ITERATIONS = 10_000


@dataclass(frozen=True)
class Solution:
    """The minimiser x (n,), the rows' multipliers (k,), the objective, and the KKT residuals.

    primal: largest violation of a row; dual: largest entry of P x + A^T y, or of a multiplier times the distance to
    its bound.
    """

    x: Floats
    multipliers: Floats
    objective: float
    primal: float
    dual: float
    iterations: int

    @property
    def solved(self) -> bool:
        """Whether the residuals are small enough."""
        return max(self.primal, self.dual) <= ACCURACY


def minimise(P: sparse.csc_array, A: sparse.csc_array, low: Floats, high: Floats) -> Solution:
    """Minimise x^T P x / 2 subject to low <= A x <= high, with P positive definite; bounds may be infinite.

    The tolerance is lowered until the certificate shows it solved; the best solution found otherwise.
    """
    if (low <= 0.0).all() and (
        high >= 0.0
    ).all():  # no row is active at the minimum, of which OSQP would print a message
        return certified(P, A, low, high, np.zeros(P.shape[0]), np.zeros(A.shape[0]), 0)
    solver = osqp.OSQP()
    solver.setup(
        sparse.csc_matrix(sparse.triu(P)), np.zeros(P.shape[0]), sparse.csc_matrix(A), low, high, verbose=False,
        polishing=True, scaling=0, rho=1.0, alpha=1.7, max_iter=MAX_ITERATIONS, adaptive_rho_interval=50,
    )  # fmt: skip
    found, iterations = None, 0
    for tolerance in TOLERANCES:
        solver.update_settings(eps_abs=tolerance, eps_rel=tolerance)
        answer = solver.solve(raise_error=False)
        iterations += int(answer.info.iter)
        trial = certified(P, A, low, high, np.array(answer.x), np.array(answer.y), iterations)
        if found is None or max(trial.primal, trial.dual) < max(found.primal, found.dual):
            found = trial
        if found.solved:
            break
    assert found is not None  # TOLERANCES is not empty
    return replace(found, iterations=iterations)


def certified(
    P: sparse.csc_array, A: sparse.csc_array, low: Floats, high: Floats, x: Floats, y: Floats, iterations: int
) -> Solution:
    """A point and its multipliers with their KKT residuals; OSQP's signs: y < 0 at a lower bound, y > 0 at an upper."""
    curved, reached = P @ x, A @ x
    primal = max(float(np.max(low - reached, initial=0.0)), float(np.max(reached - high, initial=0.0)))
    with_low, with_high = np.isfinite(low), np.isfinite(high)
    slack_low = np.where(with_low, np.abs(reached - np.where(with_low, low, 0.0)), 1.0)
    slack_high = np.where(with_high, np.abs(reached - np.where(with_high, high, 0.0)), 1.0)
    loose = np.abs(np.minimum(y, 0.0)) * slack_low + np.maximum(y, 0.0) * slack_high
    dual = max(float(np.max(np.abs(curved + A.T @ y), initial=0.0)), float(np.max(loose, initial=0.0)))
    return Solution(x, y, 0.5 * float(x @ curved), primal, dual, iterations)
