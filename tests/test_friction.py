"""Coulomb friction against exact curves on a cylinder, and against the law itself everywhere else."""

import pickle
from typing import Any

import numpy as np
import pytest
from comparison.problem import TURN
from comparison.problems import SLIDING, TABLE, barrel
from comparison.sliding import Sliding, tube
from friction_checks import BRIDGED, SHAPES, bent, forces, lateral
from scipy.optimize import brentq

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.path import Paths, Status, solve
from meshwind.path.friction import Friction, friction_from, friction_of

LAW = 1e-3
"""How far |kg| / kn may pass mu, over mu."""
COEFFICIENTS = (0.0, 0.02, 0.1, 0.3, 0.6, 1.0)
START, END = np.array([(0.0, 0.0), (0.3, 0.02), (0.7, 0.0)]), np.array([(0.3, 1.0), (-0.25, 0.97), (1.25, 1.0)])


def slide(case: Sliding, particles: int) -> Paths:
    problem = case.problem("", "")
    return solve(case.surface(), [problem.start], [problem.end], particles=particles, friction=case.mu,
                 initial=case.initial(particles)[None])  # fmt: skip


def middle_error(case: Sliding, particles: int) -> float:
    paths = slide(case, particles)
    assert paths.status[0] == Status.CONVERGED
    return abs(float(np.interp(0.0, paths.uv[0, :, 0], paths.points[0, :, 2])) - case.middle)


def stuck_limit(case: Sliding, particles: int) -> tuple[float, float]:
    """|t| half way between the last particle that moved and the first that did not, and the spacing in t there."""
    paths = slide(case, particles)
    t = paths.uv[0, :, 0] * TURN
    fall = np.abs(paths.points[0, :, 2] - 0.5 * case.k * (case.half**2 - t**2))
    moved = np.flatnonzero(fall > 1e-9)
    first, last = moved[0], moved[-1]
    assert first + last == particles - 1  # symmetric
    return 0.5 * (t[last] + t[last + 1]), t[last + 1] - t[last]


@pytest.mark.parametrize("name", ["catenary-0.3", "catenary-0.2"])
def test_a_sliding_fibre_becomes_a_catenary(name: str) -> None:
    errors = [middle_error(SLIDING[name], n) for n in (51, 101, 201, 401)]
    assert errors[-1] <= 2e-5
    assert np.log2(errors[0] / errors[-1]) / 3 >= 1.9


def test_stick_and_slip_meet_where_they_should() -> None:
    case = SLIDING["stick-slip"]
    errors = [middle_error(case, n) for n in (51, 201, 401, 1601)]
    assert errors[2] <= 1e-4
    assert np.log2(errors[0] / errors[-1]) / 5 >= 1.8
    for n in (201, 401, 1601):
        limit, spacing = stuck_limit(case, n)
        assert limit == pytest.approx(case.slid, abs=spacing)


def test_what_never_moved_lies_on_its_start_exactly() -> None:
    case = SLIDING["stick-slip"]
    paths = slide(case, 401)
    t = paths.uv[0, :, 0] * TURN
    stuck = np.abs(t) > case.slid + 2 * case.half / 400
    assert stuck.sum() > 50
    assert paths.points[0, stuck, 2] == pytest.approx(0.5 * case.k * (case.half**2 - t[stuck] ** 2), abs=1e-13)


@pytest.mark.parametrize("mu", [0.81, 0.9])
def test_a_start_that_friction_holds_does_not_move(mu: float) -> None:
    """The parabola needs |kg| / kn <= k = 0.8."""
    paths = slide(Sliding(mu, 0.8, np.pi), 201)
    t = paths.uv[0, :, 0] * TURN
    assert paths.status[0] == Status.CONVERGED
    assert paths.points[0, :, 2] == pytest.approx(0.4 * (np.pi**2 - t**2), abs=1e-13)


@pytest.mark.parametrize("mu", COEFFICIENTS)
@pytest.mark.parametrize("name", SHAPES)
def test_coulombs_law_holds_at_every_contact(name: str, mu: float) -> None:
    """Nothing passes mu, and what slides to the last is held by all of it: a fibre does not slide further than it must.

    The side to which a particle lies of its start says nothing: it may have slid there and part of the way back.
    """
    paths = solve(SHAPES[name](), START, END, particles=301, friction=mu)
    assert (paths.status == Status.CONVERGED).all()
    side, press, uneven = forces(paths)
    touching = paths.on_surface[:, 1:-1]
    assert (np.abs(side) <= mu * (1 + LAW) * np.maximum(press, 0.0) + 1e-8)[touching].all()
    assert press[touching].min(initial=0.0) >= -2e-9  # nothing is pulled off
    assert uneven.max() <= 1e-2
    away = lateral(paths, START, END)[:, 1:-1]
    moved = touching & (np.abs(away) > 1e-6)
    if mu > 0.0:
        held = np.abs(side) >= mu * press * (1 - 1e-2) - 1e-8
        assert held[moved].mean() > 0.5 if moved.any() else (np.abs(away[touching]) <= 1e-6).all()
    if name in BRIDGED and mu == 0.1:
        assert not touching.all()


@pytest.mark.parametrize("mu", COEFFICIENTS)
def test_the_slip_of_the_certificate_keeps_the_law(mu: float) -> None:
    for name in SHAPES:
        paths = solve(SHAPES[name](), START, END, particles=301, friction=mu)
        assert np.nanmax(paths.slip) <= mu * (1 + LAW) + 1e-6
        assert np.isnan(paths.slip[~paths.on_surface]).all()
        assert paths.friction == mu


@pytest.mark.parametrize("name", SHAPES)
def test_no_friction_is_the_geodesic_and_little_is_near_it(name: str) -> None:
    surface = SHAPES[name]()
    smooth = solve(surface, START, END, particles=201)
    again = solve(surface, START, END, particles=201, friction=np.zeros((4, 7)))
    assert np.array_equal(smooth.points, again.points)
    away = [
        np.abs(solve(surface, START, END, particles=201, friction=mu).points - smooth.points).max()
        for mu in (1e-2, 1e-3, 1e-4)
    ]
    assert away[2] <= 2e-3 * surface.size
    assert away[2] <= 0.2 * away[1] + 1e-9 * surface.size


def rising(places: Floats) -> Floats:
    """Friction that rises with the height on `tall`."""
    return np.asarray(0.1 + 0.1 * (places[:, 2] + 1.0))


def test_table_function_and_vertex_field_agree() -> None:
    case = Sliding(0.3, 0.8, np.pi)
    surface = case.surface()
    problem = case.problem("", "")
    initial = case.initial(201)[None]
    height = case.top + 2.0
    table = 0.1 + 0.1 * height * np.tile(np.linspace(0.0, 1.0, 2), (3, 1))
    u, v = np.meshgrid(np.arange(400) / 400, np.linspace(0.0, 1.0, 401), indexing="ij")
    places = surface.points(np.stack([u.ravel(), v.ravel()], axis=1))
    vertex = friction_from(surface, places, rising(places))
    ways: tuple[object, ...] = (table, rising, vertex, friction_of(surface, table))
    found = [
        solve(surface, [problem.start], [problem.end], particles=201, friction=way, initial=initial)  # type: ignore[arg-type]
        for way in ways
    ]
    for paths, tolerance in zip(found, (0.0, 1e-9, 5e-4, 0.0), strict=True):
        assert paths.status[0] == Status.CONVERGED
        assert np.abs(paths.points - found[0].points).max() <= tolerance * surface.size
        assert paths.friction == pytest.approx(0.1 + 0.1 * height, rel=5e-3)
    side, press, _ = forces(found[0])
    allowed = rising(found[0].points[0, 1:-1])
    assert (np.abs(side[0]) <= allowed * press[0] * (1 + LAW) + 1e-8).all()
    used = np.abs(side[0]) / (allowed * press[0])
    assert used.max() == pytest.approx(1.0, abs=LAW)  # it slid somewhere, and there the local friction is used up


def test_a_constant_field_is_the_number() -> None:
    surface = bent()
    number = solve(surface, START, END, particles=201, friction=0.15)
    field = solve(surface, START, END, particles=201, friction=lambda places: np.full(len(places), 0.15))
    assert np.abs(number.points - field.points).max() <= 1e-9 * surface.size


def test_rough_half_and_smooth_half() -> None:
    """A parabola z = k/2 (half^2 - t^2) that holds where t < 0 (friction R > k) and slips where t > 0 (none).

    At rest: straight from t = 0 to its end; on the rough side a catenary with kg / kn = -R, tangent to the straight
    part and to what is left of the parabola, z' = sinh(asinh(k x) - R (t + x)) for t from -x to 0.
    """
    k, half, rough = 0.4, 2.6, 0.6
    case = Sliding(0.3, k, half)

    def slope(x: float) -> float:
        """z' at t = 0 where the catenary begins at t = -x."""
        return float(np.sinh(np.arcsinh(k * x) - rough * x))

    def miss(x: float) -> float:
        rise = (np.cosh(np.arcsinh(k * x)) - np.cosh(np.arcsinh(k * x) - rough * x)) / rough
        return float(0.5 * k * (half**2 - x**2) + rise + slope(x) * half)

    x = float(brentq(miss, 1e-9, half))
    surface, problem = case.surface(), case.problem("", "")
    table = np.zeros((4096, 2))
    table[2048:] = rough  # u from -1/2 to 0
    errors = []
    for n in (201, 801):
        paths = solve(surface, [problem.start], [problem.end], particles=n, initial=case.initial(n)[None],
                      friction=table)  # fmt: skip
        assert paths.status[0] == Status.CONVERGED
        t, z = paths.uv[0, :, 0] * TURN, paths.points[0, :, 2]
        smooth, held = t > 0.01, t < -x - 4 * half / n
        assert np.ptp(np.diff(z[smooth]) / np.diff(t[smooth])) < 1e-6
        assert held.sum() > n // 10
        assert z[held] == pytest.approx(0.5 * k * (half**2 - t[held] ** 2), abs=1e-12)
        errors.append(np.abs(z[smooth] - slope(x) * (t[smooth] - half)).max())
    assert errors[1] <= 2e-3
    assert errors[1] <= 0.5 * errors[0] + 1e-3


@pytest.mark.parametrize("given", [-0.01, 10.5, np.inf, [[0.1, 0.2]], [[0.1, np.nan], [0.1, 0.1]]])
def test_bad_friction_is_refused_in_one_line(given: object) -> None:
    with pytest.raises(BadInputError, match="friction") as refusal:
        friction_of(barrel(), given)  # type: ignore[arg-type]
    assert "\n" not in str(refusal.value)


def test_bad_fields_are_refused() -> None:
    surface = barrel()
    with pytest.raises(BadInputError, match="values"):
        friction_from(surface, np.zeros((3, 3)), np.zeros(2))
    with pytest.raises(BadInputError, match="friction"):
        friction_from(surface, np.eye(3), np.array([0.1, -3.0, 0.2]))


def test_a_field_of_one_vertex_is_a_number() -> None:
    field = friction_from(barrel(), np.zeros((1, 3)), np.array([0.25]))
    assert field.table == pytest.approx(np.full((256, 256), 0.25))
    assert Friction(np.zeros((1, 1))).none
    assert not field.none


@pytest.mark.parametrize("table", [[[0.1, -0.1]], [[np.nan, 0.1]], [0.1, 0.2], np.zeros((0, 2))], ids=str)
def test_a_table_of_ones_own_is_checked(table: Any) -> None:
    with pytest.raises(BadInputError, match="friction"):
        Friction(table)


def test_no_table_can_be_written_to() -> None:
    """Kernels are compiled for such tables: for others all of friction's would be compiled again, for a minute."""
    made = Friction(np.full((2, 2), 0.1))
    for each in (made, pickle.loads(pickle.dumps(made)), friction_of(barrel(), np.full((2, 2), 0.1))):
        assert not each.table.flags.writeable


def test_more_friction_holds_what_slides_off() -> None:
    """A barrel beyond Clairaut's limit: the advice names a coefficient, and that coefficient holds."""
    lost = solve(barrel(), [(0.0, 0.0)], [(1.0, 1.0)])
    assert lost.status[0] in (Status.SLID_OFF_START, Status.SLID_OFF_END, Status.UNSTABLE)
    enough = float(lost.holding_friction[0])
    assert enough > 0.0
    assert f"friction {enough:g}" in lost.advice(0)
    assert solve(barrel(), [(0.0, 0.0)], [(1.0, 1.0)], friction=enough).status[0] == Status.CONVERGED
    turns = float(lost.holding_turns[0])
    assert 0.0 < turns < 1.0
    assert solve(barrel(), [(0.0, 0.0)], [(turns, 1.0)]).status[0] == Status.CONVERGED


def test_a_fibre_that_cannot_leave_needs_no_search_tree() -> None:
    """With bridging=False the vase's meridian follows its hollows: it is longer, and all on the surface."""
    problem = TABLE["vase"]
    surface = problem.surface()
    pressed = solve(surface, [problem.start], [problem.end], bridging=False, friction=0.2)
    assert pressed.status[0] == Status.CONVERGED
    assert pressed.on_surface.all()
    assert pressed.counters.feet == 0
    assert np.linalg.norm(np.diff(pressed.points[0], axis=0), axis=1).sum() > 1.02 * problem.length


def test_friction_on_a_tube_is_the_same_wherever_the_ends_lie() -> None:
    """The catenary moved along and around the tube is the same catenary."""
    case = SLIDING["catenary-0.2"]
    surface = tube(-1.0, case.top + 4.0)
    height = case.top + 5.0
    here = slide(case, 201).points[0]
    curve = case.initial(201)
    z = curve[:, 1] * (case.top + 2.0) - 1.0
    for around, up in ((0.37, 0.0), (-2.2, 1.7)):
        moved = np.stack([curve[:, 0] + around, (z + up + 1.0) / height], axis=1)
        there = solve(surface, moved[:1], moved[-1:], particles=201, friction=case.mu, initial=moved[None]).points[0]
        turn = TURN * around
        back = there @ np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
        assert np.abs(back - [0, 0, up] - here).max() <= 1e-6  # the splines differ
