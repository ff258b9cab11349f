"""The eye of a program: closed forms, spans that leave a body, and what must hold of every program."""

from dataclasses import replace
from math import acos, cos, degrees, pi, radians, sin, sqrt, tan

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from program_parts import along, chord, filament, numbered, pieces, work

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.filament.closing import close_layer
from meshwind.filament.course import Course, Kind, joined
from meshwind.filament.ends import LayerPlan
from meshwind.filament.filament import filaments_of
from meshwind.mesh import mesh_from
from meshwind.program.body import Body, body_round, to_radius
from meshwind.program.eye import Solver, Spans, at_radius, axes, on_body, taut
from meshwind.program.machine import Machine, read_machine
from meshwind.program.mandrel import Mandrel, mandrel_of
from meshwind.program.program import program
from meshwind.program.stepping import Steps, stepped
from meshwind.program.track import AIR, PIVOT, track
from meshwind.program.work import Work

many = settings(max_examples=100, deadline=None, derandomize=True, database=None, phases=[Phase.generate])
few = settings(max_examples=25, deadline=None, derandomize=True, database=None)
SPAN, LEAD, AHEAD = 88.3176, 62.4500, 51.3178
"""Of a cylinder of radius 50, an eye at 80 and 45 degrees: free span, lead along the axis, and degrees ahead."""
LATHE = read_machine("lathe-4")


def on_cylinder(angle: float, count: int = 200) -> tuple[Floats, Floats]:
    """Points and tangents of a helix of radius 50 about x, by its angle from the axis."""
    turn = np.linspace(0.0, 4.0, count)
    cosine, sine, none = np.cos(turn), np.sin(turn), np.zeros(count)
    points = np.stack([50.0 * turn / tan(angle), 50.0 * cosine, 50.0 * sine], axis=1)
    return points, np.stack([none + cos(angle), -sin(angle) * sine, sin(angle) * cosine], axis=1)


def test_an_eye_at_one_radius_has_the_closed_form() -> None:
    points, tangents = on_cylinder(radians(45.0))
    span = to_radius(points, tangents, 80.0)
    assert span == pytest.approx(SPAN, abs=1e-4)
    assert span == pytest.approx(sqrt(80.0**2 - 50.0**2) / sin(radians(45.0)), rel=1e-12)
    x, r, mandrel, roll, yaw = axes(points, tangents, span)
    assert x - points[:, 0] == pytest.approx(LEAD, abs=1e-4)
    assert r == pytest.approx(80.0, rel=1e-12)
    ahead = np.degrees(-mandrel - np.linspace(0.0, 4.0, 200))
    assert ahead == pytest.approx(AHEAD, abs=1e-4)
    assert degrees(acos(50.0 / 80.0)) == pytest.approx(AHEAD, abs=1e-4)
    # seen along the cross-feed the fibre lies at atan2(cos a, sin a R/r_e)
    assert roll == pytest.approx(np.arctan2(cos(radians(45.0)), sin(radians(45.0)) * 50.0 / 80.0), abs=1e-12)
    assert yaw == pytest.approx(np.arcsin(sin(radians(45.0)) * sin(radians(AHEAD))), abs=1e-6)


@pytest.mark.parametrize("meshed", [False, True])
def test_the_closed_form_comes_through_a_filament(meshed: bool) -> None:
    surface = mw.shapes.cylinder(50.0, 400.0)
    if meshed:
        from comparison.parts import Revolved, irregular

        vertices, faces = irregular(Revolved(lambda z: 1.0 + 0.0 * z, 8.0), 6_000)
        surface = mw.fit(mw.flatten(mw.annulus(mesh_from(50.0 * vertices, faces))))
    turns = 400.0 / (2.0 * pi * 50.0)
    made = program(
        Work((filament(surface, 2, turns, 0.2, 401),), surface, 412.0, "mm"),
        replace(read_machine("lathe-2"), eye_radius=80.0, clearance=10.0),
    )  # fmt: skip
    b = made.blocks
    # away from the rims, where an eye that kept a longer span is not yet back
    middle = (b.kind == Kind.LAID) & (b.passed == 2) & (np.abs(made.mandrel.inside(b.point)[:, 0] - 200.0) < 190.0)
    inner = np.flatnonzero(middle)[len(np.flatnonzero(middle)) // 2 :]
    assert len(inner) > 20
    sense = np.sign(b.tangent[inner] @ made.mandrel.direction)
    lead = sense * (b.eye_x - made.mandrel.inside(b.point)[:, 0])[inner]
    tolerance = 1e-3 if meshed else 1e-4
    assert b.free_length[inner] == pytest.approx(SPAN, rel=tolerance)
    assert lead == pytest.approx(LEAD, rel=tolerance)
    at = made.mandrel.inside(b.point[inner])
    ahead = np.abs(np.degrees(np.arctan2(at[:, 2], at[:, 1])) + b.mandrel[inner]) % 360.0
    assert np.minimum(ahead, 360.0 - ahead) == pytest.approx(AHEAD, rel=tolerance)
    assert made.losses["cross"] >= 0.0


def test_an_axisymmetric_part_returns_all_axes_but_the_mandrel() -> None:
    surface = mw.shapes.cone(60.0, 40.0, 200.0)
    layer = close_layer(surface, LayerPlan(8, 0.7, 0.4, particles=101))
    made = program(Work(tuple(filaments_of(layer)), surface, 230.0, "mm"), LATHE)
    b = made.blocks
    circuits = [np.flatnonzero((b.circuit == k) & (b.kind == Kind.LAID)) for k in range(1, 8)]
    assert {len(each) for each in circuits} == {len(circuits[0])}
    one = circuits[0]
    for other in circuits[1:]:
        assert b.eye_x[other] == pytest.approx(b.eye_x[one], abs=1e-4)
        assert b.eye_r[other] == pytest.approx(b.eye_r[one], abs=1e-4)
        apart = b.roll[other] - b.roll[one]
        assert apart - 180.0 * np.round(apart / 180.0) == pytest.approx(0.0, abs=1e-3)
        assert np.ptp(b.mandrel[other] - b.mandrel[one]) < 1e-3
    (one_circuit,) = work(surface, circuits=1).filaments
    turn = 2.0 * pi * 2.0 * (0.8 + 0.3)
    circuits_ = [numbered(rotated(one_circuit.course, k * turn), k, 2 * k) for k in range(4)]
    whole = pieces(joined(circuits_))
    exact = program(Work((whole,), surface, 230.0, "mm"), LATHE).blocks
    second, third = (np.flatnonzero(exact.circuit == k) for k in (1, 2))
    assert len(second) == len(third)
    for name in ("eye_x", "eye_r", "roll", "free_length"):
        assert getattr(exact, name)[third] == pytest.approx(getattr(exact, name)[second], abs=1e-8)
    turned = exact.mandrel[third] - exact.mandrel[second]
    assert turned == pytest.approx(360.0 * 2.0 * (0.8 + 0.3), abs=1e-8)


def rotated(course: Course, angle: float) -> Course:
    """The course, turned about z."""
    c, s = cos(angle), sin(angle)
    by = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]).T
    return replace(course, points=course.points @ by, normal=course.normal @ by)


def test_the_flat_end_of_a_body_is_as_wide_as_its_outermost_corner() -> None:
    """A rim that is not round: points of an end lie in one plane up to round-off, some nearer to the axis."""
    x, r = np.array([-1e-10, 0.0, 1e-11, 200.0]), np.array([24.0, 44.0, 30.0, 70.0])
    body = body_round(x, r, 15.0)
    assert body.r[0] == pytest.approx(44.0 + 15.0 * np.tan(pi / 8.0), abs=1e-6)
    dense = np.linspace(body.x[0], body.x[-1], 4001)
    outline = np.stack([dense, np.interp(dense, body.x, body.r)], axis=1)
    assert np.linalg.norm(outline[:, None] - np.stack([x, r], axis=1), axis=2).min() >= 15.0 * (1.0 - 1e-3)


profiles = st.lists(st.tuples(st.floats(-100.0, 100.0), st.floats(1.0, 80.0)), min_size=3, max_size=12)


@given(profiles, st.floats(0.5, 30.0), st.integers(0, 2**32 - 1))
@many
def test_spans_leave_the_body_and_points_keep_their_clearance(
    outline: list[tuple[float, float]], clearance: float, seed: int
) -> None:
    x, r = np.array(outline).T
    body = body_round(x, r, clearance)
    assert (np.diff(body.x) > 0.0).all()
    slopes = np.diff(body.r) / np.diff(body.x)
    assert (np.diff(slopes) <= 1e-6 * (1.0 + np.abs(slopes[1:]))).all()  # concave
    dense = np.interp(np.linspace(body.x[0], body.x[-1], 4001), body.x, body.r)
    outline_ = np.stack([np.linspace(body.x[0], body.x[-1], 4001), dense], axis=1)
    assert np.linalg.norm(outline_[:, None] - np.stack([x, r], axis=1), axis=2).min() >= clearance * (1 - 1e-3)
    random = np.random.default_rng(seed)
    turn, ray = random.uniform(0.0, 2 * pi, 40), random.normal(size=(40, 3))
    k = random.integers(0, len(x), 40)
    points = np.stack([x[k], r[k] * np.cos(turn), r[k] * np.sin(turn)], axis=1)
    ray[0] = [1.0, 0.0, 0.0]  # along the axis, where it leaves through an end
    ray /= np.linalg.norm(ray, axis=1)[:, None]
    span = body.spans(points, ray)

    def depth(at: Floats) -> Floats:
        """Above 0 outside of the body."""
        eye = points + at[:, None] * ray
        return np.maximum.reduce([
            np.hypot(eye[:, 1], eye[:, 2]) - np.interp(eye[:, 0], body.x, body.r),
            eye[:, 0] - body.x[-1], body.x[0] - eye[:, 0],
        ])  # fmt: skip

    assert (span > 0.0).all()
    assert depth(span) == pytest.approx(0.0, abs=1e-9 * body.size)
    assert (depth(0.999 * span) < 0.0).all()
    assert (depth(1.001 * span) > 0.0).all()


@given(st.lists(st.tuples(st.floats(0.0, 50.0), st.floats(0.0, 9.0)), min_size=1, max_size=30))
@many
def test_a_taut_span_is_the_least_that_is_not_slack(rows: list[tuple[float, float]]) -> None:
    wanted, steps = np.array(rows).T
    laid = np.cumsum(steps)
    span = taut(wanted, laid)
    slow = [wanted[0]]
    for k in range(1, len(wanted)):
        slow.append(max(wanted[k], slow[-1] - (laid[k] - laid[k - 1])))
    assert span == pytest.approx(slow, abs=1e-9)


def axis_x() -> Mandrel:
    return Mandrel(np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))


def flat_steps(count: int, start: Floats, step: Floats) -> Floats:
    return start + np.arange(count)[:, None] * step


def test_the_eye_stands_still_while_a_bridge_lands() -> None:
    up, ahead = np.array([0.0, 1.0, 0.0]), np.array([0.8, 0.0, 0.6])
    bent = np.linspace(-20.0, 20.0, 41)[:, None]
    curve = np.array([0.0, 20.0, 0.0]) + bent * ahead - 0.01 * bent**2 * up
    before, after = chord(curve[:21], Kind.LAID, up), chord(curve[20:] + 4.0 * ahead, Kind.LAID, up)
    air = chord(flat_steps(3, curve[20] + ahead, ahead), Kind.BRIDGE, up)
    on = track(pieces(before, air, after))
    assert (on.motion == AIR).sum() == 1
    assert not (on.motion == PIVOT).any()
    place = float(np.flatnonzero(on.motion == AIR)[0])
    body = Body(np.array([-60.0, 60.0]), np.array([40.0, 40.0]))
    found = Solver(on, axis_x(), on_body(body))(np.array([place, place + 1.0]))
    lift, land = found.point
    assert [lift, land] == pytest.approx(np.stack([before.points[-1], after.points[0]]))
    assert found.span[0] - found.span[1] == pytest.approx(np.linalg.norm(land - lift), abs=1e-12)
    eyes = found.point + found.span[:, None] * found.tangent
    assert eyes[1] == pytest.approx(eyes[0], abs=1e-12)
    steps = Steps(radians(5.0), radians(10.0), radians(10.0), 3.0, 3.0, 20.0)
    block = stepped(on, Solver(on, axis_x(), on_body(body)), steps)
    assert place + 1.0 in block.at
    assert not ((block.at >= place) & (block.at < place + 1.0)).any()
    # where the span may be at most 2 long up to there, the eye draws near, runs out along the bridge, and moves off
    most = 2.0

    def near(points: Floats, rays: Floats) -> tuple[Floats, Floats]:
        before_it = points @ ahead <= lift @ ahead
        return body.spans(points, rays), np.where(before_it & (points @ ahead > -5.0 + lift @ ahead), most, np.inf)

    block = stepped(on, Solver(on, axis_x(), Spans(near)), steps)
    eyes = block.point + block.span[:, None] * block.tangent
    at = block.at
    assert (np.diff(block.span + block.laid) >= -1e-9).all()
    assert block.span[(at > place - 4.0) & (at <= place)] == pytest.approx(most, abs=1e-9)
    assert place in at
    out = (at >= place) & (at <= place + 1.0)
    assert out.sum() > 4
    along = (eyes[out] - lift) @ ahead
    assert np.linalg.norm(eyes[out] - lift - along[:, None] * ahead, axis=1) == pytest.approx(0.0, abs=1e-9)
    assert along[0] == pytest.approx(most, abs=1e-9)
    assert along[-1] >= np.linalg.norm(land - lift)
    assert np.abs(np.diff(block.x)).max() <= 3.0
    assert np.abs(np.diff(block.r)).max() <= 3.0
    # with a lift it keeps off the part past the point where the bridge lands, along the normal there
    height = 0.15
    places: Floats = np.concatenate([np.arange(place), place + np.linspace(0.0, 1.0, 401), [place + 2.0]])
    lifted = Solver(on, axis_x(), Spans(near, height))(places)
    eyes = (lifted.point + lifted.span[:, None] * lifted.tangent)[int(place) : int(place) + 401]
    off = (eyes - eyes[0]) @ up
    assert off[[0, -1]] == pytest.approx(0.0, abs=1e-9)
    assert off.max() == pytest.approx(height, rel=0.02)
    assert (eyes[int(off.argmax())] - height * up) @ ahead == pytest.approx(land @ ahead, abs=0.1)
    assert (np.diff(lifted.span + lifted.laid) >= -1e-9).all()


def test_a_corner_is_turned_about_its_point() -> None:
    up = np.array([0.0, 1.0, 0.0])
    one = flat_steps(11, np.array([-20.0, 20.0, 0.0]), np.array([1.0, 0.0, 0.1]))
    two = flat_steps(11, one[-1], np.array([0.4, 0.0, 0.8]))
    on = track(pieces(joined([chord(one, Kind.LAID, up), chord(two, Kind.LAID, up)])))
    turn = np.flatnonzero(on.motion == PIVOT)
    assert len(turn) == 1
    sharp = degrees(acos(np.dot([1.0, 0.0, 0.1], [0.4, 0.0, 0.8]) / sqrt(1.01 * 0.8)))
    assert np.degrees(on.corner[turn]) == pytest.approx(sharp, abs=1e-9)
    places: Floats = turn[0] + np.linspace(0.0, 0.875, 8)
    point, tangent = on.contact(places)
    assert point == pytest.approx(np.tile(one[-1], (8, 1)), abs=1e-12)
    step = np.degrees(np.arccos(np.clip((tangent[1:] * tangent[:-1]).sum(axis=1), -1.0, 1.0)))
    assert step == pytest.approx(sharp / 8.0, abs=1e-6)


def test_tangents_between_points_converge() -> None:
    errors = []
    for count in (40, 80, 160):
        points, tangents = on_cylinder(radians(50.0), count)
        on = track(pieces(chord(points, Kind.LAID, np.array([0.0, 1.0, 0.0]))))
        assert not (on.motion != 0).any()
        middle: Floats = np.linspace(0.5, count - 1.5, count - 1)
        turn = np.linspace(0.0, 4.0, count)
        half = 0.5 * (turn[1:] + turn[:-1])
        a = radians(50.0)
        exact = np.stack([np.full(count - 1, cos(a)), -sin(a) * np.sin(half), sin(a) * np.cos(half)], axis=1)
        errors.append(float(np.linalg.norm(on.contact(middle)[1] - exact, axis=1).max()))
        assert np.linalg.norm(on.contact(np.arange(count - 1.0))[1] - tangents[:-1], axis=1).max() < 5e-3
    assert errors[0] / errors[1] > 3.5
    assert errors[1] / errors[2] > 3.5


def test_blocks_and_places_grow_with_the_circuits_alone() -> None:
    surface = mw.shapes.cylinder(50.0, 200.0, (16, 8))
    counts = []
    for circuits in (4, 8, 16):
        on = track(filament(surface, circuits, 0.7, 0.2))
        looked: list[int] = []
        mandrel = mandrel_of(surface, filament(surface, circuits, 0.7, 0.2).course.points)

        def solve(at: Floats, on: object = on, mandrel: Mandrel = mandrel, looked: list[int] = looked) -> object:
            looked.append(len(at))
            return Solver(on, mandrel, at_radius(80.0, 1e3))(at)  # type: ignore[arg-type]

        steps = Steps(radians(5.0), radians(10.0), radians(10.0), 10.0, 10.0, 10.0)
        counts.append((len(stepped(on, solve, steps)), sum(looked)))  # type: ignore[arg-type]
    (one, a), (two, b), (four, c) = counts
    assert four - two == pytest.approx(2 * (two - one), abs=2)
    assert c - b == pytest.approx(2 * (b - a), rel=0.1)
    # few more than the longest steps allow
    assert four <= 1.4 * 16 * 2 * (0.7 + 0.2) * 72 + 16 * 60


def test_a_part_without_an_axis_is_refused() -> None:
    surface = mw.shapes.torus(80.0, 20.0, 2.0 * pi, (24, 24))
    points = along(surface, (0.0, 0.0), (1.0, 1.0), 50, Kind.LAID).points
    with pytest.raises(BadInputError, match="no axis to turn on"):
        mandrel_of(surface, points)


@given(st.floats(45.0, 60.0))
@few
def test_an_eye_that_cannot_stay_outside_is_refused(radius: float) -> None:
    machine: Machine = replace(read_machine("lathe-2"), eye_radius=radius, clearance=15.0)
    with pytest.raises(BadInputError, match="give a larger eye_radius"):
        program(work(mw.shapes.cylinder(50.0, 200.0, (16, 8))), machine)
