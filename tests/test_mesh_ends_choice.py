"""The choice of the two ends and of their order does not depend on scale, pose or the order in the file."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mesh_shapes import Part, moved, rotation, shuffled, tube

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.mesh import annulus, mesh_from, read
from meshwind.mesh.geometry.axis import forward
from meshwind.workflow.options import Options

SCALES = [1.0, 1e-3, 1.0 / 3.0, 1.0 / 25.4, 0.1, 0.7, 12.0, 25.4, 1e3, 1e6]


def bent(angle: float = 0.5 * np.pi, along: int = 20, around: int = 16) -> Part:
    """A pipe of radius 1 bent to radius 3 in the plane of x and z: its two ends are each other's mirror image."""
    vertices, faces = tube(lambda z: 1.0 + 0.0 * z, 1.0, around, along)
    turn = angle * vertices[:, 2]
    reach = 3.0 + vertices[:, 0]
    return np.column_stack([reach * np.cos(turn), vertices[:, 1], reach * np.sin(turn)]), faces[:, ::-1]


def arms(*directions: Floats) -> Part:
    """Open tubes from the faces of a cube outwards, the cube's other faces closed, as one surface."""
    corner = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1], indexing="ij")).reshape(3, -1).T.astype(float)
    vertices, faces = [corner], []
    for axis in range(3):
        for side in (-1.0, 1.0):
            ring = np.flatnonzero(corner[:, axis] == side)
            out = side * np.eye(3)[axis]
            flat = np.delete(corner[ring], axis, axis=1)
            ring = ring[np.argsort(np.arctan2(flat[:, 1], flat[:, 0]) * side * (-1.0 if axis == 1 else 1.0))]
            if not any(np.allclose(out, way / np.linalg.norm(way)) for way in directions):
                faces.append(np.array([ring[[0, 1, 2]], ring[[0, 2, 3]]]))
                continue
            reach = next(float(np.linalg.norm(way)) for way in directions if way @ out > 0.9 * np.linalg.norm(way))
            steps = np.linspace(0.0, reach, 9)[1:]
            start = sum(len(block) for block in vertices)
            vertices += [corner[ring] + step * out for step in steps]
            rows = np.concatenate([ring, start + np.arange(32)]).reshape(9, 4)
            a, b = rows[:-1], np.roll(rows[:-1], -1, axis=1)
            c, d = np.roll(rows[1:], -1, axis=1), rows[1:]
            faces.append(np.stack([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)]).reshape(-1, 3))
    return np.concatenate(vertices), np.concatenate(faces)


def starts(part: Part, ends: str = "auto") -> Floats:
    """Middles of the start and of the end rim (2, 3)."""
    found = annulus(mesh_from(*part), ends)
    return np.array([found.vertices[rim].mean(axis=0) for rim in found.rims])


@pytest.mark.parametrize("digits", ["double", "single"])
@pytest.mark.parametrize("angle", [0.5 * np.pi, np.pi, 1.0])
@pytest.mark.parametrize("seed", range(4))
def test_scaling_does_not_swap_mirrored_ends(seed: int, angle: float, digits: str) -> None:
    turn = np.eye(3) if seed == 0 else rotation(seed)
    vertices, faces = moved(bent(angle), turn, np.zeros(3), 1.0)
    first = starts((vertices, faces))
    for k, scale in enumerate(SCALES):
        points = vertices * scale
        if digits == "single":
            points = points.astype(np.float32).astype(np.float64)
        assert starts(shuffled((points, faces), k)) / scale == pytest.approx(first, abs=1e-5)


@pytest.mark.parametrize("ends", ["auto", "x", "y", "z"])
def test_scaling_does_not_choose_another_pair_of_three_alike(ends: str) -> None:
    part = arms(np.array([5.0, 0, 0]), np.array([0, 5.0, 0]), np.array([0, 0, 5.0]))
    first = starts(part, ends)
    for k, scale in enumerate(SCALES):
        noise = 1e-12 * np.random.default_rng(k).normal(size=part[0].shape)
        assert starts(shuffled((scale * (part[0] + noise), part[1]), k), ends) / scale == pytest.approx(first, abs=1e-9)


def test_of_three_alike_rims_the_two_furthest_apart_are_ends_in_any_pose() -> None:
    part = arms(np.array([5.0, 0, 0]), np.array([-6.0, 0, 0]), np.array([0, 0, 5.0]))
    for seed in range(5):
        turn = rotation(seed)
        found = starts(shuffled(moved(part, turn, np.zeros(3), 3.0), seed)) @ turn / 3.0
        assert np.sort(found[:, 0]) == pytest.approx([-7.0, 6.0])


@pytest.mark.parametrize("ends", ["z", "x"])
def test_rims_at_one_height_keep_their_order(ends: str) -> None:
    """A U-bend: along z both rims are equally far out."""
    vertices, faces = bent(np.pi)
    first = starts((vertices, faces), ends)
    for k, scale in enumerate(SCALES):
        noise = 1e-12 * np.random.default_rng(k).normal(size=vertices.shape)
        assert starts(shuffled((scale * (vertices + noise), faces), k), ends) / scale == pytest.approx(first, abs=1e-9)


def beads(heights: list[int]) -> Part:
    """Equal small triangles square to z, their middles on it."""
    turn = 2.0 * np.pi * np.arange(3) / 3.0
    corner = 0.1 * np.column_stack([np.cos(turn), np.sin(turn), 0.0 * turn])
    vertices = np.concatenate([corner + [0.0, 0.0, height] for height in heights])
    return vertices, np.arange(len(vertices)).reshape(-1, 3)


def test_without_skewness_the_fifth_moment_decides() -> None:
    """Heights whose sum and sum of cubes are 0, but not that of their fifth powers."""
    heights = [-9, -5, -1, 7, 8]
    assert sum(heights) == sum(height**3 for height in heights) == 0
    sign = np.sign(sum(height**5 for height in heights))
    vertices, faces = beads(heights)
    for seed in range(6):
        turn = rotation(seed)
        for way in (1.0, -1.0):
            found = forward(vertices @ turn.T, faces, way * turn[:, 2])
            assert found @ turn[:, 2] == pytest.approx(sign)
    skewed, faces = beads([-3, 1, 2])  # the long tail is below: the fuller end is above
    assert forward(skewed, faces, np.array([0.0, 0.0, 1.0])) == pytest.approx([0, 0, -1])


def test_the_elbow_of_the_samples_starts_alike_at_any_scale() -> None:
    mesh = read(Path(__file__).parents[1] / "data" / "elbow.obj")
    first = starts((mesh.vertices, mesh.faces))
    for k, scale in enumerate(SCALES):
        turn = rotation(k)
        again = starts(shuffled(moved((mesh.vertices, mesh.faces), turn, np.zeros(3), scale), k))
        assert again @ turn / scale == pytest.approx(first, abs=1e-5)


@pytest.mark.parametrize("given", [[(0, 0, -120), (0, 0, 120)], np.array([[0.0, 0.0, -120.0], [0.0, 0.0, 120.0]])])
def test_two_points_may_be_an_array(given: Any) -> None:
    tank, written = mw.read("data/tank.ply"), "0.0,0.0,-120.0 0.0,0.0,120.0"
    assert (mw.annulus(tank, given).vertices == mw.annulus(tank, written).vertices).all()
    options = Options(ends=given)
    assert options.ends == written and Options(ends=options.ends) == options


@pytest.mark.parametrize("given", [[(0, 0)], [(0, 0, 1), (0, np.nan, 2)], 3, None, {"a": 1}, np.eye(3)])
def test_what_is_no_two_points_is_refused_in_one_line(given: Any) -> None:
    with pytest.raises(BadInputError, match="give auto, x, y, z or two points") as refusal:
        Options(ends=given)
    assert "\n" not in str(refusal.value)
