"""Repairs: each fault is repaired, counted and reported; a clean mesh is unchanged; hopeless ones are refused."""

import numpy as np
import pytest
from mesh_shapes import Part, ball, box, cone, joined, moved, pear, rotation, shuffled

from meshwind.core.cast import Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh import Mesh, mesh_from
from meshwind.mesh.geometry.areas_and_volumes import areas, volume
from meshwind.mesh.geometry.topology import edges, euler, loops, patches


def assert_sound(mesh: Mesh) -> None:
    found = edges(mesh.faces)
    assert found.count.max() <= 2
    assert not patches(mesh.faces).any()
    tails = mesh.faces.ravel() * len(mesh.vertices) + np.roll(mesh.faces, -1, axis=1).ravel()
    assert len(np.unique(tails)) == len(tails)
    assert np.array_equal(np.unique(mesh.faces), np.arange(len(mesh.vertices)))
    assert volume(mesh.vertices, mesh.faces) > 0
    assert not mesh.vertices.flags.writeable and not mesh.faces.flags.writeable


@pytest.mark.parametrize("part", [ball(), pear(), cone(), box()])
def test_clean_mesh_is_left_alone(part: Part) -> None:
    mesh = mesh_from(*part)
    assert mesh.repairs == ()
    assert np.array_equal(mesh.vertices, part[0]) and np.array_equal(mesh.faces, part[1])
    assert (mesh.read_vertices, mesh.read_faces) == (len(part[0]), len(part[1]))
    assert_sound(mesh)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_welds_loose_triangles_within_the_tolerance(scale: float) -> None:
    vertices, faces = pear()
    loose = vertices[faces].reshape(-1, 3)
    noise = np.random.default_rng(0).uniform(-1, 1, loose.shape) * 1e-8
    mesh = mesh_from(scale * (loose + noise), np.arange(len(loose)).reshape(-1, 3))
    assert len(mesh.vertices) == len(vertices) and len(mesh.faces) == len(faces)
    assert mesh.repairs == (f"welded {len(loose) - len(vertices)} vertices that lay on another",)
    assert_sound(mesh)


def test_does_not_weld_what_lies_apart() -> None:
    vertices, faces = cone()
    mesh = mesh_from(vertices[faces].reshape(-1, 3) * [1, 1, 1e-4], np.arange(3 * len(faces)).reshape(-1, 3))
    assert len(mesh.vertices) == len(vertices)


def test_drops_collapsed_duplicate_and_unused() -> None:
    vertices, faces = pear()
    extra = np.array([[0, 0, 5], [*faces[7, [1, 2, 0]]], [*faces[9, ::-1]]])
    mesh = mesh_from(np.concatenate([vertices, [[9.0, 9.0, 9.0]]]), np.concatenate([faces, extra]))
    assert np.array_equal(mesh.faces, faces)
    assert mesh.repairs == (
        "dropped 1 vertex that no face uses",
        "dropped 1 face collapsed to a line or point",
        "dropped 2 faces that repeated another",
    )


def test_keeps_the_piece_with_the_largest_area_not_the_most_faces() -> None:
    big, small = moved(ball(1), np.eye(3), np.zeros(3), 5.0), moved(ball(3), np.eye(3), np.array([20.0, 0, 0]), 1.0)
    mesh = mesh_from(*joined(small, big))
    assert len(mesh.faces) == len(big[1])
    assert mesh.repairs == (f"dropped 1 piece beside the largest ({len(small[1])} faces)",)
    assert_sound(mesh)


@pytest.mark.parametrize("part", [pear(), cone()])
def test_turns_faces_to_agree_and_outward(part: Part) -> None:
    faces = part[1].copy()
    faces[::5] = faces[::5, ::-1]
    mesh = mesh_from(part[0], faces)
    assert f"turned {len(faces[::5])} faces to agree with the neighbours" in mesh.repairs
    assert_sound(mesh)
    assert volume(mesh.vertices, mesh.faces) == pytest.approx(volume(*part), rel=1e-12)


@pytest.mark.parametrize("part", [pear(), cone()])
def test_turns_an_inside_out_part(part: Part) -> None:
    mesh = mesh_from(part[0] + 100.0, part[1][:, ::-1])
    assert mesh.repairs == ("turned all faces outward",)
    assert_sound(mesh)


def test_open_part_outward_wherever_it_lies() -> None:
    vertices, faces = cone()
    for seed in range(5):
        mesh = mesh_from(*moved((vertices, faces), rotation(seed), np.array([50.0, -20, 9]) * seed, 2.0))
        assert mesh.repairs == () and np.array_equal(mesh.faces, faces)


def test_drops_an_inner_wall() -> None:
    wall = (np.array([[1.0, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]]), np.array([[0, 1, 2], [0, 2, 3]]))
    left, right = box(), box((1, 0, 0))
    # the two boxes lose the faces that they share and get one wall between them
    inside = [(part[0], part[1][~(part[0][part[1]][:, :, 0] == 1).all(axis=1)]) for part in (left, right)]
    mesh = mesh_from(*joined(*inside, wall))
    assert "dropped 2 faces at edges with more than two faces" in mesh.repairs
    assert_sound(mesh)
    assert volume(mesh.vertices, mesh.faces) == pytest.approx(2.0, rel=1e-12)


def test_drops_a_fin() -> None:
    vertices, faces = pear()
    a, b = faces[0, :2]
    fin = np.array([[a, b, len(vertices)]])
    mesh = mesh_from(np.concatenate([vertices, 1.1 * vertices[[a]]]), np.concatenate([faces, fin]))
    assert len(mesh.faces) == len(faces) and euler(mesh.faces) == 2
    assert mesh.repairs == ("dropped 1 face at edges with more than two faces",)
    assert_sound(mesh)


def test_boxes_that_touch_along_an_edge_come_apart() -> None:
    mesh = mesh_from(*joined(box(), box((1, 1, 0), (2, 2, 1))))
    assert_sound(mesh)
    assert volume(mesh.vertices, mesh.faces) == pytest.approx(4.0, rel=1e-12)


def voxels(cells: list[tuple[int, int, int]]) -> Part:
    """Skin of unit cells, as a segmented scan gives it."""
    parts = [box(cell) for cell in cells]
    vertices, faces = joined(*parts)
    centre = vertices[faces].mean(axis=1)
    # two triangles of a side meet the same two of its neighbour: both vanish
    side = np.round(np.where(np.abs(centre - np.round(centre)) < 1e-9, centre, np.floor(centre) + 0.5) * 2)
    _, inverse, count = np.unique(side, axis=0, return_inverse=True, return_counts=True)
    return vertices, faces[count[inverse.ravel()] == 2]


def test_part_that_touches_itself_is_split_along_the_edge() -> None:
    # three cells in a row below, one at each end above on the diagonal: an edge with four faces of one patch
    cells = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (2, 1, 0), (0, 0, 1), (0, 1, 1)]
    mesh = mesh_from(*voxels(cells))
    assert any(note.startswith("split the surface at") for note in mesh.repairs)
    assert_sound(mesh)
    assert euler(mesh.faces) == 2 and loops(mesh.faces) == []
    assert volume(mesh.vertices, mesh.faces) == pytest.approx(len(cells), rel=1e-12)


def test_edge_whose_wedges_are_connected_at_both_ends_is_halved() -> None:
    # two rows on the diagonal, bridged at both ends: they touch along the middle edge of three
    cells = [(x, y, y) for x in range(3) for y in range(2)] + [(0, 1, 0), (2, 1, 0)]
    mesh = mesh_from(*voxels(cells))
    assert_sound(mesh)
    assert euler(mesh.faces) == 0 and loops(mesh.faces) == []  # a handle without width
    assert volume(mesh.vertices, mesh.faces) == pytest.approx(len(cells), rel=1e-12)


def test_pieces_that_touch_in_a_vertex_come_apart() -> None:
    vertices, faces = pear()
    small = moved(ball(1), np.eye(3), np.zeros(3), 0.1)
    tip = vertices[np.argmax(vertices[:, 2])]
    small = small[0] - small[0][0] + tip, small[1]
    mesh = mesh_from(*joined((vertices, faces), small))
    assert len(mesh.faces) == len(faces) and "split the surface at 1 vertex where parts of it touch" in mesh.repairs
    assert_sound(mesh)


def test_vertex_where_one_part_touches_itself_is_split() -> None:
    vertices, faces = cone(around=12, along=6)
    faces = np.where(faces == 12 * 3 + 6, 12 * 3, faces)  # two sides of the tube pinched in one vertex
    vertices[12 * 3] = [0, 0, vertices[12 * 3, 2]]
    mesh = mesh_from(vertices, faces)
    assert_sound(mesh)
    assert euler(mesh.faces) == 0 and len(loops(mesh.faces)) == 2


def test_faces_without_height_are_flipped_and_nothing_moves() -> None:
    vertices, faces = pear()
    sliver = np.concatenate([vertices, [vertices[faces[0, :2]].mean(axis=0)]])
    # a vertex in the middle of an edge, one side of which knows it and the other does not
    a, b, c = faces[0]
    middle = len(vertices)
    split = np.concatenate([[[a, middle, c], [middle, b, c], [a, b, middle]], faces[1:]])
    mesh = mesh_from(sliver, split)
    assert mesh.repairs == ("flipped or dropped 1 face without height",)
    assert_sound(mesh)
    assert euler(mesh.faces) == 2 and len(mesh.faces) == len(faces) + 2
    assert areas(mesh.vertices, mesh.faces).min() > 1e-4
    assert volume(mesh.vertices, mesh.faces) == pytest.approx(volume(vertices, faces), rel=1e-12)


def test_slivers_at_the_boundary_go() -> None:
    vertices, faces = cone()
    vertices = np.concatenate([vertices, [vertices[:2].mean(axis=0)]])
    middle, top = len(vertices) - 1, 25
    below = mesh_from(vertices, np.concatenate([faces, [[1, 0, middle]]]))
    assert faces[0].tolist() == [0, 1, top]
    halves = [[0, middle, top], [middle, 1, top]]
    above = mesh_from(vertices, np.concatenate([[*halves, [0, 1, middle]], faces[1:]]))
    for mesh in (below, above):
        assert mesh.repairs == ("flipped or dropped 1 face without height",)
        assert_sound(mesh)
        assert len(mesh.faces) == len(faces) + 1
        assert areas(mesh.vertices, mesh.faces).sum() == pytest.approx(areas(*cone()).sum(), rel=1e-12)


def test_what_hangs_on_a_sliver_goes_with_it() -> None:
    """Dropped at the boundary, it leaves two fans at its apex."""
    vertices = np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0), (0.5, 1, 0), (1.5, 1, 0), (2.5, 1, 0.5)], dtype=float)
    mesh = mesh_from(vertices, [[0, 1, 3], [1, 2, 4], [2, 5, 4], [0, 2, 1]])
    assert_sound(mesh)
    assert mesh.repairs[:2] == ("flipped or dropped 1 face without height", "dropped 1 face that hung on these")
    assert (len(mesh.faces), len(mesh.vertices), len(loops(mesh.faces))) == (2, 4, 1)


def test_order_of_the_input_does_not_matter() -> None:
    part = joined(pear(), moved(ball(1), np.eye(3), np.array([9.0, 0, 0]), 0.5))
    first, second = mesh_from(*part), mesh_from(*shuffled(part))
    assert first.repairs == second.repairs
    assert np.array_equal(np.unique(first.vertices, axis=0), np.unique(second.vertices, axis=0))


def moebius() -> Part:
    turn = np.arange(30) * 2 * np.pi / 30
    rows = [np.column_stack([(1 + s * np.cos(turn / 2)) * np.cos(turn), (1 + s * np.cos(turn / 2)) * np.sin(turn),
                             s * np.sin(turn / 2)]) for s in (-0.3, 0.3)]  # fmt: skip
    low = np.arange(29)
    strip = [np.column_stack([low, low + 1, low + 31]), np.column_stack([low, low + 31, low + 30])]
    return np.concatenate(rows), np.concatenate([*strip, [[29, 30, 0], [29, 0, 59]]])


FACES = np.array([[0, 1, 2]])
BAD: dict[str, tuple[object, Ints | list[object], str]] = {
    "nan": ([[0, 0, 0], [1, 0, 0], [0, np.nan, 0]], FACES, "1 of 3 vertices have NaN or infinite coordinates; remove"),
    "inf": ([[0, 0, 0], [np.inf, 0, 0], [0, 1, 0]], FACES, "NaN or infinite coordinates; remove"),
    "flat array": ([0.0, 1.0, 2.0], FACES, r"vertices has shape \(3,\); give"),
    "quads": (np.zeros((4, 3)), np.array([[0, 1, 2, 3]]), r"faces has shape \(1, 4\); give"),
    "no faces": (np.zeros((4, 3)), [], "holds no triangles; export"),
    "index": (np.eye(3), np.array([[0, 1, 3]]), "refer to vertices that do not exist; give indices from 0 to 2"),
    "negative": (np.eye(3), np.array([[0, 1, -1]]), "refer to vertices that do not exist; give"),
    "half": (np.eye(3), np.array([[0, 1, 1.5]]), "refer to vertices that do not exist; give"),
    "one point": (np.ones((3, 3)), FACES, "all its vertices are in one point"),
    "one line": (np.arange(9).reshape(3, 3), FACES, "no face is left, none has an area; export"),
    "huge": (np.eye(3) * 1e200, FACES, "out of range; scale"),
    "tiny": (np.eye(3) * 1e-200, FACES, "out of range; scale"),
    "moebius": (*moebius(), "only one side, like a Moebius strip; give"),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_hopeless_input_is_refused_in_one_line(case: str) -> None:
    vertices, faces, words = BAD[case]
    with pytest.raises(BadInputError, match=words) as caught:
        mesh_from(vertices, faces, "part.stl")  # type: ignore[arg-type]
    assert str(caught.value).startswith("part.stl: ") and "\n" not in str(caught.value)
