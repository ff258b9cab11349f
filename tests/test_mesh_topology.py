"""Edges, components and loops against plain definitions of them."""

import numpy as np
import pytest
from mesh_shapes import cone

from meshwind.core.cast import Ints
from meshwind.mesh.geometry.areas_and_volumes import area_vectors, edge_lengths, volume
from meshwind.mesh.geometry.topology import boundary, components, edges, loops, patches


def soup(seed: int, vertices: int, faces: int) -> Ints:
    """Triangles between random vertices: edges with one, two and many faces, and some that repeat."""
    return np.random.default_rng(seed).integers(0, vertices, (faces, 3))


@pytest.mark.parametrize("faces", [soup(0, 9, 200), soup(1, 400, 300), soup(2, 3, 1), np.zeros((0, 3), dtype=np.int64)])
def test_edges_are_those_of_a_dictionary(faces: Ints) -> None:
    found = edges(faces)
    of: dict[tuple[int, int], list[int]] = {}
    for half, (tail, head) in enumerate(zip(faces.ravel(), np.roll(faces, -1, axis=1).ravel(), strict=True)):
        of.setdefault((int(min(tail, head)), int(max(tail, head))), []).append(half)
    wanted = sorted(of.items())
    assert found.ends.tolist() == [list(ends) for ends, _ in wanted]
    assert found.count.tolist() == [len(halves) for _, halves in wanted]
    assert found.halves.tolist() == [(halves + [-1])[:2] for _, halves in wanted]
    for edge, (_, halves) in enumerate(wanted):
        assert (found.of_face.ravel()[halves] == edge).all()


@pytest.mark.parametrize("links", [0, 30, 100, 400])
def test_components_agree_with_propagated_labels(links: int) -> None:
    first, second = np.random.default_rng(links).integers(0, 100, (2, links))
    lowest = np.arange(100)
    for _ in range(100):
        for a, b in zip(first, second, strict=True):
            lowest[a] = lowest[b] = min(lowest[a], lowest[b])
    assert components(100, first, second).tolist() == np.unique(lowest, return_inverse=True)[1].tolist()


def test_loops_follow_their_faces() -> None:
    _, faces = cone()
    rims = loops(faces)
    assert len(rims) == 2
    directed = {(int(a), int(b)) for a, b in boundary(faces)}
    walked = {(int(a), int(b)) for rim in rims for a, b in zip(rim, np.roll(rim, -1), strict=True)}
    assert walked == directed
    assert [int(rim[0]) for rim in rims] == sorted(int(rim.min()) for rim in rims)


def test_loops_that_touch_at_a_vertex_are_still_found() -> None:
    faces = np.array([[0, 1, 2], [0, 3, 4]])
    assert sorted(vertex for loop in loops(faces) for vertex in loop.tolist()) == [0, 1, 2, 3, 4]


def test_patches_do_not_reach_over_crowded_edges() -> None:
    faces = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4], [2, 1, 5]])
    assert patches(faces).tolist() == [0, 1, 2, 0]


def test_measures_of_a_tetrahedron() -> None:
    vertices = np.concatenate([np.zeros((1, 3)), np.eye(3)])
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    assert volume(vertices, faces) == pytest.approx(1 / 6, rel=1e-14)
    assert volume(vertices + 10.0, faces[:3]) == pytest.approx(1 / 6, rel=1e-12)
    assert np.allclose(area_vectors(vertices, faces).sum(axis=0), 0, atol=1e-15)
    assert sorted(edge_lengths(vertices, faces).ravel().round(12)) == [1.0] * 6 + [round(2**0.5, 12)] * 6
