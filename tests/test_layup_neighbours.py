"""Neighbours and how far apart they lie; batches of paths taken apart and joined."""

import numpy as np
import pytest
from layup_shapes import DATA, HEIGHT, cylinder, drawn, helices, wound

import meshwind as mw
from meshwind.layup.neighbours import neighbours
from meshwind.surface import shapes

CYLINDER = cylinder()


@pytest.mark.parametrize(("count", "turns"), [(8, 1.0), (12, 0.4), (30, 2.0), (2, 0.1), (6, 3.0), (3, 5.0), (3, -0.0)])
def test_helices_are_evenly_apart(count: int, turns: float) -> None:
    """On the unrolled cylinder they are straight, also where other strands of the next path lie nearer in space."""
    near = neighbours(helices(count, turns, 401, CYLINDER))
    between = 2.0 * np.pi / count * np.cos(np.arctan2(2.0 * np.pi * turns, HEIGHT))
    assert np.array_equal(np.sort(near.second), np.arange(2 * count))
    assert near.largest == pytest.approx(np.full(2 * count, between), rel=1e-6)
    inside = near.distance[near.distance > 0.0]
    assert len(inside) > 0.1 * near.distance.size and inside == pytest.approx(np.full(len(inside), between), rel=1e-6)


@pytest.mark.parametrize("count", [3, 4, 6, 24])
def test_meridians_of_a_sphere(count: int) -> None:
    """From latitude b the geodesic square to a meridian that is a apart has the length asin(cos b sin a)."""
    sphere = shapes.revolution(lambda z: np.sqrt(1.0 - z * z), -0.9, 0.9, (96, 96))
    paths = drawn(sphere, np.stack([np.array([[k / count, v] for v in np.linspace(0, 1, 101)]) for k in range(count)]),
                  np.ones(count, dtype=np.int64))  # fmt: skip
    near = neighbours(paths)
    apart, lat = 2.0 * np.pi / count, np.arcsin(np.clip(paths.points[0, :, 2], -1.0, 1.0))
    foot = np.arctan2(np.tan(lat), np.cos(apart))  # its latitude; past a pole for meridians more than 90 degrees apart
    known = np.abs(foot) < 0.9 * lat.max()
    exact = np.arcsin(np.cos(lat) * np.sin(apart))
    if count > 4:
        assert near.distance[:, known] == pytest.approx(np.tile(exact[known], (count, 1)), rel=8e-3)
        assert near.largest == pytest.approx(np.full(count, apart), rel=8e-3)
    assert (near.distance <= apart * (1.0 + 1e-6)).all()


@pytest.mark.parametrize(
    ("part", "count", "turns"), [("bottle.obj", 4, 1.3), ("wing.stl", 3, 0.4), ("vase.stl", 2, 0.7)]
)
def test_distances_are_those_of_all_feet_tried(part: str, count: int, turns: float) -> None:
    """Against geodesics to every foot on the strand of the next path, from some particles, each by the path solver."""
    surface = mw.fit(mw.flatten(mw.annulus(mw.read(DATA / part))), tolerance=1e-4)
    ends = mw.families(surface, count, turns)
    paths = mw.solve(surface, ends.start, ends.end, family=ends.family, particles=201)
    near = neighbours(paths)
    for pair in (0, count):
        a, b = paths.uv[near.first[pair]], paths.uv[near.second[pair]]
        line = b + [np.ceil(a[0, 0] - b[0, 0]), 0.0]
        for k in (60, 100, 140):
            feet = line[1:-1:4]
            geodesics = mw.solve(surface, np.tile(a[k], (len(feet), 1)), feet, particles=65, bridging=False)
            if (geodesics.status == 0).all():
                least = geodesics.length.min()
                assert near.distance[pair, k] in (0.0, pytest.approx(least, rel=1e-2)), (pair, k)


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
