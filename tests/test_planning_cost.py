"""What `--revolutions auto` costs, in evaluations, and what its shortcuts may not change."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from benchmarks.tally import counted
from layup_shapes import revolved

import meshwind as mw
from meshwind.core.cast import Bools, Ints
from meshwind.path.limit import Search, Way
from meshwind.planning.families import families
from meshwind.planning.settling import Settling
from meshwind.planning.trials import trial
from meshwind.planning.windings import rougher, spread
from meshwind.surface import Surface, shapes

DATA = Path(__file__).parents[1] / "data"
DEAREST = 30
"""Solvings of the paths that a choice of the revolutions may cost."""


@cache
def part(name: str) -> Surface:
    """A part's surface."""
    return mw.fit(mw.flatten(mw.annulus(mw.read(DATA / name))))


@pytest.mark.parametrize(("name", "friction"), [
    *((file.name, 0.0) for file in sorted(DATA.iterdir())), ("tank.ply", 0.2),
])  # fmt: skip
def test_a_choice_costs_no_more_than_30_solvings(name: str, friction: float) -> None:
    surface = part(name)
    with counted() as spent:
        found = mw.choose_revolutions(surface, paths=16, friction=friction)
    ends = mw.families(surface, paths=16, revolutions=found.choice)
    with counted() as once:
        paths = mw.solve(surface, ends.start, ends.end, family=ends.family, friction=friction)
    assert (paths.status == 0).all()
    assert spent["evaluations"] <= DEAREST * once["evaluations"]


def cap() -> Surface:
    """A shape off the open ends of which fibres slide from some number of revolutions on."""
    net = shapes.revolution(lambda z: np.sqrt(1.0 - 0.85 * z**2), -1.0, 1.0, (64, 48)).control_points
    return Surface(net * [1.3, 1.0, 1.0])


def settled(settling: Settling, turns: float) -> Bools:
    """Which of eight paths hold."""
    rims = families(settling.surface, 4, turns)
    return settling.holds(np.arange(8), np.stack([rims.start, rims.end], axis=1))


def test_paths_that_are_wound_on_hold_where_they_do_when_solved_anew() -> None:
    surface = part("bottle.obj")
    settling = Settling(surface, 0.0, 401)
    for turns in (0.45, 0.6, 0.61, 0.62, 0.63, 0.5):
        assert np.array_equal(settled(settling, turns), settled(Settling(surface, 0.0, 401), turns)), turns
    assert settling.sought


def test_a_path_that_was_dear_costs_less_a_little_further_on() -> None:
    surface = part("bottle.obj")
    settling = Settling(surface, 0.0, 401)
    settled(settling, 0.6)
    with counted() as on:
        settled(settling, 0.605)
    with counted() as anew:
        settled(Settling(surface, 0.0, 401), 0.605)
    assert on["evaluations"] < 0.7 * anew["evaluations"]


def test_starts_are_put_beside_others_once() -> None:
    windings = spread(cap(), 0.0, paths=4, particles=101)
    assert windings.limit(1.0, 0.4, 0.1) > 0.0
    both = np.stack([windings.family, np.round(windings.share, 9) % 1.0], axis=1)
    assert len(both) > 2 * windings.starts
    assert len(np.unique(both, axis=0)) == len(both)


def test_friction_is_tried_by_as_many_paths_from_whichever_there_is() -> None:
    surface = cap()
    starts = [rougher(spread(surface, friction, paths=16), 0.2).starts for friction in (0.0, 0.1)]
    assert starts == [spread(surface, 0.2, paths=16).starts] * 2


def test_what_is_confirmed_holds_and_lies_no_further_in_than_needed() -> None:
    windings = spread(cap(), 0.0, paths=4, particles=201)
    number = windings.confirmed(0.7, 0.1, -0.004)
    assert number > 0.1
    assert windings.holds(number)
    assert not windings.holds(number + 2.0 * 0.004)


def test_with_friction_starts_between_are_confirmed_too() -> None:
    windings = spread(cap(), 0.1, paths=4, particles=101)
    assert len(windings.share) == 24
    assert windings.confirmed(0.1, 0.05, -0.01) == 0.1
    assert sorted(set(windings.share[windings.family == 1])) == pytest.approx(list(np.arange(24) / 24))


@pytest.mark.parametrize(("through", "expected"), [(True, 0.9), (False, 0.69)])
def test_a_search_goes_beyond_a_number_that_fails_only_where_it_may(through: bool, expected: float) -> None:
    """Numbers up to 0.9 hold, but those from 0.69 to 0.7."""

    def attempt(number: float, paths: Ints) -> Bools:
        return np.full(len(paths), number <= 0.9 and not 0.692 <= number <= 0.7)

    search = Search(attempt, Way(1.0, 0.5, 0.302), np.arange(1), 100, through=through)
    found = search.run()
    assert abs(found - expected) < 0.01


def test_a_hopeless_trial_stops_early_and_tells_the_end_if_that_is_wanted() -> None:
    surface = part("wing.stl")
    with counted() as brief:
        short = trial(surface, 1.8, paths=3, slides=False)
    with counted() as whole:
        long = trial(surface, 1.8, paths=3)
    assert not short.feasible and not long.feasible
    assert 2 * brief["evaluations"] < whole["evaluations"]


def test_a_trial_counts_paths_that_hold_with_more_particles() -> None:
    flask = revolved(lambda v: 1.0 - 0.35 * np.exp(-(((v - 0.5) / 0.16) ** 2)), 32, 32)
    assert trial(flask, 0.2).converged == 1.0
    assert trial(cap(), 2.0).bridged_share == 0.0
