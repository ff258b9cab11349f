"""Fibres that leave the part before a rim that its prism stands up from: closed forms, and what a way must be."""

from math import atan2, cos, hypot, pi, sin, sqrt

import numpy as np
import pytest
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st

import meshwind as mw
from meshwind.core.cast import Floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.filament.closing import ClosedLayer, close_layer
from meshwind.filament.collar_turn import Collar
from meshwind.filament.course import Kind
from meshwind.filament.edge import Edge, Legs, edge
from meshwind.filament.ends import LayerPlan, choose_end
from meshwind.filament.filament import filaments_of
from meshwind.filament.leaving import Rays
from meshwind.filament.lift import leaning, legs_over
from meshwind.filament.line_meetings import Meeting, meet_all
from meshwind.filament.pin_turn import Pins
from meshwind.filament.section import section
from meshwind.path.winding_angle import axes, headings, winding_angle
from meshwind.program.faults import SPAN
from meshwind.program.machine import read_machine
from meshwind.program.program import program
from meshwind.program.work import Work
from meshwind.surface import Surface
from meshwind.surface.interpolate import interpolate
from meshwind.workflow.filament_notes import about_filament

property_test = settings(max_examples=8, deadline=None, derandomize=True, database=None, phases=[Phase.generate])
WIDE, NARROW, HIGH, TURNS = 98.0, 54.0, 120.0, 0.35


def cone(turned: bool) -> Surface:
    """A cone that narrows towards its end, or its start."""

    def place(u: Floats, v: Floats) -> Floats:
        t, w = 2.0 * pi * u, 1.0 - v if turned else v
        radius = WIDE + (NARROW - WIDE) * w
        return np.stack([radius * np.cos(t), radius * np.sin(t), HIGH * v], axis=-1)

    return interpolate(place, (96, 8))


def wound(surface: Surface, count: int, turns: float, particles: int = 401) -> mw.Paths:
    ends = mw.families(surface, paths=count, revolutions=turns)
    return mw.solve(surface, ends.start, ends.end, family=ends.family, particles=particles)


def from_axis(on: Edge, points: Floats) -> Floats:
    return np.asarray(np.hypot(*((points - on.origin) @ on.across.T).T))


@settings(property_test, max_examples=60)
@given(st.lists(st.floats(0.0, 6.28), min_size=3, max_size=40, unique=True), st.integers(0, 2**32 - 1))
def test_lines_come_into_a_section_where_all_its_edges_say(angles: list[float], seed: int) -> None:
    """The farthest of the edges that they enter by, if it is nearer than the nearest that they leave by."""
    t = np.unique(np.round(angles, 3))
    assume(len(t) > 2 and np.diff(t, append=t[0] + 2.0 * pi).max() < pi)
    ring = np.stack([3.0 * np.cos(t), np.sin(t)], axis=1)
    random = np.random.default_rng(seed)
    start, way = random.uniform(-5.0, 5.0, (50, 2)), random.normal(size=(50, 2))
    hull = section(ring)
    found = Meeting(*(np.empty(50) for _ in range(3)))
    meet_all(hull.ring, start, way, found)
    side = np.roll(ring, -1, axis=0) - ring
    out = np.stack([side[:, 1], -side[:, 0]], axis=1)
    rate = way @ out.T
    length = ((out * ring).sum(axis=1) - start @ out.T) / rate
    enters, leaves = np.where(rate < 0.0, length, -np.inf).max(axis=1), np.where(rate > 0.0, length, np.inf).min(axis=1)
    hits = (enters < leaves) & (leaves > 0.0)
    assert (np.isfinite(found.length) == hits).all()
    assert found.length[hits] == pytest.approx(np.maximum(enters, 0.0)[hits], abs=1e-9)
    outside = hits & (enters > 0.0)
    on = start[outside] + found.length[outside, None] * way[outside]
    assert hull.at(found.passed[outside]) == pytest.approx(on, abs=1e-9)
    assert ((found.depth > 0.0) == (enters < leaves)).all()


@pytest.mark.parametrize("turned", [False, True])
def test_a_fibre_on_a_cone_goes_over_to_a_collar(turned: bool) -> None:
    """With c = r sin(a) a ray is c / sqrt(sin^2 b + c^2 cos^2 b / r^2) from the axis, b being half the cone's angle."""
    surface = cone(turned)
    paths = wound(surface, 3, TURNS)
    slant = hypot(HIGH, WIDE - NARROW)
    sine, cosine = (WIDE - NARROW) / slant, HIGH / slant
    far, near, between = WIDE / sine, NARROW / sine, 2.0 * pi * TURNS * sine
    c = far * near * sin(between) / sqrt(far**2 + near**2 - 2.0 * far * near * cos(between)) * sine
    radius = NARROW * c * cosine / sqrt(c**2 - (NARROW * sine) ** 2)
    across = sqrt(sine**2 + (c * cosine / radius) ** 2)
    along = cosine * sqrt(1.0 - (c / radius) ** 2)
    high = sqrt(radius**2 - NARROW**2) * along / across - (radius - NARROW) * cosine / sine
    on = edge(surface, 0.0 if turned else 1.0)
    half = atan2(sine, cosine)
    assert on.crease == pytest.approx((-half, -half), abs=1e-5)
    for family in (1, -1):
        legs = legs_over(Collar(on, 0.2), paths, family)
        assert legs.lift is not None
        assert from_axis(on, legs.lift.off) == pytest.approx(radius, rel=1e-4)
        assert from_axis(on, legs.lift.corner) == pytest.approx(NARROW, rel=1e-5)
        assert legs.height == pytest.approx(high, rel=2e-3)
        assert legs.angle == pytest.approx(atan2(across, along), abs=1e-4)
        # they keep their distances round the axis
        apart = np.diff(np.sort(np.mod(legs.around, 2.0 * pi * NARROW)))
        assert apart == pytest.approx(2.0 * pi * NARROW / 3, rel=1e-4)
        # pins below that hold them: they come straight along the cone to where these are
        low = legs_over(Pins(on, 0.4 * high, 0.02 * high, 20.0), paths, family)
        assert low.lift is not None and low.lift.held.all()
        assert (low.lift.corner - on.origin) @ on.axis == pytest.approx(0.42 * high, rel=1e-4)
        assert from_axis(on, low.lift.corner) == pytest.approx(NARROW, rel=1e-5)
        place, ahead = low.lift.off - on.origin, low.lift.ahead
        out = np.stack([place @ each for each in on.across], axis=1)
        out /= np.linalg.norm(out, axis=1, keepdims=True)
        normal = cosine * out @ on.across + sine * on.axis
        assert (ahead * normal).sum(axis=1) == pytest.approx(0.0, abs=1e-4)
        round_ = np.stack([-out[:, 1], out[:, 0]], axis=1) @ on.across * low.sense
        assert from_axis(on, low.lift.off) * (ahead * round_).sum(axis=1) == pytest.approx(c, rel=1e-4)
    # over the other rim the fibre presses on the edge
    other = edge(surface, 1.0 if turned else 0.0)
    assert other.crease == pytest.approx((half, half), abs=1e-5)
    assert legs_over(Collar(other, 0.2), paths, 1).lift is None


def barrel(bulge: float, flat: float, lean: float) -> Surface:
    """A barrel with elliptic sections whose rims lie off its axis: prisms stand up from it at both."""

    def place(u: Floats, v: Floats) -> Floats:
        t, z = 2.0 * pi * u, 2.0 * v - 1.0
        radius = 1.0 - bulge * z**2
        return np.stack(
            [(1.0 + flat) * radius * np.cos(t) + lean * (1.0 - z**2), (1.0 - flat) * radius * np.sin(t), 1.5 * z],
            axis=-1,
        )

    return interpolate(place, (96, 32))


@property_test
@given(
    st.floats(0.15, 0.5), st.floats(0.0, 0.25), st.floats(-0.05, 0.05), st.integers(3, 9), st.floats(0.25, 0.6),
    st.sampled_from(["pins", "shaft", "collar"]),
)  # fmt: skip
def test_ways_touch_the_part_and_the_prism(
    bulge: float, flat: float, lean: float, count: int, turns: float, kind: str
) -> None:
    surface = barrel(bulge, flat, lean)
    try:
        layer = close_layer(surface, LayerPlan(count, turns, 0.4, 201, (kind, kind)))
    except BadInputError as refusal:
        assert "turnaround" in str(refusal)
        return
    filament, paths = layer.filaments[0], layer.paths
    assert np.linalg.norm(filament.points[0] - filament.points[-1]) <= 1e-9 * surface.size
    for turn in layer.turnarounds:
        for family in (1, -1):
            legs = legs_over(turn, paths, family)  # type: ignore[arg-type]
            assert legs.lift is not None
            lift, rows, end = legs.lift, np.flatnonzero(paths.family == family), turn.edge.end
            assert (lift.aloft > 0).all()
            leaves = paths.points.shape[1] - 1 - lift.aloft if end else lift.aloft
            # it leaves along the part, between two particles, and touches the prism where no pins hold it
            feet = surface.normals(paths.uv[rows, leaves])
            assert np.abs((lift.ahead * feet).sum(axis=1)).max() < 0.08
            touch = (lift.ahead * turn.edge.normals(legs.around, legs.height)).sum(axis=1)
            assert np.abs(touch[~lift.held]).max(initial=0.0) < 5e-3
            assert (touch[lift.held] < 0.0).all()
            assert (legs.height >= turn.edge.lowest - 1e-9).all()
            # nothing of it is inside of the prism, or of the part
            share = np.linspace(0.0, 1.0, 9)[:, None, None]
            way = ((1.0 - share) * lift.off + share * lift.corner).reshape(-1, 3)
            square = np.minimum((way[:, 2] / 1.5) ** 2, 1.0)
            wide = np.hypot((way[:, 0] - lean * (1.0 - square)) / (1.0 + flat), way[:, 1] / (1.0 - flat))
            assert (wide - (1.0 - bulge * square)).min() > -2e-4
    # each path is in the filament once, and its length that of its parts
    assert sorted(set(filament.path[filament.path >= 0].tolist())) == list(range(len(paths)))
    steps = np.linalg.norm(np.diff(filament.points, axis=0), axis=1)
    assert layer.length == pytest.approx(sum(float(steps[filament.kind[1:] == each].sum()) for each in Kind), rel=1e-12)
    hung = filament.kind == Kind.BRIDGE
    assert hung.any() and np.isnan(filament.slip[hung]).all()
    assert (filament.kind[filament.path >= 0] != Kind.DWELL).all()


def program_of(layer: ClosedLayer) -> int:
    """Blocks of the program of a layer at which the free span meets the part."""
    surface = layer.paths.surface
    made = program(Work(tuple(filaments_of(layer)), surface, surface.size), read_machine())
    return sum(fault.kind == SPAN for fault in made.faults)


@pytest.mark.parametrize(("count", "turns"), [(12, 1e-4), (40, 0.1), (12, 0.3)])
def test_fibres_that_come_from_further_out_pull_along_their_pins(count: int, turns: float) -> None:
    """A line at an angle b to the axis that passes it at p falls at sin b sqrt(1 - p^2 / r^2) where it is r from it."""
    layer = close_layer(cone(turned=False), LayerPlan(count, turns, 0.0, 401, ("pins", "pins")))
    start, end = layer.turnarounds
    assert isinstance(start, Pins) and isinstance(end, Pins)
    assert [leaning(start, layer.paths, family) for family in (1, -1)] == [0.0, 0.0]  # the part narrows from there
    lean = max(leaning(end, layer.paths, family) for family in (1, -1))
    legs = legs_over(end, layer.paths, 1)
    if legs.lift is None:  # straight along the cone
        assert lean == pytest.approx(atan2(WIDE - NARROW, HIGH), abs=1e-3)
    elif legs.lift.held.all():
        passes = np.abs(np.cross(legs.lift.off - end.edge.origin, legs.lift.ahead) @ end.edge.axis).max()
        wanted = np.sin(legs.lift.angle[0]) ** 2 - (passes / NARROW) ** 2
        assert np.sin(lean) ** 2 == pytest.approx(wanted, abs=2e-4)
    else:  # it grazes the prism before the pins
        assert not legs.lift.held.any() and lean == 0.0
    told = [note.text for note in about_filament(layer, (False, False)) if "heads" in note.text]
    assert told == ([] if lean == 0.0 else [
        "the pins at the end need heads: fibres come to them from further out, at up to "
        f"{np.degrees(lean):.0f} degrees, and would slip off their ends; or lean the pins outwards as much"
    ])  # fmt: skip


def test_the_span_is_clear_in_turnarounds_on_domes() -> None:
    dome = mw.shapes.sphere_band(60.0, polar0=0.6, polar1=pi - 0.6, spans=(96, 48))
    for turn, turns in (("pins", 0.45), ("shaft", 0.45), ("collar", 0.45)):
        layer = close_layer(dome, LayerPlan(7, turns, 0.3, 201, (turn, turn)))
        assert program_of(layer) == 0, turn
        assert min(layer.hung.before) > 1.0


def test_a_fibre_that_aims_at_the_axis_of_a_collar_is_refused() -> None:
    dome = mw.shapes.sphere_band(60.0, polar0=0.6, polar1=pi - 0.6, spans=(96, 48))
    paths = wound(dome, 5, 0.0, 101)
    plan = LayerPlan(5, 0.0, 0.3, 101)
    with pytest.raises(BadInputError, match="slide up on it without end; give pins or a shaft there"):
        choose_end(dome, 1, plan, "collar", paths).pairs(paths)
    assert choose_end(dome, 1, plan, "auto", paths).turnaround.name == "pins"


def test_a_fibre_that_lands_beside_its_pin_never_goes_back() -> None:
    """It lands on the prism anywhere between the rim and the far side of the pin, and bends from there on."""
    on, angle, count = edge(mw.shapes.cylinder(NARROW, HIGH), 1.0), np.radians(35.0), 12
    pins = Pins(on, 4.0, 1.5, 20.0)
    height = on.highest + np.linspace(0.0, 4.0 + 1.5 - 1e-3, count)

    def legs(around: Floats, sense: int) -> Legs:
        return Legs(around, height, np.full(count, angle), on.points(around, height), sense)

    later = np.full(count, 100.0)
    arriving, leaving = legs(np.zeros(count), 1), legs(later, -1)
    turns = pins.courses(arriving, leaving, later)
    assert (pins.surplus(arriving, leaving, later) > 0.0).all()
    for k in range(count):
        points = turns.course.points[turns.first[k] : turns.first[k] + turns.count[k]]
        step = np.diff(points, axis=0)
        step = step[np.linalg.norm(step, axis=1) > 1e-9]
        step /= np.linalg.norm(step, axis=1, keepdims=True)
        assert np.degrees(np.arccos((step[1:] * step[:-1]).sum(axis=1))).max() < 10.0
        assert ((points - on.origin) @ on.axis).max() == pytest.approx(on.highest + pins.reach)


def drum(dish: float, notch: float = 0.0) -> Surface:
    """The outer half of a torus, whose rims lie in flat ends, or in dishes; or with a notch in the rims."""

    def place(u: Floats, v: Floats) -> Floats:
        t, z = 2.0 * pi * u, -1.5 * np.cos(pi * v) - dish * np.sin(2.0 * pi * v)
        radius = 0.3 + 0.7 * np.sin(pi * v)
        z = z - notch * np.cos(pi * v) ** 9 * np.exp(-((30.0 * np.sin(pi * u)) ** 2))
        return np.stack([radius * np.cos(t), radius * np.sin(t), z], axis=-1)

    return interpolate(place, (384, 48))


@pytest.mark.parametrize("dish", [0.0, 1e-3, -1e-3, 0.06])
def test_flat_and_dished_ends_face_away_from_the_part(dish: float) -> None:
    surface = drum(dish)
    for v, way in ((0.0, -1.0), (1.0, 1.0)):
        assert edge(surface, v).axis == pytest.approx([0.0, 0.0, way], abs=1e-9)
        # a fibre comes straight along the end to its pins, and turns on them
        assert np.degrees(edge(surface, v).crease) == pytest.approx(-90.0, abs=20.0)
    layer = close_layer(surface, LayerPlan(12, 0.3, 0.0, 201))
    assert {turn.name for turn in layer.turnarounds} == {"pins"}
    for turn in layer.turnarounds:
        for family in (1, -1):
            legs = legs_over(turn, layer.paths, family)  # type: ignore[arg-type]
            assert legs.lift is not None and legs.lift.held.all()
    assert max(layer.joining.start_dwell.max(), layer.joining.end_dwell.max()) < 0.7


def test_a_notch_in_a_rim_is_no_rim_along_the_axis() -> None:
    """Its sides are steeper than 78 degrees, as some of a scan's rims have them."""
    on = edge(drum(0.0, 0.4), 1.0)
    assert on.highest - on.lowest == pytest.approx(0.4, rel=0.01)
    layer = close_layer(drum(0.0, 0.4), LayerPlan(12, 0.3, 0.0, 201))
    filament = layer.filaments[0]
    assert len(layer.filaments) == 1
    assert np.linalg.norm(filament.points[0] - filament.points[-1]) < 1e-9


@pytest.mark.parametrize("end", [0, 1])
def test_rays_have_points_and_tangents_of_fourth_order(end: int) -> None:
    """Along a helix, from either end, between particles and at them."""
    off = []
    for many in (21, 41, 81):
        t = np.linspace(0.0, 2.0, many)
        points = np.stack([np.cos(t), np.sin(t), 0.3 * t], axis=1)[None]
        each = np.zeros(41, dtype=np.int64)
        rays = Rays(frozen(points if end else points[:, ::-1]), each, each + 1, end)
        share = np.linspace(0.0, 0.8, 41)
        at, ahead = rays.at(share * (many - 1))
        s = 2.0 * (1.0 - share)
        exact = np.stack([np.cos(s), np.sin(s), 0.3 * s], axis=1)
        way = np.stack([-np.sin(s), np.cos(s), np.full_like(s, 0.3)], axis=1) / hypot(1.0, 0.3)
        off.append([np.abs(at - exact).max(), np.abs(ahead - way).max()])
    order = np.log2(np.divide(off[:-1], off[1:]))
    assert (order[:, 0] > 3.6).all() and (order[:, 1] > 2.7).all()
    assert off[-1][1] < 2e-6


def test_headings_are_those_by_the_frames() -> None:
    """The compiled loop against the axes of the surface, on the part and in the air."""
    surface = barrel(-0.6, 0.2, 0.05)
    paths = wound(surface, 4, 0.12, 201)
    assert not paths.on_surface.all()
    flat = paths.uv.reshape(-1, 2)
    along, around, _ = axes(surface, flat)
    frames = surface.frames(flat)
    rate, chord = (
        np.gradient(each, axis=1, edge_order=2).reshape(-1, k) for each, k in ((paths.uv, 2), (paths.points, 3))
    )
    way = np.where(paths.on_surface.reshape(-1, 1), frames[:, 1] * rate[:, :1] + frames[:, 2] * rate[:, 1:], chord)
    made = headings(paths)
    assert made[0] == pytest.approx((way * along).sum(axis=1), abs=1e-12)
    assert made[1] == pytest.approx((way * around).sum(axis=1), abs=1e-12)
    share = np.abs(made[1]) / np.linalg.norm(way, axis=1)
    assert np.sin(winding_angle(paths)).ravel() == pytest.approx(share, abs=1e-12)
