"""Neighbours and how far apart they lie; batches of paths taken apart and joined."""

import numpy as np
import pytest
from layup_shapes import HEIGHT, cylinder, helices, wound

from meshwind.path.neighbours import neighbours
from meshwind.surface import shapes

CYLINDER = cylinder()


@pytest.mark.parametrize(("count", "turns"), [(8, 1.0), (12, 0.4), (30, 2.0), (2, 0.1)])
def test_helices_are_evenly_apart(count: int, turns: float) -> None:
    near = neighbours(helices(count, turns, 401, CYLINDER))
    slope = np.arctan2(2.0 * np.pi * turns, HEIGHT)
    assert len(near.first) == 2 * count
    assert np.array_equal(np.sort(near.second), np.arange(2 * count))
    between = 2.0 * np.pi / count * np.cos(slope)  # along the surface; the chord is shorter
    assert (near.largest < between).all()
    assert near.largest == pytest.approx(np.full(2 * count, near.largest[0]), rel=1e-6)
    if count >= 30:
        assert near.largest == pytest.approx(np.full(2 * count, between), rel=2e-3)


def test_neighbours_go_around_the_rim_in_any_order() -> None:
    paths = helices(7, 0.6, 51, CYLINDER)
    order = np.random.default_rng(4).permutation(14)
    near = neighbours(paths.subset(order))
    pairs = {(int(order[a]), int(order[b])) for a, b in zip(near.first, near.second, strict=True)}
    assert pairs == {(k, (k + 1) % 7) for k in range(7)} | {(7 + k, 7 + (k + 1) % 7) for k in range(7)}


def test_paths_are_selected_and_joined_whole() -> None:
    paths = wound(shapes.cone(1.0, 0.5, 3.0, (64, 8)), 3, 0.3, 25)
    again = paths.subset(np.array([4, 5])).joined(paths.subset(np.array([0])))
    assert len(again) == 3
    assert np.array_equal(again.points, paths.points[[4, 5, 0]])
    assert np.array_equal(again.family, [-1, -1, 1])
    assert again.counters.solves == 2 * paths.counters.solves
