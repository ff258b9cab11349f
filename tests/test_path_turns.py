"""A fibre goes around the body, never through it: no path loses a turn where the part is thin."""

import numpy as np
import pytest
from friction_checks import bent

from meshwind.path import Status, solve
from meshwind.surface import shapes


@pytest.mark.parametrize(("waist", "turns", "length"), [
    (0.1, 0.65, 2.9113), (0.1, 0.95, 3.0854), (0.1, 1.25, 3.2710), (0.1, 1.85, 3.6474),
    (0.2417, 0.65, 3.0637), (0.2417, 0.95, 3.4914),
])  # fmt: skip
@pytest.mark.parametrize("particles", [201, 401])
def test_no_turn_is_lost_around_a_thin_waist(waist: float, turns: float, length: float, particles: int) -> None:
    surface = shapes.hyperboloid(waist, np.sqrt(1.0 - waist**2), 1.0, (192, 128))
    paths = solve(surface, [(0.0, 0.0)], [(turns, 1.0)], particles=particles)
    assert paths.status[0] == Status.CONVERGED
    steps = np.diff(paths.points[0], axis=0)
    assert np.linalg.norm(steps, axis=1).sum() == pytest.approx(length, rel=5e-4)
    angle = np.unwrap(np.arctan2(paths.points[0, :, 1], paths.points[0, :, 0]))
    assert (angle[-1] - angle[0]) / (2 * np.pi) == pytest.approx(turns, abs=1e-9)
    assert np.abs(np.diff(paths.uv[0, :, 0])).max() < 0.1


def test_what_slides_off_is_told_what_would_hold() -> None:
    """On a barrel with radius 0.7 at the rims no path turns by more than Clairaut's bound."""
    barrel = shapes.revolution(lambda z: 1.0 - 0.3 * (z - 1.0) ** 2, 0.0, 2.0, (128, 64))
    paths = solve(barrel, [(0.0, 0.0)], [(0.8, 1.0)], particles=201)
    assert paths.status[0] in (Status.SLID_OFF_START, Status.SLID_OFF_END)
    assert 0.3 < paths.holding_turns[0] < 0.8
    held = solve(barrel, [(0.0, 0.0)], [(paths.holding_turns[0], 1.0)], particles=201)
    assert held.status[0] == Status.CONVERGED
    assert 0.0 < paths.holding_friction[0] <= 1.0
    rough = solve(barrel, [(0.0, 0.0)], [(0.8, 1.0)], particles=201, friction=paths.holding_friction[0])
    assert rough.status[0] == Status.CONVERGED
    named = float(paths.advice(0).split("; ")[1].split(" revolutions hold it")[0])
    assert paths.holding_turns[0] == named


@pytest.mark.parametrize("friction", [0.0, 0.1])
def test_what_holds_does_not_depend_on_which_end_comes_first(friction: float) -> None:
    """On a bent tube a search that turns one end only finds others than one that turns the other."""
    draw = np.random.default_rng(0)
    start = np.stack([draw.random(30), np.zeros(30)], axis=1)
    end = start + np.stack([draw.uniform(-1.5, 1.5, 30), np.ones(30)], axis=1)
    ahead, back = (solve(bent(), *ends, friction=friction) for ends in ((start, end), (end, start)))
    assert np.array_equal(ahead.status == Status.CONVERGED, back.status == Status.CONVERGED)
    assert (ahead.status == Status.CONVERGED).sum() >= 26


@pytest.mark.parametrize("friction", [0.2, 0.6])
def test_no_touching_neighbours_leap_from_rim_to_rim(friction: float) -> None:
    """The rims of a closed ring lie on each other: a fibre that leapt would lose all of its length."""
    paths = solve(shapes.torus(3.0, 1.0), [(0.0, 0.0)], [(0.3, 1.0)], particles=101, friction=friction)
    touching = paths.on_surface[0, 1:] & paths.on_surface[0, :-1]
    assert paths.status[0] != Status.CONVERGED or np.abs(np.diff(paths.uv[0, :, 1]))[touching].max() < 0.1
