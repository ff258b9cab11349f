"""The worst corners of the stability maps, with the exact answers that `examples/stability.py` has in every cell."""

from functools import partial

import numpy as np
import pytest
from charts import folds, rest_states, ribs, rough_meshes
from comparison.attempt import Outcome, attempt
from comparison.parts import PARTS, irregular
from comparison.problem import TURN, Problem
from comparison.problems import TABLE, barrel_length, barrel_radius
from comparison.sliding import Sliding

from meshwind.core.cast import Floats
from meshwind.path import Status, solve
from meshwind.surface import Surface, shapes


def ours(problem: Problem, particles: int = 201) -> float:
    """Relative error of a path that must come to rest."""
    found = attempt("meshwind", problem, particles)
    assert found.outcome == Outcome.REST
    return problem.error(found.length)


@pytest.mark.parametrize("waist", [0.1, 0.95])
@pytest.mark.parametrize("share", [0.98, 1.0, 1.02])
def test_at_the_rulings_a_chord_becomes_a_path_on_the_waist(waist: float, share: float) -> None:
    """Where the fibre only just touches, along all its length at once."""
    slope = float(np.sqrt(1.0 - waist**2))
    twist = share * 2.0 * float(np.arctan2(slope, waist))
    surface = shapes.hyperboloid(waist, slope, 1.0, (192, 128))
    paths = solve(surface, [(0, 0)], [(twist / TURN, 1)], particles=201)
    assert paths.status[0] == Status.CONVERGED
    chord = float(np.hypot(2.0, 2.0 * np.sin(twist / 2)))
    if share <= 1.0:
        assert paths.length[0] == pytest.approx(chord, rel=1e-7)
    else:
        assert chord < paths.length[0] < chord * 1.01
    assert paths.gap.min() >= 0.0


@pytest.mark.parametrize(
    ("friction", "bend"), [(0.75, 1.5), (0.7, 1.42), (1.0, 1.5), (0.05, 1.5), (0.5, 0.5), (1.0, 0.999)]
)
def test_sliding_where_it_is_off_the_most(friction: float, bend: float) -> None:
    sliding = Sliding(friction, bend, float(np.pi))
    assert ours(sliding.problem("corner", "corner")) < 3e-4


def stretched(squeeze: float, shear: float) -> Surface:
    k = np.log(squeeze)

    def formula(u: Floats, v: Floats) -> Floats:
        z = 2.0 * np.expm1(k * v) / np.expm1(k)
        r, t = barrel_radius(z), TURN * (u + shear * v)
        return np.stack([r * np.cos(t), r * np.sin(t), z], -1)

    return shapes.parametric(formula, (192, 512))


@pytest.mark.parametrize(("squeeze", "shear"), [(1e3, 1.0), (3e2, 2.0)])
def test_charts_stretched_a_thousandfold_change_nothing(squeeze: float, shear: float) -> None:
    problem = Problem("stretched", "corner", partial(stretched, squeeze, shear), (0, 0), (1.5 / TURN - shear, 1),
                      barrel_length(1.5))  # fmt: skip
    assert ours(problem) < 1e-7


def test_a_chart_stretched_a_millionfold_is_refused_or_right() -> None:
    problem = Problem("stretched", "corner", partial(stretched, 1e6, 0.5), (0, 0), (1.5 / TURN - 0.5, 1),
                      barrel_length(1.5))  # fmt: skip
    found = attempt("meshwind", problem, 101)
    assert found.outcome != Outcome.REST or problem.error(found.length) < 1e-4


@pytest.mark.parametrize("name", ["barrel-1.5", "vase", "catenary-0.3"])
@pytest.mark.parametrize(("scale", "offset"), [(1e-6, 1e6), (1e6, 1e6), (1e-6, 0.0), (1e6, 1.0)])
def test_units_and_places_leave_the_length(name: str, scale: float, offset: float) -> None:
    problem = TABLE[name]
    here = attempt("meshwind", problem, 101).length
    away = offset * problem.surface().size * np.array([1.0, -0.7, 0.4])
    surface = Surface(scale * (problem.surface().control_points + away))
    moved = Problem(name, "corner", lambda: surface, problem.start, problem.end, scale * here, problem.bridges,
                    friction=problem.friction, initial=problem.initial, accuracy=0.0)  # fmt: skip
    assert ours(moved, 101) < 1e-12 + 3e-14 * offset


@pytest.mark.parametrize("ratio", [0.1, 0.9])
def test_an_equator_past_its_conjugate_point_is_never_given(ratio: float) -> None:
    limit = float(np.pi * np.sqrt(ratio / (1 + ratio)))
    for share in (0.9, 1.1, 1.5):
        bend = share * limit
        surface = shapes.torus(1.0, ratio, bend, (96, 128))
        paths = solve(surface, [(0, 0)], [(0, 1)], particles=101)
        same = abs(paths.length[0] / ((1 + ratio) * bend) - 1) < 1e-6
        if share < 1.0:
            assert paths.status[0] == Status.CONVERGED and same
        else:
            assert paths.status[0] != Status.CONVERGED or not same


@pytest.mark.parametrize("width", [0.25, 1.0, 16.0])
@pytest.mark.parametrize("particles", [51, 101, None])
def test_ribs_far_narrower_than_the_particles_distance(width: float, particles: int | None) -> None:
    row = ribs.ours(width, particles)
    assert row["result"] == "ok" or (row["result"] in ("vague", "refused") and width < 2.0 and particles is not None)


@pytest.mark.parametrize(("height", "friction", "particles"), [(6.0, 0.2, 401), (8.0, 0.3, 101), (8.0, 0.3, 401)])
def test_a_bump_that_just_catches_a_fibre_catches_it(height: float, friction: float, particles: int) -> None:
    ends = np.array(rest_states.BUMPY_ENDS)
    course = rest_states.Course(rest_states.bumpy(height), ends[0], ends[1], friction, 1601)
    assert rest_states.Reference.of(course).compare(particles)["result"] == "ok"


@pytest.mark.parametrize(("noise", "kept"), [(0.0, 0.05), (0.03, 0.03)])
def test_lengths_from_the_worst_meshes_are_within_what_is_stated(noise: float, kept: float) -> None:
    mesh = rough_meshes.roughened(*irregular(PARTS["vase"], 4000), noise, kept)
    row = rough_meshes.cell("vase", mesh, noise, kept)
    assert row["result"] == "ok" and row["share"] > 0.01  # off by more than nothing


def test_no_path_runs_through_a_collar_that_hangs_over() -> None:
    surface = folds.fitted(0.3, 2.0, 8000)
    assert isinstance(surface, Surface)
    row = folds.cell(surface, folds.Depths(surface), 101)
    assert row["result"] == "ok" and row["deep"] > 1e-5 * surface.size
