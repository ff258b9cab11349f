"""The peers solve the same problems: each comes to its own kind of truth."""

import numpy as np
import pytest
from comparison.attempt import OURS, Outcome, attempt
from comparison.peers_mesh import PEERS, Facets, facets
from comparison.peers_smooth import collocate, shoot, shoot_traced
from comparison.problems import TABLE

ON_SURFACE = ["cone-1", "barrel-1.5", "sphere", "ellipsoid", "bottle"]


@pytest.mark.parametrize("name", [*ON_SURFACE, "barrel-4", "cone-6", "helix-5", "bottle-turn"])
@pytest.mark.parametrize(("solver", "tolerance", "error"), [(shoot, 1e-5, 1e-3), (shoot_traced, 1e-7, 2e-9),
                                                            (collocate, 1e-5, 1e-5)])  # fmt: skip
def test_smooth_peers_find_the_length(name: str, solver: object, tolerance: float, error: float) -> None:
    found = solver(TABLE[name], tolerance)  # type: ignore[operator]
    assert found.outcome == Outcome.REST
    assert TABLE[name].error(found.length) < error
    assert found.evaluations > 0


@pytest.mark.parametrize("name", [*ON_SURFACE, "barrel-4", "helix-5"])
def test_facets_are_a_closed_tube_with_both_ends(name: str) -> None:
    problem = TABLE[name]
    mesh = facets(problem, 1000)
    ends = problem.surface().points([problem.start, problem.end])
    np.testing.assert_allclose(mesh.vertices[[mesh.start, mesh.end]], ends, atol=1e-9 * problem.surface().size)
    edges = np.sort(mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    used = np.unique(edges, axis=0, return_counts=True)[1]
    assert set(used) == {1, 2}
    assert len(mesh.vertices) - len(used) + len(mesh.faces) == 0  # an annulus
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    outward = problem.surface().normals(mesh.uv[mesh.faces[:, 0]])
    assert np.mean((np.cross(b - a, c - a) * outward).sum(axis=1) > 0) > 0.99


def mesh_of(name: str, count: int) -> Facets:
    return facets(TABLE[name], count)


@pytest.mark.parametrize("name", ON_SURFACE)
def test_exact_methods_and_flipout_agree_on_the_facets(name: str) -> None:
    mesh = mesh_of(name, 1000)
    flip, first, second = (peer(mesh, TABLE[name]).length for peer in PEERS.values())
    assert first == pytest.approx(second, rel=1e-9)
    assert flip == pytest.approx(first, rel=2e-3)  # a geodesic, not always the shortest
    assert flip >= first * (1 - 1e-9)
    assert TABLE[name].error(flip) < 5e-3


def test_only_flipout_keeps_several_turns() -> None:
    mesh = mesh_of("helix-5", 2000)
    flip, first, second = (peer(mesh, TABLE["helix-5"]).length for peer in PEERS.values())
    assert TABLE["helix-5"].error(flip) < 1e-3
    assert first == pytest.approx(second)
    assert first < 0.2 * flip


def test_an_attempt_says_how_it_ended() -> None:
    assert attempt(OURS, TABLE["vase"], 41).outcome == Outcome.REST
    assert attempt("backward-euler", TABLE["vase"], 41, dict(step_size=1e-3, steps=5)).outcome == Outcome.STALLED
    assert attempt("rk4", TABLE["cone-6"], 41, dict(step_size=30.0, steps=200)).outcome == Outcome.DIVERGED
