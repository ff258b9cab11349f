"""Solution of sparse Laplace equations in linear time: conjugate gradients that algebraic multigrid preconditions.

A level joins neighbours into aggregates and takes a smoothed step of each as its coarse functions [1]_, so that only
the matrix is needed, whatever the mesh.  The iteration takes some 20 steps whatever the number of unknowns, where the
time of a factorisation grows with the power 1.5 and its memory faster than the mesh.

References
----------
.. [1] P. Vanek, J. Mandel, M. Brezina, "Algebraic multigrid by smoothed aggregation for second and fourth order
   elliptic problems", Computing 56, 1996.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from meshwind.core.cast import Floats, Ints
from meshwind.core.kernel import njit

COARSEST = 200
"""Unknowns up to which a level is factored as a dense matrix."""
LEAST_COARSENING = 0.7
"""Share of the unknowns that the next level may have at most; a level that joins fewer is the last."""
STRONG = 0.06
"""Least strength of a neighbour that is joined: the entry over the root of both diagonal ones; halved at each level."""
DAMPING = 2 / 3
"""Step of the Jacobi iteration that smooths the aggregates: 4/3 over 2, about the largest eigenvalue of D^-1 A."""
_MOST_LEVELS = 20


def solve_laplace(
    matrix: sparse.csr_array, right: Floats, start: Floats, tolerance: float, steps: int
) -> Floats | None:
    """Solve matrix x = right for x (n,) from a start; the matrix is symmetric and definite, most rows sum to about 0.

    tolerance: reduction of the residual against the right side, in the preconditioner's norm.  None if so many steps do
    not suffice, or if the matrix is not definite.
    """
    inverse = Multigrid.of(matrix)
    if inverse is None:
        return None
    enough = tolerance**2 * _dot(right, inverse.solve(right))
    x, rest = start.copy(), right - matrix @ start
    ahead = inverse.solve(rest)
    way, size = ahead.copy(), _dot(rest, ahead)
    for _ in range(steps):
        if size <= enough:
            return x
        image = matrix @ way
        step = size / _dot(way, image)
        if not step > 0:
            return None
        _add(way, step, x)
        _add(image, -step, rest)
        ahead = inverse.solve(rest)
        before, size = size, _dot(rest, ahead)
        way *= size / before
        way += ahead
    return None


@njit(nogil=True, cache=True)
def _dot(a: Floats, b: Floats) -> float:
    """The product, on one thread: those of BLAS would spin between two of them."""
    total = 0.0
    for i in range(len(a)):
        total += a[i] * b[i]
    return total


@njit(nogil=True, cache=True)
def _add(a: Floats, factor: float, out: Floats) -> None:
    """Add so many times a to `out`, without an array between them."""
    for i in range(len(a)):
        out[i] += factor * a[i]


@dataclass(frozen=True)
class _Level:
    """A matrix with sorted columns, its diagonal, and the functions of the next level (n, n') with their transpose."""

    matrix: sparse.csr_array
    diagonal: Floats
    coarse: sparse.csr_array
    transposed: sparse.csr_array


@dataclass(frozen=True)
class Multigrid:
    """One symmetric V-cycle as an approximate inverse: levels from fine to coarse, and the factor of the coarsest."""

    levels: tuple[_Level, ...]
    last: tuple[Floats, bool]

    @staticmethod
    def of(matrix: sparse.csr_array) -> Multigrid | None:
        """The levels of a matrix; None if one is not definite, or if the coarsest is too large to factor."""
        levels: list[_Level] = []
        strong = STRONG
        while matrix.shape[0] > COARSEST:
            matrix.sort_indices()
            diagonal = matrix.diagonal()
            if len(levels) == _MOST_LEVELS or not diagonal.min() > 0:
                return None
            groups, count = _aggregates(matrix.indptr, matrix.indices, matrix.data, diagonal, strong)
            if count > LEAST_COARSENING * len(diagonal):
                return None
            coarse = _smoothed(matrix, diagonal, groups, count)
            levels.append(_Level(matrix, diagonal, coarse, coarse.T.tocsr()))
            matrix = (levels[-1].transposed @ (matrix @ coarse)).tocsr()
            strong *= 0.5
        try:
            return Multigrid(tuple(levels), cho_factor(matrix.toarray(), lower=True))
        except (LinAlgError, ValueError):
            return None

    def solve(self, right: Floats) -> Floats:
        """The approximate solution (n,)."""
        return self._cycle(right, 0)

    def _cycle(self, right: Floats, k: int) -> Floats:
        if k == len(self.levels):
            return np.asarray(cho_solve(self.last, right, check_finite=False))
        level = self.levels[k]
        matrix, diagonal = level.matrix, level.diagonal
        x, rest = np.empty_like(right), np.empty_like(right)
        _sweep_from_zero(matrix.indptr, matrix.indices, matrix.data, diagonal, right, x, rest)
        x += level.coarse @ self._cycle(level.transposed @ rest, k + 1)
        _sweep_back(matrix.indptr, matrix.indices, matrix.data, diagonal, right, x)
        return x


def _smoothed(matrix: sparse.csr_array, diagonal: Floats, groups: NDArray[np.int32], count: int) -> sparse.csr_array:
    """Functions (n, count) that are 1 on an aggregate, after a damped step of Jacobi."""
    n = len(diagonal)
    ones = sparse.csr_array((np.ones(n), groups, np.arange(n + 1, dtype=groups.dtype)), shape=(n, count))
    image = (matrix @ ones).tocsr()
    image.data *= np.repeat(-DAMPING / diagonal, np.diff(image.indptr))
    return (ones + image).tocsr()


@njit(forceinline=True, cache=True)
def _is_strong(i: int, j: int, value: float, diagonal: Floats, strong: float) -> bool:
    """Whether an entry (i, j) is strong."""
    return i != j and -value > strong * np.sqrt(diagonal[i] * diagonal[j])


@njit(nogil=True, cache=True)
def _aggregates(
    starts: Ints, columns: Ints, values: Floats, diagonal: Floats, strong: float
) -> tuple[NDArray[np.int32], int]:
    """Number (n,) of the aggregate of each unknown, and how many there are.

    First each unknown whose strong neighbours are all free forms one with them, then those left over join the aggregate
    of their nearest neighbour, and those without one stay together with what is left around them.
    """
    groups, count = _first_aggregates(starts, columns, values, diagonal, strong)
    first = groups.copy()
    for i in range(len(diagonal)):
        if first[i] >= 0:
            continue
        largest = 0.0
        for p in range(starts[i], starts[i + 1]):
            j = columns[p]
            if j != i and first[j] >= 0 and -values[p] > largest:
                largest = -values[p]
                groups[i] = first[j]
    for i in range(len(diagonal)):
        if groups[i] >= 0:
            continue
        groups[i] = count
        for p in range(starts[i], starts[i + 1]):
            if groups[columns[p]] < 0:
                groups[columns[p]] = count
        count += 1
    return groups, count


@njit(nogil=True, cache=True)
def _first_aggregates(
    starts: Ints, columns: Ints, values: Floats, diagonal: Floats, strong: float
) -> tuple[NDArray[np.int32], int]:
    """Number (n,) of the aggregate of each unknown whose strong neighbours are all free, and of these; else -1."""
    groups, count = np.full(len(diagonal), -1, np.int32), 0
    for i in range(len(diagonal)):
        free, joined = groups[i] < 0, False
        for p in range(starts[i], starts[i + 1]):
            if not free:
                break
            if _is_strong(i, columns[p], values[p], diagonal, strong):
                free, joined = groups[columns[p]] < 0, True
        if free and joined:
            groups[i] = count
            for p in range(starts[i], starts[i + 1]):
                if _is_strong(i, columns[p], values[p], diagonal, strong):
                    groups[columns[p]] = count
            count += 1
    return groups, count


@njit(nogil=True, cache=True)
def _sweep_from_zero(
    starts: Ints, columns: Ints, values: Floats, diagonal: Floats, right: Floats, x: Floats, rest: Floats
) -> None:
    """A sweep of Gauss and Seidel from zero, and the residual that it leaves: only the upper triangle adds to it."""
    for i in range(len(x)):
        total = right[i]
        for p in range(starts[i], starts[i + 1]):
            if columns[p] >= i:
                break
            total -= values[p] * x[columns[p]]
        x[i] = total / diagonal[i]
    for i in range(len(x)):
        total = 0.0
        for p in range(starts[i + 1] - 1, starts[i] - 1, -1):
            if columns[p] <= i:
                break
            total -= values[p] * x[columns[p]]
        rest[i] = total


@njit(nogil=True, cache=True)
def _sweep_back(starts: Ints, columns: Ints, values: Floats, diagonal: Floats, right: Floats, x: Floats) -> None:
    """A sweep of Gauss and Seidel in the opposite order, so that the cycle is symmetric."""
    for i in range(len(x) - 1, -1, -1):
        total = right[i]
        for p in range(starts[i], starts[i + 1]):
            total -= values[p] * x[columns[p]]
        x[i] += total / diagonal[i]
