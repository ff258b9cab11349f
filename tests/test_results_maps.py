"""Maps on the surface against closed forms."""

import numpy as np
import pytest
from layup_shapes import HEIGHT, cylinder, drawn, helices, revolved, waisted

from meshwind.core.cast import Floats
from meshwind.layup.direction import directions, winding_angle
from meshwind.layup.layup import assess
from meshwind.layup.windability import of_frames
from meshwind.results import schema
from meshwind.results.maps import maps
from meshwind.surface.grid import grid
from meshwind.surface.surface import Surface


def waist_curvatures(v: Floats) -> tuple[Floats, Floats]:
    """Hoop and meridian curvature of the waisted shape, positive where it bulges."""
    x, z_v = (v - 0.5) / 0.16, HEIGHT
    bump = 0.35 * np.exp(-(x**2))
    slope = bump * 2.0 * x / 0.16 / z_v
    bend = bump * (2.0 - 4.0 * x**2) / 0.16**2 / z_v**2
    root = np.sqrt(1.0 + slope**2)
    return 1.0 / ((1.0 - bump) * root), -bend / root**3


def test_curvatures_of_a_waist() -> None:
    on = grid(waisted())
    hoop, meridian = waist_curvatures(on.uv[:, 1])
    press = of_frames(on.frames, 0.0)
    k1, k2 = press.largest, press.smallest
    assert np.abs(k1 - np.maximum(hoop, meridian)).max() < 0.02
    assert np.abs(k2 - np.minimum(hoop, meridian)).max() < 0.02


def test_curvatures_of_a_cylinder_and_their_sign() -> None:
    press = of_frames(grid(cylinder()).frames, 0.0)
    normal, k1, k2 = press.normal, press.largest, press.smallest
    assert k1 == pytest.approx(np.ones(len(k1)), abs=1e-4)
    assert np.abs(k2).max() < 1e-4
    assert np.abs(normal[:, 2]).max() < 1e-9


def test_class_and_windability_of_a_waist() -> None:
    layup = assess(helices(6, 0.5, 51, waisted()))
    on = grid(waisted())
    data = maps(on, layup)
    v = on.uv[:, 1]
    waist, ends = np.abs(v - 0.5) < 0.05, np.abs(v - 0.5) > 0.4
    assert (data[schema.CLASS][waist] == 0).all()
    assert (data[schema.WINDABILITY][waist] < 0.75).all()
    assert (data[schema.CLASS][ends] == 1).all()
    assert (data[schema.WINDABILITY][ends] == 1.0).all()
    assert "fit_error" not in data


def test_inside_out_is_concave() -> None:
    net = cylinder().control_points
    cup = revolved(lambda v: 1.0 - 0.4 * (2.0 * v - 1.0) ** 2, 64, 32)
    on = grid(Surface(cup.control_points[::-1]))
    data = maps(on, assess(helices(6, 0.5, 51, Surface(net[::-1]))))
    assert (data[schema.CLASS] == -1).all()
    assert (data[schema.WINDABILITY] == 0.0).all()


@pytest.mark.parametrize("revolutions", [0.0, 0.3, 2.0])
def test_winding_angle_of_helices(revolutions: float) -> None:
    angle = winding_angle(helices(6, revolutions, 101, cylinder()), 24, 33)
    assert angle == pytest.approx(np.full((24, 33), np.arctan2(2 * np.pi * revolutions, HEIGHT)), abs=1e-7)


def test_winding_angle_of_one_family_alone_is_finite() -> None:
    paths = helices(1, 0.5, 21, cylinder())
    assert np.isfinite(winding_angle(paths, 9, 7)).all()


def test_winding_angle_does_not_cross_an_open_edge() -> None:
    """From the outermost fibre on the angle stays, as `directions` has it: what lies beyond the other edge is far."""
    surface = Surface(np.ascontiguousarray(cylinder(64).control_points[:40]), periodic=False)
    v = np.linspace(0.0, 1.0, 41)
    uv = np.stack([np.stack([0.1 + 0.0 * v, v], axis=1), np.stack([0.8 + 0.1 * v, v], axis=1)])
    paths = drawn(surface, uv, [1, 1])
    angle = winding_angle(paths, 11, 5)
    steep = angle[9, -1]
    assert steep > 0.05
    assert angle[0] == pytest.approx(np.zeros(5), abs=1e-6)
    assert angle[-1] == pytest.approx(np.full(5, steep), abs=1e-3)
    edges = np.array([[0.0, 0.5], [1.0, 0.5]])
    assert angle[[0, -1], 2] == pytest.approx(directions(paths, edges)[1], abs=1e-6)


@pytest.mark.parametrize(("spans", "shape"), [((256, 5), (200, 21)), ((32, 5), (128, 21))])
def test_grid_takes_four_samples_a_span_up_to_a_limit(spans: tuple[int, int], shape: tuple[int, int]) -> None:
    assert grid(revolved(np.ones_like, spans[0], spans[1] + 3)).shape == shape


def test_an_open_surface_has_both_its_edges() -> None:
    net = cylinder().control_points[:40]
    on = grid(Surface(np.ascontiguousarray(net), periodic=False))
    assert on.uv[:, 0].max() == 1.0
    assert len(on.quads) == (on.shape[0] - 1) * (on.shape[1] - 1)
