"""Solution of a net's normal equations: directly while the band is narrow, iteratively where that is cheaper."""

import numpy as np

from meshwind.core.cast import Floats
from meshwind.surface.fitting.banded import band_width, solve_banded
from meshwind.surface.fitting.conjugate_gradients import solve_iteratively

DIRECT = 1e8
"""Products of a banded factorisation (unknowns times the square of its width) up to which it costs less."""
MOST_STEPS = 150
"""Steps of the iteration after which a factorisation is cheaper; nets with data in all their spans take 5 to 60."""


def solve(stencil: Floats, right: Floats, tolerance: Floats, start: Floats | None = None) -> Floats:
    """Solve for nets (nu, nv, m), each of the right sides (nu, nv, m) for itself; see `normal_equations.accumulate`.

    tolerance (m,): reduction of each residual in the preconditioner's norm, where the solution is iterative; start
    (nu, nv, m): nets near the answer, zero by default.
    """
    nu, nv = right.shape[:2]
    if nu * nv * band_width(nu, nv) ** 2 <= DIRECT:
        return solve_banded(stencil, right)
    net = solve_iteratively(stencil, right, tolerance, np.zeros_like(right) if start is None else start, MOST_STEPS)
    return solve_banded(stencil, right) if net is None else net
