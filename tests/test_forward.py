"""The forward solver against exact answers: geodesics, slip lines, and where they stop."""

import numpy as np
import pytest
from comparison.problem import TURN, Problem
from comparison.problems import PROBLEMS, barrel_clairaut, barrel_length, hyperboloid
from forward_shapes import fine_barrel, gutter, parabola, tube
from scipy.optimize import brentq

from meshwind.core.cast import Floats
from meshwind.march import Stop, trace
from meshwind.surface import shapes

SHOT = [p for p in PROBLEMS if p.name.startswith(("cone", "barrel", "sphere", "ellipsoid"))]


# exact answers


@pytest.mark.parametrize("problem", SHOT, ids=lambda p: p.name)
def test_shooting_at_the_far_end_gives_the_exact_length(problem: Problem) -> None:
    """The direction that hits the end point is found from outside; length and rim are the solver's."""
    surface, longest = problem.surface(), 3 * problem.length

    def miss(angle: float) -> float:
        return float(trace(surface, problem.start, angle, longest).uv[-1, 0] - problem.end[0])

    low, high = 0.05, 0.1
    while miss(high) < 0:
        low, high = high, high + 0.05
    found = trace(surface, problem.start, brentq(miss, low, high, xtol=1e-14), longest)
    assert found.stop == Stop.RIM_END
    assert found.uv[-1] == pytest.approx(problem.end, abs=1e-11)
    assert found.arc_length[-1] == pytest.approx(problem.length, rel=1e-8)


@pytest.mark.parametrize("twist", [0.5, 1.5, 2.5])
def test_clairaut_constant(twist: float) -> None:
    c = barrel_clairaut(twist)
    path = trace(fine_barrel(), (0, 0), np.arcsin(c / 0.7), 10.0)
    x, y, _ = path.points.T
    assert x * path.tangent[:, 1] - y * path.tangent[:, 0] == pytest.approx(np.full(len(path), c), abs=1e-9)
    assert path.stop == Stop.RIM_END
    assert path.arc_length[-1] == pytest.approx(barrel_length(twist), abs=1e-9)
    assert path.uv[-1] == pytest.approx([twist / TURN, 1.0], abs=1e-9)


def test_great_circle_closes() -> None:
    sphere = shapes.sphere_band(2.0, 0.25 * np.pi, 0.75 * np.pi, (512, 256))
    path = trace(sphere, (0.3, 0.5), np.radians(60), 2 * TURN)
    assert path.stop == Stop.LENGTH
    assert path.arc_length[-1] == 2 * TURN
    assert path.points[-1] == pytest.approx(path.points[0], abs=1e-9)
    assert path.uv[-1] == pytest.approx(path.uv[0] + [1, 0], abs=1e-9)
    assert path.normal_curvature == pytest.approx(np.full(len(path), 0.5), abs=1e-4)


def test_developed_it_is_a_straight_line() -> None:
    """On a parabolic cylinder, which the spline holds exactly, to round-off."""
    angle, start = 0.7, (0.2, 0.1)
    path = trace(gutter(), start, angle, 1.5, tolerance=1e-14)
    rolled = np.array([parabola(x) for x in path.points[:, 0]])
    assert rolled == pytest.approx(parabola(-0.6) + np.sin(angle) * path.arc_length, abs=2e-14)
    assert path.points[:, 1] == pytest.approx(0.2 + np.cos(angle) * path.arc_length, abs=2e-14)
    assert path.normal_curvature == pytest.approx(np.sin(angle) ** 2 / (1 + path.points[:, 0] ** 2) ** 1.5, rel=1e-11)


def test_torus_outside_and_inside() -> None:
    torus = shapes.torus(3.0, 1.0, np.pi, (192, 256))
    outside = trace(torus, (0, 0), 0.0, 100.0)
    assert (outside.stop, outside.arc_length[-1]) == (Stop.RIM_END, pytest.approx(4 * np.pi, rel=1e-8))
    assert np.abs(outside.uv[:, 0]).max() < 1e-9
    inside = trace(torus, (0.5, 0.2), 0.0, 1.0)
    assert (inside.stop, len(inside)) == (Stop.LIFTS_OFF, 1)
    assert trace(torus, (0.5, 0.2), 0.0, 1.0, press="ignore").stop == Stop.LENGTH


def test_hyperboloid_presses_only_beyond_the_rulings() -> None:
    for degrees, stop in ((0, Stop.LIFTS_OFF), (44, Stop.LIFTS_OFF), (46, Stop.LENGTH), (90, Stop.LENGTH)):
        path = trace(hyperboloid(), (0, 0.5), np.radians(degrees), 0.5)
        assert path.stop == stop
        assert (len(path) == 1) == (stop == Stop.LIFTS_OFF)
    ruling = trace(hyperboloid(), (0, 0.5), np.radians(45), 1.5, press="ignore")
    straight = ruling.points[0] + ruling.arc_length[:, None] * np.array([0, 1, 1]) / np.sqrt(2)
    assert ruling.points == pytest.approx(straight, abs=1e-7)


# constant slip


@pytest.mark.parametrize("slip", [0.2, -0.2, 1.0])
def test_slip_line_on_a_cylinder_is_a_catenary(slip: float) -> None:
    """d alpha/ds = -slip sin^2(alpha) / r, so cot(alpha) = cot(alpha0) + slip s / r; z and r theta follow."""
    r, start = 1.5, np.radians(70)
    path = trace(tube(2048), (0.1, 0.5), start, 4.0, slip=slip)
    c0 = 1 / np.tan(start)
    c = c0 + slip * path.arc_length / r
    assert path.points[:, 2] == pytest.approx(2.0 + r / slip * (np.hypot(1, c) - np.hypot(1, c0)), abs=1e-9)
    assert path.uv[:, 0] == pytest.approx(0.1 + (np.arcsinh(c) - np.arcsinh(c0)) / slip / TURN, abs=1e-9)
    assert path.geodesic_curvature == pytest.approx(slip * path.normal_curvature, rel=1e-15)


@pytest.mark.parametrize("slip", [0.3, -0.3])
def test_curvatures_measured_on_the_curve_have_the_slip(slip: float) -> None:
    """Differences of order 6 of the tangents in space; left as seen from outside is normal x tangent."""
    h = 0.01
    path = trace(gutter(), (0.2, 0.1), 0.9, 1.2, slip=slip, step=h)
    t = path.tangent
    bend = (45 * (t[4:-2] - t[2:-4]) - 9 * (t[5:-1] - t[1:-5]) + (t[6:] - t[:-6])) / (60 * h)
    n, left = path.normal[3:-3], np.cross(path.normal, t)[3:-3]
    kn, kg = -(bend * n).sum(axis=1), (bend * left).sum(axis=1)
    assert kg / kn == pytest.approx(np.full(len(kn), slip), abs=1e-10)
    assert kn == pytest.approx(path.normal_curvature[3:-3], abs=1e-10)
    assert kg == pytest.approx(path.geodesic_curvature[3:-3], abs=1e-10)


def test_friction_holds_nothing_where_nothing_presses() -> None:
    """Past the inflection a fibre kept on the surface goes on as a geodesic: straight when developed."""
    path = trace(gutter(turn=2.0), (0.8, 0.1), 0.9, 0.5, slip=0.5, press="ignore")
    assert np.all(path.normal_curvature < 0)
    assert not path.geodesic_curvature.any()
    assert path.points[-1, 1] == pytest.approx(0.2 + np.cos(0.9) * path.arc_length[-1], abs=1e-13)


# where it stops


@pytest.mark.parametrize(
    ("angle", "stop", "uv"),
    [(0.5, Stop.RIM_END, (None, 1.0)), (2.6, Stop.RIM_START, (None, 0.0)), (1.4, Stop.EDGE, (1.0, None)),
     (-1.4, Stop.EDGE, (0.0, None))],
)  # fmt: skip
@pytest.mark.parametrize("method", ["adaptive", "rk4"])
def test_stops_on_rims_and_edges_to_round_off(
    method: str, angle: float, stop: Stop, uv: tuple[float | None, float | None]
) -> None:
    step = None if method == "adaptive" else 0.002
    path = trace(gutter(), (0.5, 0.5), angle, 9.0, method=method, step=step, tolerance=1e-14)  # type: ignore[arg-type]
    ends = {Stop.RIM_END: 1 / np.cos(angle), Stop.RIM_START: -1 / np.cos(angle)}
    exact = ends.get(stop, parabola(1.0) / abs(np.sin(angle)))
    assert path.stop == stop
    assert path.arc_length[-1] == pytest.approx(exact, abs=1e-14 if method == "adaptive" else 1e-11)
    for got, want in zip(path.uv[-1], uv, strict=True):
        assert want is None or got == want


@pytest.mark.parametrize(("method", "error"), [("adaptive", 1e-14), ("rk4", 1e-10)])
def test_lifts_off_at_the_inflection(method: str, error: float) -> None:
    """z'' = -1 + 2 x vanishes at x = 0.5, whatever the direction."""
    path = trace(gutter(turn=2.0), (0.3, 0.1), 0.9, 9.0, method=method, step=None if method == "adaptive" else 0.002)  # type: ignore[arg-type]
    assert path.stop == Stop.LIFTS_OFF
    assert path.points[-1, 0] == pytest.approx(0.5, abs=error)
    assert np.all(path.normal_curvature[:-1] > 0)


def test_a_dip_within_one_step_is_seen() -> None:
    """z'' = 0.002 - 4 x^2 is below 0 at both ends of the step, but not where the fibre passes x = 0."""

    def formula(u: Floats, v: Floats) -> Floats:
        x = 2 * u - 1
        return np.stack([x, 2 * v, 1e-3 * x**2 - x**4 / 3], -1)

    surface = shapes.parametric(formula, (400, 4), periodic=False)
    path = trace(surface, (0.25, 0.1), 1.2, 9.0, method="rk4", step=0.2)
    assert path.stop == Stop.LIFTS_OFF
    assert path.points[-1, 0] == pytest.approx(-np.sqrt(2e-3) / 2, abs=1e-3)


def test_torus_lifts_off_where_clairaut_says() -> None:
    """Ring radius times cos(alpha) is c; kn = c^2 cos(t) / rho^3 + 1 - c^2 / rho^2 for tube radius 1."""
    c = 3.0 * np.cos(np.radians(20))

    def kn(t: float) -> float:
        rho = 3.0 + np.cos(t)
        return float(c**2 * np.cos(t) / rho**3 + 1 - c**2 / rho**2)

    torus = shapes.torus(3.0, 1.0, spans=(512, 512))
    path = trace(torus, (0.25, 0.1), np.radians(20), 20.0)
    assert path.stop == Stop.LIFTS_OFF
    assert path.uv[-1, 0] == pytest.approx(brentq(kn, TURN / 4, TURN / 2) / TURN, abs=1e-5)


@pytest.mark.parametrize(("margin", "stop"), [(1e-7, Stop.LENGTH), (-1e-7, Stop.RIM_START)])
@pytest.mark.parametrize("method", ["adaptive", "rk4"])
def test_grazing_a_rim(method: str, margin: float, stop: Stop) -> None:
    """The catenary's lowest point lies just above or just below the rim, in the middle of a step."""
    slip, start = 0.4, np.radians(110)
    depth = 1.5 / slip * (np.hypot(1, 1 / np.tan(start)) - 1)
    v = (depth + margin) / 4.0
    path = trace(tube(), (0.1, v), start, 4.0, slip=slip, method=method, step=None if method == "adaptive" else 0.03)  # type: ignore[arg-type]
    assert path.stop == stop
    assert path.uv[-1, 1] == 0.0 or stop == Stop.LENGTH


def test_starting_outward_on_a_rim_stops_at_once() -> None:
    for v, angle, stop in ((0.0, 2.0, Stop.RIM_START), (1.0, 1.0, Stop.RIM_END)):
        path = trace(tube(), (0.1, v), angle, 1.0)
        assert (path.stop, len(path)) == (stop, 1)
        back = trace(tube(), (0.1, v), np.pi - angle, 1.0)
        assert (back.stop, back.arc_length[-1]) == (Stop.LENGTH, 1.0)


def test_along_a_cylinder_nothing_lifts() -> None:
    """Normal curvature is 0 but for round-off on a straight ruling; and a hoop may run along a knot line."""
    up = trace(tube(), (0.1, 0.0), 0.0, 9.0)
    assert (up.stop, up.arc_length[-1]) == (Stop.RIM_END, pytest.approx(4.0, abs=1e-13))
    hoop = trace(tube(), (0.1, 0.625), np.pi / 2, 3 * TURN)  # v on a knot line
    assert hoop.stop == Stop.LENGTH
    assert hoop.uv[-1] == pytest.approx([2.1, 0.625], abs=1e-9)


def test_a_surface_that_folds_up_is_said_not_nan() -> None:
    """At the fold v = 0.45 the tangent plane is lost; RK4, without error control, may leap over it."""
    surface = shapes.parametric(lambda u, v: np.stack([u, (v - 0.45) ** 2, 0 * u], -1), (4, 4), periodic=False)
    for method in ("adaptive", "rk4"):
        path = trace(surface, (0.5, 0.2), 0.1, 1.0, method=method)  # type: ignore[arg-type]
        if method == "adaptive":
            assert path.stop == Stop.STEP_LIMIT
            assert path.uv[-1, 1] == pytest.approx(0.45, abs=1e-5)
        for values in (path.points, path.tangent, path.normal, path.normal_curvature, path.uv_rate):
            assert np.isfinite(values).all()
