"""Coverage: exact on a cylinder, and the balance of area always closes."""

import numpy as np
import pytest
from layup_shapes import HEIGHT, bridged, cylinder, drawn, helices, straight_uv, waisted
from scipy.integrate import quad

from meshwind.core.errors import BadInputError
from meshwind.layup.coverage import cell_areas, coverage

CYLINDER = cylinder()


@pytest.mark.parametrize(("count", "revolutions", "particles"), [(8, 1.0, 101), (16, 0.3, 2), (7, 2.3, 131)])
def test_a_regular_pattern_covers_a_cylinder_evenly(count: int, revolutions: float, particles: int) -> None:
    cover = coverage(helices(count, revolutions, particles, CYLINDER))
    assert np.abs(cover.layers - 2.0).max() < 1e-8
    # One family of N bands of width w covers 2 pi r cos(alpha) = N w.  Chords are a little shorter than arcs.
    if particles > 100:
        slope = np.arctan2(2.0 * np.pi * revolutions, HEIGHT)
        assert cover.width == pytest.approx(2.0 * np.pi * np.cos(slope) / count, rel=2e-3)


def test_layers_grow_with_the_width_given() -> None:
    paths = helices(8, 1.0, 101, CYLINDER)
    plain = coverage(paths)
    assert np.allclose(coverage(paths, 3.0 * plain.width).layers, 6.0, rtol=1e-8)


def test_area_balance_closes_where_it_is_uneven() -> None:
    paths = bridged()
    cover = coverage(paths, 0.05)
    length = np.linalg.norm(np.diff(paths.points, axis=1), axis=2).sum()
    assert (cover.layers * cover.area).sum() == pytest.approx(0.05 * length, rel=1e-12)
    assert cover.min < cover.median < cover.max


def test_cells_sum_to_the_area_of_the_part() -> None:
    def ring(v: float) -> float:
        bump = 0.35 * np.exp(-(((v - 0.5) / 0.16) ** 2))
        slope = bump * 2.0 * (v - 0.5) / 0.16**2
        return float(2.0 * np.pi * (1.0 - bump) * np.hypot(HEIGHT, slope))

    assert cell_areas(waisted(), 12, 20).sum() == pytest.approx(quad(ring, 0.0, 1.0)[0], rel=1e-5)
    assert cell_areas(CYLINDER, 5, 3) == pytest.approx(np.full((5, 3), 2.0 * np.pi * HEIGHT / 15), rel=1e-8)


def test_length_lands_in_the_cells_that_are_crossed() -> None:
    """One straight segment from corner to corner of a 2 x 5 grid of known cells."""
    uv = np.array([[[0.0, 0.0], [0.0, 1.0]], [[0.5, 0.1], [0.5, 0.3]]])
    cover = coverage(drawn(CYLINDER, uv, np.array([1.0, 1.0])), 1.0)
    nu, nv = cover.layers.shape
    assert nu == 2
    length = cover.layers * cover.area
    assert length[0] == pytest.approx(np.full(nv, HEIGHT / nv), rel=1e-8)
    edges = np.arange(nv + 1) / nv
    inside = np.clip(np.minimum(edges[1:], 0.3) - np.maximum(edges[:-1], 0.1), 0.0, None)
    assert length[1] == pytest.approx(HEIGHT * inside, rel=1e-8, abs=1e-12)


def test_sampling_joins_across_the_seam() -> None:
    uv, family = straight_uv(8, 1.0, 101)
    uv[..., 0] += 0.1 * np.sin(2 * np.pi * uv[..., 0])
    cover = coverage(drawn(CYLINDER, uv, family))
    v = np.linspace(0.0, 1.0, 9)
    near = [cover.at(np.column_stack([np.full(9, u), v])) for u in (1.0 - 1e-9, 1.0, 0.0, -1e-9)]
    assert np.abs(np.diff(near, axis=0)).max() < 1e-6
    nu, nv = cover.layers.shape
    u, v = np.meshgrid((np.arange(nu) + 0.5) / nu, (np.arange(nv) + 0.5) / nv, indexing="ij")
    assert cover.at(np.column_stack([u.ravel(), v.ravel()])) == pytest.approx(cover.layers.ravel(), rel=1e-12)


@pytest.mark.parametrize("width", [0.0, -1.0, float("nan"), float("inf")])
def test_a_width_that_is_no_length_is_refused(width: float) -> None:
    with pytest.raises(BadInputError, match="give a number > 0"):
        coverage(helices(3, 1.0, 11, CYLINDER), width)
