"""Where a fibre comes to rest under friction: against an explicit slide in time that shares no code with the solver."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from friction_checks import forces
from scipy.spatial import cKDTree

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.path import Paths, Status
from meshwind.path.batch import fresh, resampled
from meshwind.path.friction import friction_of
from meshwind.path.kernels.coulomb import STUCK
from meshwind.path.levels import draw
from meshwind.path.sliding import slide_from_level
from meshwind.path.solver import Solver

DATA = Path(__file__).parents[1] / "data"
Shape = Callable[[Floats, Floats], Floats]


@dataclass(frozen=True)
class Case:
    """A smooth shape, where the fibre starts and ends, the wave of its starting curve in v, and the friction.

    halves: number of half waves.
    """

    shape: Shape
    ends: tuple[tuple[float, float], tuple[float, float]]
    wave: float
    mu: float
    halves: int = 3

    def start(self, count: int) -> Floats:
        t = np.linspace(0.0, 1.0, count)
        (a, b), (c, d) = self.ends
        return np.column_stack([a + t * (c - a), b + t * (d - b) + self.wave * np.sin(self.halves * np.pi * t)])


def torus(u: Floats, v: Floats) -> Floats:
    t = 2.0 * np.pi * u
    ring = 3.0 + np.cos(t)
    return np.stack([ring * np.cos(1.4 * v), ring * np.sin(1.4 * v), -np.sin(t)], axis=-1)


def ellipsoid(u: Floats, v: Floats) -> Floats:
    t, p = 2.0 * np.pi * u, 0.6 + 2.0 * v
    return np.stack([1.3 * np.sin(p) * np.cos(t), 0.8 * np.sin(p) * np.sin(t), -1.6 * np.cos(p)], axis=-1)


def barrel(u: Floats, v: Floats) -> Floats:
    t, r = 2.0 * np.pi * u, 1.0 - 0.3 * (2.0 * v - 1.0) ** 2
    return np.stack([r * np.cos(t), r * np.sin(t), 2.5 * v], axis=-1)


def cone(u: Floats, v: Floats) -> Floats:
    t, r = 2.0 * np.pi * u, 1.0 - 0.6 * v
    return np.stack([r * np.cos(t), r * np.sin(t), 2.0 * v], axis=-1)


def oval(size: Floats, turn: Floats, axes: tuple[float, float], u: Floats, v: Floats) -> Floats:
    """Ellipses of these half axes, each of its size and turned by its angle, up to a height v."""
    t = 2.0 * np.pi * u
    x, y = axes[0] * size * np.cos(t), axes[1] * size * np.sin(t)
    return np.stack([x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn), v], axis=-1)


def hyperboloid(u: Floats, v: Floats) -> Floats:
    return oval(np.sqrt(0.49 + 0.5 * (2.0 * v - 1.0) ** 2), 0.0 * v, (1.0, 1.0), u, 3.2 * v - 1.6)


def ogive(u: Floats, v: Floats) -> Floats:
    return oval(np.sqrt(1.9**2 - (1.02 * v) ** 2) - 0.9, 0.0 * v, (1.0, 1.0), u, 1.87 * v)


def elliptic(u: Floats, v: Floats) -> Floats:
    return oval(np.ones_like(v), 0.0 * v, (1.3, 0.8), u, 6.0 * v)


def wavy(u: Floats, v: Floats) -> Floats:
    return oval(1.0 + 0.05 * np.cos(6.0 * np.pi * v), 0.0 * v, (1.0, 1.0), u, 4.0 * v)


def tapered(u: Floats, v: Floats) -> Floats:
    return oval(1.0 - 0.45 * v, 0.0 * v, (1.2, 0.85), u, 2.5 * v)


def bent(u: Floats, v: Floats) -> Floats:
    """A tube of radius 0.6 round a quarter of a sine and more, its sections across it."""
    lean = 0.8 * 2.2 / 3.0 * np.cos(2.2 * v)
    across = 0.6 * np.cos(2.0 * np.pi * u) / np.sqrt(1.0 + lean * lean)
    return np.stack([0.8 * np.sin(2.2 * v) + across, 0.6 * np.sin(2.0 * np.pi * u), 3.0 * v - lean * across], axis=-1)


def squared(u: Floats, v: Floats) -> Floats:
    """A superellipse of the fourth order: flat in the middle of its four sides."""
    t = 2.0 * np.pi * u
    r = (np.cos(t) ** 4 + np.sin(t) ** 4) ** -0.25 * (1.0 - 0.15 * (2.0 * v - 1.0) ** 2)
    return np.stack([r * np.cos(t), r * np.sin(t), 3.0 * v], axis=-1)


def twisted(u: Floats, v: Floats) -> Floats:
    return oval(np.ones_like(v), 1.2 * v, (1.15, 0.9), u, 2.4 * v)


CASES = {
    "torus": Case(torus, ((-0.2, 0.1), (0.22, 0.9)), 0.1, 0.1),
    "ellipsoid": Case(ellipsoid, ((0.0, 0.1), (0.4, 0.75)), 0.0, 0.08),
    "barrel": Case(barrel, ((0.0, 0.15), (0.6, 0.85)), 0.1, 0.06),
    "cone": Case(cone, ((0.0, 0.1), (0.55, 0.25)), 0.0, 0.15),
    "hyperboloid": Case(hyperboloid, ((0.0, 0.25), (0.9, 0.7)), 0.08, 0.1, 2),
    "ogive": Case(ogive, ((0.0, 0.1), (0.5, 0.75)), 0.0, 0.05),
    "elliptic": Case(elliptic, ((0.0, 0.3), (0.62, 0.3)), 0.3, 0.35, 1),
    "wavy": Case(wavy, ((0.0, 0.15), (1.3, 0.8)), 0.0, 0.05),
    "tapered": Case(tapered, ((0.05, 0.2), (0.75, 0.45)), 0.15, 0.2, 2),
    "bent": Case(bent, ((0.1, 0.1), (1.2, 0.9)), 0.06, 0.15),
    "squared": Case(squared, ((0.06, 0.2), (0.7, 0.75)), 0.12, 0.1),
    "twisted": Case(twisted, ((0.0, 0.3), (0.7, 0.5)), 0.15, 0.6, 2),
}


def evenly(uv: Floats, points: Floats) -> Floats:
    """The places of as many particles, evenly by length."""
    far = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    goal = np.linspace(0.0, far[-1], len(uv))
    return np.column_stack([np.interp(goal, far, uv[:, k]) for k in range(2)])


@cache
def slid(name: str, count: int = 61) -> Floats:
    """Particles (n, 3) at rest: each moves across the fibre at the rate |kg| - mu kn, by short explicit steps."""
    case = CASES[name]
    uv = case.start(801)
    uv = uv[np.searchsorted(np.linspace(0, 1, 801), np.linspace(0, 1, count))]
    uv = evenly(evenly(uv, case.shape(*uv.T)), case.shape(*evenly(uv, case.shape(*uv.T)).T))
    step, eps = 0.0, 1e-5
    for turn in range(40_000):
        points = case.shape(*uv.T)
        chord = np.diff(points, axis=0)
        size = np.linalg.norm(chord, axis=1)
        step = step or 0.3 * float(size.mean()) ** 2
        u, v = uv[1:-1].T
        su = (case.shape(u + eps, v) - case.shape(u - eps, v)) / (2.0 * eps)
        sv = (case.shape(u, v + eps) - case.shape(u, v - eps)) / (2.0 * eps)
        normal = np.cross(su, sv)
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        along = chord[1:] + chord[:-1]
        across = np.cross(normal, along)
        across /= np.linalg.norm(across, axis=1)[:, None]
        turned = (chord[1:] / size[1:, None] - chord[:-1] / size[:-1, None]) / (0.5 * (size[1:] + size[:-1]))[:, None]
        side, press = (turned * across).sum(axis=1), np.maximum(-(turned * normal).sum(axis=1), 0.0)
        rate = np.sign(side) * np.maximum(np.abs(side) - case.mu * press, 0.0)
        if turn % 200 == 199 and np.abs(rate).max() < 3e-4 * press.max():
            break
        move = step * rate[:, None] * across
        e, f, g = (su * su).sum(axis=1), (su * sv).sum(axis=1), (sv * sv).sum(axis=1)
        a, b = (su * move).sum(axis=1), (sv * move).sum(axis=1)
        uv[1:-1] += np.column_stack([g * a - f * b, e * b - f * a]) / (e * g - f * f)[:, None]
        if turn % 50 == 49:
            uv = evenly(uv, case.shape(*uv.T))
    return case.shape(*uv.T)


def wound(name: str, particles: int) -> Paths:
    case = CASES[name]
    surface = mw.shapes.parametric(case.shape, (192, 128))
    return mw.solve(surface, *([end] for end in case.ends), particles=particles, friction=case.mu,
                    initial=case.start(401)[None])  # fmt: skip


def apart(points: Floats, line: Floats) -> float:
    """Largest distance of points from a polyline, over its length."""
    share = np.linspace(0.0, 1.0, 11)[:, None, None]
    dense = (line[:-1] + share * np.diff(line, axis=0)).reshape(-1, 3)
    return float(cKDTree(dense).query(points)[0].max() / np.linalg.norm(np.diff(line, axis=0), axis=1).sum())


@pytest.mark.parametrize("name", CASES)
def test_a_fibre_rests_where_it_comes_to_rest_in_time(name: str) -> None:
    paths = wound(name, 201)
    assert paths.status[0] == mw.Status.CONVERGED and np.nanmax(paths.slip) <= CASES[name].mu * (1.0 + 1e-3)
    assert apart(slid(name), paths.points[0]) <= 2e-3


@pytest.mark.parametrize("name", CASES)
def test_it_rests_there_with_any_number_of_particles(name: str) -> None:
    fine = wound(name, 1601)
    for particles in (101, 193, 401, 769):
        assert apart(wound(name, particles).points[0], fine.points[0]) <= 3e-4


@pytest.mark.parametrize(("part", "turns", "mu"), [
    ("vase.stl", 0.55, 0.2), ("bottle.obj", 0.3, 0.4), ("bottle.obj", 0.55, 0.15), ("wing.stl", 0.55, 0.2),
])  # fmt: skip
def test_parts_have_one_answer(part: str, turns: float, mu: float) -> None:
    surface = mw.fit(mw.flatten(mw.annulus(mw.read(DATA / part))), tolerance=1e-4)
    ends = mw.families(surface, 3, turns)
    found = [mw.solve(surface, ends.start, ends.end, particles=n, friction=mu) for n in (401, 101, 193, 769)]
    for other in found[1:]:
        assert np.array_equal(other.status, found[0].status) and (other.status == 0).all()
        stated = other.length_error + found[0].length_error
        assert (np.abs(other.length - found[0].length) <= stated).all()
        assert max(apart(*both) for both in zip(other.points, found[0].points, strict=True)) <= 1e-3


@pytest.mark.parametrize(("turns", "mu", "within"), [(0.55, 0.3, 1e-3), (0.55, 0.4, 1e-3), (0.2, 0.3, 4e-3)])
def test_the_law_holds_between_bridges_with_a_particle_moved_to_an_edge(turns: float, mu: float, within: float) -> None:
    """Next to the edge springs are uneven: their pulls, and what friction holds, are alike only in the limit."""
    surface = mw.fit(mw.flatten(mw.annulus(mw.read(DATA / "wing.stl"))))
    ends = mw.families(surface, 8, turns)
    paths = mw.solve(surface, ends.start[4:5], ends.end[4:5], particles=101, friction=mu)
    lateral, press, uneven = forces(paths)
    there = paths.on_surface[:, 1:-1]
    assert paths.status[0] == mw.Status.CONVERGED and uneven[there].max() > 0.1
    assert (np.abs(lateral) - mu * np.maximum(press, 0.0))[there].max() <= paths.residual[0] + 1e-9
    pressed = there & (press > 1e-4)
    assert (np.abs(lateral)[pressed] <= mu * (1.0 + within) * press[pressed]).all()


@pytest.mark.parametrize("particles", [51, 101])
def test_a_slide_that_stalls_is_shown_where_it_lies(particles: int) -> None:
    """Its anchors are on a curve of its own; taken as those of the starting curve, they lay far off the part."""
    surface = mw.shapes.revolution(lambda z: 1.0 - 0.3 * (z - 1.0) ** 2, 0.0, 2.0)
    t = np.linspace(0.0, 1.0, 41)
    wavy = np.column_stack([0.25 * t, t + 0.05 * np.sin(4.0 * np.pi * t)])
    solver = Solver(surface, friction_of(surface, 0.1), True, 1e-10, 1000)
    rested = slide_from_level(solver, fresh(wavy[None], particles), 0)
    assert rested.status[0] == Status.CONVERGED
    stopped = rested.copied()._replace(starts=resampled(wavy[None], particles))
    stopped.status[:], stopped.mode[:] = Status.STALLED, STUCK
    draw(solver, stopped, np.array([0]))
    assert stopped.status[0] == Status.STALLED
    np.testing.assert_allclose(stopped.X, rested.X, atol=1e-3)


def test_a_path_slides_as_it_would_alone() -> None:
    """Also beside one that turns further: advice tries paths a few at a time, and a run solves all of them."""
    surface = mw.shapes.revolution(lambda z: 1.0 + 0.3 * (z - 1.0) ** 2, 0.0, 2.0)
    start, end = np.array([[0.0, 0.0], [0.1, 0.0]]), np.array([[0.2, 1.0], [2.3, 1.0]])
    both = mw.solve(surface, start, end, particles=51, friction=0.3)
    assert not both.on_surface[0].all()  # it bridges the waist
    alone = [mw.solve(surface, start[k : k + 1], end[k : k + 1], particles=51, friction=0.3) for k in range(2)]
    assert sum(each.counters.evaluations for each in alone) == both.counters.evaluations
    for each, path in zip(alone, both, strict=True):
        assert each.status[0] == path.status
        np.testing.assert_array_equal(each.points[0], path.points)
