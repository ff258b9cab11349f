"""Parts a thousand times as long as wide: where their ends are opened, and that a surface follows them."""

import numpy as np
import pytest
import trimesh
from mesh_shapes import moved, pear, rotation
from test_mesh_annulus import rim_points, trim

import meshwind as mw


@pytest.mark.parametrize("length", [100.0, 800.0, 1000.0, 3000.0])
@pytest.mark.parametrize("subdivisions", [2, 3])
def test_a_closed_needle_is_opened_at_its_tips(length: float, subdivisions: int) -> None:
    """Up to 2500 times as long as wide: the poles are its tips, not points on its flanks."""
    vertices, faces = pear(subdivisions)
    slim = vertices * [1.0, 1.0, length / 2.5], faces
    tips = slim[0][[np.argmin(vertices[:, 2]), np.argmax(vertices[:, 2])]]
    for seed in range(2):
        turn = rotation(seed)
        found = trim(moved(slim, turn, np.zeros(3), 2.0))
        for rim, tip in zip(rim_points(found), tips, strict=True):
            away = np.linalg.norm(rim @ turn / 2.0 - tip, axis=1)
            assert away.min() > 0.35 and away.max() < 0.55
    wanted = trim(slim, "z", 0.2)
    for rim, tip in zip(rim_points(wanted), tips, strict=True):
        assert np.linalg.norm(rim - tip, axis=1) == pytest.approx(np.full(len(rim), 0.2), abs=0.02)


def test_a_long_rod_is_opened_in_the_middle_of_its_flat_ends() -> None:
    rod = trimesh.creation.cylinder(radius=1.0, height=4000.0, sections=40)
    found = trim((np.asarray(rod.vertices), np.asarray(rod.faces)))
    for rim, z in zip(rim_points(found), (-2000.0, 2000.0), strict=True):
        assert np.abs(rim[:, 2] - z).max() < 1e-9
        assert np.ptp(np.linalg.norm(rim[:, :2], axis=1)) < 1e-9


def test_a_needle_can_be_wound() -> None:
    vertices, faces = pear(3)
    found = trim((vertices * [1.0, 1.0, 400.0], faces))
    chart = mw.flatten(found)
    error = mw.fit(chart).error
    assert chart.flipped == 0
    assert error is not None and error.to_surface_max < 0.02  # of a part 2.4 wide
