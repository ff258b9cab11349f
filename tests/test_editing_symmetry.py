"""Symmetry that an edit keeps: of its control net, and of the vertices where the mesh is symmetric itself."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

import meshwind as mw
from meshwind.core.vectors import rotation
from meshwind.editing.edit import edit
from meshwind.editing.freedom import free_moves, frozen_mask
from meshwind.editing.options import EditOptions
from meshwind.editing.redesign import redesign
from meshwind.editing.symmetry import mesh_group, net_group, planes, reflected
from meshwind.mesh import Mesh, mesh_from
from meshwind.surface import Surface, shapes
from meshwind.workflow.options import Options

X, Z = planes("x")[0], planes("z")[0]
WINDING = Options(4, 0.05, 61)
FLIPS = {"x": [-1.0, 1.0, 1.0], "y": [1.0, -1.0, 1.0], "z": [1.0, 1.0, -1.0]}


def uneven(count: int = 16) -> Surface:
    """A waist that is no surface of revolution, symmetric by reflection in x, y and z, of so many spans each way."""
    return Surface(shapes.hyperboloid(1.0, 0.6, 1.5, (count, count)).control_points * [1.4, 1.0, 1.0])


def waist(turned: float = 0.0) -> Mesh:
    """A mesh of a waist with four arms, each vertex of which has its images by a quarter turn and in x, y and z."""
    around, along = 48, 41
    u, z = np.meshgrid(np.arange(around) / around, np.linspace(-1.5, 1.5, along), indexing="ij")
    angle = 2.0 * np.pi * u
    radius = np.sqrt(1.0 + 0.3 * z**2) * (1.0 + 0.05 * np.cos(4.0 * angle))
    at = angle + turned
    points = np.stack([radius * np.cos(at), radius * np.sin(at), z], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(around), np.arange(along - 1), indexing="ij")
    a, b = i * along + j, (i + 1) % around * along + j
    faces = np.concatenate([np.stack([a, b, b + 1], axis=-1), np.stack([a, b + 1, a + 1], axis=-1)]).reshape(-1, 3)
    return mesh_from(30.0 * points, faces)


@pytest.mark.parametrize("mirror", ["x", "y", "z", "x, y", "x,y,z"])
def test_the_change_of_a_surface_is_its_own_mirror_image(mirror: str) -> None:
    surface = uneven()
    found = edit(surface, WINDING, EditOptions(mirror=mirror, rounds=2))
    uv = np.random.default_rng(3).uniform(size=(500, 2))
    images = {"x": [0.5, -1.0], "y": [0.0, -1.0], "z": [0.0, 1.0]}  # u of the image: what is added, and its sign
    moved = found.surface.points(uv) - surface.points(uv)
    assert np.linalg.norm(moved, axis=1).max() > 0.1
    for name in mirror.replace(" ", "").split(","):
        add, sign = images[name]
        to = np.stack([add + sign * uv[:, 0], 1.0 - uv[:, 1] if name == "z" else uv[:, 1]], axis=1)
        assert surface.points(to) == pytest.approx(surface.points(uv) * FLIPS[name], abs=1e-12)
        there = found.surface.points(to) - surface.points(to)
        assert np.abs(there - moved * FLIPS[name]).max() < 1e-9


def test_without_a_mirror_a_skew_winding_moves_the_part_otherwise() -> None:
    surface = uneven(10)
    mask = np.zeros(surface.control_points.shape[:2], dtype=bool)
    mask[:3] = True
    free, kept = (edit(surface, WINDING, EditOptions(mirror=m, rounds=1, frozen=mask)) for m in (None, "x"))
    moved = [each.surface.control_points - surface.control_points for each in (free, kept)]
    held = [np.abs(each).max(axis=(1, 2)) == 0.0 for each in moved]
    assert held[0].sum() == 3 and held[1].sum() == 6  # what is frozen on one side is on the other


def test_the_columns_are_orthonormal_and_span_what_the_group_keeps() -> None:
    surface = uneven()
    group = net_group(surface, 2, (X, Z))
    assert len(group.images) == 8  # the half turn and two mirrors
    moves = free_moves(surface, frozen_mask(surface, None), group)
    assert (moves.T @ moves).toarray() == pytest.approx(np.eye(moves.shape[1]), abs=1e-12)
    change = np.random.default_rng(1).standard_normal((surface.control_points.size // 3, 3))
    inside = (moves @ (moves.T @ change.ravel())).reshape(-1, 3)
    assert inside == pytest.approx(group.mean(change), abs=1e-12)
    assert group.mean(inside) == pytest.approx(inside, abs=1e-12)
    assert np.abs(inside - change).max() > 0.1


@pytest.mark.parametrize("turned", [0.0, 0.7])
def test_vertices_of_a_symmetric_mesh_are_moved_to_1e_9(turned: float) -> None:
    part = waist(turned)
    normal = f"{np.cos(turned)} {np.sin(turned)} 0 0"
    found = redesign(part, revolutions=0.1, paths=4, particles=61, symmetry=4, mirror=f"{normal}, z", rounds=2,
                     tolerance=1e-3)  # fmt: skip
    assert len(found.rounds) > 0 and np.linalg.norm(found.displacement, axis=1).max() > 1.0
    side = np.array([np.cos(turned), np.sin(turned), 0.0])
    across = np.eye(3) - 2.0 * side[:, None] * side
    for matrix in (across, np.diag([1.0, 1.0, -1.0]), rotation(np.array([0.0, 0.0, 1.0]), np.pi / 2)):
        far, image = cKDTree(part.vertices).query(part.vertices @ matrix.T)
        assert far.max() < 1e-9
        assert np.abs(found.displacement[image] - found.displacement @ matrix.T).max() < 1e-9
        assert np.abs(found.mesh.vertices[image] - found.mesh.vertices @ matrix.T).max() < 1e-9


def test_planes_are_found_on_the_chart() -> None:
    surface = uneven()
    middle = np.zeros(3)
    assert reflected(surface, X, middle).sign == -1 and not reflected(surface, X, middle).flipped
    assert abs(reflected(surface, X, middle).turn) == pytest.approx(0.5, abs=1e-6)
    z = reflected(surface, Z, middle)
    assert z.sign == 1 and z.flipped and z.turn == pytest.approx(0.0, abs=1e-6)


def test_a_mesh_that_is_not_symmetric_has_no_group() -> None:
    part = waist()
    axis = np.array([0.0, 0.0, 1.0])
    assert mesh_group(part.vertices, 4, (X,), axis) is not None
    assert mesh_group(part.vertices, 3, (), axis) is None
    assert mesh_group(part.vertices + np.eye(3)[0] * (part.vertices[:, :1] > 40.0), 1, (X,), axis) is None


@pytest.mark.parametrize("text", ["w", "x=", "1 2 3", "0 0 0 1", "x;y", ""])
def test_other_words_are_no_plane(text: str) -> None:
    with pytest.raises(mw.BadInputError, match="give planes by commas"):
        planes(text)


def test_a_plane_may_lie_anywhere() -> None:
    plane = planes("3 0 4 10")[0]
    assert plane.normal == pytest.approx((0.6, 0.0, 0.8)) and plane.at == pytest.approx(2.0)
    assert plane.images(np.array([[1.2, 5.0, 1.6]]), np.zeros(3))[0] == pytest.approx([1.2, 5.0, 1.6])  # it lies on it
    assert planes("x=12.5")[0].at == 12.5
