"""Bands of fibre laid on the surface: layers over its points, and what stays bare at the ends."""

import numpy as np
import pytest
from layup_shapes import HEIGHT, cylinder, drawn, fitted, helices, straight_uv, wound

from meshwind.core.cast import Floats
from meshwind.layup.bands import bands
from meshwind.surface import Surface, shapes

CYLINDER = cylinder()


@pytest.mark.parametrize(("count", "turns"), [(8, 1.0), (16, 0.3), (7, 2.3)])
def test_helices_whose_bands_touch_cover_a_cylinder_twice(count: int, turns: float) -> None:
    width = 2.0 * np.pi / count * np.cos(np.arctan2(2.0 * np.pi * turns, HEIGHT))
    laid = bands(helices(count, turns, 401, CYLINDER), width)
    assert laid.share(2) > 0.99
    assert laid.balance == pytest.approx(1.0, abs=5e-3)
    # twice as narrow: a point is under each family's band half of the time
    half = bands(helices(count, turns, 401, CYLINDER), 0.5 * width)
    assert [half.share(k) for k in range(3)] == pytest.approx([0.25, 0.5, 0.25], abs=0.02)
    assert half.bare == half.share(0)


def test_one_hoop_lies_where_it_was_put() -> None:
    v = np.full(65, 0.5)
    uv = np.stack([np.linspace(0.0, 1.0, 65), v], axis=1)[None]
    laid = bands(drawn(CYLINDER, uv, np.array([1.0])), 0.8)
    assert set(np.unique(laid.layers)) == {0, 1}
    covered = np.abs(laid.uv[:, 1] * HEIGHT - 2.0) < 0.4
    assert (laid.layers.ravel() == covered).mean() > 0.99
    assert laid.balance == pytest.approx(1.0, abs=0.09)  # a row of points more or less


def test_caps_are_the_openings_and_the_bare_rings() -> None:
    uv, family = straight_uv(12, 0.5, 201)
    uv[..., 1] = 0.25 + 0.5 * uv[..., 1]
    laid = bands(drawn(CYLINDER, uv, family), 0.05)
    assert laid.openings == pytest.approx((np.pi, np.pi), rel=1e-6)
    ring = 2.0 * np.pi * HEIGHT * 0.25
    assert laid.caps == pytest.approx((np.pi + ring, np.pi + ring), rel=0.03)
    assert bands(helices(12, 0.5, 201, CYLINDER), 0.3).caps == pytest.approx((np.pi, np.pi), rel=1e-6)


@pytest.mark.parametrize(("name", "turns"), [("vase.stl", 0.8), ("cast.ply", 1.5), ("bottle.obj", 0.5),
                                             ("wing.stl", 0.5), ("elbow.obj", 1.0), ("tank.ply", 0.5)])  # fmt: skip
def test_area_balance_closes_on_every_part(name: str, turns: float) -> None:
    """Length times width is the integral of the layers, of what the bands cover as of what the cells hold."""
    from meshwind.layup.coverage import coverage

    paths = wound(fitted(name), 12, turns, 201)
    cover = coverage(paths)
    length = np.linalg.norm(np.diff(paths.points, axis=1), axis=2).sum()
    assert (cover.layers * cover.area).sum() == pytest.approx(cover.width * length, rel=1e-9)
    assert bands(paths, 0.2 * cover.width).balance == pytest.approx(1.0, abs=5e-3)


def test_bands_do_not_depend_on_the_units() -> None:
    def scaled(factor: float) -> Floats:
        surface = Surface(shapes.elbow(3.0, 1.0, spans=(48, 32)).control_points * factor)
        laid = bands(wound(surface, 6, 1.0, 97), 0.2 * factor)
        return np.array([laid.share(k) for k in range(4)])

    assert scaled(1000.0) == pytest.approx(scaled(1.0), abs=1e-3)
