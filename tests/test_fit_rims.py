"""What a fit makes of rims whose vertices are further apart than the net's spans."""

import numpy as np
import pytest
from irregular import annulus

from meshwind.chart import flatten
from meshwind.core.cast import Floats
from meshwind.surface import fit
from meshwind.surface.fitting.rim_points import rim_points


def radius(angle: Floats, z: Floats) -> Floats:
    return np.asarray((1 + 0.2 * np.cos(2.2 * z)) * (1 + 0.1 * np.cos(3 * angle) + 0.03 * np.sin(7 * angle)))


def waved(u: Floats, v: Floats) -> Floats:
    angle, z = 2 * np.pi * u, 4 * v
    return np.stack([radius(angle, z) * np.cos(angle), radius(angle, z) * np.sin(angle), z], -1)


@pytest.mark.parametrize("seed", [0, 1])
def test_a_rim_with_few_vertices_does_not_swing_between_them(seed: int) -> None:
    surface = fit(flatten(annulus(waved, 4000, 0.7, seed, sparse=1.5)))
    uv = np.random.default_rng(1).random((8000, 2))
    depth = 0.5 * uv[:, 1] / surface.spans[1]
    uv[:, 1] = np.where(np.arange(8000) % 2 == 0, depth, 1.0 - depth)
    x, y, z = surface.points(uv).T
    off = np.abs(np.hypot(x, y) - radius(np.arctan2(y, x), z))
    assert np.sqrt(np.mean(off**2)) < 2e-4 and off.max() < 1e-3  # 3.7e-4 and 3.4e-3 without points between


def ring(count: int) -> tuple[Floats, Floats]:
    """A circle of so many vertices, unevenly apart, and their parameters."""
    u = (np.arange(count) + 0.3 * np.sin(5.0 * np.arange(count))) / count
    points = np.stack([np.cos(2 * np.pi * u), np.sin(2 * np.pi * u), np.zeros(count)], axis=1)
    return np.stack([u, np.ones(count)], axis=1), points


def test_points_between_lie_on_the_rim_to_the_fourth_order() -> None:
    errors = []
    for count in (24, 48):
        uv, points = ring(count)
        on, between = rim_points(uv, points, count)
        assert 0 < len(on) < count and (on[:, 1] == 1.0).all()
        angle = 2 * np.pi * on[:, 0]
        errors.append(np.abs(between - np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)).max())
    assert errors[0] < 1e-3 and errors[1] < errors[0] / 12


def test_edges_within_a_span_next_to_corners_or_on_bare_rims_get_none() -> None:
    uv, points = ring(24)
    assert len(rim_points(uv, points, 10)[0]) == 0  # within a span
    assert len(rim_points(uv, points, 37)[0]) == 0  # too few vertices for the net
    corner = np.array(points)
    corner[6] *= 3.0
    wide = len(rim_points(uv, points, 30)[0])
    assert 0 < len(rim_points(uv, corner, 30)[0]) < wide
    back = np.array(uv)
    back[[3, 4], 0] = uv[3, 0]
    assert len(rim_points(back, points, 30)[0]) == 0
