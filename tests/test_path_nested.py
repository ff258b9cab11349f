"""From coarse to fine: accuracy without a number of particles, counters, and answers that do not depend on threads."""

import json
import os
import subprocess
import sys
from dataclasses import fields
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest
from comparison.problem import Problem
from comparison.problems import FREEFORM, PROBLEMS, TABLE, barrel, vase
from friction_checks import bent, wavy

from meshwind.core.cast import Floats
from meshwind.path import Counters, Paths, Status, solve
from meshwind.path.friction import friction_of
from meshwind.path.nested import resolve, solve_with
from meshwind.path.sliding import slide_at
from meshwind.path.solver import Solver
from meshwind.planning.families import families
from meshwind.surface import Surface, shapes


def length(paths: Paths) -> Floats:
    return np.asarray(np.linalg.norm(np.diff(paths.points, axis=1), axis=2).sum(axis=1))


def choose(problem: Problem, accuracy: float) -> Paths:
    initial = None if problem.initial is None else problem.initial(1601)[None]
    return solve(problem.surface(), [problem.start], [problem.end], particles=None, accuracy=accuracy,
                 friction=problem.friction, initial=initial)  # fmt: skip


@pytest.mark.parametrize("problem", (*PROBLEMS, *FREEFORM), ids=lambda p: p.name)
def test_the_accuracy_asked_for_is_met(problem: Problem) -> None:
    for accuracy in (1e-3, 1e-5):
        paths = choose(problem, accuracy)
        assert paths.status[0] == Status.CONVERGED
        assert problem.error(float(length(paths)[0])) <= accuracy
        assert paths.residual[0] <= 1e-10


@pytest.mark.parametrize("name", ["catenary-0.3", "catenary-0.2", "stick-slip"])
def test_the_accuracy_asked_for_is_met_under_friction(name: str) -> None:
    paths = choose(TABLE[name], 1e-5)
    assert paths.status[0] == Status.CONVERGED
    assert TABLE[name].error(float(length(paths)[0])) <= 1e-5


@pytest.mark.parametrize("name", ["catenary-0.2", "stick-slip"])
def test_a_slide_with_more_particles_leads_to_the_same_rest(name: str) -> None:
    """A path comes back to where it rests, with every second or fourth particle of the finer slide."""
    problem = TABLE[name]
    curve = np.ascontiguousarray(problem.initial(201)[None] if problem.initial else [[problem.start, problem.end]])
    surface = problem.surface()
    solver = Solver(surface, friction_of(surface, problem.friction), True, 1e-10, 1000)
    batch = solve_with(solver, curve, 101)
    for level in (-1, -2):
        fine = slide_at(solver, batch._replace(starts=curve), level)
        assert fine.status[0] == Status.CONVERGED and fine.residual[0] <= 1e-10
        assert fine.X.shape == batch.X.shape and fine.starts.shape == batch.starts.shape
        assert (fine.counters > batch.counters).any()
        across = np.linalg.norm(fine.X - batch.X, axis=2).max()
        assert across <= 1e-3 * np.linalg.norm(np.diff(batch.X, axis=1), axis=2).sum()


def star(arms: int, height: float, sharp: float, twist: float) -> Surface:
    """A tube of which ridges as sharp as asked run round as they rise."""

    def points(u: Floats, v: Floats) -> Floats:
        r = 1.0 + height * np.tanh(sharp * np.cos(2 * np.pi * (arms * u + twist * v))) / np.tanh(sharp)
        return np.stack([r * np.cos(2 * np.pi * u), r * np.sin(2 * np.pi * u), 3.0 * v], axis=-1)

    return shapes.parametric(points, (128, 48))


@pytest.mark.parametrize("weight", [4.0, 16.0])
def test_few_particles_of_a_path_at_rest_under_friction_are_at_rest(weight: float) -> None:
    """Most of them stand where it bends, on ridges that it crosses at an angle, and hardly slip from there."""
    surface = star(5, 0.15, 2.0, 0.5)
    solver = Solver(surface, friction_of(surface, 0.2), True, 1e-10, 1000)
    ends = families(surface, 4, 0.4)
    fine = solve_with(solver, np.stack([ends.start, ends.end], axis=1), 401)
    for particles in (51, 101):
        few = fine.thinned(particles, weight).curves_sampled()
        before = few.X.copy()
        solver.relax_as_spaced(few)
        assert (few.status == Status.CONVERGED).all()
        assert (few.residual <= 1e-8).all()
        assert few.starts.shape == (few.paths, particles, 2)
        turned = np.linalg.norm(np.diff(few.X, axis=1), axis=2).sum(axis=1)
        whole = np.linalg.norm(np.diff(before, axis=1), axis=2).sum(axis=1)
        assert np.abs(turned / whole - 1.0).max() <= 20.0 / particles**2


def test_paths_that_cut_edges_follow_them_with_particles_where_they_bend() -> None:
    surface = star(4, 0.3, 1.5, 1.5)
    solver = Solver(surface, friction_of(surface, 0.0), True, 1e-10, 1000)
    ends = families(surface, 3, 1.1)
    curves = np.stack([ends.start, ends.end], axis=1)
    batch = solve_with(solver, curves, 26)
    cut = batch.status == Status.TOO_COARSE
    assert cut.sum() >= 3
    resolve(solver, batch, curves)
    assert (batch.status != Status.TOO_COARSE).all()
    assert (batch.status[cut] == Status.CONVERGED).any()


def test_no_more_particles_than_needed() -> None:
    """A looser accuracy takes fewer particles, and an easy path fewer than a bumpy one."""
    counts = [choose(TABLE["barrel-1.5"], accuracy).points.shape[1] for accuracy in (1e-4, 1e-5, 1e-6)]
    assert counts[0] <= counts[1] < counts[2]
    assert choose(TABLE["hyperboloid-0.5"], 1e-5).points.shape[1] < choose(TABLE["bottle-turn"], 1e-5).points.shape[1]
    # second order: the error at the count chosen for 1e-5 says that an eighth of them would not have done
    few = solve(barrel(), [(0, 0)], [TABLE["barrel-1.5"].end], particles=counts[1] // 8)
    assert TABLE["barrel-1.5"].error(float(length(few)[0])) > 1e-5


def test_counters_add_up() -> None:
    flat = solve(barrel(), [(0, 0)], [(0.3, 1)]).counters
    held = solve(barrel(), [(0, 0)], [(0.3, 1)], friction=0.1).counters
    aloft = solve(vase(), [(0, 0)], [(0.3, 1)]).counters
    for counters in (flat, held, aloft):
        assert min(counters.evaluations, counters.solves, counters.iterations) > 0
        assert counters.evaluations >= 401
        assert counters.iterations <= 1000
    assert flat.feet == held.feet == 0
    assert aloft.feet > 0
    twice = solve(barrel(), [(0, 0), (0, 0)], [(0.3, 1), (0.3, 1)]).counters
    assert twice == Counters(*(2 * getattr(flat, field.name) for field in fields(Counters)))


def test_a_path_does_not_depend_on_its_neighbours() -> None:
    """Among others, in whatever order, and alone: the same bits."""
    start = np.array([(0.0, 0.0), (0.3, 0.02), (0.7, 0.0), (0.1, 0.0)])
    end = np.array([(0.3, 1.0), (-0.25, 0.97), (1.25, 1.0), (2.4, 1.0)])
    for surface, friction in ((bent(), 0.0), (bent(), 0.1), (wavy(), 0.0), (wavy(), 0.1)):
        together = solve(surface, start, end, particles=301, friction=friction)
        for order in (np.array([3, 2, 1, 0]), *np.arange(4)[:, None]):
            other = solve(surface, start[order], end[order], particles=301, friction=friction)
            for name in ("points", "uv", "on_surface", "gap", "slip", "status", "residual"):
                one, two = getattr(together, name)[order], getattr(other, name)
                assert np.array_equal(one, two, equal_nan=one.dtype.kind == "f"), name


LAY = """
import json, sys
sys.path.insert(0, {tests!r})
from test_path_nested import digest
print(json.dumps(digest()))
"""


def digest() -> dict[str, str]:
    """Hashes of all that batches on several parts hold, with and without friction."""
    start = np.stack([np.arange(12) / 12, np.zeros(12)], axis=1)
    end = np.stack([np.arange(12) / 12 + np.linspace(-1.5, 1.5, 12), np.ones(12)], axis=1)
    found = {}
    for name, surface in (("bent", bent()), ("barrel", barrel())):
        for friction in (0.0, 0.1):
            for particles in (201, None):
                paths = solve(surface, start, end, particles=particles, friction=friction, accuracy=1e-4)
                arrays = [getattr(paths, field.name) for field in fields(Paths)]
                joined = b"".join(array.tobytes() for array in arrays if isinstance(array, np.ndarray))
                found[f"{name} {friction} {particles}"] = sha256(joined + repr(paths.counters).encode()).hexdigest()
    return found


def python(code: str, threads: int) -> str:
    examples = str(Path(__file__).parents[1] / "examples")
    known = os.pathsep.join(filter(None, (examples, os.environ.get("PYTHONPATH"))))
    environment = dict(os.environ) | {"NUMBA_NUM_THREADS": str(threads), "PYTHONPATH": known}
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code], env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_threads_do_not_change_a_bit() -> None:
    code = LAY.format(tests=os.path.dirname(__file__))
    one, two = (json.loads(python(code, threads)) for threads in (1, 2))
    assert one == two
    assert len(set(one.values())) == len(one)


FRUGAL = """
from comparison.problems import barrel, sphere
from meshwind.path import solve
from meshwind.path.kernels.relax_with_friction import relax_all_with_friction
from meshwind.surface import tree

for surface in (barrel(), sphere()):
    for particles in (401, None):
        paths = solve(surface, [(0, 0), (0.1, 0)], [(0.2, 1), (0.35, 1)], particles=particles)
        assert (paths.status == 0).all()
        assert paths.counters.feet == 0
    assert "tree" not in vars(surface) and "tree" not in vars(surface.centred)
assert not tree.build.signatures
assert not relax_all_with_friction.signatures
solve(barrel(), [(0, 0)], [(0.2, 1)], friction=0.1)
assert relax_all_with_friction.signatures
print("frugal")
"""


def test_smooth_convex_parts_pay_for_neither_friction_nor_lifting() -> None:
    """No search tree is built, no foot point found and no friction code compiled, nor loaded from the cache."""
    assert python(FRUGAL, 1).strip() == "frugal"
