"""Quality of quads against closed forms, and of the meshes of the parts in data/."""

from pathlib import Path

import numpy as np
import pytest
from layup_shapes import HEIGHT, cylinder, helices

import meshwind as mw
from meshwind.core.cast import frozen
from meshwind.layup.layup import assess
from meshwind.layup.quads import QuadMesh, quad_quality
from meshwind.path import solve
from meshwind.planning.families import families

DATA = Path(__file__).parents[1] / "data"


def one(*corners: tuple[float, float, float]) -> QuadMesh:
    points = np.array(corners, dtype=np.float64)
    uv = np.full((4, 2), 0.5)
    none = np.zeros((0, 3), dtype=np.int64)
    return QuadMesh(frozen(points), frozen(uv), np.array([[0, 1, 2, 3]]), none, np.ones(4, dtype=bool))


def test_a_rectangle() -> None:
    told = quad_quality(one((0, 0, 0), (3, 0, 0), (3, 1, 0), (0, 1, 0)))
    assert (told.jacobian[0], told.aspect[0], told.warp[0]) == pytest.approx((1.0, 3.0, 0.0))
    assert told.convex_share == 1.0


@pytest.mark.parametrize("angle", [10.0, 45.0, 90.0, 135.0])
def test_a_rhomb_has_the_sine_of_its_angle(angle: float) -> None:
    a = np.radians(angle)
    x, y = np.cos(a), np.sin(a)
    told = quad_quality(one((0, 0, 0), (1, 0, 0), (1 + x, y, 0), (x, y, 0)))
    assert (told.jacobian[0], told.aspect[0]) == pytest.approx((np.sin(a), 1.0))


def test_a_dart_is_not_convex_and_a_crossed_quad_neither() -> None:
    for corners in (((0, 0, 0), (2, -1, 0), (0.5, 0, 0), (2, 1, 0)), ((0, 0, 0), (2, 0, 0), (0, 1, 0), (2, 1, 0))):
        told = quad_quality(one(*corners))
        assert not told.convex[0]
        assert told.jacobian[0] <= 0.0
        assert told.convex_share == 0.0


def test_warp_is_the_distance_of_the_diagonals() -> None:
    told = quad_quality(one((0, 0, 0), (1, 0, 0.2), (1, 1, 0), (0, 1, 0.2)))
    assert told.warp[0] == pytest.approx(0.2 / np.hypot(1.0, 0.2))


def test_quads_of_helices_are_rhombs_of_the_crossing_angle() -> None:
    mesh = assess(helices(48, 1.0, 401, cylinder())).quads
    told = quad_quality(mesh)
    between = 2.0 * np.arctan2(2.0 * np.pi, HEIGHT)
    assert told.jacobian == pytest.approx(np.full(len(mesh.quads), np.sin(between)), rel=0.01)
    assert told.aspect == pytest.approx(np.ones(len(mesh.quads)), rel=1e-3)
    assert told.convex_share == 1.0
    assert told.inner.all()  # at the rims there are triangles


@pytest.mark.parametrize(("name", "turns"), [("vase.stl", 1.3), ("cast.ply", 2.06), ("bottle.obj", 0.5),
                                             ("wing.stl", 0.54), ("elbow.obj", 1.0), ("tank.ply", 0.6)])  # fmt: skip
def test_inner_quads_of_the_parts_are_convex(name: str, turns: float) -> None:
    surface = mw.fit(mw.flatten(mw.annulus(mw.read(DATA / name))))
    rims = families(surface, 16, turns)
    layup = assess(solve(surface, rims.start, rims.end, particles=201, family=rims.family))
    mesh, told = layup.quads, quad_quality(layup.quads)
    assert len(mesh.quads) >= 0.8 * (len(mesh.quads) + len(mesh.triangles))
    assert mesh.euler == 0
    assert told.convex_share >= 0.95
    assert np.isfinite(told.aspect).all()
    lifted = ~layup.paths.on_surface.all()
    assert (~mesh.on_surface).any() == lifted
