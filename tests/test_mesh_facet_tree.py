"""The search tree over triangles against trying every triangle."""

import numpy as np
import pytest
from mesh_shapes import ball, box, cone, joined

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.geometry.facet_tree import FacetTree
from meshwind.mesh.geometry.rays import cast
from meshwind.mesh.repair.overlaps import overlaps


def brute_distance(vertices: Floats, faces: Ints, point: Floats) -> float:
    """The least distance to the triangles' planes where the foot is inside, and to all their edges."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    height = np.einsum("ij,ij->i", point - a, normal)
    foot = point - height[:, None] * normal
    inside = np.ones(len(faces), dtype=bool)
    least = np.inf
    for start, end in ((a, b), (b, c), (c, a)):
        along = end - start
        inside &= np.einsum("ij,ij->i", np.cross(along, foot - start), normal) >= 0
        t = np.clip(np.einsum("ij,ij->i", point - start, along) / np.einsum("ij,ij->i", along, along), 0, 1)
        least = min(least, float(np.linalg.norm(start + t[:, None] * along - point, axis=1).min()))
    return min(least, float(np.abs(height[inside]).min(initial=np.inf)))


@pytest.mark.parametrize("part", [ball(2), cone(around=9, along=40), (np.eye(3), np.array([[0, 1, 2]]))])
def test_distances_are_the_least_of_all(part: tuple[Floats, Ints]) -> None:
    points = np.random.default_rng(0).normal(size=(300, 3)) * 2
    found = FacetTree.of(*part).distances(points)
    assert np.allclose(found, [brute_distance(*part, point) for point in points], rtol=1e-12, atol=1e-14)


def test_vertices_lie_on_their_faces() -> None:
    vertices, faces = ball(3)
    assert FacetTree.of(vertices, faces).distances(vertices).max() < 1e-15


def test_faces_without_area_are_points_and_lines() -> None:
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]])
    points = np.array([[0.5, 3, 0], [5, 0, 4], [1, 0, 0]])
    assert FacetTree.of(vertices, np.array([[0, 1, 2]])).distances(points).tolist() == [3.0, 5.0, 0.0]
    assert FacetTree.of(vertices, np.array([[0, 0, 0], [1, 1, 0]])).distances(points).tolist() == [3.0, 4 * 2**0.5, 0.0]


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_segments_meet_the_first_face_of_a_box(scale: float) -> None:
    vertices, faces = box()
    y, z = np.random.default_rng(1).uniform(0.05, 0.95, (2, 100))
    start = np.column_stack([np.full(100, -1.0), y, z])
    ray = np.tile([3.0, 0.0, 0.0], (100, 1))
    tree = FacetTree.of(scale * vertices, faces)
    near = tree.first_hits(scale * start, scale * ray)
    assert (vertices[faces[near]][:, :, 0] == 0).all()
    far = tree.first_hits(scale * (start + ray), -scale * ray)
    assert (vertices[faces[far]][:, :, 0] == 1).all()
    assert (tree.first_hits(scale * start, 0.3 * scale * ray) == -1).all()


@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1e6])
def test_overlaps_do_not_depend_on_the_unit(scale: float) -> None:
    vertices, faces = ball(3)
    twice, both = joined((vertices, faces), (vertices + [1.0, 0.013, 0.02], faces))
    notes = overlaps(twice, both)
    assert notes[0].startswith("noticed that the surface runs through itself: 160 of 3840 edges")
    assert overlaps(scale * twice, both) == notes


def meeting(vertices: Floats, faces: Ints, start: Floats, ray: Floats, least: float) -> float:
    """The least distance above `least` at which a ray meets a triangle, by trying all: infinity if there is none."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    with np.errstate(divide="ignore", invalid="ignore"):
        away = np.einsum("ij,ij->i", a - start, normal) / (normal @ ray)
    place = start + np.where(np.isfinite(away), away, 0.0)[:, None] * ray
    inside = np.isfinite(away) & (away > least)
    for one, two in ((a, b), (b, c), (c, a)):
        inside &= np.einsum("ij,ij->i", np.cross(two - one, place - one), normal) >= 0.0
    return float(away[inside].min(initial=np.inf))


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("part", [joined(ball(2), box((3, 0, 0))), cone(around=9, along=40)])
def test_rays_meet_the_first_face_of_all(part: tuple[Floats, Ints], scale: float) -> None:
    rng = np.random.default_rng(2)
    start, ray = rng.normal(size=(400, 3)), rng.normal(size=(400, 3))
    ray /= np.linalg.norm(ray, axis=1, keepdims=True)
    face, distance = cast(FacetTree.of(scale * part[0], part[1]), scale * start, ray, 0.1 * scale)
    right = [meeting(*part, *each, 0.1) for each in zip(start, ray, strict=True)]
    assert np.allclose(distance / scale, right, rtol=1e-9)
    assert np.array_equal(face < 0, np.isinf(right)) and 40 < (face >= 0).sum() < 360


def test_rays_along_axes_meet_flat_boxes() -> None:
    """Boxes of the tree without thickness, and components of the ray that are 0."""
    vertices, faces = box(size=(1, 1, 1))
    start = np.array([[0.3, 0.4, -1.0], [0.3, 0.4, 0.5], [0.3, 1.4, -1.0]])
    face, distance = cast(FacetTree.of(vertices, faces), start, np.tile([0.0, 0.0, 1.0], (3, 1)), 0.0)
    assert distance.tolist() == [1.0, 0.5, np.inf]
    assert (vertices[faces[face[0]]][:, 2] == 0).all() and face[2] == -1
