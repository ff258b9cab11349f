"""Harmonic coordinates of an annulus: the Laplace equations of its edges with given weights."""

from __future__ import annotations

from dataclasses import dataclass

import igl
import numpy as np
from scipy import sparse

from meshwind.chart.multigrid import solve_laplace
from meshwind.core.cast import Floats, Ints
from meshwind.core.threads import side_by_side
from meshwind.mesh.geometry.mesh import Annulus
from meshwind.mesh.geometry.topology import edges

LEAST_WEIGHT = 1e-2
"""Lower bound of positive weights, over the median."""
DIRECT = 20_000
"""Unknowns up to which a factorisation costs no more than the iteration."""
TOLERANCE = 1e-10
"""Reduction of the residual by the iteration: far below what a fit can resolve."""
MOST_STEPS = 100
"""Steps of the iteration after which the matrix is factored; sound meshes take 15 to 30."""


@dataclass(frozen=True)
class EdgeGraph:
    """Undirected edges of the annulus: ends (e, 2), the turns that u gains along each, and cotangent weights."""

    ends: Ints
    gain: Floats
    cotangents: Floats

    @staticmethod
    def of(annulus: Annulus, jump: Floats) -> EdgeGraph:
        """The edges of an annulus; jump (m, 3): the turn that u has gained at each corner."""
        found = edges(annulus.faces)
        # both half-edges of an edge have the same gain, but for its sign
        half = found.halves[:, 0]
        gain = (np.roll(jump, -1, axis=1) - jump).ravel()[half]
        upwards = annulus.faces.ravel()[half] == found.ends[:, 0]
        # libigl's entry k is that of the edge across from corner k
        cotangent = np.roll(igl.cotmatrix_entries(annulus.vertices, annulus.faces), 1, axis=1)
        return EdgeGraph(
            found.ends,
            np.where(upwards, gain, -gain),
            np.asarray(np.bincount(found.of_face.ravel(), cotangent.ravel()), dtype=np.float64),
        )

    @property
    def positive(self) -> Floats:
        """The cotangents, raised to a positive bound where they are below it."""
        return np.maximum(self.cotangents, LEAST_WEIGHT * np.median(np.abs(self.cotangents)))


def harmonic(annulus: Annulus, graph: EdgeGraph, weights: Floats, near: Floats | None = None) -> Floats:
    """Solve for u and v with the given edge weights, (n, 2); near: a guess of them."""
    n = len(annulus.vertices)
    (i, j), turned = graph.ends.T.astype(np.int32), weights * graph.gain
    off = sparse.csr_array((np.r_[weights, weights], (np.r_[i, j], np.r_[j, i])), shape=(n, n))
    laplacian = (sparse.diags_array(np.asarray(off.sum(axis=1))) - off).tocsr()
    del off
    pull = np.asarray(np.bincount(i, turned, n) - np.bincount(j, turned, n), dtype=np.float64)
    rims = np.concatenate(annulus.rims)
    guess: Floats = np.zeros((n, 2)) if near is None else near - [near[annulus.rims[0][0], 0], 0.0]
    u, v = np.zeros(n), np.zeros(n)
    v[annulus.rims[1]] = 1.0
    side_by_side(
        lambda: _solve_fixed(laplacian, pull, annulus.rims[0][:1], u, guess[:, 0]),
        lambda: _solve_fixed(laplacian, np.zeros(n), rims, v, guess[:, 1]),
    )
    return np.column_stack([u, v])


def _solve_fixed(laplacian: sparse.csr_array, right: Floats, known: Ints, x: Floats, near: Floats) -> None:
    """Solve laplacian x = right for x (n,) in place, of which some are known; near (n,): a guess."""
    free = np.ones(len(x), dtype=bool)
    free[known] = False
    matrix = laplacian[free]
    right = right[free] - matrix @ x
    matrix = matrix[:, free]
    found = None
    if len(right) > DIRECT:
        found = solve_laplace(matrix, right, near[free], TOLERANCE, MOST_STEPS)
    x[free] = _factored(matrix, right) if found is None else found


def _factored(matrix: sparse.csr_array, right: Floats) -> Floats:
    """Solve by libigl's sparse Cholesky, which takes half the time of SuperLU."""
    none, whole = np.zeros((0, 1)), sparse.csc_matrix(matrix)
    x = igl.min_quad_with_fixed(
        whole, -right[:, None], np.zeros(0, np.int64), none, sparse.csc_matrix((0, len(right))), none, True
    )
    return np.asarray(x)[:, 0]
