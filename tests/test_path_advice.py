"""Advice is true to the letter, and tight: against Clairaut's bound, on parts of any shape, and as a search alone."""

import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.path import Status, solve
from meshwind.path.limit import BEYOND, Search, Way
from meshwind.path.paths import Paths
from meshwind.planning.families import families
from meshwind.planning.spacing import space_out
from meshwind.surface import shapes
from meshwind.surface.surface import Surface


def dome() -> Surface:
    return shapes.revolution(lambda z: 2.0 * np.sqrt(1.0 - 0.93 * (z / 0.9) ** 2), -0.9, 0.9, (128, 96))


def barrel() -> Surface:
    return shapes.revolution(lambda z: 1.0 - 0.3 * (z - 1.0) ** 2, 0.0, 2.0, (128, 64))


def three_sided() -> Surface:
    """A part with rims that are not round, so that ends spread by arc length are not spread evenly in u."""

    def formula(u: Floats, v: Floats) -> Floats:
        t = 2.0 * np.pi * u
        r = 0.8 + 0.4 * np.sin(np.pi * v) + 0.08 * np.cos(3.0 * t)
        return np.stack([r * np.cos(t), r * np.sin(t), 2.2 * v], axis=-1)

    return shapes.parametric(formula, (64, 32))


def dome_bound() -> float:
    """Clairaut's integral at c = r(0.9), by z = 0.9 sin(t)."""

    def rate(t: float) -> float:
        z = 0.9 * np.sin(t)
        r = 2.0 * np.sqrt(1.0 - 0.93 * (z / 0.9) ** 2)
        slope = -4.0 * 0.93 / 0.81 * z / r
        return float(np.sqrt(0.28) * np.hypot(1.0, slope) * 0.9 / (r * 2.0 * np.sqrt(0.93)))

    return float(quad(rate, -0.5 * np.pi, 0.5 * np.pi)[0] / (2.0 * np.pi))


def barrel_bound() -> float:
    """Clairaut's integral at c = 0.7, by z = 1 - cos(q)."""

    def rate(q: float) -> float:
        r = 0.7 + 0.3 * np.sin(q) ** 2
        return float(0.7 * np.hypot(1.0, 0.6 * np.cos(q)) / (r * np.sqrt(0.3 * (r + 0.7))))

    return float(quad(rate, 0.0, np.pi)[0] / (2.0 * np.pi))


def rest(paths: Paths) -> bool:
    return bool((paths.status == Status.CONVERGED).all())


@pytest.mark.parametrize(("surface", "asked", "bound"), [(dome(), 0.9, dome_bound()), (barrel(), 0.8, barrel_bound())])
@pytest.mark.parametrize("particles", [101, 401, None])
def test_the_revolutions_named_are_clairauts_bound_rounded_down(
    surface: Surface, asked: float, bound: float, particles: int | None
) -> None:
    lost = solve(surface, [(0.2, 0.0)], [(0.2 - asked, 1.0)], particles=particles)
    named = float(re.findall(r"([\d.]+) revolutions hold it", lost.advice(0))[0])
    assert 0.98 * bound < named < bound
    assert lost.holding_turns[0] == named
    assert rest(solve(surface, [(0.2, 0.0)], [(0.2 - named, 1.0)], particles=particles))
    assert not rest(solve(surface, [(0.2, 0.0)], [(0.2 - 1.02 * named, 1.0)], particles=particles))


def test_the_friction_named_holds_and_less_does_not() -> None:
    lost = solve(barrel(), [(0.0, 0.0)], [(0.8, 1.0)], particles=51)
    named = float(re.findall(r"friction ([\d.]+) would hold it at 0.8 revolutions", lost.advice(0))[0])
    assert lost.holding_friction[0] == named
    assert rest(solve(barrel(), [(0.0, 0.0)], [(0.8, 1.0)], particles=51, friction=named))
    assert not rest(solve(barrel(), [(0.0, 0.0)], [(0.8, 1.0)], particles=51, friction=0.98 * named))


def test_one_sentence_holds_all_paths_of_a_run_as_families_and_as_u_would_turn_them() -> None:
    surface = three_sided()
    rims = families(surface, 5, 0.7)
    lost = solve(surface, rims.start, rims.end, family=rims.family, particles=101)
    failed = np.flatnonzero(lost.status)
    assert "holding" not in vars(lost)  # it costs nothing until it is asked for
    assert len(failed) > 0
    assert all(lost.advice(int(k)).endswith("; " + lost.holding.text) for k in failed)
    assert re.match(r"[\d.]+ revolutions hold all 10 paths; friction [\d.]+ would hold all at 0.7", lost.holding.text)
    named, friction = lost.holding.revolutions, lost.holding.friction
    turned = families(surface, 5, named).end
    shifted = np.stack([rims.start[:, 0] + rims.family * named, np.ones(10)], axis=1)
    assert np.abs(turned - shifted).max() > 1e-3
    for end in (turned, shifted):
        assert rest(solve(surface, rims.start, end, particles=101))
    assert rest(solve(surface, rims.start, rims.end, particles=101, friction=friction))
    further = families(surface, 5, 1.02 * named).end
    assert not rest(solve(surface, rims.start, further, particles=101))


def test_paths_of_one_turn_are_advised_by_the_number_that_was_asked_for() -> None:
    """By symmetry all turn alike in u, too, by another number than the revolutions that the rims' lengths give."""
    surface = shapes.ellipsoid(1.3, 0.7, 1.9, 0.5, 2.7, (128, 96))
    rims = families(surface, 1, 0.8)
    lost = solve(surface, rims.start, rims.end, family=rims.family, particles=51)
    turn = abs(rims.end - rims.start)[:, 0]
    assert np.ptp(turn) < 1e-9 < 1e-3 < abs(turn[0] - 0.8)
    assert lost.holding.asked == pytest.approx(0.8, abs=1e-9)
    turned = families(surface, 1, lost.holding.revolutions)
    assert rest(solve(surface, turned.start, turned.end, family=turned.family, particles=51))
    single = solve(surface, [(0.0, 0.0)], [(0.9, 1.0)], particles=51)
    assert single.holding.asked == pytest.approx(0.9, abs=1e-9)


def test_paths_with_turns_of_their_own_and_rough_places_are_told_a_factor() -> None:
    start, end = [(0.0, 0.0), (0.3, 0.0)], [(0.8, 1.0), (-0.6, 1.0)]
    table = np.array([[0.02, 0.04], [0.03, 0.02]])
    lost = solve(barrel(), start, end, particles=33, friction=table)
    share, factor = lost.holding.turns, lost.holding.rougher
    assert 0.0 < share < 1.0 < factor
    assert f"turned by {share:.3g} times as much hold all 2 paths; {factor:.3g} times the friction" in lost.advice(0)
    turned = np.array(end)
    turned[:, 0] = np.array(start)[:, 0] + share * (turned - start)[:, 0]
    assert rest(solve(barrel(), start, turned, particles=33, friction=table))
    assert rest(solve(barrel(), start, end, particles=33, friction=factor * table))
    assert not rest(solve(barrel(), start, end, particles=33, friction=0.98 * factor * table))


def test_what_cannot_be_done_to_the_letter_is_not_advised() -> None:
    curve = np.stack([np.linspace(0.0, 0.8, 9), np.linspace(0.0, 1.0, 9)], axis=1)
    drawn = solve(barrel(), [(0.0, 0.0)], [(0.8, 1.0)], initial=[curve], particles=101)
    assert "revolutions hold" not in drawn.advice(0) and "friction" in drawn.advice(0)
    unknown = replace(drawn, asked=None)
    assert unknown.advice(0) == Status(int(drawn.status[0])).advice
    assert not unknown.holding_turns.any() and not unknown.holding_friction.any()


def test_paths_that_were_added_to_keep_a_spacing_leave_the_advice_to_those_asked_for() -> None:
    """On the barrel all paths of both families slide off, or none; one that holds is asked for beside them."""
    start, end = np.array([(0.0, 0.0), (0.5, 0.0), (0.0, 0.0)]), np.array([(0.5, 1.0), (1.0, 1.0), (-0.8, 1.0)])
    few = solve(barrel(), start, end, particles=51)
    spaced = space_out(few, 0.5, 1.0).paths
    assert len(spaced) > len(few)
    assert spaced.holding == few.holding
    assert spaced.subset(spaced.status == Status.CONVERGED).holding.text == ""


def test_parts_of_a_batch_and_batches_together_are_advised_by_what_they_were_asked() -> None:
    start, end = np.array([(0.0, 0.0), (0.5, 0.0)]), np.array([(0.8, 1.0), (0.6, 1.0)])
    both = solve(barrel(), start, end, particles=101)
    assert both.subset(np.array([0])).holding.revolutions == pytest.approx(barrel_bound(), rel=0.02)
    joined = both.subset(np.array([1])).joined(both.subset(np.array([0])))
    assert joined.holding.turns == both.holding.turns > 0.0
    rougher = solve(barrel(), start, end, particles=101, friction=0.05)
    assert both.joined(rougher).asked is None


def held_up_to(limits: Floats) -> Callable[[float, Ints], Bools]:
    return lambda number, paths: np.asarray(number <= limits[paths])


@settings(deadline=None)
@given(st.lists(st.floats(0.05, 3.0), min_size=1, max_size=40), st.floats(1.01, 4.0))
def test_a_search_finds_the_least_limit_of_many_paths(limits: list[float], above: float) -> None:
    least = min(limits)
    asked = above * least
    down = Search(held_up_to(np.array(limits)), Way(asked, asked / 64.0, 0.5), np.arange(len(limits)), 100_000).run()
    assert least / (1.0 + BEYOND) < down <= least and down == float(f"{down:.3g}")
    needs = 0.3 * np.array(limits)
    worst = float(needs.max())
    up = Search(lambda number, paths: number >= needs[paths], Way(0.0, 1.0, 1.0), np.arange(len(needs)), 100_000).run()
    assert worst <= up < worst / (1.0 - 2.0 * BEYOND)


def test_a_number_that_holds_by_itself_is_tried_with_all_paths_and_within_the_budget() -> None:
    """Paths hold in islands; whatever is named holds all of them, and solves are bounded."""
    spent = 0
    draw = np.random.default_rng(3)
    for _ in range(200):
        phase, limit = draw.random(12), draw.uniform(0.3, 0.9, 12)

        def attempt(number: float, paths: Ints, phase: Floats = phase, limit: Floats = limit) -> Bools:
            nonlocal spent
            spent += len(paths)
            return (number < limit[paths]) & (np.mod(17.0 * number + phase[paths], 1.0) > 0.05)

        spent = 0
        found = Search(attempt, Way(1.0, 1.0 / 64.0, 0.5), np.arange(12), 168).run()
        assert spent <= 168 + 5 * 12
        assert found == 0.0 or attempt(found, np.arange(12)).all()


@settings(max_examples=5, deadline=None, derandomize=True)
@given(st.floats(0.2, 0.5), st.floats(0.0, 0.08), st.integers(2, 4), st.floats(0.6, 1.2))
def test_what_is_named_holds_on_any_part(bulge: float, wave: float, lobes: int, turns: float) -> None:
    def formula(u: Floats, v: Floats) -> Floats:
        t = 2.0 * np.pi * u
        r = 0.7 + bulge * np.sin(np.pi * v) * (1.0 + wave * np.cos(lobes * t))
        return np.stack([r * np.cos(t), r * np.sin(t), 2.0 * v], axis=-1)

    surface = shapes.parametric(formula, (32, 24))
    rims = families(surface, 3, turns)
    lost = solve(surface, rims.start, rims.end, family=rims.family, particles=73)
    named = lost.holding
    if named.revolutions > 0.0:
        assert rest(solve(surface, rims.start, families(surface, 3, named.revolutions).end, particles=73))
        assert not rest(solve(surface, rims.start, families(surface, 3, 1.02 * named.revolutions).end, particles=73))
    if named.friction > 0.0:
        assert rest(solve(surface, rims.start, rims.end, particles=73, friction=named.friction))
    assert rest(lost) == (named.text == "")


def test_a_search_finds_the_limit_of_two_readings() -> None:
    """Paths hold up to 1 by the one and to 0.6 by the other: the number found is the largest with both, to 1 %."""

    def held(number: float, paths: Ints) -> Bools:
        return np.full(len(paths), number <= 1.0)

    def held_by_the_other(number: float, paths: Ints) -> Bools:
        return (paths != 5) | (number <= 0.6)

    search = Search(held, Way(2.0, 0.05, 0.5), np.arange(8), 144, held_by_the_other)
    assert 0.594 <= search.run() <= 0.6 and search.budget > 0


def test_nobody_is_told_a_friction_that_is_next_to_none() -> None:
    search = Search(
        lambda number, paths: np.full(len(paths), number > 1e-8), Way(0.0, 1.0, 1.0, 1e-3), np.arange(8), 144
    )
    assert 5e-4 <= search.run() <= 1e-3 and search.budget > 0


def test_single_numbers_that_fail_do_not_end_a_search() -> None:
    """All hold from 0.3 on but for some numbers; numbers next to 0.889 hold as well, 2 % beyond 0.907."""
    islands = (0.2, 0.4, 0.8, 0.889, 0.9)

    def held(number: float, paths: Ints) -> Bools:
        return np.full(len(paths), number >= 0.3 and number not in islands)

    found = Search(held, Way(0.1, 1.0, 1.0, 1e-3), np.arange(4), 400).run()
    assert 0.3 <= found < 0.3 / (1.0 - BEYOND)


def test_a_small_friction_is_told_as_closely_as_a_large_one() -> None:
    """Above what is next to none the number is the least that holds, to 2 %."""
    for needed in (0.0012, 0.0033, 0.021, 0.4):

        def held(number: float, paths: Ints, needed: float = needed) -> Bools:
            return np.full(len(paths), number >= needed)

        found = Search(held, Way(0.0, 1.0, 1.0, 1e-3), np.arange(6), 200).run()
        assert needed <= found < needed / (1.0 - BEYOND)
