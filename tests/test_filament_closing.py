"""One filament of a layer: closed forms through the mesh, turns counted in space, and what must not change it."""

from dataclasses import dataclass
from math import asinh, atan, cos, degrees, gcd, pi, radians, sqrt, tan
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
from comparison.parts import Revolved, irregular
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import ellipe

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.filament.closing import ClosedLayer, close_layer
from meshwind.filament.course import Kind
from meshwind.filament.ends import LayerPlan
from meshwind.filament.pin_turn import Pins
from meshwind.mesh import mesh_from
from meshwind.surface import Surface
from meshwind.surface.interpolate import interpolate

property_test = settings(max_examples=15, deadline=None, derandomize=True, database=None)
TURN = 2.0 * pi


@dataclass(frozen=True)
class Spar(Revolved):
    """A prism with an elliptic section, of half axes `radius(0)` and `narrow`."""

    narrow: float = 1.0

    def points(self, u: Floats, v: Floats) -> Floats:
        wide = self.radius(np.zeros(1))[0]
        return np.stack([wide * np.cos(TURN * u), self.narrow * np.sin(TURN * u), self.height * v], axis=-1)


def meshed(part: Revolved, unit: float) -> Surface:
    """The surface fitted to an irregular mesh of 8,000 vertices, of a part in units of its mean radius."""
    vertices, faces = irregular(part, 16_000)
    return mw.fit(mw.flatten(mw.annulus(mesh_from(unit * vertices, faces))))


def passed(layer: ClosedLayer, kind: Kind) -> float:
    """Length of fibre of a kind, of all filaments."""
    total = 0.0
    for each in layer.filaments:
        steps = np.linalg.norm(np.diff(each.points, axis=0), axis=1)
        total += float(steps[each.kind[1:] == kind].sum())
    return total


def turned(layer: ClosedLayer) -> float:
    """Turns of all filaments around z, in either sense."""
    total = 0.0
    for each in layer.filaments:
        angle = np.arctan2(each.points[:, 1], each.points[:, 0])
        total += float((np.mod(np.diff(angle) + pi, TURN) - pi).sum()) / TURN
    return abs(total)


def test_a_meshed_cylinder_between_collars() -> None:
    """Radius 50, length 400, 45 degrees, slip 0.2, 23 circuits: every part of the filament has a closed form."""
    surface = meshed(Revolved(lambda z: 1.0 + 0.0 * z, 8.0), 50.0)
    asked = 400.0 * tan(radians(45.0)) / (TURN * 50.0)
    layer = close_layer(surface, LayerPlan(23, asked, 0.2, turns=("collar", "collar")))
    assert asked == pytest.approx(1.273240, abs=1e-6)
    assert abs(layer.revolutions - asked) <= 1.0 / 23
    angle = atan(layer.revolutions * TURN * 50.0 / 400.0)
    leg = asinh(1.0 / tan(angle)) / 0.2 / TURN
    assert layer.joining.start_dwell == pytest.approx(layer.joining.end_dwell.mean(), abs=1e-3)
    assert float(layer.joining.end_dwell.min()) >= 2.0 * leg - 1e-4
    assert layer.pattern.turns / 23 == pytest.approx(
        2.0 * layer.revolutions + layer.joining.start_dwell.mean() + layer.joining.end_dwell.mean(), abs=1e-9
    )
    assert passed(layer, Kind.LAID) == pytest.approx(2 * 23 * 400.0 / cos(angle), rel=1e-4)
    assert passed(layer, Kind.TURN) == pytest.approx(23 * 4 * 50.0 / 0.2 / tan(angle), rel=1e-4)
    waits = 23 * TURN * 50.0 * (layer.joining.start_dwell.mean() + layer.joining.end_dwell.mean() - 4.0 * leg)
    assert passed(layer, Kind.DWELL) == pytest.approx(waits, abs=1e-4 * layer.length)
    for each in layer.turnarounds:
        assert each.reach == pytest.approx(50.0 / 0.2 * (1.0 / np.sin(angle) - 1.0), rel=1e-3)
    assert layer.pattern.filaments == len(layer.filaments) == 1
    assert turned(layer) == pytest.approx(layer.pattern.turns, abs=1e-6)


def test_a_meshed_elliptic_spar() -> None:
    """Half axes 80 and 30, length 400, 45 degrees: it unrolls, so that every path is as long from everywhere."""
    perimeter = 4.0 * 80.0 * float(ellipe(1.0 - (30.0 / 80.0) ** 2))
    assert perimeter == pytest.approx(363.668628, abs=1e-6)
    surface = meshed(Spar(lambda z: 1.6 + 0.0 * z, 8.0, 0.6), 50.0)
    layer = close_layer(surface, LayerPlan(26, 1.099902, turns=("pins", "shaft")))
    assert layer.paths.length == pytest.approx(sqrt(400.0**2 + (layer.revolutions * perimeter) ** 2), rel=1e-4)
    assert turned(layer) == pytest.approx(layer.pattern.turns, abs=1e-6)
    assert len(layer.filaments) == 1
    pins = layer.turnarounds[0]
    assert isinstance(pins, Pins)
    # the way to a pin, round it and on to the second: each is a straight line or an arc on the unrolled prism
    angle = atan(layer.revolutions * perimeter / 400.0)
    climb = pins.height + pins.radius * np.sin(angle)
    way = 2 * (climb / cos(angle) + pins.radius * (0.5 * pi - angle))
    dwell = layer.joining.start_dwell.mean() * perimeter - 2 * (climb * tan(angle) + pins.radius * cos(angle))
    filament = layer.filaments[0]
    steps = np.linalg.norm(np.diff(filament.points, axis=0), axis=1)
    start = (filament.points[1:, 2] < 1e-6) & (filament.kind[1:] >= Kind.TURN)
    assert steps[start].sum() / 26 == pytest.approx(way + dwell, rel=2e-3)
    assert dwell >= pins.pitch - 1e-3


def lumpy(lean: float, flat: float, wave: float) -> Surface:
    """A tube whose rims are an ellipse and a three-lobed curve, off its axis."""

    def place(u: Floats, v: Floats) -> Floats:
        t = TURN * u
        wide, narrow = 1.0 + flat * (1.0 - v), 1.0 - flat * (1.0 - v)
        bulge = 1.0 + 0.08 * wave * v * np.cos(3 * t)
        return np.stack([lean * v * (1 - v) + wide * bulge * np.cos(t), narrow * bulge * np.sin(t), 3.0 * v], axis=-1)

    return interpolate(place, (48, 24))


@property_test
@given(
    st.floats(-0.3, 0.3), st.floats(0.0, 0.4), st.floats(-1.0, 1.0), st.integers(3, 17), st.floats(0.1, 0.8),
    st.sampled_from(["pins", "shaft", "collar"]), st.sampled_from(["pins", "shaft", "collar"]),
)  # fmt: skip
def test_the_filament_is_one_and_whole(
    lean: float, flat: float, wave: float, count: int, revolutions: float, start: str, end: str
) -> None:
    surface = lumpy(lean, flat, wave)
    try:
        layer = close_layer(surface, LayerPlan(count, revolutions, 0.3, 101, (start, end)))
    except BadInputError as refusal:
        assert "turnaround" in str(refusal) or "at rest" in str(refusal)
        return
    pattern, filament = layer.pattern, layer.filaments[0]
    assert gcd(pattern.shift, pattern.circuits) == len(layer.filaments) == 1
    assert (pattern.turns - pattern.shift) % pattern.circuits == 0
    assert turned(layer) == pytest.approx(pattern.turns, abs=1e-6)
    size = surface.size
    assert np.isfinite(filament.points).all()
    assert np.linalg.norm(filament.points[0] - filament.points[-1]) <= 1e-9 * size
    # each path once, in the sense of turning, with its own points
    order = filament.path[np.flatnonzero(np.diff(filament.path, prepend=-2))]
    order = order[order >= 0]
    assert sorted(set(order.tolist())) == list(range(len(layer.paths)))
    assert len(order) == len(layer.paths)
    assert (layer.paths.family[order] == np.tile([1, -1], len(order) // 2)).all()
    steps = np.linalg.norm(np.diff(layer.hung.points, axis=1), axis=2)
    # the last of a way from the part to where a turnaround stands up from it counts as the turnaround's
    there = layer.paths.family > 0
    steps[there & layer.hung.aloft[:, -1], -1] = steps[~there & layer.hung.aloft[:, 0], 0] = 0.0
    laid = float(steps.sum())
    parts = sum(passed(layer, kind) for kind in Kind)
    assert layer.length == pytest.approx(parts, rel=1e-12)
    assert passed(layer, Kind.LAID) + passed(layer, Kind.BRIDGE) == pytest.approx(laid, rel=1e-9)
    slips = filament.slip[filament.kind >= Kind.TURN]
    assert np.nanmax(slips, initial=0.0) <= 0.3
    assert (
        np.linalg.norm(np.diff(filament.points, axis=0), axis=1)[filament.kind[1:] == Kind.DWELL] < 0.2 * size
    ).all()


def test_a_mirrored_part_has_the_mirrored_program() -> None:
    surface = lumpy(0.2, 0.3, 0.7)
    net = surface.control_points * np.array([1.0, -1.0, 1.0])
    mirrored = Surface(np.ascontiguousarray(np.roll(net[::-1], 3, axis=0)), True)
    here, there = (close_layer(each, LayerPlan(7, 0.4, 0.3, 101, ("collar", "pins"))) for each in (surface, mirrored))
    assert here.pattern == there.pattern
    assert there.length == pytest.approx(here.length, rel=2e-3)
    for name in ("start_dwell", "end_dwell"):
        a, b = (getattr(each.joining, name) for each in (here, there))
        assert b.mean() == pytest.approx(a.mean(), abs=1e-3)


def test_a_tank_between_caps_and_a_dome_on_a_shaft() -> None:
    """Passes touch the openings and come back; turns are counted in space."""
    tank = mw.fit(mw.flatten(mw.annulus(mw.read("data/tank.ply"))))
    layer = close_layer(tank, LayerPlan(31, 0.5, 0.2, 201, ("cap", "cap")))
    assert (layer.paths.status == 0).all()
    assert turned(layer) == pytest.approx(layer.pattern.turns, abs=1e-6)
    assert len(layer.filaments) == 1
    filament = layer.filaments[0]
    assert (filament.kind == Kind.LAID).all()
    assert np.linalg.norm(filament.points[0] - filament.points[-1]) <= 1e-9 * tank.size
    assert layer.length == pytest.approx(float(layer.paths.length.sum()), rel=1e-4)
    assert 0.0 < max(each.slip for each in layer.turnarounds) < 0.2
    dome = mw.shapes.sphere_band(1.0, polar0=0.5 * pi, polar1=2.6, spans=(96, 48))
    layer = close_layer(dome, LayerPlan(7, 0.5, particles=101, turns=("shaft", "cap")))
    assert turned(layer) == pytest.approx(layer.pattern.turns, abs=1e-6)
    assert len(layer.filaments) == 1
    assert float(layer.joining.end_dwell.max()) == pytest.approx(0.0, abs=1e-9)
    assert layer.joining.start_dwell.min() > 1.0 / 3.0  # to the shaft of half the radius and back


def test_what_cannot_turn_is_said() -> None:
    tube = mw.shapes.cylinder(1.0, 3.0)
    with pytest.raises(BadInputError, match="holds no fibre without friction"):
        close_layer(tube, LayerPlan(5, 0.3, turns=("collar", "auto")))
    with pytest.raises(BadInputError, match="more than 20 turns; give pins"):
        close_layer(tube, LayerPlan(5, 0.02, 0.02, 51, ("auto", "collar")))
    layer = close_layer(tube, LayerPlan(5, 0.3, 0.02, 51))
    assert [each.name for each in layer.turnarounds] == ["pins", "pins"]
    steep = close_layer(tube, LayerPlan(5, 1.5, 0.3, 101))
    assert [each.name for each in steep.turnarounds] == ["collar", "collar"]


def test_a_run_writes_its_filament(tmp_path: Path) -> None:
    result = mw.wind("data/tank.ply", paths=5, particles=51, continuous=True, out=tmp_path, render=False)
    figures = result.report()["pattern"][0]
    assert figures["circuits"] == 5
    assert figures["revolutions"]["wound"] == result.revolutions
    assert figures["words"].endswith("one filament")
    assert len(figures["alternatives"]) == 5
    filament = pv.read(tmp_path / "filament.vtp")
    assert filament.n_cells == 1
    arc = filament.point_data["arc_length"]
    assert arc[-1] == pytest.approx(filament.cell_data["length"][0], rel=1e-12)
    assert arc[-1] == pytest.approx(figures["fibre_length"], rel=1e-12)
    assert np.unique(filament.point_data["pass"]).tolist() == list(range(10))
    assert 0.0 <= filament.point_data["angle"].min() <= filament.point_data["angle"].max() <= 90.0
    assert degrees(1.0) > figures["dwell"]["end"]["mean"] > 0.0


@pytest.mark.parametrize(("options", "line"), [
    ({"turn_start": "pins"}, "turn_start is given without continuous"),
    ({"continuous": True, "turn_end": "hook"}, "turn_end is 'hook'; give auto, collar, pins, shaft or cap"),
    ({"continuous": True, "spacing": 5.0}, "spacing sets others"),
])  # fmt: skip
def test_options_that_cannot_be_used(options: dict[str, object], line: str) -> None:
    with pytest.raises(BadInputError, match=line):
        mw.wind("data/tank.ply", **options)  # type: ignore[arg-type]
