"""The literature's schemes: where each settles, where each explodes, and what each gets wrong."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from comparison.problem import Problem
from comparison.problems import PROBLEMS, barrel, sphere
from numpy.typing import NDArray

from meshwind.core.errors import BadInputError
from meshwind.methods import Ending, Method, Motion, largest_frequency, run, stable_step
from meshwind.path import solve
from meshwind.surface import Surface, shapes

Floats = NDArray[np.float64]
TABLE = {problem.name: problem for problem in PROBLEMS}
N = 51
CRITICAL = 2 * np.pi / (N - 1)
"""Damping that is critical for the slowest mode of a chain of N unit masses and springs."""
EULER = 0.5 * stable_step("explicit-euler", 2.0, damping=CRITICAL)
SETTLES = {
    "explicit-euler": ("explicit-euler", dict(step_size=EULER, damping=CRITICAL, steps=100000)),
    "symplectic-euler": ("symplectic-euler", dict(step_size=0.8, damping=CRITICAL, steps=3000)),
    "rk4": ("rk4", dict(step_size=1.2, damping=CRITICAL, steps=3000)),
    "backward-euler": ("backward-euler", dict(step_size=100.0, steps=200)),
    "backward-euler-damped": ("backward-euler", dict(step_size=5.0, damping=0.1, steps=500)),
    "backward-euler-reused": ("backward-euler", dict(step_size=10.0, damping=0.1, reuse=8, steps=500)),
    "kkt": ("kkt", dict(step_size=10.0, damping=0.1, steps=1000)),
}
"""A setting of each scheme with which it comes to rest."""
EXPLICIT = [Method.EXPLICIT_EULER, Method.SYMPLECTIC_EULER, Method.RUNGE_KUTTA]


def lay(name: str, method: str, **setting: Any) -> Motion:
    problem = TABLE[name]
    setting = {"particles": N, **setting}
    return run(method, problem.surface(), problem.start, problem.end, **setting)


def ours(name: str) -> float:
    problem: Problem = TABLE[name]
    points = solve(problem.surface(), [problem.start], [problem.end], particles=N).points[0]
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def slip(surface: Surface, result: Motion) -> Floats:
    """|kg| / kn at the inner particles."""
    X, normal = result.points, surface.normals(result.uv)[1:-1]
    bend, along = X[:-2] - 2 * X[1:-1] + X[2:], X[2:] - X[:-2]
    side = np.cross(normal, along / np.linalg.norm(along, axis=1, keepdims=True))
    ratio = np.abs(np.sum(bend * side, 1)) / -np.sum(bend * normal, 1)
    return np.asarray(ratio, dtype=np.float64)


@pytest.mark.parametrize("name", ["barrel-0.5", "cone-1", "sphere"])
@pytest.mark.parametrize("scheme", SETTLES)
def test_every_scheme_settles_where_ours_does(name: str, scheme: str) -> None:
    method, setting = SETTLES[scheme]
    result = lay(name, method, **setting)
    assert result.status == Ending.CONVERGED
    assert result.residual <= 1e-10
    assert result.length == pytest.approx(ours(name), rel=1e-9)
    assert result.on_surface.all()


@pytest.mark.parametrize("name", ["vase", "hyperboloid-0.5", "elbow"])
@pytest.mark.parametrize("scheme", [s for s in SETTLES if s != "explicit-euler"])
def test_bridges_are_those_of_ours(name: str, scheme: str) -> None:
    method, setting = SETTLES[scheme]
    result = lay(name, method, **({} if method == "kkt" else {"weighted": True}), **setting)
    assert result.status == Ending.CONVERGED
    assert result.length == pytest.approx(ours(name), rel=1e-9)
    assert result.gap.min() >= -1e-9


def test_the_sources_lifting_test_chatters() -> None:
    """Algorithm 1 lifts by unweighted neighbours, so that a particle beside a bridge lifts and lands for ever."""
    source = lay("vase", "backward-euler", step_size=10.0, damping=0.1, steps=3000, history=True)
    assert source.status == Ending.STOPPED
    assert source.residual > 1e-3
    assert source.history is not None
    assert np.all(source.history.residual[-100:] > 1e-3)
    assert source.length == pytest.approx(ours("vase"), rel=1e-4)  # near, but not at rest


def test_without_lifting_the_fibre_follows_the_hollow() -> None:
    held = lay("vase", "backward-euler", step_size=100.0, steps=200, lifting=False)
    assert held.status == Ending.CONVERGED
    assert held.on_surface.all()
    assert held.length > 1.03 * ours("vase")


@pytest.mark.parametrize("reuse", [2, 5, 20])
def test_a_reused_matrix_leads_to_the_same_place(reuse: int) -> None:
    setting = dict(step_size=5.0, damping=0.1, steps=1000)
    fresh, reused = (lay("sphere", "backward-euler", reuse=k, **setting) for k in (1, reuse))
    assert reused.status == Ending.CONVERGED
    np.testing.assert_allclose(reused.points, fresh.points, atol=1e-8)
    early = [lay("sphere", "backward-euler", step_size=5.0, damping=0.1, steps=10, reuse=k).points for k in (1, reuse)]
    assert np.abs(early[0] - early[1]).max() > 1e-9  # by another way


def test_largest_frequency_is_that_of_a_straight_chain() -> None:
    t = np.linspace(0.0, 1.0, N)
    straight = np.stack([0.0 * t, t], 1)
    got = largest_frequency(shapes.cylinder(1.0, 4.0), straight, stiffness=9.0, mass=4.0)
    assert got == pytest.approx(3.0 * np.cos(np.pi / (2 * (N - 1))), rel=1e-9)


@pytest.mark.parametrize("method", EXPLICIT)
@pytest.mark.parametrize("damping", [CRITICAL, 1.0])
def test_explicit_schemes_explode_above_their_limit_and_not_below(method: Method, damping: float) -> None:
    rest = lay("barrel-0.5", "backward-euler", step_size=100.0, steps=100)
    limit = stable_step(method, largest_frequency(barrel(), rest.uv), damping=damping)
    setting = dict(damping=damping, steps=60000, tolerance=1e-6)
    below, above = (lay("barrel-0.5", method, step_size=share * limit, **setting) for share in (0.9, 1.2))
    assert below.status != Ending.DIVERGED
    assert below.length == pytest.approx(rest.length, rel=1e-3)
    assert above.status == Ending.DIVERGED


@pytest.mark.parametrize(("method", "limit"), [("symplectic-euler", 2.0), ("rk4", 2.0 * np.sqrt(2.0))])
def test_undamped_limits_are_the_textbooks(method: str, limit: float) -> None:
    assert stable_step(method, 1.0) == pytest.approx(limit, rel=1e-4)
    low, high = (lay("sphere", method, step_size=share * limit / 2.0, steps=2000) for share in (0.8, 1.2))
    assert (low.status, high.status) == (Ending.STOPPED, Ending.DIVERGED)


def test_nothing_holds_explicit_euler_undamped() -> None:
    assert stable_step("explicit-euler", 1.0) == 0.0
    assert lay("sphere", "explicit-euler", step_size=0.1, steps=3000).status == Ending.DIVERGED
    assert stable_step("backward-euler", 1.0) == np.inf


@pytest.mark.parametrize("method", [*EXPLICIT, Method.PENALTY])
def test_an_explosion_leaves_numbers(method: Method) -> None:
    wild = lay("barrel-2.5", method, step_size=1e3, steps=500, width=1e-9, push=1e9, history=True)
    assert wild.status in (Ending.DIVERGED, Ending.STOPPED)
    assert wild.history is not None
    assert len(wild.history.length) == wild.counters.iterations + 1
    for values in (wild.points, wild.uv, wild.gap, wild.length, wild.residual, wild.history.length, wild.history.angle):
        assert np.isfinite(values).all()


@pytest.mark.parametrize(
    ("method", "order", "inertial"),
    [("rk4", 4, False), ("rk4", 4, True), ("symplectic-euler", 1, True), ("backward-euler", 1, False)],
)
def test_order_in_time(method: str, order: int, inertial: bool) -> None:
    least = 64 if order == 4 else 512
    ends = [
        lay("sphere", method, steps=k, step_size=8.0 / k, particles=11, inertial=inertial).points
        for k in (least, 2 * least, 4 * least)
    ]
    first, second = (np.abs(a - b).max() for a, b in pairwise(ends))
    assert np.log2(first / second) == pytest.approx(order, abs=0.3)


def test_only_the_inertial_term_makes_the_motion_that_of_the_surface() -> None:
    """The true motion (4.10) is the same in any chart; (4.12), which drops J-dot V, moves otherwise in another."""
    other = shapes.revolution(lambda z: np.sqrt(4.0 - z**2), -np.sqrt(2.0), np.sqrt(2.0), (256, 128))
    t = np.linspace(0.0, 1.0, 21)
    curve = np.stack([0.2 * t, t], 1)
    height = -2.0 * np.cos(0.25 * np.pi + 0.5 * np.pi * t)
    twin = np.stack([0.2 * t, (height + np.sqrt(2.0)) / (2 * np.sqrt(2.0))], 1)
    twin[[0, -1], 1] = 0.0, 1.0
    apart = []
    for inertial in (True, False):
        setting: dict[str, Any] = dict(particles=21, steps=100, step_size=0.2, inertial=inertial)
        one = run("rk4", sphere(), curve[0], curve[-1], initial=curve, **setting)
        two = run("rk4", other, twin[0], twin[-1], initial=twin, **setting)
        apart.append(np.abs(one.points - two.points).max())
    assert apart[0] < 1e-7
    assert apart[1] > 1e-5


def test_only_stiffness_over_mass_counts() -> None:
    plain = lay("sphere", "rk4", steps=50, step_size=0.8, damping=0.1)
    scaled = lay("sphere", "rk4", steps=50, step_size=0.4, damping=0.4, stiffness=8.0, mass=2.0)
    np.testing.assert_allclose(scaled.points, plain.points, atol=1e-12)


@pytest.mark.parametrize("method", ["backward-euler", "kkt"])
def test_a_part_far_from_the_origin_winds_alike(method: str) -> None:
    problem = TABLE["vase"]
    setting: dict[str, Any] = dict(SETTLES[method][1], tolerance=1e-8)
    here = problem.surface()
    far = Surface(here.control_points + 1e3 * np.array([1.0, -2.0, 3.0]))
    near, away = (
        run(method, s, problem.start, problem.end, particles=N, weighted=True, **setting) for s in (here, far)
    )
    assert away.status == Ending.CONVERGED
    assert away.length == pytest.approx(near.length, rel=1e-9)
    np.testing.assert_allclose(
        away.points - far.control_points[0, 0] + here.control_points[0, 0], near.points, atol=1e-6
    )


def test_the_penalty_error_shrinks_with_its_width() -> None:
    truth, size = ours("sphere"), sphere().size
    errors = []
    for width in (1e-2, 3e-3, 1e-3):
        result = lay("sphere", "penalty", step_size=0.3, damping=0.1, steps=20000, width=width * size, tolerance=1e-6)
        assert result.status == Ending.CONVERGED
        assert np.median(result.gap) > 0.9 * width * size  # it floats, wherever it should touch
        errors.append(result.length - truth)
    assert errors[0] > 0.1
    assert np.log10(errors[0] / errors[2]) == pytest.approx(1.0, abs=0.15)
    assert errors[0] > errors[1] > errors[2]


def test_a_thin_penalty_layer_is_unstable() -> None:
    setting = dict(step_size=1.0, damping=0.1, steps=5000, tolerance=1e-6)
    result = lay("sphere", "penalty", width=1e-6 * sphere().size, **setting)
    assert result.status != Ending.CONVERGED
    assert abs(result.length - ours("sphere")) > 1e-4


@pytest.mark.parametrize("stabilisation", [0.05, 0.2, 0.5])
def test_kkt_agrees_with_ours_whatever_the_stabilisation(stabilisation: float) -> None:
    result = lay("vase", "kkt", step_size=10.0, damping=0.1, steps=2000, stabilisation=stabilisation)
    assert result.status == Ending.CONVERGED
    assert result.length == pytest.approx(ours("vase"), rel=1e-9)


def test_kkt_needs_its_stabilisation() -> None:
    result = lay("sphere", "kkt", step_size=3.0, damping=0.1, steps=2000, stabilisation=0.0)
    assert np.abs(result.gap).max() > 1e-3  # once off the surface, always off it


WAVE = np.linspace(0.0, 1.0, 201)
WAVY = np.stack([0.5 * WAVE, WAVE + 0.08 * np.sin(2 * np.pi * WAVE)], 1)


def rub(step_size: float, friction: float = 0.1) -> tuple[Motion, Floats]:
    """A wavy fibre on a cylinder, to be held in part by friction; and the slip it needs where it comes to rest."""
    surface = shapes.cylinder(1.0, 4.0, (256, 16))
    result = run("backward-euler", surface, WAVY[0], WAVY[-1], particles=201, initial=WAVY, steps=20000,
                 step_size=step_size, damping=0.05, friction=friction)  # fmt: skip
    assert result.status == Ending.CONVERGED
    return result, slip(surface, result)


def test_velocity_scaling_breaks_coulombs_law_unless_the_step_is_small() -> None:
    """(4.19) scales after the solve has spread each force over the neighbours, so that particles stick too early."""
    (fine, least), (coarse, some), (stuck, most) = (rub(h) for h in (0.1, 10.0, 1000.0))
    assert least.max() <= 0.1
    assert fine.residual < 1e-4
    assert some.max() > 5.0
    assert coarse.residual > 1e-2
    assert np.mean(most > 0.1) > 0.9  # nearly all of it breaks (3.12) ...
    assert stuck.points == pytest.approx(stuck_start(), abs=1e-12)  # ... because it has not moved at all


def stuck_start() -> Floats:
    return np.asarray(shapes.cylinder(1.0, 4.0, (256, 16)).points(WAVY))


def test_velocity_scaling_makes_the_tension_uneven() -> None:
    """It resists slip along the fibre too, against the constant tension of (3.4): springs are as long as taut."""
    spacing = np.linalg.norm(np.diff(rub(0.1, 0.2)[0].points, axis=0), axis=1)
    assert spacing.max() / spacing.min() > 1.1


def test_without_friction_the_wave_straightens() -> None:
    result, needed = rub(10.0, 0.0)
    assert needed.max() < 1e-6
    assert result.length == pytest.approx(np.hypot(np.pi, 4.0), rel=1e-4)


def test_history_follows_the_run() -> None:
    result = lay("barrel-0.5", "backward-euler", step_size=10.0, damping=0.1, steps=500, history=True)
    assert result.history is not None
    assert len(result.history.length) == result.counters.iterations + 1
    assert result.history.length[-1] == result.length
    assert result.history.residual[-1] == result.residual
    assert result.history.angle[0] > 1e-2
    assert result.history.angle[-1] < 1e-6
    assert np.all(np.diff(result.history.length) < 1e-4)


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        (dict(method="euler"), "no method 'euler'; choose one of explicit-euler"),
        (dict(step_size=0.0), "step_size is 0.0; give a positive number"),
        (dict(steps=0), "steps is 0; give a whole number"),
        (dict(damping=-1.0), "damping is -1.0; give a number that is not negative"),
        (dict(method="kkt", friction=0.1), "kkt has no friction; set friction=0"),
        (dict(end=(0.0, 0.0)), "has no length; give two different ends"),
        (dict(end=(0.0, 1.5)), "v outside"),
        (dict(particles=2), "particles is 2; give a whole number from 3 up"),
        (dict(reuse=0), "reuse is 0"),
        (dict(method="backward-euler", inertial=True), "set inertial=False"),
        (dict(width=-1.0), "width is -1.0"),
        (dict(stabilisation=2.0), "stabilisation is 2.0; give a number from 0 to 1"),
    ],
)
def test_bad_input_is_refused_with_advice(setting: dict[str, Any], message: str) -> None:
    given: dict[str, Any] = (
        dict(method="rk4", start=(0.0, 0.0), end=(0.2, 1.0), steps=10, step_size=1.0, particles=N) | setting
    )
    method, start, end = given.pop("method"), given.pop("start"), given.pop("end")
    with pytest.raises(BadInputError, match=message):
        run(method, barrel(), start, end, **given)
