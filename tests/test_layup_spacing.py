"""Neighbours and how far apart they lie; new paths between those too far apart; bands on the surface."""

from pathlib import Path

import numpy as np
import pytest
from layup_shapes import HEIGHT, cylinder, drawn, helices, straight_uv

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.layup.bands import bands
from meshwind.layup.crossings import cell_sides, crossings
from meshwind.path import Paths, solve
from meshwind.path.neighbours import neighbours
from meshwind.planning.families import families
from meshwind.planning.spacing import Spaced, space_out
from meshwind.surface import Surface, shapes

DATA = Path(__file__).parents[1] / "data"
CYLINDER = cylinder()


def wound(surface: Surface, paths: int, turns: float, particles: int = 145) -> Paths:
    rims = families(surface, paths, turns)
    return solve(surface, rims.start, rims.end, particles=particles, family=rims.family)


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


def test_neighbours_go_around_the_rim_whatever_the_order() -> None:
    paths = helices(7, 0.6, 51, CYLINDER)
    order = np.random.default_rng(4).permutation(14)
    near = neighbours(paths.subset(order))
    pairs = {(int(order[a]), int(order[b])) for a, b in zip(near.first, near.second, strict=True)}
    assert pairs == {(k, (k + 1) % 7) for k in range(7)} | {(7 + k, 7 + (k + 1) % 7) for k in range(7)}


@pytest.mark.parametrize(("count", "turns"), [(8, 1.0), (5, 1.3)])
def test_sides_of_the_cells_of_helices(count: int, turns: float) -> None:
    paths = helices(count, turns, 401, CYLINDER)
    sides = cell_sides(paths, crossings(paths))
    # a path crosses the other family every 1 / (2 R N) of its length
    whole = np.hypot(2.0 * np.pi * turns, HEIGHT)
    assert sides.d1 == pytest.approx(np.full(len(sides.d1), whole / (2 * turns * count)), rel=1e-3)
    assert sides.d2 == pytest.approx(np.full(len(sides.d2), whole / (2 * turns * count)), rel=1e-3)
    met = len(crossings(paths))
    assert len(sides.d1) == met - count


def test_paths_are_selected_and_joined_whole() -> None:
    paths = wound(shapes.cone(1.0, 0.5, 3.0, (64, 8)), 3, 0.3, 25)
    again = paths.subset(np.array([4, 5])).joined(paths.subset(np.array([0])))
    assert len(again) == 3
    assert np.array_equal(again.points, paths.points[[4, 5, 0]])
    assert np.array_equal(again.family, [-1, -1, 1])
    assert again.counters.solves == 2 * paths.counters.solves


def test_no_gap_is_left_and_ends_are_where_they_belong() -> None:
    surface = shapes.elbow(3.0, 1.0, spans=(48, 32))
    even = wound(surface, 6, 1.0)
    spaced = space_out(even, 1.0, 0.25)
    assert len(spaced.partings) == 0
    assert spaced.gap <= 0.25
    assert (spaced.paths.status == 0).all()
    assert neighbours(spaced.paths).largest.max() <= 0.25
    assert spaced.even == 6
    # the ends of both rims are at the same shares of their lengths, turned by one
    turn = spaced.paths.uv[:, -1, 0] - spaced.paths.uv[:, 0, 0]
    assert np.abs(turn - spaced.paths.family).max() < 0.1
    assert np.abs(spaced.share[:, None] - np.arange(6) / 6).min(axis=0).max() < 1e-12
    for family in (1, -1):
        assert (np.diff(spaced.share[spaced.paths.family == family]) > 0).all()


def test_wide_enough_paths_are_left_alone_and_even_ones_stay_even() -> None:
    even = wound(shapes.cone(1.0, 0.5, 3.0, (64, 8)), 6, 0.3)
    assert len(space_out(even, 0.3, 10.0).paths) == 12
    spaced = space_out(even, 0.3, 0.2)
    by_family = [np.diff(spaced.share[spaced.paths.family == family]) for family in (1, -1)]
    assert np.concatenate(by_family) == pytest.approx(np.full(len(spaced.paths) - 2, by_family[0][0]))


def fitted(name: str) -> Surface:
    return mw.fit(mw.flatten(mw.annulus(mw.read(DATA / name))))


def largest_gap(paths: Paths, partings: tuple[int, int]) -> float:
    """The largest distance between neighbours, but for the largest of each family, as many as it has partings."""
    near = neighbours(paths)
    left = []
    for family, many in zip((1, -1), partings, strict=True):
        gap = np.sort(near.largest[near.family == family])
        left.append(gap[: max(len(gap) - many, 0)])
    return float(np.concatenate(left).max(initial=0.0))


def compared(surface: Surface, turns: float, spacing: float) -> tuple[Spaced, float]:
    """Spaced paths, and the largest gap of as many even ones."""
    spaced = space_out(wound(surface, 8, turns), turns, spacing)
    count = max(int((spaced.paths.family == family).sum()) for family in (1, -1))
    return spaced, largest_gap(wound(surface, count, turns), spaced.parted)


@pytest.mark.parametrize(("name", "turns", "spacing"), [("cast.ply", 2.06, 10.0), ("bottle.obj", 0.3, 10.0)])
def test_new_paths_where_they_are_needed_beat_as_many_even_ones(name: str, turns: float, spacing: float) -> None:
    """As in Fig. 6.6, at equal count; both parts have a boss that fibres part around, which no spacing mends."""
    spaced, even = compared(fitted(name), turns, spacing)
    assert spaced.gap <= spacing
    assert spaced.gap <= 0.85 * even
    assert 0 < len(spaced.partings) <= 6
    assert spaced.widest > 3.0 * spacing


@pytest.mark.parametrize("spacing", [0.0, -1.0, float("nan"), float("inf")])
def test_a_spacing_that_is_no_length_is_refused(spacing: float) -> None:
    with pytest.raises(BadInputError, match="give a length above 0"):
        space_out(helices(3, 1.0, 11, CYLINDER), 1.0, spacing)


def test_a_spacing_that_takes_too_many_paths_is_refused() -> None:
    even = wound(shapes.cone(1.0, 0.5, 3.0, (64, 8)), 6, 0.3, 25)
    with pytest.raises(BadInputError, match="give a larger one"):
        space_out(even, 0.3, 1e-3)


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
