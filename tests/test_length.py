"""The fibre's own length against exact ones: of the fourth order, with bridges too, and no shorter than its chords."""

from dataclasses import replace

import numpy as np
import pytest
from comparison.problem import Problem
from comparison.problems import FREEFORM, LONG, PROBLEMS, TABLE
from hypothesis import given, settings
from hypothesis import strategies as st

from meshwind.core.cast import Floats
from meshwind.path import Paths, Status, solve
from meshwind.path.length import bend
from meshwind.surface import Surface

SMOOTH = [p for p in (*PROBLEMS, *LONG, *FREEFORM) if not p.name.startswith(("hyperboloid", "elbow"))]
"""Hyperboloid and elbow are one chord: exact with any number of particles."""


def lay(problem: Problem, particles: int) -> Paths:
    paths = solve(problem.surface(), [problem.start], [problem.end], particles=particles)
    assert paths.status[0] == Status.CONVERGED
    return paths


def chords(paths: Paths) -> Floats:
    return np.asarray(np.linalg.norm(np.diff(paths.points, axis=1), axis=2).sum(axis=1))


@pytest.mark.parametrize("problem", SMOOTH, ids=lambda p: p.name)
def test_fourth_order(problem: Problem) -> None:
    errors = [abs(float(lay(problem, n).length[0]) / problem.length - 1.0) for n in (51, 101, 201, 401)]
    assert errors[-1] <= (3e-7 if problem.name == "helix-5" else 2e-9)
    floor = 1e-9  # the spline's own distance from the exact shape
    least = 2.7 if problem.bridges else 3.7  # where a bridge ends between two particles is a matter of luck
    assert errors[2] <= floor or np.log2(errors[0] / errors[2]) / 2 >= least


@pytest.mark.parametrize("problem", [p for p in PROBLEMS if p.name.startswith(("hyperboloid", "elbow"))],
                         ids=lambda p: p.name)  # fmt: skip
def test_a_fibre_in_the_air_is_straight(problem: Problem) -> None:
    for particles in (5, 51):
        assert float(lay(problem, particles).length[0]) == pytest.approx(problem.length, rel=1e-10)


def test_friction_is_of_the_second_order_but_better_than_its_chords() -> None:
    problem = TABLE["catenary-0.3"]
    assert problem.initial is not None
    errors = []
    for particles in (101, 401):
        paths = solve(problem.surface(), [problem.start], [problem.end], particles=particles,
                      friction=problem.friction, initial=problem.initial(particles)[None])  # fmt: skip
        errors.append(abs(float(paths.length[0]) / problem.length - 1.0))
        assert errors[-1] < 0.3 * abs(float(chords(paths)[0]) / problem.length - 1.0)
    assert np.log2(errors[0] / errors[1]) / 2 >= 1.9


@settings(max_examples=25, deadline=None, derandomize=True, database=None)
@given(st.sampled_from(["vase", "bottle", "bottle-neck", "barrel-1.5"]), st.floats(0.0, 1.0), st.floats(-0.6, 0.6),
       st.floats(1e-3, 1e3))  # fmt: skip
def test_no_shorter_than_its_chords_nor_changed_by_unit_and_sense(
    name: str, u: float, turn: float, unit: float
) -> None:
    surface = TABLE[name].surface()
    ahead = solve(surface, [(u, 0.0)], [(u + turn, 0.9)], particles=101)
    back = solve(surface, [(u + turn, 0.9)], [(u, 0.0)], particles=101)
    scaled = replace(ahead, surface=Surface(surface.control_points * unit, surface.periodic),
                     points=ahead.points * unit)  # fmt: skip
    assert scaled.length[0] == pytest.approx(unit * ahead.length[0], rel=1e-12)
    if ahead.status[0] == back.status[0] == Status.CONVERGED:
        assert ahead.length[0] == pytest.approx(back.length[0], rel=1e-9)
        assert ahead.length[0] >= chords(ahead)[0] * (1.0 - 1e-6)


def test_particles_that_coincide_do_not_bend() -> None:
    assert bend(np.zeros((3, 3)), 1) == 0.0
