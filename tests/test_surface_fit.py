"""The fitted surface against known shapes, and its stated error against independent distances."""

from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
from comparison.problem import TURN, Problem
from comparison.problems import vase_radius
from irregular import annulus
from scipy.spatial import cKDTree

import meshwind as mw
from meshwind.chart import flatten
from meshwind.core.cast import Floats
from meshwind.surface import Surface, fit, shapes

DATA = Path(__file__).parents[1] / "data"


def vase(u: Floats, v: Floats) -> Floats:
    r = vase_radius(4 * v)
    return np.stack([r * np.cos(TURN * u), r * np.sin(TURN * u), 4 * v], -1)


def true_error(surface: Surface) -> Floats:
    """Radial distance of a dense sample to the vase, an upper bound of the true distance."""
    uv = np.random.default_rng(5).random((20000, 2))
    P = surface.points(uv)
    return np.asarray(np.abs(np.hypot(P[:, 0], P[:, 1]) - vase_radius(P[:, 2])))


def test_vertices_carry_the_surface_far_below_the_facets() -> None:
    surface = fit(flatten(annulus(vase, 4000, 0.7)))
    error = surface.error
    assert error is not None
    assert np.sqrt(np.mean(true_error(surface) ** 2)) < 1e-5 * error.diagonal
    assert error.to_surface_rms < 1e-5 * error.diagonal < error.to_mesh_rms  # the facets are the coarser of the two


def test_error_falls_with_third_order_or_better() -> None:
    errors = [
        np.sqrt(np.mean(true_error(fit(flatten(annulus(vase, n, 0.7)), 1e-12)) ** 2)) for n in (1000, 4000, 16000)
    ]
    assert np.log2(errors[0] / errors[2]) / 2 >= 3.0


def test_next_to_a_cut_the_surface_does_not_swing_between_the_vertices() -> None:
    """Opened wider, a part is still the same one: its surface there is that of the part opened less wide."""
    mesh = mw.read(DATA / "bottle.obj")
    inner = fit(flatten(mw.annulus(mesh, opening=12.0)))
    grid = np.stack(np.meshgrid(np.arange(300) / 300, np.linspace(0, 1, 600), indexing="ij"), axis=-1).reshape(-1, 2)
    points, normals = inner.points(grid), inner.normals(grid)
    tree = cKDTree(points)
    for opening in (14.0, 15.0, 16.5, 17.0):
        surface = fit(flatten(mw.annulus(mesh, opening=opening)))
        edge = np.random.default_rng(4).random((4000, 2)) * [1.0, 0.05]
        for uv in (edge, [0.0, 1.0] - edge * [-1.0, 1.0]):
            at = surface.points(uv)
            near = tree.query(at)[1]
            off = np.abs(((at - points[near]) * normals[near]).sum(axis=1))
            assert off.max() < 0.04  # of 220 mm; 0.1 where the points between the vertices count for nothing


def test_the_tolerance_chooses_the_net() -> None:
    chart = flatten(annulus(vase, 4000, 0.7))
    coarse, fine = fit(chart, 1e-3), fit(chart, 1e-5)
    for surface, tolerance in ((coarse, 1e-3), (fine, 1e-5)):
        assert surface.error is not None
        assert surface.error.to_surface_max <= tolerance * surface.error.diagonal
    assert coarse.control_points.size < 0.5 * fine.control_points.size


@pytest.mark.parametrize("name", ["vase.stl", "tank.ply"])
def test_stated_error_holds_against_an_independent_distance(name: str) -> None:
    """VTK's distance to the facets, on a sample of the surface that the fit has not used."""
    mesh = mw.read(DATA / name)
    surface = fit(flatten(mw.annulus(mesh)))
    error = surface.error
    assert error is not None
    uv = np.random.default_rng(1).random((4000, 2))
    body = pv.PolyData.from_regular_faces(mesh.vertices, mesh.faces)
    there = pv.PolyData(surface.points(uv)).compute_implicit_distance(body)
    distance = np.abs(np.asarray(there.point_data["implicit_distance"]))
    assert distance.max() <= 1.05 * error.to_mesh_max
    assert np.sqrt(np.mean(distance**2)) == pytest.approx(error.to_mesh_rms, rel=0.1)


def test_moving_and_scaling_the_mesh_moves_and_scales_the_surface() -> None:
    angle = np.radians(40)
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])

    def moved(u: Floats, v: Floats) -> Floats:
        return 1e4 * vase(u, v) @ turn.T + [3e5, -2e5, 1e5]

    here, there = (fit(flatten(annulus(shape, 1000, 0.7))).control_points for shape in (vase, moved))
    assert np.abs((there - [3e5, -2e5, 1e5]) @ turn / 1e4 - here).max() < 1e-8


def test_normals_point_outward() -> None:
    surface = fit(flatten(annulus(vase, 1000, 0.7)))
    uv = np.random.default_rng(2).random((500, 2))
    P, N = surface.points(uv), surface.normals(uv)
    assert ((P[:, :2] * N[:, :2]).sum(axis=1) > 0).all()


@pytest.mark.parametrize("name", ["barrel", "cone"])
@pytest.mark.parametrize("seed", [0, 1])
def test_lengths_from_a_mesh_are_exact(name: str, seed: int) -> None:
    """4,000 irregular vertices to taut paths: the exact length to 2e-5, where the facets are wrong by 1e-4."""
    from comparison.problems import PROBLEMS

    for problem in (p for p in PROBLEMS if p.name.startswith(name)):
        assert _worst(problem, seed) < 2e-5


def _worst(problem: Problem, seed: int) -> float:
    radius, height = {
        "b": (lambda z: 1.0 - 0.3 * (z - 1.0) ** 2, 2.0),
        "c": (lambda z: 1.0 - z / 6.0, 3.0),
    }[problem.name[0]]

    def formula(u: Floats, v: Floats) -> Floats:
        z = height * v
        return np.stack([radius(z) * np.cos(TURN * u), radius(z) * np.sin(TURN * u), z], -1)

    surface = fit(flatten(annulus(formula, 4000, 0.45, seed)))
    ends = mw.families(surface, 6, problem.end[0])
    paths = mw.solve(surface, ends.start, ends.end, family=ends.family)
    assert (paths.status == 0).all()
    length = np.linalg.norm(np.diff(paths.points, axis=1), axis=2).sum(axis=1)
    return float(np.abs(length / problem.length - 1).max())


def test_shapes_are_what_they_say() -> None:
    """Every analytic shape lies on its own equation, normals outward."""
    uv = np.random.default_rng(0).random((2000, 2))

    def radius(P: Floats) -> Floats:
        return np.asarray(np.hypot(P[:, 0], P[:, 1]))

    cases = {
        "cylinder": (shapes.cylinder(2, 5), lambda P: radius(P) - 2),
        "cone": (shapes.cone(1, 0.5, 3), lambda P: radius(P) - (1 - P[:, 2] / 6)),
        "sphere": (shapes.sphere_band(2, 0.5, 2.5), lambda P: np.linalg.norm(P, axis=1) - 2),
        "ellipsoid": (shapes.ellipsoid(1, 0.8, 1.5, 0.6, 2.4),
                      lambda P: np.linalg.norm(P / [1, 0.8, 1.5], axis=1) - 1),
        "torus": (shapes.torus(3, 1), lambda P: np.hypot(radius(P) - 3, P[:, 2]) - 1),
        "elbow": (shapes.elbow(3, 1), lambda P: np.hypot(radius(P) - 3, P[:, 2]) - 1),
        "hyperboloid": (shapes.hyperboloid(1, 1, 1.5), lambda P: radius(P) - np.hypot(1, P[:, 2])),
    }  # fmt: skip
    for name, (surface, off) in cases.items():
        P, N = surface.points(uv), surface.normals(uv)
        assert np.abs(off(P)).max() < 5e-8, name
        assert (off(P + 1e-3 * N) > 5e-4).all(), name
