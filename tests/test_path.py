"""Taut paths against exact answers, their order of convergence and their certificates."""

import numpy as np
import pytest

from meshwind.errors import BadInputError
from meshwind.methods.problems import PROBLEMS, RULING, TURN, Problem, barrel, barrel_clairaut, hyperboloid, vase_radius
from meshwind.path import Paths, Status, solve
from meshwind.surface import shapes


def lay(problem: Problem, particles: int = 401) -> Paths:
    return solve(problem.surface(), [problem.start], [problem.end], particles=particles)


def length(paths: Paths) -> float:
    return float(np.linalg.norm(np.diff(paths.points[0], axis=0), axis=1).sum())


@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda p: p.name)
def test_length_is_exact(problem: Problem) -> None:
    paths = lay(problem)
    assert paths.status[0] == Status.CONVERGED
    assert paths.residual[0] <= 1e-10
    assert length(paths) == pytest.approx(problem.length, rel=1e-5)
    assert (~paths.on_surface).any() == problem.bridges
    if problem.gap is not None:
        assert paths.gap.max() == pytest.approx(problem.gap, abs=2e-5)


@pytest.mark.parametrize(
    "problem", [p for p in PROBLEMS if not p.name.startswith(("hyper", "elbow"))], ids=lambda p: p.name
)
def test_length_converges_with_second_order(problem: Problem) -> None:
    errors = [abs(length(lay(problem, n)) - problem.length) for n in (51, 101, 201)]
    assert np.log2(errors[0] / errors[2]) / 2 >= 1.9


@pytest.mark.parametrize("name", ["barrel-1.5", "sphere", "ellipsoid"])
def test_position_converges_with_second_order(name: str) -> None:
    problem = next(p for p in PROBLEMS if p.name == name)
    fine = lay(problem, 1601).points[0]
    errors = [
        np.linalg.norm(lay(problem, n).points[0] - fine[:: 1600 // (n - 1)], axis=1).max() for n in (51, 101, 201)
    ]
    assert np.log2(errors[0] / errors[2]) / 2 >= 1.9


def test_bridge_ends_converge_with_second_order() -> None:
    """The vase's long bridge starts at z=0 and lands tangent to the profile; the fibre's own landing must converge."""
    errors = []
    z = np.linspace(2.4, 2.9, 2_000_001)
    r = vase_radius(z)
    slope = (r - vase_radius(np.zeros(1))) / z
    touch = np.array([z[np.argmax(slope)], 0.0, 0.0])
    for n in (101, 401, 1601):
        paths = lay(next(p for p in PROBLEMS if p.name == "vase"), n)
        first = np.flatnonzero(paths.on_surface[0])[1]
        errors.append(abs(paths.points[0, first, 2] - touch[0]))
        assert errors[-1] <= 2 * 4.2 / n  # a contact is a particle: no better than the spacing
    assert errors[2] < errors[0]


@pytest.mark.parametrize("twist", [0.5, 1.5, 2.5])
def test_clairaut_constant_holds_along_the_path(twist: float) -> None:
    paths = solve(barrel(), [(0, 0)], [(twist / TURN, 1)], particles=1601)
    P = paths.points[0]
    chord, middle = np.diff(P, axis=0), (P[1:] + P[:-1]) / 2
    around = (middle[:, 0] * chord[:, 1] - middle[:, 1] * chord[:, 0]) / np.linalg.norm(chord, axis=1)
    assert around == pytest.approx(np.full(1600, barrel_clairaut(twist)), abs=1e-6)


def test_ruling_carries_no_force() -> None:
    """At the rulings' twist the chord lies in the surface: any mix of touching and barely free is right."""
    paths = solve(hyperboloid(), [(0, 0)], [(RULING / TURN, 1)])
    assert paths.status[0] == Status.CONVERGED
    assert paths.gap.max() < 1e-7
    assert length(paths) == pytest.approx(np.sqrt(18.0), rel=1e-9)


def test_helix_on_a_cylinder_over_several_turns() -> None:
    paths = solve(shapes.cylinder(2.0, 3.0), [(0, 0)], [(5.25, 1)], particles=2001)
    exact = np.hypot(5.25 * TURN * 2.0, 3.0)
    assert length(paths) == pytest.approx(exact, rel=2e-5)
    assert paths.points[0, 1000, 2] == pytest.approx(1.5, abs=1e-7)


def test_sliding_off_is_said() -> None:
    """Beyond Clairaut's limit (c = rim radius, 0.7) a barrel holds no path: it must not look converged."""
    paths = solve(barrel(), [(0, 0)], [(0.9, 1)])
    assert paths.status[0] != Status.CONVERGED
    assert Status(int(paths.status[0])).advice


def test_convex_parts_pay_nothing_for_lifting() -> None:
    assert lay(PROBLEMS[3]).counters.feet == 0


@pytest.mark.parametrize(("change", "why"), [
    (dict(friction=0.1), "friction"), (dict(particles=2), "particles"), (dict(start=[(0, -0.5)]), "start"),
    (dict(end=[(0, 1), (1, 1)]), "as many"), (dict(start=[(np.nan, 0)]), "NaN"),
])  # fmt: skip
def test_bad_arguments_are_refused(change: dict[str, object], why: str) -> None:
    arguments: dict[str, object] = dict(start=[(0, 0)], end=[(0.5, 1)]) | change
    with pytest.raises(BadInputError, match=why):
        solve(barrel(), arguments.pop("start"), arguments.pop("end"), **arguments)  # type: ignore[arg-type]
