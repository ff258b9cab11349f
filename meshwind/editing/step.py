"""One round of the redesign: the least change of the control net that meets the demands of the paths, (6.12).

The inequalities are elastic: min dC^T (1 + f B) dC + |t|^2 / d subject to M dC + t >= b.  Paths lie closer together
than control points, so that the rows of (6.10) nearly repeat each other; their multipliers are then not unique, unless
the form is elastic.  A row is violated by one or two
hundredths of the largest demand, which the margin compensates; without a solution a row is violated by much more.
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from meshwind.core.cast import Bools, Floats
from meshwind.editing.demands import Demands
from meshwind.editing.freedom import octahedra
from meshwind.editing.program import Solution, minimise
from meshwind.editing.stencil import bending
from meshwind.surface.surface import Surface

ELASTICITY = 3e-2
"""d, with rows of length 1, change of order 1 and demands up to 1."""
LEAST_FREE = (0.05, 0.5)
"""Least free share of the length of a row of `reach` and of `press`; others move what is frozen, and are left out."""
MARGIN = 0.02
"""Distance beyond the fibre over the largest gap: more than a row is violated."""
MAX_SOLVES, MAX_BOUND_SOLVES = 3, 12
"""Programs that are solved in a round for rows that were left unmet, and for control points beyond the bound."""
BOUND_SHARE = 1 - 1e-4
"""Share of the bound that the program is given, so that its error stays within the bound."""


@dataclass(frozen=True)
class Program:
    """min x^T P x / 2 subject to low <= A x <= high; the first columns of x, times `unit`, are the moves."""

    P: sparse.csc_array
    A: sparse.csc_array
    low: Floats
    high: Floats
    unit: float


@dataclass(frozen=True)
class Step:
    """A change (m, 3) of the control points, and by how much it falls short of the fibre at most.

    objective is the change's energy in the surface's units squared: dC^T dC of (6.12) plus its bending.
    """

    change: Floats
    objective: float
    shortfall: float
    solution: Solution
    rows: int


def energy(surface: Surface, fairness: float) -> sparse.csr_array:
    """Energy (3m, 3m) of a change: its square, (6.12), and its bending, equal for waves of length fairness * size.

    Without bending, control points between the paths stay behind, and a filled hollow is wrinkled.
    """
    points = surface.control_points.size // 3
    total = sparse.eye_array(points)
    if fairness > 0:
        total = total + bending(surface) * (fairness * surface.size / (2 * np.pi)) ** 4
    return sparse.csr_array(sparse.kron(total, sparse.eye_array(3)))


def step(
    reach: Demands, press: Demands, cost: sparse.csr_array, moves: sparse.csr_array, moved: Floats,
    bound: float | None, margin: float,
) -> Step:  # fmt: skip
    """Solve (6.12) for the chosen demands, and again with those that are left unmet.

    cost (3m, 3m): from `energy`; moves (3m, r): span the allowed moves; moved (m, 3): displacements of the control
    points so far; bound: largest total displacement; margin: least distance beyond the fibre.
    """
    margin = max(margin, MARGIN * float(reach.least.max(initial=0.0)))
    bounded = np.zeros(len(moved), dtype=bool)
    tips = moved
    kept = reach.chosen.copy()
    solves = 0
    while True:
        solves += 1
        limits = None if bound is None else octahedra(tips, np.flatnonzero(bounded), BOUND_SHARE * bound)
        program = assembled(reach, press, kept, cost, moves, moved, limits, margin)
        solution = minimise(program.P, program.A, program.low, program.high)
        change = moves @ (solution.x[: moves.shape[1]] * program.unit)
        missed = reach.least - reach.matrix @ change
        found = Step(
            change.reshape(-1, 3), float(change @ (cost @ change)), max(0.0, float(missed.max(initial=0.0))),
            solution, program.A.shape[0],
        )  # fmt: skip
        more: Bools = (missed > 0) & ~kept
        over = np.zeros_like(bounded)
        if bound is not None:
            total = moved + found.change
            over = (np.linalg.norm(total, axis=1) > bound) & ~bounded
            tips = np.where(over[:, None], total, tips)
        if solves >= MAX_BOUND_SOLVES or not (over.any() or (more.any() and solves < MAX_SOLVES)):
            return found
        kept, bounded = kept | more, bounded | over


def assembled(
    reach: Demands, press: Demands, kept: Bools, cost: sparse.csr_array, moves: sparse.csr_array, moved: Floats,
    limits: tuple[sparse.csr_array, Floats] | None, margin: float,
) -> Program:  # fmt: skip
    """The elastic program for the rows `kept` of reach and the chosen ones of press, in units of the largest demand."""
    pressing = press.chosen & (press.least > -0.1 * float(press.least.max(initial=0.0)) - 10 * margin)
    rows = sparse.vstack([reach.matrix[kept], press.matrix[pressing]]).tocsr()
    least = np.concatenate([reach.least[kept] + margin, press.least[pressing]])
    free = sparse.csr_array(rows @ moves)
    may_move = np.diff(moves.indptr) > 0  # symmetry shortens a row as well, but a shortened row can still be met
    length, free_length = _lengths(rows), _lengths(rows * may_move)
    first = int(kept.sum())
    usable = free_length > np.where(np.arange(len(length)) < first, *LEAST_FREE) * length
    free, least, length = free[usable], least[usable] / length[usable], length[usable]
    unit = float(np.abs(least).max(initial=margin))
    count, size = free.shape
    scale = sparse.diags_array(1.0 / length)
    parts = [[scale @ free, np.sqrt(ELASTICITY) * sparse.eye_array(count)]]
    low, high = [least / unit], [np.full(count, np.inf)]
    if limits is not None:
        parts.append([limits[0] @ moves, sparse.csr_array((len(limits[1]), count))])
        high.append((limits[1] - limits[0] @ moved.ravel()) / unit)
        low.append(np.full(len(limits[1]), -np.inf))
    own_cost = moves.T @ cost @ moves
    own_cost = own_cost / own_cost.diagonal().mean()
    P = sparse.csc_array(sparse.block_diag([own_cost, sparse.eye_array(count)]))
    A = sparse.csc_array(sparse.block_array(parts))
    return Program(P, A, np.concatenate(low), np.concatenate(high), unit)


def _lengths(rows: sparse.csr_array) -> Floats:
    return np.asarray(np.sqrt(rows.multiply(rows).sum(axis=1))).ravel()
