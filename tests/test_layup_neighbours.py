"""Neighbours and how far apart they lie; batches of paths taken apart and joined."""

from dataclasses import replace

import numpy as np
import pytest
from layup_shapes import DATA, HEIGHT, cylinder, drawn, helices, wound

import meshwind as mw
from meshwind.core.cast import Floats, frozen
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


def bossed(height: float) -> mw.Surface:
    """A cylinder with a round boss in the middle of one side."""

    def points(u: Floats, v: Floats) -> Floats:
        far = ((np.mod(u, 1.0) - 0.5) / 0.05) ** 2 + ((v - 0.5) / 0.08) ** 2
        ring, turn = 1.0 + height * np.exp(-0.5 * far), 2.0 * np.pi * u
        return np.stack([ring * np.cos(turn), ring * np.sin(turn), 4.0 * v], axis=-1)

    return shapes.parametric(points, (96, 64))


def test_neighbours_part_round_a_boss_and_not_where_fibres_fan_out() -> None:
    """However many paths start between the two, none rests on the boss; on a cone and an elbow all distances shrink."""
    paths = wound(bossed(0.6), 10, 0.1)
    layup = mw.assess(paths)
    near = layup.neighbours
    pairs = np.stack([near.first, near.second], axis=1)[layup.partings]
    assert len(pairs) == 2
    for first, second in pairs:  # one on either side of the boss
        middle = paths.uv[[first, second]][:, paths.uv.shape[1] // 2, 0]
        assert middle[0] < 0.5 < middle[1]
    assert near.largest[layup.partings].min() > 2.0 * np.median(near.largest)
    for even in (wound(bossed(0.02), 10, 0.1), wound(shapes.elbow(3.0, 1.0, spans=(48, 32)), 12, 0.5)):
        assert not mw.assess(even).partings.any()


def test_partings_are_those_of_more_paths() -> None:
    """With twice as many paths the same places stay open, and no others of their size."""
    surface = mw.fit(mw.flatten(mw.annulus(mw.read(DATA / "cast.ply"))), tolerance=1e-4)
    few, many = (mw.assess(wound(surface, count, 1.5)) for count in (24, 48))
    near, parted = few.neighbours, few.partings
    left = np.sort(many.neighbours.largest)
    assert parted.sum() == 2
    assert left[-2:] == pytest.approx(np.sort(near.largest[parted]), rel=0.1)
    assert left[-3] < 0.25 * left[-2]


def test_paths_that_are_not_at_rest_part_round_nothing() -> None:
    paths = wound(bossed(0.6), 10, 0.1)
    loose = replace(paths, status=frozen(np.full(len(paths), int(mw.Status.STALLED))))
    assert not mw.assess(loose).partings.any()
