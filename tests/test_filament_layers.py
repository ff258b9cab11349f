"""Layers on layers: thickness by volume, surfaces raised by it, hoops, and laminates from a file."""

import csv
from math import pi, sqrt
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.filament.hoop import HoopPlan, hoop
from meshwind.filament.offset import raised
from meshwind.filament.thickness import Laying, Thickness, Tracks, deposit, tracks
from meshwind.surface.interpolate import interpolate

property_test = settings(max_examples=5, deadline=None, derandomize=True, database=None)
LAYERS = """
[[layer]]
kind = "helical"
angle = 20
band_width = 12
tex = 2400

[[layer]]
kind = "hoop"
band_width = 12
band_thickness = 0.3
from = 0.3
to = 0.7

[[layer]]
kind = "helical"
revolutions = 0.5
paths = 12
band_width = 12
band_thickness = 0.3
friction = 0.2
"""


@property_test
@given(
    st.floats(0.2, 0.9), st.floats(2.0, 25.0), st.sampled_from(["flat", "lens"]), st.sampled_from(["hollow", "filled"])
)
def test_volume_is_kept(turns: float, width: float, section: str, bridges: str) -> None:
    bottle = mw.shapes.revolution(lambda z: 50.0 - 18.0 * np.exp(-(((z - 100.0) / 30.0) ** 2)), 0.0, 200.0)
    ends = mw.families(bottle, 2, turns)
    paths = mw.solve(bottle, ends.start, ends.end, family=ends.family, particles=51)
    layer = deposit(bottle, tracks(paths), Laying(width, 0.25, section, bridges))
    assert layer.volume == pytest.approx(width * 0.25 * float(paths.length.sum()), rel=1e-9)
    assert layer.min >= 0.0
    assert 0.0 <= layer.over_rim < layer.volume


def test_helices_on_a_cylinder_are_as_thick_as_their_bands() -> None:
    tube = mw.shapes.cylinder(50.0, 300.0)
    ends = mw.families(tube, 40, 300.0 / (2 * pi * 50.0))  # 45 degrees
    paths = mw.solve(tube, ends.start, ends.end, family=ends.family, particles=101)
    layer = deposit(tube, tracks(paths), Laying(8.0, 0.2))
    rings = layer.along()
    wanted = 40 * 2 * 8.0 * 0.2 / (2 * pi * 50.0 * sqrt(0.5))
    assert rings[3:-3] == pytest.approx(wanted, rel=1e-3)
    assert rings.mean() == pytest.approx(wanted, rel=1e-3)  # what hangs over the rims is counted inside of them


def test_strips_on_a_flat_disc() -> None:
    """Bands whose inner edge touches the radius r0: n t / pi (acos(r0 / r) - acos((r0 + B) / r))."""
    inner, outer, r0, width, count = 20.0, 140.0, 35.21, 12.0, 89

    def flat(u: Floats, v: Floats) -> Floats:
        r = inner + (outer - inner) * v
        return np.stack([r * np.cos(2 * pi * u), r * np.sin(2 * pi * u), 0 * u], axis=-1)

    disc = interpolate(flat, (96, 48))
    p = r0 + 0.5 * width
    reach = np.arccos(p / outer)
    at = p * np.tan(np.linspace(-reach, reach, 801))
    angle, radius = np.arctan2(at, p) / (2 * pi), np.hypot(at, p)
    uv = np.stack(
        [np.arange(count)[:, None] / count + angle, np.tile((radius - inner) / (outer - inner), (count, 1))], axis=-1
    )
    steps = np.tile(np.diff(at), (count, 1))
    layer = deposit(disc, Tracks(uv, steps, np.zeros(uv.shape[:2])), Laying(width, 1.0))
    rings = layer.along()
    edges = np.linspace(inner, outer, len(rings) + 1)
    fine = np.linspace(edges[:-1], edges[1:], 201)
    clipped = [np.arccos(np.minimum(each / fine, 1.0)) for each in (r0, r0 + width)]
    wanted = (count / pi * (clipped[0] - clipped[1]) * fine).mean(axis=0) / fine.mean(axis=0)
    inside = (edges[:-1] > inner + 2.0) & (edges[1:] < outer - 2.0 * width)
    assert np.median(np.abs(rings[inside] / np.maximum(wanted[inside], 0.5) - 1.0)[wanted[inside] > 1.0]) < 5e-3
    assert np.abs(rings[inside] - wanted[inside]).max() < 0.06 * wanted.max()


def test_a_cylinder_is_raised_by_the_volume() -> None:
    """A tube of even thickness t grows to the radius sqrt(R^2 + 2 R t)."""
    tube = mw.shapes.cylinder(50.0, 300.0)
    even = Thickness(np.full((64, 64), 2.0), np.zeros((64, 64)), np.full((64, 64), 2 * pi * 50.0 * 300.0 / 4096), 0.0)
    above = raised(tube, even, 8.0)
    uv = np.random.default_rng(3).random((500, 2))
    radius = np.hypot(*above.surface.points(uv)[:, :2].T)
    assert radius == pytest.approx(sqrt(50.0**2 + 2 * 50.0 * 2.0), abs=1e-4)
    assert above.off_max < 1e-4


def test_hoops_on_a_cylinder() -> None:
    tube = mw.shapes.cylinder(50.0, 300.0)
    laid = hoop(tube, HoopPlan(0.1, 0.9, 10.0, passes=2))
    assert laid.pitch == pytest.approx(10.0, rel=1e-3)
    assert laid.cover == pytest.approx((1.0, 1.0), rel=1e-3)
    assert laid.friction < 0.01
    assert laid.advice(0.1) == ""
    lean = laid.course.angle[(laid.course.kind == 0)]
    assert np.median(lean) == pytest.approx(np.arctan(2 * pi * 50.0 / 10.0), abs=1e-3)
    z = laid.course.points[:, 2]
    assert 30.0 <= z.min() <= 36.0 and 264.0 <= z.max() <= 270.0  # the band's edges stay between the stations
    layer = deposit(tube, laid.tracks, Laying(10.0, 0.25))
    assert layer.volume == pytest.approx(10.0 * 0.25 * laid.tracks.length, rel=1e-9)


def test_a_laminate_of_three_layers(tmp_path: Path) -> None:
    (tmp_path / "layers.toml").write_text(LAYERS)
    result = mw.wind(
        "data/tank.ply", layers=tmp_path / "layers.toml", particles=101, out=tmp_path / "out", render=False
    )
    layers = result.report()["laminate"]
    assert [each["kind"] for each in layers] == ["helical", "hoop", "helical"]
    told = [note for note in result.report()["notes"] if "degrees at" in note]  # of the layer that has an angle
    assert len(told) == 1 and told[0].startswith("layer 1: 20 degrees at v=0.5, the widest place, take ")
    for each, thickness in zip(layers, (2.4 / 1.8 / 0.6 / 12.0, 0.3, 0.3), strict=True):
        assert each["band_thickness"] == pytest.approx(thickness, rel=1e-12)
        assert each["volume"] == pytest.approx(12.0 * thickness * each["fibre_length"], rel=1e-9)
        assert each["off_below"] < 1e-6
    assert layers[0]["cover"]["min"] == pytest.approx(1.0, abs=0.05)
    assert layers[0]["fibre_mass"] == pytest.approx(2.4e-3 * layers[0]["fibre_length"], rel=1e-9)
    assert layers[1]["fibre_mass"] is None
    assert result.layered is not None
    below, above = result.layered.laminate.layers[:2]
    # the second layer lies on the first one, where that is about as thick as its bands
    outwards = above.surface.points([(0.1, 0.5)]) - below.surface.points([(0.1, 0.5)])
    assert 0.5 < np.linalg.norm(outwards) / below.thickness.at(np.array([[0.1, 0.5]]))[0] < 1.5
    with (tmp_path / "out" / "laminate.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["v", "z", "layer", "angle", "thickness", "cover"]
    assert {row["layer"] for row in rows} == {"0", "1", "2"}
    assert all(0.0 <= float(row["angle"]) <= 90.0 for row in rows)
    again = mw.wind("data/tank.ply", layers=tmp_path / "layers.toml", particles=101)
    assert [each["volume"] for each in again.report()["laminate"]] == [each["volume"] for each in layers]


@pytest.mark.parametrize(("text", "line"), [
    ('[[layer]]\nkind = "spiral"\n', "layer 1: kind is 'spiral'; give helical or hoop"),
    ('[[layer]]\nkind = "helical"\n', "layer 1: a helical layer needs an angle or its revolutions"),
    ('[[layer]]\nkind = "hoop"\nband_widht = 4\n', "did you mean 'band_width'"),
    ('[[layer]]\nkind = "hoop"\nband_width = 4\n', "layer 1: a layer needs the thickness of its band"),
])  # fmt: skip
def test_a_file_of_layers_that_cannot_be_used(text: str, line: str, tmp_path: Path) -> None:
    (tmp_path / "layers.toml").write_text(text)
    with pytest.raises(BadInputError, match=line):
        mw.wind("data/tank.ply", layers=tmp_path / "layers.toml")


@pytest.mark.parametrize(("places", "line"), [
    ('from = "z=60"\nto = "z=-60"', r"layer 2: it starts at z=60 \(v=.*\) and ends at z=-60 \(v=.*the other way round"),
    ("from = 0.7\nto = 0.3", "layer 2: it starts at v=0.7 and ends at v=0.3, .*the other way round"),
    ("from = 0.4\nto = 0.4", "layer 2: it starts and ends at v=0.4; give two places"),
    ('from = "z=1e4"', "layer 2: z=1e4 lies off the part"),
])  # fmt: skip
def test_places_out_of_order_are_told_before_anything_is_wound(places: str, line: str, tmp_path: Path) -> None:
    (tmp_path / "layers.toml").write_text(LAYERS[: LAYERS.index("from =")] + places)
    said: list[str] = []
    with pytest.raises(BadInputError, match=line):
        mw.wind("data/tank.ply", layers=tmp_path / "layers.toml", units="mm", progress=said.append)
    assert not any(each.startswith("layer 1") for each in said)
