"""The choice of revolutions: pressing by (6.3), Clairaut's bound, and what the trials say where there is none."""

import numpy as np
import pytest
from layup_shapes import revolved
from scipy.integrate import quad

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.path import solve
from meshwind.planning.alternatives import with_wider_openings
from meshwind.planning.clairaut import profile
from meshwind.planning.families import families, hoop_revolutions, square_revolutions
from meshwind.planning.feasible import Feasible, feasible_revolutions
from meshwind.planning.pressing import intervals, pressing
from meshwind.planning.revolutions import choose_revolutions
from meshwind.planning.trials import holding_trial, trial
from meshwind.surface import Surface, shapes
from meshwind.surface.forms import fundamental_forms

WAIST = 3.0 / (2.0 * np.pi)
"""Turns per v of the rulings of r^2 = 1 + z^2, |z| <= 1.5, at the waist: tan of the ruling is 1 there."""


def barrel(spans: tuple[int, int] = (128, 64)) -> Surface:
    return shapes.revolution(lambda z: 1.0 - 0.3 * (z - 1.0) ** 2, 0.0, 2.0, spans)


def barrel_bound() -> float:
    """Clairaut's integral at c = 0.7, the rim's radius, by z = 1 - cos(q): no root is left."""

    def rate(q: float) -> float:
        rise = 0.3 * np.sin(q) ** 2  # r - c
        r = 0.7 + rise
        slant = np.sqrt(1.0 + (0.6 * np.cos(q)) ** 2)
        return float(0.7 * slant / (r * np.sqrt(0.3 * (r + 0.7))))

    return float(quad(rate, 0.0, np.pi, epsabs=1e-13)[0] / (2.0 * np.pi))


def test_the_hyperboloid_presses_from_its_rulings_on() -> None:
    surface = shapes.hyperboloid(1.0, 1.0, 1.5, (64, 1024))
    where = np.array([[(0.5 - 1.0 / np.sqrt(12.0)) / 64, 0.5], [(20.5 + 1.0 / np.sqrt(12.0)) / 64, 0.5]])
    ((low, high),) = pressing(surface, uv=where).most_common()
    assert low == pytest.approx(WAIST, abs=1e-6)
    assert high == np.inf


def test_the_whole_hyperboloid_presses_from_the_waists_rulings_on() -> None:
    pressed = pressing(shapes.hyperboloid(1.0, 1.0, 1.5, (64, 96)))
    ((low, high),) = pressed.most_common()
    assert low == pytest.approx(WAIST, abs=2e-4)
    assert high == np.inf
    # at z the rulings turn by WAIST / (1 + z^2): with n, |z| >= sqrt(WAIST / n - 1) presses
    z = np.sqrt(WAIST / 0.3 - 1.0)

    def area(height: float) -> float:
        return float(quad(lambda x: np.sqrt(1.0 + 2.0 * x * x), 0.0, height)[0])

    assert pressed.share(np.array([0.3]))[0] == pytest.approx(1.0 - area(z) / area(1.5), abs=0.01)


def test_a_convex_barrel_presses_everywhere() -> None:
    pressed = pressing(barrel())
    assert pressed.most_common() == ((0.0, np.inf),)
    assert pressed.share(np.array([0.0, 0.3, 5.0])) == pytest.approx(1.0)
    assert pressed.most_common(0.1, 0.6) == ((0.1, 0.6),)


def test_intervals_are_where_the_normal_curvature_presses() -> None:
    """Against a scan of (6.3) for both families, at random frames of every kind."""
    rng = np.random.default_rng(5)
    frames = rng.normal(size=(400, 6, 3))
    low, high = intervals(fundamental_forms(frames))
    turns = rng.uniform(0.0, 4.0, 200)
    normal = np.cross(frames[:, 1], frames[:, 2])
    a, b, c = (-(frames[:, k] * normal).sum(axis=1)[:, None] for k in (3, 4, 5))
    presses = a * turns**2 - 2.0 * np.abs(b) * turns + c >= 0.0
    inside = ((low[:, :, None] <= turns) & (turns <= high[:, :, None])).any(axis=1)
    assert np.array_equal(inside, presses)
    assert (low[:, 1] > high[:, 1]).any() and (high[:, 0] < 0.0).any() and np.isinf(high[:, 1]).any()


def test_shares_are_those_of_a_count() -> None:
    rng = np.random.default_rng(6)
    pressed = pressing(shapes.elbow(3.0, 1.0, spans=(24, 16)))
    turns = rng.uniform(0.0, 2.0, 50)
    inside = ((pressed.low[:, :, None] <= turns) & (turns <= pressed.high[:, :, None])).any(axis=1)
    assert pressed.share(turns) == pytest.approx((pressed.weight[:, None] * inside).sum(axis=0), abs=1e-12)
    most = pressed.most_common(0.0, 2.0)
    within = pressed.share(np.array([0.5 * (low + high) for low, high in most]))
    assert (within >= pressed.share(turns).max() - 1e-9).all()


def test_clairaut_bounds_the_barrel() -> None:
    shape = profile(barrel())
    assert shape is not None
    assert shape.presses(0.7)
    assert shape.bound() == pytest.approx(barrel_bound(), rel=1e-6)
    found = feasible_revolutions(barrel())
    assert (found.low, found.by, found.slides) == (0.0, "Clairaut", "both")
    assert found.high == pytest.approx(barrel_bound(), rel=1e-3)


def test_trials_find_clairauts_bound_by_themselves() -> None:
    """The same barrel, stretched along x by too much to count as one of revolution."""
    net = barrel().control_points * [1.0 + 1e-5, 1.0, 1.0]
    found = feasible_revolutions(Surface(net), most=1.0, paths=4)
    assert found.by == "trials"
    assert 0.975 * barrel_bound() < found.high < barrel_bound()
    assert found.slides


def test_bound_of_a_sphere_is_half_a_turn_and_of_a_narrow_middle_none() -> None:
    sphere = profile(shapes.sphere_band(2.0, 0.25 * np.pi, 0.75 * np.pi, (96, 64)))
    assert sphere is not None
    assert sphere.bound() == pytest.approx(0.5, abs=1e-6)
    waisted = profile(shapes.hyperboloid(1.0, 1.0, 1.5, (64, 64)))
    assert waisted is not None
    assert waisted.bound() == np.inf
    assert profile(shapes.cylinder(1.0, 3.0)).bound() == np.inf  # type: ignore[union-attr]


def test_a_tilted_one_ended_shape_is_found_and_others_are_not() -> None:
    turn = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    turn[:, 0] *= np.linalg.det(turn)
    cone = shapes.cone(1.0, 0.5, 3.0)
    tilted = profile(Surface(cone.control_points @ turn.T + [3.0, -2.0, 5.0]))
    straight = profile(cone)
    assert tilted is not None and straight is not None
    # unrolled, the cone is a sector: from the tangent at the near rim, arccos(0.5) of the sector's angle
    assert straight.bound() == pytest.approx(np.arccos(0.5) / (2.0 * np.pi * 0.5 / np.hypot(3.0, 0.5)), rel=1e-6)
    assert tilted.bound() == pytest.approx(straight.bound(), rel=1e-9)
    assert tilted.rims == pytest.approx((1.0, 0.5))
    assert profile(shapes.elbow(3.0, 1.0)) is None
    assert profile(shapes.ellipsoid(1.0, 0.999, 1.5, 0.8, 2.2)) is None


def test_a_cut_back_barrel_is_the_barrel_between_wider_rims() -> None:
    wider = with_wider_openings(barrel(), 1.2)
    assert wider is not None
    shape = profile(wider)
    assert shape is not None
    assert shape.rims == pytest.approx((0.84, 0.84), abs=1e-4)
    assert with_wider_openings(barrel(), 1.5) is None  # it is nowhere so wide
    assert shape.bound() > 0.5


def test_square_winding_is_at_45_degrees() -> None:
    surface = shapes.cylinder(1.0, 4.0)
    assert square_revolutions(surface) == pytest.approx(4.0 / (2.0 * np.pi), rel=1e-4)
    assert hoop_revolutions(surface) == pytest.approx(np.tan(np.radians(80.0)) * 4.0 / (2.0 * np.pi), rel=1e-4)


def test_choice_on_a_barrel_is_square_and_inside_the_bound() -> None:
    chosen = choose_revolutions(barrel(), paths=6, further=False)
    assert np.array(chosen.common) == pytest.approx(np.array([[0.0, barrel_bound()]]), rel=1e-3)
    assert chosen.common_share == pytest.approx(1.0)
    assert 0.0 < chosen.choice < barrel_bound()
    assert abs(chosen.choice - chosen.square) < 1.0 / 12.0
    assert chosen.choice * 12.0 == pytest.approx(round(chosen.choice * 12.0))  # both families end in the same points
    assert chosen.chosen.feasible and chosen.chosen.bridged_share == 0.0
    assert "no fibre bridges" in chosen.why and "0.675" in chosen.why


def test_choice_on_the_hyperboloid_presses_where_the_square_winding_would_not() -> None:
    chosen = choose_revolutions(shapes.hyperboloid(1.0, 1.0, 1.5, (64, 64)), paths=6, further=False)
    assert chosen.choice > WAIST - 1e-3 > chosen.square
    assert chosen.chosen.bridged_share == 0.0
    assert not np.isfinite(chosen.feasible.high)


def test_choice_bridges_least_where_pressing_everywhere_is_impossible() -> None:
    """An arched vase with a deep oval waist, against a scan of windings at full resolution."""

    def oval(u: Floats, v: Floats) -> Floats:
        r = 1.0 - 0.45 * np.exp(-(((v - 0.5) / 0.16) ** 2))
        t = 2.0 * np.pi * u
        return np.stack([1.3 * r * np.cos(t), 0.8 * r * np.sin(t), 3.0 * v + 0.3 * np.sin(t) * np.sin(np.pi * v)], -1)

    surface = shapes.parametric(oval, (32, 32))
    chosen = choose_revolutions(surface, paths=6, particles=145, further=False, most=1.0)
    scan = []
    for turns in np.linspace(0.05, 1.0, 20):
        rims = families(surface, 6, float(turns))
        laid = solve(surface, rims.start, rims.end, particles=145, family=rims.family)
        steps = np.linalg.norm(np.diff(laid.points, axis=1), axis=2)
        off = ~(laid.on_surface[:, 1:] & laid.on_surface[:, :-1])
        if (laid.status == 0).all():
            scan.append((steps * off).sum() / steps.sum())
    assert min(scan) > 0.01
    assert chosen.chosen.feasible
    assert chosen.chosen.bridged_share <= min(scan) + 0.02
    assert len(chosen.trials) > 20


def test_more_friction_and_wider_openings_hold_more() -> None:
    cap = shapes.revolution(lambda z: np.sqrt(1.0 - 0.85 * z**2), -1.0, 1.0, (64, 48))
    chosen = choose_revolutions(cap, paths=4, particles=101)
    assert chosen.with_friction > 1.05 * chosen.feasible.high
    assert trial(cap, chosen.with_friction, friction=0.2, paths=3).feasible
    assert not trial(cap, chosen.with_friction, paths=3).feasible
    assert chosen.with_opening == 0.0 or chosen.with_opening > chosen.feasible.high


def test_a_surface_that_is_no_annulus_is_refused() -> None:
    patch = Surface(shapes.cylinder(1.0, 2.0).control_points[:40], periodic=False)
    with pytest.raises(BadInputError, match="closes in u"):
        choose_revolutions(patch)


def test_trials_measure_what_bridges() -> None:
    flask = revolved(lambda v: 1.0 - 0.35 * np.exp(-(((v - 0.5) / 0.16) ** 2)), 32, 32)
    assert trial(flask, 0.1).bridged_share > 0.2
    assert trial(flask, 0.1).feasible


def test_where_no_number_holds_all_starts_one_is_taken_that_holds_those_asked_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """No small shape is known of which that is so: of a scanned femur it is. The barrel's numbers are kept back."""
    part = barrel((32, 16))
    bound = feasible_revolutions(part, 0.0, None, 4, 101).high
    beyond = trial(part, 1.2 * bound, 0.0, 3)
    assert not beyond.feasible
    none = Feasible(0.0, 0.0, "trials", "both", (beyond,))
    monkeypatch.setattr("meshwind.planning.revolutions.feasible_revolutions", lambda *_: none)
    found = choose_revolutions(part, paths=4, particles=101, further=False)
    assert 0.5 * bound < found.choice < bound and found.chosen.feasible
    assert "these fibres hold, others between them may not" in found.why
    assert holding_trial(part, found.choice, 0.0, 4, 101) == found.chosen  # a number that holds stays
