"""One round of the redesign: the least total change of the control net that meets the demands of the paths, (6.12).

What is minimised is the energy of the change from the surface before all rounds, not of the step from the last one:
iterated to rest, the rounds then end at a least change, and take back what an early round moved too far.

Rows give way softly, at such a cost that they do only where they cannot be met.  Where a bound or what is frozen keeps
the surface below a fibre, a second program finds the least largest shortfall of the rows of `reach`, and the first is
solved again with no row shorter than that: what can be met is met, the rest as far as it goes.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse

from meshwind.core.cast import Bools, Floats
from meshwind.editing.demands import Demands
from meshwind.editing.program import Balls, Program, Solution, minimise
from meshwind.editing.shape_rows import Kept
from meshwind.editing.stencil import bending
from meshwind.surface.surface import Surface

SOFTNESS = 1e-5
"""d of |t|^2 / d, the cost of falling short by t of a row of length 1, with changes and their cost of order 1.

Neighbouring paths lie closer than control points, so that their rows nearly repeat each other.
"""
LEAST_FREE = (0.2, 0.5)
"""Least free share of the length of a row of `reach` and of `press`; others move what is frozen, and are left out."""
ROUGH = 0.02
"""Of the largest gap: what the next round can see to, so that rows left out of a program may be missed by so much."""
THIN = 4
"""Of the chosen rows, those left in a program of a round that is followed by others: neighbours say nearly the same.

The first program on the sample cast takes two fifths of the time with them, and its energy is 6 % less.
"""
MAX_SOLVES = 12
"""Programs of one kind that are solved in a round for rows left unmet."""
SLIGHT = 1e-8
"""Weight of the change's energy where the least shortfall is sought."""
AGAIN = 1.003
"""Of the least shortfall: what may be left when the change is sought; without some room its price has no limit."""
SPARE, LITTLE = 0.1, 1e-4
"""Of what the largest gap is lowered by, and of the gap: no more room than the first, and no less than both."""
FINE = 0.005
"""Of what rows that are left out may be missed by otherwise: what they may be where not all can be met."""
FREE = np.inf
"""Shortfall that may be left where none is limited."""


@dataclass(frozen=True)
class Step:
    """A change (m, 3) of the control points, and by how much it falls short of the fibre at most.

    objective is the energy of the total change in the surface's units squared: dC^T dC of (6.12) plus its bending;
    least: the least that the largest shortfall can be, 0 where all demands are met.
    """

    change: Floats
    objective: float
    shortfall: float
    solution: Solution
    rows: int
    least: float = 0.0


def energy(surface: Surface, fairness: float) -> sparse.csr_array:
    """Energy (3m, 3m) of a change: its square, (6.12), and its bending, equal for waves of length fairness * size.

    Without bending, control points between the paths stay behind, and a filled hollow is wrinkled.
    """
    points = surface.control_points.size // 3
    total = sparse.eye_array(points)
    if fairness > 0:
        total = total + bending(surface) * (fairness * surface.size / (2 * np.pi)) ** 4
    return sparse.csr_array(sparse.kron(total, sparse.eye_array(3)))


@dataclass(frozen=True)
class Limits:
    """What a change may be.

    moves (3m, r): span the allowed moves; moved (m, 3): displacements of the control points so far; bound (m,): largest
    total displacement of each, infinite where there is none; kept: rows that every change keeps; near: largest change
    of a control point in this round.
    """

    moves: sparse.csr_array
    moved: Floats
    bound: Floats
    kept: Kept
    near: float = np.inf

    def balls(self, unit: float) -> Balls | None:
        """The balls of the control points that may move, by the moves over `unit`; None where nothing bounds them."""
        free = np.diff(self.moves.indptr).reshape(-1, 3).any(axis=1)
        bounded = np.flatnonzero(free & np.isfinite(self.bound))
        near = np.flatnonzero(free & np.isfinite(self.near))
        which = np.append(bounded, near)
        if not len(which):
            return None
        rows = (3 * which[:, None] + np.arange(3)).ravel()
        centre = np.append(self.moved[bounded].ravel(), np.zeros(3 * len(near)))
        radius = np.append(self.bound[bounded], np.full(len(near), self.near))
        return Balls(self.moves[rows], centre / unit, radius / unit)


@dataclass(frozen=True)
class Demanded:
    """What a round demands; cost (3m, 3m): from `energy`; margin: distance beyond the fibre for a row of length 1.

    total: whether the total change is to be the least, or only that of the round.
    """

    reach: Demands
    press: Demands
    cost: sparse.csr_array
    limits: Limits
    margin: float
    total: bool = True


def step(demanded: Demanded, short: bool = False, early: bool = False) -> Step:
    """The change that a round makes.

    short: the last round found demands that cannot all be met; early: others follow, and this one need not be exact.
    """
    rough = max(demanded.margin, ROUGH * float(demanded.reach.least.max(initial=0.0)))
    if not demanded.total:
        demanded = replace(demanded, margin=rough)
    if not short:
        found = _solved(_thinned(demanded) if early else demanded, FREE)
        if found.shortfall <= rough:
            return found
    least = _solved(demanded, 0.0).shortfall
    if short and least <= rough:
        return _solved(demanded, FREE)
    now = float((demanded.reach.least / demanded.reach.part).max())
    room = min((AGAIN - 1.0) * least, SPARE * max(now - least, LITTLE * least))
    return replace(_solved(demanded, least + room), least=least)


def _thinned(demanded: Demanded) -> Demanded:
    """The same with fewer rows."""
    return replace(demanded, reach=demanded.reach.thinned(THIN), press=demanded.press.thinned(THIN))


def _solved(demanded: Demanded, most: float) -> Step:
    """The change with no row of `reach` further short than `most`; with 0, that with the least largest shortfall."""
    reach, limits = demanded.reach, demanded.limits
    rough = max(demanded.margin, ROUGH * float(reach.least.max(initial=0.0)))
    kept, solves = reach.chosen | reach.short if most < FREE else reach.chosen.copy(), 0
    rough *= FINE if most < FREE else 1.0
    while True:
        solves += 1
        rows = rows_of(demanded, kept, LEAST_FREE if most == FREE else (LITTLE, LEAST_FREE[1]))
        solution = minimise(levelled(rows) if most == 0.0 else soft(rows, most))
        change = limits.moves @ (solution.x[: limits.moves.shape[1]] * rows.unit)
        missed = (reach.least - reach.matrix @ change) / reach.part
        total = limits.moved.ravel() + change
        found = Step(
            change.reshape(-1, 3), float(total @ (demanded.cost @ total)), max(0.0, float(missed.max(initial=0.0))),
            solution, len(rows.least),
        )  # fmt: skip
        largest = max(0.0, float(missed[kept].max(initial=0.0)))
        more: Bools = (missed > largest + rough) & ~kept
        if solves >= MAX_SOLVES or not more.any():
            return found
        kept = kept | more


@dataclass(frozen=True)
class Rows:
    """The rows of a program, scaled to length 1, and what is common to its forms.

    free (k, r): by the moves; least (k,): what they must be at least, and beyond it (k,), over `unit`; reaching: number
    of the rows of `reach`, which come first; length (k,): that they had; part (k,): as in `Demands`; cost (r, r) and
    slope (r,): of the moves; hard, hard_least: rows that do not give way.
    """

    free: sparse.csr_array
    least: Floats
    beyond: Floats
    reaching: int
    length: Floats
    part: Floats
    cost: sparse.csr_array
    slope: Floats
    balls: Balls | None
    unit: float
    hard: sparse.csr_array
    hard_least: Floats


def rows_of(demanded: Demanded, kept: Bools, least_free: tuple[float, float] = LEAST_FREE) -> Rows:
    """The rows `kept` of reach and the chosen ones of press, of which so much is free."""
    reach, press, limits, margin = demanded.reach, demanded.press, demanded.limits, demanded.margin
    moves, pressing = limits.moves, press.chosen
    rows = sparse.vstack([reach.matrix[kept], press.matrix[pressing]]).tocsr()
    least = np.concatenate([reach.least[kept], press.least[pressing]])
    beyond = np.concatenate([np.full(int(kept.sum()), margin), np.zeros(int(pressing.sum()))])
    free = sparse.csr_array(rows @ moves)
    may_move = np.diff(moves.indptr) > 0  # symmetry shortens a row as well, but a shortened row can still be met
    length, free_length = _lengths(rows), _lengths(rows * may_move)
    first = int(kept.sum())
    usable = free_length > np.where(np.arange(len(length)) < first, *least_free) * length
    free, least, beyond, length = free[usable], least[usable], beyond[usable], length[usable]
    part = np.concatenate([reach.part[kept], press.part[pressing]])[usable]
    unit = max(float(reach.least.max(initial=margin)), float(np.abs(limits.moved).max(initial=0.0)))
    cost = moves.T @ demanded.cost @ moves
    mean = float(cost.diagonal().mean())
    slope = moves.T @ (demanded.cost @ limits.moved.ravel()) / (unit * mean) * demanded.total
    return Rows(
        sparse.diags_array(1.0 / length) @ free, least / length / unit, beyond / unit, int(usable[:first].sum()),
        length, part, cost / mean, slope, limits.balls(unit), unit, *_hard(limits, unit),
    )  # fmt: skip


def _hard(limits: Limits, unit: float) -> tuple[sparse.csr_array, Floats]:
    """The rows that are kept, by the moves and scaled to length 1, and what they must be at least, over `unit`."""
    free = sparse.csr_array(limits.kept.matrix @ limits.moves)
    size = _lengths(free)
    some = size > 0.0  # of what cannot move nothing is asked
    return sparse.csr_array(sparse.diags_array(1.0 / size[some]) @ free[some]), limits.kept.least[some] / size[
        some
    ] / unit


def soft(rows: Rows, most: float = FREE) -> Program:
    """The program of least change, its unknowns the moves and the t by which rows fall short.

    With a limit, rows of reach may be short by up to `most`, and t counts there in lengths, not in rows of length 1:
    near its ends a bridge has short rows, which would outweigh the others.  Then t is large, and what is minimised is
    scaled for its price to be of order 1: half the steps lead to a thousandth of the residual.
    """
    count, n, size = len(rows.least), rows.reaching, rows.cost.shape[0]
    low, limits = rows.least + rows.beyond, sparse.csr_array((0, size + count))
    weight, price = 1.0, np.full(count, 1.0 / SOFTNESS)
    if most < FREE:
        weight, price = SOFTNESS, np.append(rows.length[:n] ** 2, np.ones(count - n))
        limits = sparse.csr_array((-np.ones(n), (np.arange(n), size + np.arange(n))), shape=(n, size + count))
        low = np.append(low, -(rows.beyond[:n] + most * rows.part[:n] / rows.unit / rows.length[:n]))
    A = sparse.vstack([sparse.hstack([rows.free, sparse.eye_array(count)]), limits, _padded_rows(rows.hard, count)])
    low = np.append(low, rows.hard_least)
    P = sparse.block_diag([weight * rows.cost, sparse.diags_array(price)])
    q = np.append(weight * rows.slope, np.zeros(count))
    return Program(sparse.csc_array(P), q, sparse.csc_array(A), low, _padded(rows.balls, count))


def levelled(rows: Rows) -> Program:
    """That of the least largest shortfall, the last of its unknowns beside the moves."""
    n = rows.reaching
    P = sparse.block_diag([SLIGHT * rows.cost, sparse.eye_array(1)])
    A = sparse.hstack([rows.free[:n], sparse.csr_array((rows.part / rows.length)[:n, None])])
    A, low = sparse.vstack([A, _padded_rows(rows.hard, 1)]), np.append(rows.least[:n], rows.hard_least)
    q = np.append(SLIGHT * rows.slope, 0.0)
    return Program(sparse.csc_array(P), q, sparse.csc_array(A), low, _padded(rows.balls, 1))


def _padded(balls: Balls | None, more: int) -> Balls | None:
    """Balls of a program with so many more unknowns."""
    if balls is None:
        return None
    return Balls(_padded_rows(balls.matrix, more), balls.centre, balls.radius)


def _padded_rows(rows: sparse.csr_array, more: int) -> sparse.csr_array:
    """Rows with so many more unknowns, which they do not hold."""
    return sparse.csr_array(sparse.hstack([rows, sparse.csr_array((rows.shape[0], more))]))


def _lengths(rows: sparse.csr_array) -> Floats:
    return np.asarray(np.sqrt(rows.multiply(rows).sum(axis=1))).ravel()
