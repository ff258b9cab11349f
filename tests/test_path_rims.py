"""Fibres along a rim: they rest where nothing presses them over it, and slide off where something does."""

import numpy as np
import pytest

from meshwind.path import Status, solve
from meshwind.surface import Surface, shapes

OVER = {0.0: Status.SLID_OFF_START, 1.0: Status.SLID_OFF_END}
TURNS = 0.3, 1.0, 2.0


def along(surface: Surface, v: float, particles: int, friction: float = 0.0) -> list[int]:
    """Statuses of fibres along a level line."""
    start, end = [(0.0, v)] * len(TURNS), [(turns, v) for turns in TURNS]
    return solve(surface, start, end, particles=particles, friction=friction).status.tolist()


@pytest.mark.parametrize("rim", [0.0, 1.0])
@pytest.mark.parametrize("off", [0.0, 1e-15, 1e-10, 1e-6])
@pytest.mark.parametrize(("friction", "particles"), [(0.0, 101), (0.0, 401), (0.2, 201)])
def test_hoops_at_the_rim_of_a_cylinder_rest(rim: float, off: float, friction: float, particles: int) -> None:
    """They are geodesics: only round-off presses them over the rim."""
    for radius in (1e-3, 1.0, 77.7):
        cylinder = shapes.cylinder(radius, 3.0 * radius, (64, 8))
        assert along(cylinder, abs(rim - off), particles, friction) == [Status.CONVERGED] * 3


@pytest.mark.parametrize("rim", [0.0, 1.0])
@pytest.mark.parametrize("off", [0.0, 1e-15, 1e-12, 1e-9, 1e-7])
@pytest.mark.parametrize("slope", [1e-5, 0.3])
def test_hoops_slide_off_where_the_part_narrows(rim: float, off: float, slope: float) -> None:
    """However little it narrows towards the rim, and however close to it they start."""
    ends = (1.0 - slope, 1.0) if rim == 0.0 else (1.0, 1.0 - slope)
    assert along(shapes.cone(*ends, 2.0, (64, 8)), abs(rim - off), 201) == [OVER[rim]] * 3


def test_hoops_at_the_wide_rim_of_a_cone_leave_it() -> None:
    paths = solve(shapes.cone(1.0, 0.9, 2.0, (64, 8)), [(0.0, 0.0)], [(0.3, 0.0)], particles=201)
    assert paths.status[0] == Status.CONVERGED and np.ptp(paths.uv[0, :, 1]) > 0.01
