"""Scales of colours: true to their values, even to the eye, with legible marks."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.colors import to_rgb

from meshwind.appearance.looks import DIVERGING, MAPS, SEQUENTIAL, Scale, colour_map, round_below
from meshwind.core.cast import Floats
from meshwind.pictures.canvas import FAMILY
from meshwind.pictures.layup_scenes import ANGLE
from meshwind.results.schema import SURFACE

finite = st.floats(-1e6, 1e6)


def test_every_scalar_map_of_the_surface_has_a_look() -> None:
    scalars = {field: field.unit.replace("2", "²") for field in SURFACE.point_data if field.columns == 1}
    assert {name: look.unit for name, look in MAPS.items()} == scalars


def lab(colours: Floats) -> Floats:
    """CIELAB of sRGB colours (n, 3), D65."""
    linear = np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)
    to_xyz = np.array(
        [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
    )
    xyz = linear @ to_xyz.T / [0.95047, 1.0, 1.08883]
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16.0 / 116.0)
    return np.stack([116.0 * f[:, 1] - 16.0, 500.0 * (f[:, 0] - f[:, 1]), 200.0 * (f[:, 1] - f[:, 2])], axis=1)


def without(cone: int, colours: Floats) -> Floats:
    """What an eye without its long (0) or middle (1) cones sees, after Viénot, Brettel and Mollon (1999)."""
    to_lms = np.array([[17.8824, 43.5161, 4.11935], [3.45565, 27.1554, 3.86714], [0.0299566, 0.184309, 1.46709]])
    missing = np.eye(3)
    missing[cone] = [[0.0, 2.02344, -2.52581], [0.494207, 0.0, 1.24827]][cone]
    return np.clip(colours**2.2 @ (np.linalg.inv(to_lms) @ missing @ to_lms).T, 0.0, 1.0) ** (1.0 / 2.2)


NAMES = {look.colours for look in (*MAPS.values(), ANGLE)} - {DIVERGING} | {"gap"}
SEQUENCES = {name: colour_map(name) for name in sorted(NAMES)}


@pytest.mark.parametrize("name", SEQUENCES)
def test_lightness_runs_evenly_one_way(name: str) -> None:
    step = np.diff(lab(SEQUENCES[name](np.linspace(0.0, 1.0, 17))[:, :3])[:, 0])
    assert (step > 0.0).all() or (step < 0.0).all()
    assert np.abs(step).max() < 2.2 * np.abs(step).min()


@pytest.mark.parametrize("name", SEQUENCES)
@pytest.mark.parametrize("cone", [0, 1])
def test_scales_keep_their_order_for_the_colour_blind(name: str, cone: int) -> None:
    step = np.diff(lab(without(cone, SEQUENCES[name](np.linspace(0.0, 1.0, 17))[:, :3]))[:, 0])
    assert (step > 0.0).all() or (step < 0.0).all()


@pytest.mark.parametrize("cone", [0, 1])
def test_both_signs_and_both_families_are_distinct_to_every_eye(cone: int) -> None:
    ends = colour_map(DIVERGING)(np.array([0.1, 0.9]))[:, :3]
    families = np.array([to_rgb(colour) for colour in FAMILY.values()])
    for pair in (ends, families):
        seen = lab(without(cone, pair))
        assert np.linalg.norm(seen[0] - seen[1]) > 40.0


@given(st.lists(finite, min_size=1, max_size=40), st.sampled_from(sorted(MAPS)))
def test_scales_hold_any_values(values: list[float], name: str) -> None:
    numbers = np.abs(np.array(values)) if MAPS[name].log else np.array(values)
    scale = MAPS[name].scale(numbers, "mm")
    shares = scale.shares(numbers)
    assert scale.low < scale.high
    assert ((shares >= 0.0) & (shares <= 1.0)).all()
    marks = [share for share, _ in scale.marks]
    assert marks and marks == sorted(marks)
    assert min(marks) >= 0.0 and max(marks) <= 1.0
    assert not any(text.startswith("-0") and float(text) == 0.0 for _, text in scale.marks if text[0] not in "≤≥")


def test_marks_of_long_fibres_are_written_out() -> None:
    texts = [text for _, text in Scale(("wound so far,",), SEQUENTIAL, 0.0, 16820.0).marks]
    assert texts == ["0", "5,000", "10,000", "15,000"]


def test_a_scale_marks_values_beyond_it() -> None:
    values = np.r_[np.linspace(0.0, 2.0, 1000), 50.0]
    scale = MAPS["coverage"].scale(values, "")
    assert scale.beyond and scale.high < 2.1
    assert scale.marks[-1] == (1.0, f"≥ {scale.high:.2g}")
    assert not MAPS["coverage"].scale(values[:-1], "").beyond


def test_units_are_shown_if_a_map_has_one() -> None:
    ones = np.ones(3)
    assert MAPS["fit_error"].scale(ones, "mm").words[-1] == "in mm"
    assert MAPS["gaussian_curvature"].scale(ones, "in").words[-1] == "in 1/in²"
    assert MAPS["fit_error"].scale(ones, "").words[-1] == "to the mesh"
    assert MAPS["coverage"].scale(ones, "mm").words == ("layers of fibre",)


def test_logarithms_and_nan() -> None:
    scale = Scale(("x",), "viridis", 0.01, 100.0, log=True)
    assert scale.shares(np.array([0.0, 0.01, 1.0, 100.0, 1e9])) == pytest.approx([0.0, 0.0, 0.5, 1.0, 1.0])
    assert np.isnan(scale.shares(np.array([np.nan]))).all()


@given(st.floats(1e-12, 1e12))
def test_round_lengths_are_close_below(value: float) -> None:
    assert 0.39 * value < round_below(value) <= value * (1.0 + 1e-9)
