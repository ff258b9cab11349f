"""Scan noise is smoothed, not followed; creases are followed, not smoothed."""

import numpy as np
import pytest
from comparison.problem import TURN
from comparison.problems import vase_radius
from irregular import annulus

from meshwind.chart import flatten
from meshwind.core.cast import Floats
from meshwind.mesh import annulus as opened
from meshwind.mesh import mesh_from
from meshwind.surface import fit
from meshwind.surface.interpolate import Formula

DIAGONAL = 4.8
"""Of the vase below, roughly."""


def vase(u: Floats, v: Floats) -> Floats:
    r = vase_radius(4 * v)
    return np.stack([r * np.cos(TURN * u), r * np.sin(TURN * u), 4 * v], -1)


def noisy(level: float) -> Formula:
    rng = np.random.default_rng(11)
    return lambda u, v: vase(u, v) + rng.normal(0.0, level * DIAGONAL, (len(u), 3))


@pytest.mark.parametrize("level", [3e-4, 1e-3])
def test_noise_is_smoothed(level: float) -> None:
    """The surface is much closer to the true vase than the noisy vertices are, and says how far these lie off."""
    surface = fit(flatten(annulus(noisy(level), 4000, 0.7)))
    P = surface.points(np.random.default_rng(5).random((5000, 2)) * [1, 0.96] + [0, 0.02])
    off = np.abs(np.hypot(P[:, 0], P[:, 1]) - vase_radius(P[:, 2]))
    assert np.sqrt(np.mean(off**2)) < 0.6 * level * DIAGONAL
    assert surface.error is not None
    assert surface.error.to_surface_rms == pytest.approx(level * DIAGONAL, rel=0.15)


def test_long_flat_triangles_do_not_swing() -> None:
    """A cylinder meshed in one strip of long triangles has no vertex between its rims: it must stay a cylinder."""
    turn = np.arange(64) * TURN / 64
    ring = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    vertices = np.concatenate([np.c_[ring, np.full(64, z)] for z in (0.0, 5.0)])
    i, j = np.arange(64), (np.arange(64) + 1) % 64
    faces = np.concatenate([np.c_[i, j, i + 64], np.c_[j, j + 64, i + 64]])
    surface = fit(flatten(opened(mesh_from(vertices, faces))))
    uv = np.random.default_rng(1).random((2000, 2))
    P = surface.points(uv)
    assert np.abs(np.hypot(P[:, 0], P[:, 1]) - 1).max() < 2e-3
