"""Patterns: a layer closes to gcd(K, N) filaments, on rims as uneven as they may be, and as closed forms say."""

from math import asin, asinh, ceil, cos, degrees, gcd, pi, radians, sin, tan

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.filament.band import Roving
from meshwind.filament.joining import Joining, join, passes
from meshwind.filament.pattern import Pattern, nearest_pattern, patterns

property_test = settings(max_examples=200, deadline=None, derandomize=True, database=None)


def test_a_cylinder_between_collars() -> None:
    """Radius 50, length 400, 45 degrees, band 10, slip 0.2: 124 or 125 turns of 23 circuits."""
    angle = radians(45.0)
    there = 400.0 * tan(angle) / (2 * pi * 50.0)
    collar = 2.0 * asinh(1.0 / tan(angle)) / 0.2 / (2 * pi)
    circuit = 2.0 * (there + collar)
    assert there == pytest.approx(1.273240, abs=1e-6)
    assert collar == pytest.approx(1.402750, abs=1e-6)
    assert circuit == pytest.approx(5.351978, abs=3e-6)
    first, second = patterns(23, circuit)[:2]
    assert (first.turns, first.number, first.leading) == (124, 5, False)
    assert (second.turns, second.number, second.leading) == (125, 7, True)
    assert degrees(pi * first.dwell) == pytest.approx(7.0787, abs=1e-3)  # half a circuit's at each end
    assert degrees(pi * second.dwell) == pytest.approx(14.9048, abs=1e-3)


def test_a_capsule() -> None:
    """Radius 100, length 300, openings of 30: the geodesic takes 180 degrees over each cap; a closed form."""
    angle = asin(30.0 / 100.0)
    assert degrees(angle) == pytest.approx(17.457603, abs=1e-6)
    circuit = 2.0 * (180.0 + degrees(300.0 * tan(angle) / 100.0)) / 360.0
    assert 180.0 * circuit == pytest.approx(234.056067, abs=1e-6)
    assert 360.0 * circuit % 360.0 == pytest.approx(108.112134, abs=1e-6)
    found = patterns(100, circuit, within=0.5)  # 90 degrees at each end
    assert len(found) == 20
    assert [(each.shift, each.number, each.leading) for each in found[:2]] == [(31, 29, False), (33, 3, False)]
    assert [round(180.0 * each.dwell, 6) for each in found[:2]] == [1.743933, 5.343933]


def test_a_commercial_vessel() -> None:
    """Of 233 circuits with a band of 4 each turns by 427.98283 degrees: 44 places on."""
    pattern = nearest_pattern(233, 427.98283 / 360.0)
    assert (pattern.shift, pattern.number, pattern.leading, pattern.filaments) == (44, 90, False, 1)
    assert 360.0 * pattern.turns / pattern.circuits == pytest.approx(427.98283, abs=1e-5)
    assert 233 * 4 / (2 * pi * 152.925 * cos(radians(14.1))) == pytest.approx(1.0001, abs=1e-4)
    roving = Roving(tex=800.0, fibre_density=1.8, resin_density=1.1, fibre_volume=0.6)
    assert roving.thickness(4.0) == pytest.approx(0.185185, abs=1e-6)
    assert roving.fibre_share == pytest.approx(0.710526, abs=1e-6)
    assert roving.fibre_mass(424245.5) == pytest.approx(339.40, abs=5e-3)
    assert roving.resin_mass(424245.5) == pytest.approx(138.27, abs=5e-3)


def test_a_pressure_vessel_of_103_circuits() -> None:
    """A pass takes 205.47 degrees; with a dwell of 4.24 at each end circuits are 17 places apart: pattern 6 lagging."""
    pattern = patterns(103, 2.0 * 205.47 / 360.0)
    found = next(each for each in pattern if each.shift == 17)
    assert 180.0 * found.dwell == pytest.approx(4.24, abs=0.01)
    assert (found.number, found.leading) == (6, False)


def test_the_nearest_pattern_changes_the_revolutions() -> None:
    pattern = nearest_pattern(24, 2 * 0.6 + 0.5)
    assert pattern.turns == 41
    assert (pattern.turns / 24 - 0.5) / 2 == pytest.approx(0.604167, abs=1e-6)


@property_test
@given(st.integers(1, 400), st.integers(0, 4000))
def test_the_pattern_number_leads_to_a_neighbour(circuits: int, turns: int) -> None:
    pattern = Pattern(circuits, turns)
    apart = pattern.filaments
    where = [k * pattern.shift % circuits for k in range(1, pattern.number + 1)]
    assert where[-1] == (apart if pattern.leading else -apart) % circuits
    assert all(0 < at < circuits and at not in (apart, circuits - apart) for at in where[:-1])


@property_test
@given(st.integers(1, 300), st.floats(0.0, 20.0))
def test_patterns_are_all_there_are(circuits: int, least: float) -> None:
    found = patterns(circuits, least)
    dwell = [each.dwell for each in found]
    assert dwell == sorted(dwell) and all(0.0 <= each <= 1.0 + 1e-9 for each in dwell)
    inside = range(ceil(circuits * (least - 1e-9)), int(circuits * (least + 1.0 + 1e-9)) + 1)
    assert [each.turns for each in found] == [m for m in inside if gcd(m, circuits) == 1]
    near = nearest_pattern(circuits, least)
    assert all(abs(near.turns / circuits - least) <= abs(m / circuits - least) + 1e-12 for m in inside
               if gcd(m, circuits) == 1)  # fmt: skip


def rim(seed: int, count: int, turned: float) -> Floats:
    """Uneven places on a rim, in order, from somewhere about `turned` on."""
    rng = np.random.default_rng(seed)
    gaps = rng.random(count) + 0.05
    return turned + rng.random() + (np.cumsum(gaps) - gaps) / gaps.sum()


def layer(seed: int, count: int, dwell: tuple[float, float], filaments: int | None = 1) -> Joining:
    """Two families between uneven rims, with their numbers in no order, and up to 3 turns of each."""
    rng = np.random.default_rng(seed)
    ends = []
    for k in range(2):
        start = rim(seed + 7 * k, count, 0.0)
        end = rim(seed + 7 * k + 3, count, np.ceil(start.max()) + rng.integers(0, 3))
        mixed = rng.permutation(count)
        ends.append(passes(start[mixed], end[mixed]))
    return join(*ends, end_dwell=dwell[0], start_dwell=dwell[1], filaments=filaments)


dwells = st.tuples(st.floats(0.0, 2.5), st.floats(0.0, 2.5))


@property_test
@given(st.integers(0, 10**6), st.integers(1, 60), dwells)
def test_any_rims_close_to_one_filament(seed: int, count: int, dwell: tuple[float, float]) -> None:
    joining = layer(seed, count, dwell)
    assert [sorted(each.tolist()) for each in joining.filaments] == [list(range(count))]
    assert sorted(joining.back.tolist()) == list(range(count)) == sorted(joining.there.tolist())
    assert joining.end_dwell.min() >= dwell[0] - 1e-8 and joining.start_dwell.min() >= dwell[1] - 1e-8
    assert gcd(joining.turns, count) == 1


@property_test
@given(st.integers(0, 10**6), st.integers(1, 60), dwells)
def test_any_rims_close_to_as_many_as_the_divisor_says(seed: int, count: int, dwell: tuple[float, float]) -> None:
    joining = layer(seed, count, dwell, filaments=None)
    assert len(joining.filaments) == gcd(joining.turns, count) == joining.pattern.filaments
    assert len({len(each) for each in joining.filaments}) == 1


@property_test
@given(st.integers(0, 10**6), st.integers(2, 60))
def test_all_that_turns_is_a_whole_number(seed: int, count: int) -> None:
    """Followed along the filament, from each path's own ends; and the order of rims is kept."""
    rng = np.random.default_rng(seed)
    start, end = rim(seed, count, 0.0), rim(seed + 1, count, 2.0)
    other, last = rim(seed + 2, count, 0.0), rim(seed + 3, count, 2.0)
    joining = join(passes(start, end), passes(other, last), end_dwell=rng.random(), start_dwell=rng.random())
    there, back = end - start, last - other
    total = there.sum() + back.sum() + joining.end_dwell.sum() + joining.start_dwell.sum()
    assert total == pytest.approx(joining.turns, abs=1e-9 * count)
    at, path = start[0], 0
    for _ in range(count):
        assert (at - start[path] + 0.5) % 1.0 == pytest.approx(0.5, abs=1e-8)
        way = joining.back[path]
        at += there[path] + joining.end_dwell[path]
        assert (at - other[way] + 0.5) % 1.0 == pytest.approx(0.5, abs=1e-8)
        at += back[way] + joining.start_dwell[way]
        path = joining.there[way]
    assert path == 0 and at - start[0] == pytest.approx(joining.turns, abs=1e-8)
    around = np.argsort(end % 1.0)
    places = np.argsort(np.argsort(other % 1.0))[joining.back[around]]
    assert len({int(each) for each in (places - np.arange(count)) % count}) == 1


@property_test
@given(st.integers(0, 10**6), st.integers(2, 40))
def test_the_largest_dwell_is_the_least_of_all_orders(seed: int, count: int) -> None:
    """Against swapping any two: with as many turns none has a smaller largest dwell."""
    start, end, other = rim(seed, count, 0.0), rim(seed + 1, count, 2.0), rim(seed + 2, count, 0.0)
    joining = join(passes(start, end), passes(other, other + 2.0), filaments=None)
    dwell = joining.end_dwell
    where = end + dwell
    for one in range(count):
        swapped = np.maximum(where - end[one], where[one] - end)
        fine = (where - end[one] >= 0.0) & (where[one] - end >= 0.0)
        assert (swapped[fine] >= np.maximum(dwell, dwell[one])[fine] - 1e-9).all()


def test_even_rims_dwell_evenly() -> None:
    rim_ = np.arange(24) / 24
    joining = join(passes(rim_, rim_ + 0.604167), passes(rim_, rim_ + 0.604167), end_dwell=0.2, start_dwell=0.2)
    assert np.ptp(joining.end_dwell) < 1e-9 and np.ptp(joining.start_dwell) < 1e-9
    assert len(joining.filaments) == 1


def test_what_cannot_be_joined_is_said() -> None:
    rim_ = np.arange(6) / 6
    good = passes(rim_, rim_ + 0.3)
    with pytest.raises(BadInputError, match="paths 1 and 2 of a family cross"):
        passes(rim_, rim_ + np.array([0.3, 0.6, 0.3, 0.3, 0.3, 0.3]))
    with pytest.raises(BadInputError, match="path 2 turns back"):
        passes(rim_, rim_ + np.array([0.1, 0.1, -0.2, 0.1, 0.1, 0.1]))
    with pytest.raises(BadInputError, match="6 paths there but 5 back"):
        join(good, passes(rim_[:5], rim_[:5] + 0.3))
    with pytest.raises(BadInputError, match="4 filaments cannot share out 6 circuits"):
        join(good, good, filaments=4)
    with pytest.raises(BadInputError, match="no path to join"):
        passes([], [])
    with pytest.raises(BadInputError, match="tex is 0; give a number above 0"):
        Roving(tex=0.0)
    with pytest.raises(BadInputError, match="circuits is 0"):
        patterns(0, 1.0)


def test_an_elliptic_spar_needs_26_circuits() -> None:
    """The band of a path at 45 degrees covers a perimeter of 363.668628 in 25.7153 circuits."""
    wanted = 363.668628 * cos(radians(45.0)) / 10.0
    assert wanted == pytest.approx(25.7153, abs=1e-4)
    assert ceil(wanted) * 10.0 / (363.668628 * sin(radians(45.0))) == pytest.approx(1.01107, abs=1e-5)
