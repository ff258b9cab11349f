"""A convex quadratic program by PIQP, a proximal interior point method, with its certificate of optimality."""

from dataclasses import dataclass

import numpy as np
import piqp
from scipy import sparse

from meshwind.core.cast import Floats

ACCURACY = 1e-6
"""Largest KKT residual that counts as solved, for data of order 1."""
TOLERANCE = 1e-9
"""PIQP's own, absolute and relative: its last steps gain two digits each."""


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

    The answer is certified by itself, whatever the solver says of it.
    """
    if (low <= 0.0).all() and (high >= 0.0).all():  # no row is active at the minimum
        return certified(P, A, low, high, np.zeros(P.shape[0]), np.zeros(A.shape[0]), 0)
    solver = piqp.SparseSolver()
    settings = solver.settings
    settings.eps_abs = settings.eps_rel = settings.eps_duality_gap_abs = settings.eps_duality_gap_rel = TOLERANCE
    solver.setup(
        sparse.csc_matrix(P), np.zeros(P.shape[0]), G=sparse.csc_matrix(A), h_l=low, h_u=high
    )  # fmt: skip
    solver.solve()
    found = solver.result
    multipliers = np.array(found.z_u) - np.array(found.z_l)
    return certified(P, A, low, high, np.array(found.x), multipliers, int(found.info.iter))


def certified(
    P: sparse.csc_array, A: sparse.csc_array, low: Floats, high: Floats, x: Floats, y: Floats, iterations: int
) -> Solution:
    """A point and its multipliers with their KKT residuals; y < 0 at a lower bound, y > 0 at an upper."""
    curved, reached = P @ x, A @ x
    primal = max(float(np.max(low - reached, initial=0.0)), float(np.max(reached - high, initial=0.0)))
    with_low, with_high = np.isfinite(low), np.isfinite(high)
    slack_low = np.where(with_low, np.abs(reached - np.where(with_low, low, 0.0)), 1.0)
    slack_high = np.where(with_high, np.abs(reached - np.where(with_high, high, 0.0)), 1.0)
    loose = np.abs(np.minimum(y, 0.0)) * slack_low + np.maximum(y, 0.0) * slack_high
    dual = max(float(np.max(np.abs(curved + A.T @ y), initial=0.0)), float(np.max(loose, initial=0.0)))
    return Solution(x, y, 0.5 * float(x @ curved), primal, dual, iterations)
