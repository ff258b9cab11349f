"""Lengths from a mesh against exact ones, and against the exact geodesics of the mesh's own facets.

FlipOut (Sharp and Crane 2020) shortens an edge path to a geodesic of the polyhedron, MMP (Mitchell, Mount and
Papadimitriou 1987) finds the polyhedron's shortest one: both without error but for the facets, which lie inside the
part.  The smooth surface through the same vertices lies closer.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np
import potpourri3d
import pygeodesic.geodesic
import pytest
from comparison.problem import TURN
from comparison.problems import barrel_radius, vase_radius
from irregular import annulus
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.spatial import cKDTree

import meshwind as mw
from meshwind.core.cast import Floats, Ints
from meshwind.surface.foot import feet


@dataclass(frozen=True)
class Turned:
    """A part of revolution about z: its profile, the profile's slope, its ends, and its length in turns."""

    name: str
    radius: Callable[[Floats], Floats]
    slope: Callable[[Floats], Floats]
    z0: float
    z1: float
    aspect: float
    twists: tuple[float, ...]

    def points(self, u: Floats, v: Floats) -> Floats:
        z = self.z0 + v * (self.z1 - self.z0)
        r = self.radius(z)
        return np.stack([r * np.cos(TURN * u), r * np.sin(TURN * u), z], -1)

    def clairaut(self, twist: float) -> tuple[float, float]:
        """The constant c = r sin(angle) of the geodesic that turns by `twist` from rim to rim, and its length."""
        narrow = float(self.radius(np.linspace(self.z0, self.z1, 100_001)).min())

        def integral(c: float, f: Callable[[float, float], float]) -> float:
            def rate(z: float) -> float:
                r, slope = float(self.radius(np.float64(z))), float(self.slope(np.float64(z)))  # type: ignore[arg-type]
                return f(r, float(np.sqrt((1 + slope**2) / (r * r - c * c))))

            return float(quad(rate, self.z0, self.z1, epsabs=1e-12, epsrel=1e-12, limit=400)[0])

        c = float(brentq(lambda c: integral(c, lambda r, q: c * q / r) - twist, 0.05 * narrow, 0.9999 * narrow))
        return c, integral(c, lambda r, q: r * q)

    def length(self, twist: float) -> float:
        return self.clairaut(twist)[1]


def vase_slope(z: Floats) -> Floats:
    return np.asarray(-0.35 * 0.75 * np.pi * np.sin(0.75 * np.pi * z + 0.3) + 0.225 * np.cos(2.25 * z))


BARREL = Turned("barrel", barrel_radius, lambda z: -0.6 * (z - 1), 0.0, 2.0, 0.45, (0.5, 1.5, 2.5))
# above 3.6 rad the vase's hollows and above the rulings' 1.97 rad the waist are pressed on all the way
VASE = Turned("vase", vase_radius, vase_slope, 0.0, 4.0, 0.7, (3.9, 4.5, 5.0))
HYPERBOLOID = Turned("hyperboloid", lambda z: np.hypot(1, z), lambda z: z / np.hypot(1, z), -1.5, 1.5, 0.45,
                     (2.2, 2.6, 3.0))  # fmt: skip
PARTS = {part.name: part for part in (BARREL, VASE, HYPERBOLOID)}
EACH = [(part.name, twist) for part in PARTS.values() for twist in part.twists]


@cache
def made(name: str, vertices: int = 4000, tolerance: float = 1e-5) -> tuple[mw.Annulus, mw.Surface]:
    part = PARTS[name]
    opened = annulus(part.points, vertices, part.aspect)
    return opened, mw.fit(mw.flatten(opened), tolerance)


def lengths(paths: mw.Paths) -> Floats:
    assert (paths.status == mw.Status.CONVERGED).all()
    return np.asarray(np.linalg.norm(np.diff(paths.points, axis=1), axis=2).sum(axis=1))


def angle(points: Floats) -> Floats:
    return np.asarray(np.arctan2(points[..., 1], points[..., 0]))


def rim_pairs(opened: mw.Annulus, twist: float, count: int = 6) -> tuple[Ints, Floats]:
    """Vertices (count, 2) on the two rims about `twist` apart, and how far they are apart indeed."""
    first, second = (opened.vertices[rim] for rim in opened.rims)
    start = np.linspace(0, len(first), count, endpoint=False).astype(int)
    goal = angle(first[start]) + twist
    end = cKDTree(np.stack([np.cos(angle(second)), np.sin(angle(second))], 1)).query(
        np.stack([np.cos(goal), np.sin(goal)], 1)
    )[1]
    off = (angle(second[end]) - goal + np.pi) % TURN - np.pi
    return np.stack([opened.rims[0][start], opened.rims[1][end]], axis=1), twist + off


def on_rim(surface: mw.Surface, points: Floats, v: float) -> Floats:
    """Feet (k, 2) on the fitted surface of vertices on its rim v."""
    u = np.arange(4096) / 4096
    rim = np.stack([u, np.full_like(u, v)], axis=1)
    uv = rim[cKDTree(surface.points(rim)).query(points)[1]]
    feet(0, len(uv), surface.spline, points, uv, np.empty((len(uv), 6, 3)))
    uv[:, 1] = v
    return uv


def ours(opened: mw.Annulus, surface: mw.Surface, pairs: Ints, twists: Floats) -> Floats:
    start, end = (on_rim(surface, opened.vertices[pairs[:, k]], float(k)) for k in (0, 1))
    end[:, 0] += np.round(start[:, 0] + twists / TURN - end[:, 0])
    return lengths(mw.solve(surface, start, end, particles=801))


def flipout(opened: mw.Annulus, part: Turned, pairs: Ints, twists: Floats) -> Floats:
    """Lengths of FlipOut's geodesics, started from edge paths through vertices near the true geodesic's sense."""
    solver = potpourri3d.EdgeFlipGeodesicSolver(opened.vertices, opened.faces)
    tree = cKDTree(opened.vertices)
    found = []
    for (a, b), twist in zip(pairs, twists, strict=True):
        share = np.arange(1, 6) / 6
        turned = angle(opened.vertices[a]) + share * twist
        between = tree.query(part.points(turned / TURN, share))[1]
        path = solver.find_geodesic_path_poly([int(a), *(int(k) for k in between), int(b)])
        found.append(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
    return np.array(found)


@pytest.mark.parametrize(("name", "twist"), EACH)
def test_families_from_a_mesh_have_exact_lengths(name: str, twist: float) -> None:
    """4,000 irregular vertices through flattening, fitting and solving: right to 2e-5."""
    _, surface = made(name)
    ends = mw.families(surface, 6, twist / TURN)
    found = lengths(mw.solve(surface, ends.start, ends.end, family=ends.family, particles=801))
    assert np.abs(found / PARTS[name].length(twist) - 1).max() < 2e-5


@pytest.mark.parametrize(("name", "twist"), EACH)
def test_ten_times_closer_than_the_facets_geodesics(name: str, twist: float) -> None:
    """Between vertices, where FlipOut's paths must end, with the exact length for those very ends."""
    part, (opened, surface) = PARTS[name], made(name)
    pairs, twists = rim_pairs(opened, twist)
    exact = np.array([part.length(t) for t in twists])
    error = np.abs(ours(opened, surface, pairs, twists) / exact - 1)
    facets = np.abs(flipout(opened, part, pairs, twists) / exact - 1)
    assert error.max() < 2e-5
    # the mean square: where facets lie outside the part as well, one path in six may be right by luck
    assert 10 * np.sqrt(np.mean(error**2)) < np.sqrt(np.mean(facets**2))


def test_flipout_s_error_is_the_facets_own() -> None:
    """The shortest way over the facets by an exact method is as wrong: no better search helps."""
    opened, _ = made("barrel")
    pairs, twists = rim_pairs(opened, 1.5, 2)
    exact = np.array([BARREL.length(t) for t in twists])
    search = pygeodesic.geodesic.PyGeodesicAlgorithmExact(opened.vertices, opened.faces)
    shortest = np.array([search.geodesicDistance(int(a), int(b))[0] for a, b in pairs])
    np.testing.assert_allclose(flipout(opened, BARREL, pairs, twists), shortest, rtol=1e-9)
    assert (shortest < exact * (1 - 1e-4)).all()


@pytest.mark.parametrize("part", PARTS.values(), ids=PARTS.keys())
def test_clairaut_is_right(part: Turned) -> None:
    """The yardstick itself: marching the geodesic's equation in arc length meets the other rim at the twist."""
    from scipy.integrate import solve_ivp

    c, length = part.clairaut(part.twists[1])

    def rate(_: float, state: Floats) -> Floats:
        z, _ = state
        r, slope = part.radius(z), part.slope(z)
        return np.array([np.sqrt(1 - (c / r) ** 2) / np.sqrt(1 + slope**2), c / r**2])

    end = solve_ivp(rate, (0, length), [part.z0, 0.0], method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
    np.testing.assert_allclose(end, [part.z1, part.twists[1]], rtol=0, atol=1e-9)


def true_error(part: Turned, surface: mw.Surface) -> float:
    """Rms radial distance of a dense sample to the part, over its diagonal: an upper bound."""
    P = surface.points(np.random.default_rng(5).random((20_000, 2)))
    assert surface.error is not None
    return float(np.sqrt(np.mean((np.hypot(P[:, 0], P[:, 1]) - part.radius(P[:, 2])) ** 2))) / surface.error.diagonal


@pytest.mark.parametrize("name", PARTS)
def test_fits_converge_with_third_order(name: str) -> None:
    errors = [true_error(PARTS[name], made(name, count, 1e-12)[1]) for count in (1000, 4000, 16_000)]
    assert errors[1] < 1e-5
    for coarse, fine in pairwise(errors):
        assert np.log2(coarse / fine) >= 3.0, errors
