"""The forward solver's order and error, its own reversal, the identities of space, its batches and arguments."""

import numba
import numpy as np
import pytest
from comparison.problems import ellipsoid
from forward_shapes import apart, coarse_barrel, dome, fine_barrel, tube
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import DOP853, solve_ivp

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.march import Stop, trace, traces
from meshwind.march.forward import marched
from meshwind.surface import Surface, shapes

# accuracy and order


def test_rk4_is_of_order_four() -> None:
    truth = trace(dome(), (0.2, 0.3), 1.1, 1.6, slip=0.1, tolerance=1e-14)
    errors = [
        apart(trace(dome(), (0.2, 0.3), 1.1, 1.6, slip=0.1, method="rk4", step=1.6 / n), truth) for n in (16, 32, 64)
    ]
    assert truth.stop == Stop.LENGTH
    assert np.log2(np.divide(errors[:-1], errors[1:])) == pytest.approx([4, 4], abs=0.15)


@pytest.mark.parametrize("slip", [0.0, 0.15])
def test_agrees_with_scipy(slip: float) -> None:
    """SciPy's DOP853 over a right-hand side of another make: the acceleration is solved for, without (3.21)."""
    surface = coarse_barrel()

    def right(_: float, y: Floats) -> Floats:
        _, su, sv, suu, suv, svv = surface.frames(y[None, :2])[0]
        bend = y[2] ** 2 * suu + 2 * y[2] * y[3] * suv + y[3] ** 2 * svv
        cross = np.cross(su, sv)
        normal = cross / np.linalg.norm(cross)
        side = -slip * (bend @ normal) * np.cross(normal, y[2] * su + y[3] * sv)
        a, b, _ = np.linalg.solve(np.column_stack([su, sv, normal]), side - bend)
        return np.array([y[2], y[3], a, b])

    path = trace(surface, (0.05, 0.3), 1.2, 3.0, slip=slip, tolerance=1e-13)
    first = np.r_[path.uv[0], path.uv_rate[0]]
    other = solve_ivp(right, (0, 3.0), first, method=DOP853, rtol=1e-13, atol=1e-14, max_step=0.01)
    assert np.r_[path.uv[-1], path.uv_rate[-1]] == pytest.approx(other.y[:, -1], abs=1e-11)


def test_error_follows_the_tolerance() -> None:
    """Honest: on a surface whose pieces are large, the error stays within a few tolerances."""
    truth = trace(dome(), (0.2, 0.3), 1.1, 1.6, slip=0.1, tolerance=1e-14)
    for tolerance in (1e-4, 1e-6, 1e-8, 1e-10, 1e-12):
        path = trace(dome(), (0.2, 0.3), 1.1, 1.6, slip=0.1, tolerance=tolerance)
        assert apart(path, truth) < 10 * tolerance


@pytest.mark.parametrize("slip", [0.0, 0.2])
@pytest.mark.parametrize("surface", [coarse_barrel, fine_barrel, ellipsoid])
def test_marching_back_returns_to_the_start(surface: object, slip: float) -> None:
    """Backwards left is right: the slip changes sign."""
    there = trace(surface(), (0.1, 0.4), 1.3, 2.0, slip=slip)  # type: ignore[operator]
    back = trace(surface(), there.uv[-1], -there.uv_rate[-1], there.arc_length[-1], slip=-slip)  # type: ignore[operator]
    assert there.arc_length[-1] == 2.0
    assert back.uv[-1] == pytest.approx(there.uv[0], abs=1e-13)
    assert back.tangent[-1] == pytest.approx(-there.tangent[0], abs=1e-12)


# identities


def turned(seed: int) -> Floats:
    q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return np.asarray(q * np.linalg.det(q))


@pytest.mark.parametrize(
    ("scale", "shift", "error"), [(1.0, 0.0, 1e-12), (1e-6, 0.0, 1e-12), (1e6, 0.0, 1e-12), (1.0, 1e3, 1e-9)]
)
def test_rigid_motion_and_scale(scale: float, shift: float, error: float) -> None:
    """Far away the control points themselves are rounded, and that is all that is lost."""
    matrix = turned(4)
    moved = Surface(scale * (ellipsoid().control_points @ matrix.T) + shift)
    here = trace(ellipsoid(), (0.1, 0.4), 1.2, 3.0, slip=0.1, step=0.1)
    there = trace(moved, (0.1, 0.4), 1.2, 3.0 * scale, slip=0.1, step=0.1 * scale)
    assert there.stop == here.stop
    assert there.uv == pytest.approx(here.uv, abs=error)
    assert there.points == pytest.approx(scale * (here.points @ matrix.T) + shift, abs=error * scale * (1 + shift))
    assert there.normal_curvature * scale == pytest.approx(here.normal_curvature, abs=1e3 * error)


def mirrored(surface: Surface) -> Surface:
    """x to -x and u to -u, which keeps the normals outward; control point k stands at knot k - 1."""
    k = np.arange(len(surface.control_points))
    return Surface(surface.control_points[(2 - k) % len(k)] * [-1, 1, 1])


@settings(max_examples=40, deadline=None, derandomize=True)
@given(u=st.floats(-3, 3), v=st.floats(0, 1), angle=st.floats(-4, 4), length=st.floats(0.01, 6), slip=st.floats(-1, 1))
def test_the_mirror_image_winds_the_other_way(u: float, v: float, angle: float, length: float, slip: float) -> None:
    here = trace(ellipsoid(), (u, v), angle, length, slip=slip)
    there = trace(mirrored(ellipsoid()), (-u, v), -angle, length, slip=-slip)
    assert there.stop == here.stop
    assert there.arc_length[-1] == pytest.approx(here.arc_length[-1], abs=1e-10)
    assert there.points[-1] == pytest.approx(here.points[-1] * [-1, 1, 1], abs=1e-10)
    for path in (here, there):
        assert np.isfinite(path.points).all()
        assert np.linalg.norm(path.tangent, axis=1) == pytest.approx(np.ones(len(path)), abs=1e-14)
        assert np.all(np.diff(path.arc_length) > 0)


# the batch and its arguments


def test_a_batch_is_its_paths_whatever_the_threads() -> None:
    rng = np.random.default_rng(5)
    start, angle = rng.random((40, 2)), rng.uniform(-np.pi, np.pi, 40)
    length, slip = rng.uniform(0.1, 20, 40), rng.uniform(-0.2, 0.2, 40)
    before = numba.get_num_threads()
    batches = []
    try:
        for threads in (1, before):
            numba.set_num_threads(threads)
            batches.append(traces(ellipsoid(), start, angle, length, slip=slip))
    finally:
        numba.set_num_threads(before)
    single = [trace(ellipsoid(), *one, slip=s) for *one, s in zip(start, angle, length, slip, strict=True)]
    for path, *others in zip(single, *batches, strict=True):
        for other in others:
            assert np.array_equal(path.points, other.points)
            assert (path.stop, path.evaluations) == (other.stop, other.evaluations)


def test_step_sets_where_points_are_given() -> None:
    path = trace(ellipsoid(), (0, 0.5), 1.4, 1.05, step=0.1)
    assert path.arc_length == pytest.approx(np.r_[np.arange(11) * 0.1, 1.05], abs=1e-15)
    assert apart(path, trace(ellipsoid(), (0, 0.5), 1.4, 1.05)) < 1e-13


def test_long_paths_outgrow_one_chunk() -> None:
    path = trace(tube(), (0, 0.5), np.radians(89), 60.0)
    assert len(path) > 3000
    assert path.points[-1, 2] == pytest.approx(2.0 + 60 * np.cos(np.radians(89)), abs=1e-9)


def test_angle_is_from_the_direction_of_v_towards_u() -> None:
    """On a surface whose s_u and s_v are not at right angles; a tangent's length does not matter."""
    skew = shapes.parametric(lambda u, v: np.stack([u + v, 2 * v, 0 * u], -1), (4, 4), periodic=False)
    path = trace(skew, (0.5, 0.5), 0.3, 0.1)
    along, across = np.array([1, 2, 0]) / np.sqrt(5), np.array([2, -1, 0]) / np.sqrt(5)
    assert path.tangent[0] == pytest.approx(np.cos(0.3) * along + np.sin(0.3) * across, abs=1e-14)
    again = trace(skew, (0.5, 0.5), 1e-9 * path.uv_rate[0], 0.1)
    assert again.points[-1] == pytest.approx(path.points[-1], abs=1e-14)


@pytest.mark.parametrize(("change", "why"), [
    (dict(start=(0, 1.5)), "off the surface"), (dict(start=(0, np.nan)), "NaN"), (dict(start=(0, 0, 0)), "start"),
    (dict(direction=(0, 0)), "not zero"), (dict(direction=(0, 0, 1)), "direction"), (dict(length=0), "length"),
    (dict(length=np.inf), "length"), (dict(slip=np.nan), "slip"), (dict(method="euler"), "adaptive"),
    (dict(press="no"), "press"), (dict(step=-1), "step"), (dict(tolerance=1e-20), "tolerance"),
])  # fmt: skip
def test_bad_arguments_are_refused(change: dict[str, object], why: str) -> None:
    arguments: dict[str, object] = dict(start=(0, 0), direction=0.5, length=1.0) | change
    with pytest.raises(BadInputError, match=why):
        trace(tube(), **arguments)  # type: ignore[arg-type]


def test_every_stop_has_advice() -> None:
    assert all(stop.advice for stop in Stop)


def test_a_piece_of_the_surface_costs_two_steps() -> None:
    """One to see where the path leaves it and one that ends there, of 12 evaluations each, and two for the pressure."""
    path = trace(fine_barrel(), (0, 0.3), 1.2, 3.2)
    assert path.evaluations < 28 * len(path)


@pytest.mark.parametrize("surface", [fine_barrel(), coarse_barrel()], ids=["many spans", "few spans"])
def test_fibres_beside_marched_ones_are_what_a_march_gives(surface: Surface) -> None:
    """As far as they are said to be good: a little beside all are, far beside none, on surfaces with kinks as well."""
    start = np.stack([np.arange(9) / 9, np.zeros(9)], axis=1)
    angle, most = np.linspace(0.4, 1.2, 9), 2e-11
    first = marched(surface, start, angle, 9.0, slip=0.05, press="ignore")
    assert (first.stop == Stop.RIM_END).all()
    shares = []
    for more in (1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 0.1):
        found, good = first.beside(np.full(9, 0.05 + more), most)
        exact = marched(surface, start, angle, 9.0, slip=0.05 + more, press="ignore", tolerance=1e-14)
        size = [surface.size, 1.0, 1.0, 1.0 / surface.size, 1.0 / surface.size]
        assert (np.abs(found.last - exact.last)[good] / size).max(initial=0.0) < most
        assert (found.last[good, 2] == 1.0).all()
        shares.append(good.mean())
    assert shares[0] == 1.0 and shares[-1] == 0.0
