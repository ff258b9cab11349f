"""The table of problems itself: its answers by other ways than the one they were worked out."""

from itertools import pairwise

import numpy as np
import pytest
from comparison.attempt import OURS, Outcome, attempt, polyline_length
from comparison.problem import TURN, Kind, Problem
from comparison.problems import (
    BARREL_LIMIT,
    CONE_LIMIT,
    DRAGGED,
    FREEFORM,
    SLIDING,
    TABLE,
    barrel_clairaut,
    barrel_length,
    vase_radius,
)
from comparison.sliding import Dragged, Sliding
from scipy.integrate import quad
from scipy.optimize import brentq

from meshwind.march import trace
from meshwind.path import solve

EACH = pytest.mark.parametrize("problem", TABLE.values(), ids=TABLE.keys())


def polyline(problem: Problem, particles: int) -> float:
    found = attempt(OURS, problem, particles)
    assert found.outcome == Outcome.REST and found.points is not None
    return polyline_length(found.points)


def test_every_kind_is_there() -> None:
    assert {problem.kind for problem in TABLE.values()} == set(Kind)


@EACH
def test_an_entry_is_sound(problem: Problem) -> None:
    a, b = problem.surface().points([problem.start, problem.end])
    assert problem.length >= np.linalg.norm(b - a) * (1 - 1e-9)
    assert 0 < problem.accuracy < 1e-9
    assert problem.difficulty
    assert problem.error(problem.length) == problem.accuracy
    assert problem.error(2 * problem.length) == pytest.approx(1.0)
    if problem.dragged_from is not None:
        np.testing.assert_allclose([w[0] for w in problem.motion], problem.dragged_from, atol=1e-15)
        np.testing.assert_allclose([w[-1] for w in problem.motion], [problem.start, problem.end], atol=1e-15)
    if problem.initial is not None:
        np.testing.assert_allclose(problem.initial(9)[[0, -1]], [problem.start, problem.end], atol=1e-15)


@EACH
def test_richardson_agrees_with_the_answer(problem: Problem) -> None:
    coarse, fine = polyline(problem, 401), polyline(problem, 801)
    # a dragged fibre comes to rest in frames, which leave their own trace
    assert problem.error(fine + (fine - coarse) / 3) < (2e-6 if problem.dragged_from else 2e-7)


@pytest.mark.parametrize("twist", [0.5, 2.5, 4.0])
def test_barrel_by_a_plain_quadrature_and_an_integrator(twist: float) -> None:
    c = barrel_clairaut(twist)
    length = barrel_length(twist)

    def rate(z: float) -> float:
        r = 1 - 0.3 * (z - 1) ** 2
        return float(r * np.sqrt((1 + 0.36 * (z - 1) ** 2) / (r * r - c * c)))

    assert quad(rate, 0, 2, epsabs=1e-11, epsrel=1e-11, points=[1.0], limit=200)[0] == pytest.approx(length, rel=1e-9)
    way = trace(TABLE["barrel-1.5"].surface(), (0, 0), float(np.arcsin(c / 0.7)), 2 * length, press="ignore")
    assert way.arc_length[-1] == pytest.approx(length, rel=1e-7)
    assert way.uv[-1] == pytest.approx((twist / TURN, 1), abs=1e-6)


def test_limits_of_the_windings() -> None:
    assert barrel_clairaut(BARREL_LIMIT - 1e-9) == pytest.approx(0.7, abs=1e-6)
    slant = float(np.hypot(3, 0.5))
    assert np.cos(CONE_LIMIT * 0.5 / slant) == pytest.approx(0.5)
    assert 6 < CONE_LIMIT < 7 and 4 < BARREL_LIMIT < 5


def test_vase_by_its_two_tangents() -> None:
    """The hull: from the first rim tangent to the bulge, along the profile, tangent to the second bridge's far end."""
    z = np.linspace(0, 4, 200_001)
    r = vase_radius(z)
    hull = [0]
    while hull[-1] < len(z) - 1:
        i = hull[-1]
        slope = (r[i + 1 :] - r[i]) / (z[i + 1 :] - z[i])
        hull.append(i + 1 + int(slope.argmax()))
    length = np.hypot(np.diff(z[hull]), np.diff(r[hull])).sum()
    assert length == pytest.approx(TABLE["vase"].length, rel=1e-8)


@pytest.mark.parametrize("sliding", [*SLIDING.values(), Sliding(0.3, 0.2, 2.0), Sliding(0.1, 0.5, 1.0)])
def test_sliding_keeps_coulombs_law(sliding: Sliding) -> None:
    mu, k, x = sliding.mu, sliding.k, sliding.slid
    if x == 0.0:
        assert k <= mu
    elif x < sliding.half:  # the catenary meets the parabola with its tangent, and nothing beyond needs more than mu
        assert np.sinh(mu * x) == pytest.approx(k * x)
        assert k / np.sqrt(1 + (k * x) ** 2) <= mu
    steps = np.linspace(-sliding.half, sliding.half, 400_001)
    inside = np.abs(steps) <= x
    z = np.where(inside, sliding.middle - (np.cosh(mu * steps) - 1) / mu, k / 2 * (sliding.half**2 - steps**2))
    assert np.hypot(np.diff(steps), np.diff(z)).sum() == pytest.approx(sliding.length, rel=1e-9)


@pytest.mark.parametrize("dragged", [DRAGGED, Dragged(0.1, 2.0, 0.2), Dragged(0.8, 3.0, 1.5)])
def test_dragging_keeps_coulombs_law(dragged: Dragged) -> None:
    mu, stuck = dragged.mu, dragged.stuck
    assert 0.0 < stuck < dragged.half
    t = np.linspace(-dragged.half, dragged.half, 400_001)
    z = (np.cosh(mu * np.maximum(np.abs(t) - stuck, 0.0)) - 1.0) / mu
    assert z[0] == pytest.approx(dragged.rise, rel=1e-12)
    slope = np.gradient(z, t)
    used = np.gradient(slope, t) / np.sqrt(1.0 + slope**2)
    away = np.abs(np.abs(t) - stuck) > 1e-3
    np.testing.assert_allclose(used[away][2:-2], np.where(np.abs(t) > stuck, mu, 0.0)[away][2:-2], atol=1e-4)
    assert np.hypot(np.diff(t), np.diff(z)).sum() == pytest.approx(dragged.length, rel=1e-9)


def test_known_figures_of_sliding() -> None:
    first, second, third = SLIDING.values()
    assert first.middle == pytest.approx((np.cosh(0.3 * np.pi) - 1) / 0.3, rel=1e-12)
    assert second.length == pytest.approx(2 * np.sinh(0.15 * np.pi) / 0.2, rel=1e-12)
    assert third.slid == pytest.approx(brentq(lambda t: 0.4 * t - np.sinh(0.3 * t), 3, 6), rel=1e-12)
    assert (third.slid, third.middle) == pytest.approx((4.5041653342961965, 7.373457949061208), rel=1e-12)


@pytest.mark.parametrize("problem", FREEFORM, ids=lambda p: p.name)
def test_a_dense_reference_knows_its_own_error(problem: Problem) -> None:
    lengths = [polyline(problem, n) for n in (401, 801, 1601)]
    once = [b + (b - a) / 3 for a, b in pairwise(lengths)]
    left = abs(once[1] / once[0] - 1)  # an upper bound of the finer one's error
    assert abs(once[1] / problem.length - 1) <= max(left, problem.accuracy)


@pytest.mark.parametrize("name", ["bottle", "bottle-turn"])
def test_a_dense_reference_by_marching(name: str) -> None:
    """The forward solver has no particles: from the taut path's start it meets the end at the reference's length."""
    problem = TABLE[name]
    surface = problem.surface()
    uv = solve(surface, [problem.start], [problem.end], particles=3201).uv[0]
    way = trace(surface, problem.start, (-11 * uv[0] + 18 * uv[1] - 9 * uv[2] + 2 * uv[3]), problem.length)
    np.testing.assert_allclose(way.points[-1], surface.points([problem.end])[0], atol=2e-5)
