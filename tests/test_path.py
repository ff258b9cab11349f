"""Taut paths against exact answers, their order of convergence and their certificates."""

import numpy as np
import pytest
from comparison.problem import TURN, Problem
from comparison.problems import PROBLEMS, RULING, TABLE, barrel, barrel_clairaut, bottle, hyperboloid, vase_radius
from scipy.optimize import brentq

from meshwind.core.errors import BadInputError
from meshwind.path import Paths, Status, solve
from meshwind.path.kernels.touchdown import touchdowns
from meshwind.path.lengths import bridges
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


def tangent_contact(end: float, low: float, high: float) -> float:
    """The z in [low, high] at which the vase's profile is tangent to the line through its point at z = `end`."""

    def slope(z: float) -> float:
        return float(-0.35 * 0.75 * np.pi * np.sin(0.75 * np.pi * z + 0.3) + 0.225 * np.cos(2.25 * z))

    def miss(z: float) -> float:
        return float(np.diff(vase_radius(np.array([z, end])))[0] - slope(z) * (end - z))

    return float(brentq(miss, low, high, xtol=1e-15))


def bridge_end_errors(particles: int) -> tuple[float, float]:
    """How far the inner ends of the vase's two bridges are from where their chords are tangent to it."""
    spans = bridges(lay(TABLE["vase"], particles))
    assert len(spans) == 2
    landing, leaving = spans.ends[0, 1, 2], spans.ends[1, 0, 2]
    return abs(landing - tangent_contact(0.0, 2.0, 2.8)), abs(leaving - tangent_contact(4.0, 2.8, 3.4))


def test_bridge_ends_converge_with_second_order() -> None:
    """Both bridges of the vase end at its rims' one side; on the other they must find the common tangent."""
    coarse, fine = bridge_end_errors(101), bridge_end_errors(1601)
    assert np.log2(coarse[1] / fine[1]) / 4 >= 1.9
    assert max(bridge_end_errors(401)[0], fine[0]) <= 1e-7


def test_bridge_ends_are_where_the_chord_is_tangent() -> None:
    """The chord's angle to the surface at a touchdown is far below that at the particle next to it."""
    paths = solve(bottle(), [(0.1, 0), (0.3, 0)], [(0.4, 1), (0.9, 1)])
    spans = bridges(paths)
    assert len(spans) >= 2
    places = touchdowns(paths.surface, paths.points, paths.uv, spans.path, spans.first, spans.last)[1]
    chord = spans.ends[:, 1] - spans.ends[:, 0]
    chord /= np.linalg.norm(chord, axis=1)[:, None]
    spacing = spans.length / (spans.last - spans.first)
    for side, particle in enumerate((spans.first, spans.last)):
        free = (particle > 0) & (particle < 400)
        assert free.any()
        dip = np.abs(np.einsum("bk,bk->b", chord, paths.surface.normals(places[:, side])))[free]
        at_particle = np.abs(np.einsum("bk,bk->b", chord, paths.normal[spans.path, particle]))[free]
        assert (dip <= 0.05 * at_particle.max()).all()
        moved = np.linalg.norm(spans.ends[:, side] - paths.points[spans.path, particle], axis=1)
        assert (moved <= 2.0 * spacing).all()


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
    (dict(friction=-0.1), "friction"), (dict(friction=np.nan), "friction"), (dict(friction=11.0), "friction"),
    (dict(friction=np.ones((1, 5))), "2 by 2"), (dict(friction=lambda places: places), "one number a point"),
    (dict(friction=lambda places: places[:, 0] - 9.0), "friction"), (dict(particles=2), "particles"),
    (dict(particles=2.5), "particles"), (dict(particles=None, accuracy=0.0), "accuracy"),
    (dict(start=[(0, -0.5)]), "start"), (dict(end=[(0, 1), (1, 1)]), "as many"), (dict(start=[(np.nan, 0)]), "NaN"),
    (dict(initial=[[[0.0, np.nan], [0.5, 1.0]]]), "initial"),
])  # fmt: skip
def test_bad_arguments_are_refused(change: dict[str, object], why: str) -> None:
    arguments: dict[str, object] = dict(start=[(0, 0)], end=[(0.5, 1)]) | change
    with pytest.raises(BadInputError, match=why) as refusal:
        solve(barrel(), arguments.pop("start"), arguments.pop("end"), **arguments)  # type: ignore[arg-type]
    assert "\n" not in str(refusal.value)
