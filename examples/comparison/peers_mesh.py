"""Geodesics of a triangle mesh, by other libraries (the extra `peers`): FlipOut and exact polyhedral methods.

FlipOut (Sharp and Crane 2020, potpourri3d) shortens an edge path within its homotopy class; the exact methods
(Mitchell, Mount and Papadimitriou 1987, pygeodesic and libigl) find the shortest of all paths.  All three stay on the
facets: no bridging, no friction.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import igl
import numpy as np
import potpourri3d
import pygeodesic.geodesic

from comparison.attempt import Attempt, Outcome, polyline_length
from comparison.problem import Problem
from meshwind.core.cast import Floats, Ints
from meshwind.surface.grid import mean_speeds

JITTER = 0.25
"""Of the vertices, over their pitch in (u, v): meshes in practice are no regular grids."""
LEGS = 12
"""Pieces per turn in which FlipOut's first path follows the straight line in (u, v)."""
SPEED_SAMPLES = 16
"""Points each way from which the numbers of rows and columns are chosen."""
FEWEST = 8, 4
"""Fewest columns and rows."""


@dataclass(frozen=True)
class Facets:
    """An irregular mesh of a problem's surface whose vertices lie on it, and both ends among them."""

    vertices: Floats
    faces: Ints
    uv: Floats
    start: int
    end: int

    @cached_property
    def flipper(self) -> potpourri3d.EdgeFlipGeodesicSolver:
        """FlipOut, set up."""
        return potpourri3d.EdgeFlipGeodesicSolver(self.vertices, self.faces)

    @cached_property
    def exact(self) -> pygeodesic.geodesic.PyGeodesicAlgorithmExact:
        """The exact method of pygeodesic, set up."""
        return pygeodesic.geodesic.PyGeodesicAlgorithmExact(self.vertices, self.faces)


def facets(problem: Problem, count: int, seed: int = 0) -> Facets:
    """A mesh of about `count` vertices, nearly square cells in rows around, sheared so that the end is a vertex."""
    surface = problem.surface()
    around, along = _pitches(problem, count)
    (u0, v0), (u1, v1) = problem.start, problem.end
    # rows fall on both ends' v, columns on both ends' u
    knots = np.unique([0.0, v0, v1, 1.0])
    rows = np.concatenate(
        [np.linspace(a, b, max(2, round((b - a) * along) + 1))[:-1] for a, b in pairwise(knots)] + [np.ones(1)]
    )
    slant = ((u1 - u0) * around) % 1.0 / around
    share = (rows - v0) / (v1 - v0)
    rng = np.random.default_rng(seed)
    u = u0 + np.arange(around)[None, :] / around + slant * share[:, None]
    v = np.repeat(rows[:, None], around, axis=1)
    fixed = np.isin(rows, knots)
    move = rng.uniform(-JITTER, JITTER, (2, *u.shape))
    move[:, fixed] = 0.0
    pitch = np.minimum(np.gradient(rows), 1.0 / along)
    u, v = u + move[0] / around, v + move[1] * pitch[:, None]
    uv = np.stack([u.ravel(), v.ravel()], axis=1)
    corner = np.arange(len(rows) * around).reshape(len(rows), around)
    a, b = corner[:-1], np.roll(corner, -1, axis=1)[:-1]
    c, d = np.roll(corner, -1, axis=1)[1:], corner[1:]
    flip = rng.random(a.shape) < 0.5
    first = np.where(flip[..., None], np.stack([a, b, d], -1), np.stack([a, b, c], -1))
    second = np.where(flip[..., None], np.stack([b, c, d], -1), np.stack([a, c, d], -1))
    faces = np.concatenate([first.reshape(-1, 3), second.reshape(-1, 3)]).astype(np.int64)
    column = round((u1 - u0) * around - slant * around)
    start = int(corner[np.flatnonzero(rows == v0)[0], 0])
    end = int(corner[np.flatnonzero(rows == v1)[0], column % around])
    return Facets(surface.points(uv), faces, uv, start, end)


def _pitches(problem: Problem, count: int) -> tuple[int, int]:
    """Columns around, and rows per unit of v."""
    width, height = mean_speeds(problem.surface(), SPEED_SAMPLES)
    around = max(FEWEST[0], round(np.sqrt(count * width / height)))
    return around, max(FEWEST[1], round(count / around))


def flip_out(mesh: Facets, problem: Problem) -> Attempt:
    """FlipOut from an edge path through vertices along the straight line in (u, v), where our solver starts too."""
    legs = max(1, round(LEGS * abs(problem.end[0] - problem.start[0])))
    share = np.arange(1, legs) / legs
    line = np.array(problem.start) + share[:, None] * (np.array(problem.end) - problem.start)
    through = [_nearest(mesh, problem, uv) for uv in line]
    path = mesh.flipper.find_geodesic_path_poly([mesh.start, *through, mesh.end])
    return Attempt(Outcome.REST, polyline_length(path), 0, points=path)


def _nearest(mesh: Facets, problem: Problem, uv: Floats) -> int:
    """The vertex nearest to a point (2,) of the surface."""
    point = problem.surface().points(uv[None])[0]
    return int(((mesh.vertices - point) ** 2).sum(axis=1).argmin())


def exact_pygeodesic(mesh: Facets, _: Problem) -> Attempt:
    """The shortest path over the facets, by pygeodesic."""
    length, path = mesh.exact.geodesicDistance(mesh.start, mesh.end)
    return Attempt(Outcome.REST, float(length), 0, points=np.asarray(path)[::-1])


def exact_libigl(mesh: Facets, _: Problem) -> Attempt:
    """The length of the shortest path over the facets, by libigl, which gives no path."""
    empty = np.empty(0, np.int64)
    ends = np.array([mesh.start]), np.array([mesh.end])
    length = igl.exact_geodesic(mesh.vertices, mesh.faces, ends[0], empty, ends[1], empty)
    return Attempt(Outcome.REST, float(length[0]), 0)


PEERS: dict[str, Callable[[Facets, Problem], Attempt]] = {
    "flipout": flip_out,
    "mmp-pygeodesic": exact_pygeodesic,
    "mmp-libigl": exact_libigl,
}
"""The methods by the names that charts and tables use."""
