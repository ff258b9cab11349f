"""The quad mesh: an oriented manifold annulus for every pattern; quality of quads against closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from layup_shapes import HEIGHT, bridged, cylinder, drawn, fitted, helices, straight_uv, wound

from meshwind.core.cast import Ints, frozen
from meshwind.layup.crossings import crossings
from meshwind.layup.layup import assess
from meshwind.layup.quads import QuadMesh, edge_counts, quad_quality, quads
from meshwind.path.paths import Paths, Status

CYLINDER = cylinder()


def meshed(paths: Paths) -> QuadMesh:
    return quads(paths, crossings(paths))


def directed(faces: Ints) -> Ints:
    return np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)


def check_annulus(mesh: QuadMesh) -> None:
    assert mesh.note == ""
    assert mesh.euler == 0
    edges, counts = edge_counts(mesh.quads, mesh.triangles)
    assert counts.max() == 2
    rim = edges[counts == 1]
    assert np.isin(mesh.uv[rim, 1], [0.0, 1.0]).all()
    assert np.array_equal(mesh.uv[rim[:, 0], 1], mesh.uv[rim[:, 1], 1])
    sides = np.concatenate([directed(mesh.quads), directed(mesh.triangles)])
    assert len(np.unique(sides, axis=0)) == len(sides)  # one orientation
    assert np.array_equal(np.unique(sides), np.arange(len(mesh.points)))  # every node is used


def outward(mesh: QuadMesh) -> bool:
    """Do all faces of a mesh around the z axis look away from it?"""
    looks = []
    for faces in (mesh.quads, mesh.triangles):
        corner = mesh.points[faces]
        normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, -1] - corner[:, 0])
        looks.append(((normal * corner.mean(axis=1))[:, :2]).sum(axis=1))
    return bool((np.concatenate(looks) > 0).all())


@pytest.mark.parametrize(
    ("count", "revolutions", "particles"),
    [(8, 1.0, 101), (16, 1.0, 100), (32, 2.5, 401), (6, 0.5, 11), (3, 1 / 3, 50), (12, 2 / 3, 2)],
)
def test_whole_patterns_give_quads_with_triangles_at_the_rims(count: int, revolutions: float, particles: int) -> None:
    mesh = meshed(helices(count, revolutions, particles, CYLINDER))
    check_annulus(mesh)
    assert outward(mesh)
    rows = round(2 * revolutions * count)
    assert len(mesh.quads) == count * (rows - 1)
    assert len(mesh.triangles) == 2 * count
    assert len(mesh.points) == count * (rows + 1)


@pytest.mark.parametrize(("count", "revolutions"), [(8, 0.97), (5, 3.03), (16, 0.3), (9, 1.0 + 1e-6)])
def test_broken_patterns_split_the_pentagons_at_the_end_rim(count: int, revolutions: float) -> None:
    mesh = meshed(helices(count, revolutions, 101, CYLINDER))
    check_annulus(mesh)
    assert outward(mesh)
    rows = int(np.ceil(2 * revolutions * count)) - 1  # of crossings
    assert len(mesh.quads) == count * rows  # rows - 1 of cells, and one from each pentagon
    assert len(mesh.triangles) == 3 * count


@pytest.mark.parametrize("slack", [1e-14, 1e-12, 1e-10, 5e-10, 1e-9, 2e-9, 4e-9, 1e-8, 1e-6])
def test_ends_that_nearly_coincide_still_make_an_annulus(slack: float) -> None:
    """Around the tolerance, merged rim nodes and dropped crossings must agree."""
    for sign in (1, -1):
        mesh = meshed(helices(8, 1.0 + sign * slack, 101, CYLINDER))
        check_annulus(mesh)
        assert len(mesh.quads) >= 8 * 15


def test_bridges_are_marked() -> None:
    mesh = meshed(bridged())
    check_annulus(mesh)
    assert outward(mesh)
    lifted = (mesh.uv[:, 1] > 0.31) & (mesh.uv[:, 1] < 0.69)
    assert np.array_equal(mesh.on_surface, ~lifted)


def test_no_crossing_is_noted() -> None:
    mesh = meshed(helices(8, 0.0, 31, CYLINDER))
    assert len(mesh.quads) == len(mesh.triangles) == 0
    assert "more revolutions" in mesh.note


@pytest.mark.parametrize("count", [1, 2])
def test_too_few_paths_are_noted(count: int) -> None:
    mesh = meshed(helices(count, 1.0, 21, CYLINDER))
    assert len(mesh.quads) == len(mesh.triangles) == 0
    assert "more paths" in mesh.note


def test_a_path_that_crosses_its_own_family_is_left_out() -> None:
    uv, family = straight_uv(8, 1.0, 201)
    uv[2, :, 0] += 0.3 * np.sin(np.pi * uv[2, :, 1])  # over its two neighbours and back
    mesh = meshed(drawn(CYLINDER, uv, family))
    assert mesh.left_out == (2,)
    check_annulus(mesh)


def test_a_path_that_crosses_itself_is_left_out() -> None:
    uv, family = straight_uv(8, 1.0, 201)
    turn = np.linspace(0.0, 2.0 * np.pi, 21)
    uv[5, 90:111] = uv[5, 100] + 0.02 * np.column_stack([np.sin(turn), 1.0 - np.cos(turn)]) + [0.0, -0.001]
    mesh = meshed(drawn(CYLINDER, uv, family))
    assert mesh.left_out == (5,)
    check_annulus(mesh)


def test_a_path_that_runs_along_a_rim_is_left_out() -> None:
    uv, family = straight_uv(8, 1.0, 201)
    uv[11, :, 1] = np.clip(2.0 * uv[11, :, 1] - 1.0, 0.0, 1.0)
    mesh = meshed(drawn(CYLINDER, uv, family))
    assert mesh.left_out == (11,)
    check_annulus(mesh)


def test_families_that_all_slide_along_a_rim_are_noted() -> None:
    uv, family = straight_uv(8, 1.0, 201)
    uv[..., 1] = np.clip(2.0 * uv[..., 1] - 1.0, 0.0, 1.0)
    mesh = meshed(drawn(CYLINDER, uv, family))
    assert mesh.left_out == tuple(range(16))
    assert "fewer revolutions" in mesh.note


def test_two_fibres_that_meet_twice_with_nothing_between_leave_no_face() -> None:
    uv, family = straight_uv(6, 0.5, 201)
    v = uv[8, :, 1]
    uv[8, :, 0] += 0.12 * np.exp(-(((v - 0.25) / 0.01) ** 2))  # a wiggle across one + path, there and back
    paths = drawn(CYLINDER, uv, family)
    found = crossings(paths)
    assert (found.sense == -1).any()
    check_annulus(quads(paths, found))


def test_random_smooth_families_always_mesh() -> None:
    """Warped patterns: any monotone warp of u and v keeps the topology, so the mesh must not change."""
    rng = np.random.default_rng(7)
    plain = meshed(helices(9, 0.8, 151, CYLINDER))
    for _ in range(5):
        uv, family = straight_uv(9, 0.8, 151)
        a, b, phase = rng.uniform(0.0, 0.12), rng.uniform(0.0, 0.14), rng.uniform(0.0, 6.0)
        twist = rng.uniform(-1.0, 1.0)
        u, v = uv[..., 0].copy(), uv[..., 1].copy()
        uv[..., 0] = u + a * np.sin(2 * np.pi * u + phase) + twist * v
        uv[..., 1] = v + b * np.sin(2 * np.pi * v)
        mesh = meshed(drawn(CYLINDER, uv, family))
        check_annulus(mesh)
        assert (len(mesh.quads), len(mesh.triangles)) == (len(plain.quads), len(plain.triangles))


def test_layup_meshes_the_converged_paths() -> None:
    paths = helices(8, 1.0, 101, CYLINDER)
    status = np.zeros(16, dtype=np.int64)
    status[[1, 9]] = Status.SLID_OFF_END
    result = assess(replace(paths, status=frozen(status)))
    assert not np.isin(result.crossings.path_a, [1, 9]).any()
    assert len(result.crossings) == 120 - 15 - 15 + 1  # the two meet half way
    check_annulus(result.quads)
    status[:6] = Status.STALLED
    assert len(assess(replace(paths, status=frozen(status))).crossings) == 120


def one(*corners: tuple[float, float, float]) -> QuadMesh:
    points = np.array(corners, dtype=np.float64)
    uv = np.full((4, 2), 0.5)
    none = np.zeros((0, 3), dtype=np.int64)
    return QuadMesh(frozen(points), frozen(uv), np.array([[0, 1, 2, 3]]), none, np.ones(4, dtype=bool))


def test_a_rectangle() -> None:
    found = quad_quality(one((0, 0, 0), (3, 0, 0), (3, 1, 0), (0, 1, 0)))
    assert (found.jacobian[0], found.aspect[0], found.warp[0]) == pytest.approx((1.0, 3.0, 0.0))
    assert found.convex_share == 1.0


@pytest.mark.parametrize("angle", [10.0, 45.0, 90.0, 135.0])
def test_a_rhomb_has_the_sine_of_its_angle(angle: float) -> None:
    a = np.radians(angle)
    x, y = np.cos(a), np.sin(a)
    found = quad_quality(one((0, 0, 0), (1, 0, 0), (1 + x, y, 0), (x, y, 0)))
    assert (found.jacobian[0], found.aspect[0]) == pytest.approx((np.sin(a), 1.0))


def test_a_dart_is_not_convex_and_a_crossed_quad_neither() -> None:
    for corners in (((0, 0, 0), (2, -1, 0), (0.5, 0, 0), (2, 1, 0)), ((0, 0, 0), (2, 0, 0), (0, 1, 0), (2, 1, 0))):
        found = quad_quality(one(*corners))
        assert not found.convex[0]
        assert found.jacobian[0] <= 0.0
        assert found.convex_share == 0.0


def test_warp_is_the_distance_of_the_diagonals() -> None:
    found = quad_quality(one((0, 0, 0), (1, 0, 0.2), (1, 1, 0), (0, 1, 0.2)))
    assert found.warp[0] == pytest.approx(0.2 / np.hypot(1.0, 0.2))


def test_quads_of_helices_are_rhombs_of_the_crossing_angle() -> None:
    mesh = assess(helices(48, 1.0, 401, cylinder())).quads
    found = quad_quality(mesh)
    between = 2.0 * np.arctan2(2.0 * np.pi, HEIGHT)
    assert found.jacobian == pytest.approx(np.full(len(mesh.quads), np.sin(between)), rel=0.01)
    assert found.aspect == pytest.approx(np.ones(len(mesh.quads)), rel=1e-3)
    assert found.convex_share == 1.0
    assert found.inner.all()  # at the rims there are triangles


@pytest.mark.parametrize(("name", "turns"), [("vase.stl", 1.3), ("cast.ply", 2.06), ("bottle.obj", 0.5),
                                             ("wing.stl", 0.54), ("elbow.obj", 1.0), ("tank.ply", 0.6)])  # fmt: skip
def test_inner_quads_of_the_parts_are_convex(name: str, turns: float) -> None:
    layup = assess(wound(fitted(name), 16, turns, 201))
    mesh, found = layup.quads, quad_quality(layup.quads)
    assert len(mesh.quads) >= 0.8 * (len(mesh.quads) + len(mesh.triangles))
    assert mesh.euler == 0
    assert found.convex_share >= 0.95
    assert np.isfinite(found.aspect).all()
    lifted = ~layup.paths.on_surface.all()
    assert (~mesh.on_surface).any() == lifted
