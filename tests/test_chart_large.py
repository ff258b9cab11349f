"""Flattening of large meshes: the iteration gives what a factorisation does, in as many steps whatever the mesh."""

from collections.abc import Iterator

import numpy as np
import pytest
from irregular import annulus
from scipy import sparse

from meshwind.chart import flatten, harmonic
from meshwind.chart.multigrid import COARSEST, Multigrid, solve_laplace
from meshwind.core.cast import Floats
from meshwind.mesh import Annulus


def vase(u: Floats, v: Floats) -> Floats:
    r = 1.0 + 0.3 * np.sin(2 * np.pi * v) + 0.1 * np.cos(6 * np.pi * u)
    return np.stack([r * np.cos(2 * np.pi * u), r * np.sin(2 * np.pi * u), 4 * v], -1)


def grid_laplacian(n: int, stretch: float = 1.0) -> tuple[sparse.csr_array, Floats]:
    """The five-point matrix of n x n inner points, edges along one side weaker by a factor, and a right side."""
    line = sparse.diags_array([-np.ones(n - 1), 2 * np.ones(n), -np.ones(n - 1)], offsets=[-1, 0, 1])
    eye = sparse.eye_array(n)
    matrix = sparse.csr_array(sparse.kron(line, eye) + stretch * sparse.kron(eye, line))
    return matrix, np.random.default_rng(2).standard_normal(n * n)


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[int]]:
    """Sizes of the residuals that a multigrid was given, one of each step and two more."""
    sizes: list[int] = []
    cycle = Multigrid.solve

    def count(self: Multigrid, right: Floats) -> Floats:
        sizes.append(len(right))
        return cycle(self, right)

    monkeypatch.setattr(Multigrid, "solve", count)
    yield sizes


def flattened(part: Annulus, monkeypatch: pytest.MonkeyPatch, direct: int) -> Floats:
    monkeypatch.setattr(harmonic, "DIRECT", direct)
    return flatten(part).uv


def test_the_iteration_gives_the_chart_of_the_factorisation(
    monkeypatch: pytest.MonkeyPatch, counted: list[int]
) -> None:
    part = annulus(vase, 6000, 0.4)
    direct = flattened(part, monkeypatch, 10**9)
    assert not counted
    iterated = flattened(part, monkeypatch, 0)
    assert len(counted) > 10
    apart = iterated - direct
    apart[:, 0] -= np.round(apart[:, 0])
    apart[:, 0] -= np.median(apart[:, 0])  # the part is nearly round: where u begins is the phase of what is left of it
    assert np.abs(apart).max() < 1e-8


@pytest.mark.parametrize("stretch", [1.0, 1e-3], ids=["even", "stretched"])
def test_steps_do_not_grow_with_the_matrix(stretch: float, counted: list[int]) -> None:
    """Also where edges one way are stronger than the other way, as on triangles that are longer than wide."""
    steps = []
    for n in (40, 80, 160, 320):
        counted.clear()
        matrix, right = grid_laplacian(n, stretch)
        x = solve_laplace(matrix, right, np.zeros(n * n), 1e-9, 60)
        assert x is not None
        assert np.linalg.norm(matrix @ x - right) < 1e-7 * np.linalg.norm(right)
        steps.append(len(counted) - 2)
    assert max(steps) <= min(40, steps[0] + 14)


def test_levels_take_little_more_than_the_matrix() -> None:
    """The numbers that all levels hold are a fixed multiple of those of the matrix."""
    for n in (60, 240):
        matrix, _ = grid_laplacian(n)
        grid = Multigrid.of(matrix)
        assert grid is not None
        held = sum(level.matrix.nnz + level.coarse.nnz + level.transposed.nnz for level in grid.levels)
        assert held < 3.5 * matrix.nnz
        assert grid.last[0].shape[0] <= COARSEST


def test_a_good_guess_saves_steps(counted: list[int]) -> None:
    matrix, right = grid_laplacian(100)
    x = solve_laplace(matrix, right, np.zeros(len(right)), 1e-9, 60)
    assert x is not None
    afresh = len(counted)
    again = solve_laplace(matrix, right, x * (1.0 + 1e-6), 1e-9, 60)
    assert again is not None
    assert len(counted) - afresh < 0.7 * afresh


def test_what_is_not_definite_is_not_solved() -> None:
    matrix, right = grid_laplacian(30)
    assert solve_laplace(-matrix, right, np.zeros(len(right)), 1e-9, 60) is None
    assert solve_laplace(matrix, right, np.zeros(len(right)), 1e-9, 2) is None  # nor what takes too many steps


def test_a_factorisation_takes_over(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the iteration does not end in time, the chart is the same."""
    part = annulus(vase, 2000, 0.4)
    direct = flattened(part, monkeypatch, 10**9)
    monkeypatch.setattr(harmonic, "MOST_STEPS", 1)
    assert np.array_equal(flattened(part, monkeypatch, 0), direct)
