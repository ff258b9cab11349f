"""Pieces, rims by number, faults that are reported but not repaired, damaged files."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from broken_meshes import MESHES, branch, double_skin, save_obj
from mesh_shapes import Part, assert_annulus, ball, cone, joined, moved, pear, rotation, shuffled, tube

from meshwind.cli.check import described
from meshwind.core.errors import BadInputError
from meshwind.mesh import Mesh, annulus, check, mesh_from, read
from meshwind.mesh.geometry.areas_and_volumes import perimeter, volume
from meshwind.mesh.geometry.topology import loops
from meshwind.mesh.opening.choose_ends import position_text


def three() -> Part:
    """Balls of radius 1, 3 and 2 in a row."""
    return joined(
        *(moved(ball(2), np.eye(3), np.array([9.0 * k, 0, 0]), size) for k, size in enumerate((1.0, 3.0, 2.0)))
    )


@pytest.mark.parametrize(("component", "radius"), [(0, 3.0), (1, 2.0), (2, 1.0)])
def test_component_is_the_rank_by_area(component: int, radius: float) -> None:
    for part in (three(), shuffled(three()), moved(three(), rotation(1), np.ones(3), 1.0)):
        mesh = mesh_from(*part, component=component)
        assert volume(mesh.vertices, mesh.faces) == pytest.approx(radius**3 * volume(*ball(2)), rel=1e-9)


def test_a_large_dropped_piece_is_a_warning_and_a_small_one_is_not() -> None:
    mesh = mesh_from(*three())
    assert mesh.repairs == ("dropped 2 pieces beside the largest (640 faces)",)
    assert mesh.warnings == (
        "3 pieces: the largest is taken; the next one has 44 % of its area, and component=1 takes that instead",
    )
    small = mesh_from(*joined(pear(), moved(ball(1), np.eye(3), np.full(3, 9.0), 0.1)))
    assert len(small.repairs) == 1 and small.warnings == ()
    assert "the next one, within its bounds, has 96 %" in mesh_from(*double_skin(pear())).warnings[0]


@pytest.mark.parametrize("component", [0, 1, 2])
def test_a_piece_that_the_user_chose_needs_no_warning(component: int, tmp_path: Path) -> None:
    save_obj(tmp_path / "three.obj", three())
    assert read(tmp_path / "three.obj", component).warnings == ()
    assert "pieces" not in " ".join(check(tmp_path / "three.obj", component=component).warnings)
    (warning,) = read(tmp_path / "three.obj").warnings
    assert warning in check(tmp_path / "three.obj").warnings
    assert mesh_from(*three(), component=2).repairs == ("dropped 2 pieces beside number 2 by area (640 faces)",)


def test_check_gives_the_size_of_the_piece_that_is_taken(tmp_path: Path) -> None:
    save_obj(tmp_path / "three.obj", three())
    largest = check(tmp_path / "three.obj")
    assert largest.part_size == pytest.approx(read(tmp_path / "three.obj").size) and largest.size[0] > 18.0
    first, _, third, *_ = described(largest)
    long = max(largest.part_size)
    assert first.startswith(f"mesh      three.obj: {long:.4g} mm long") and "of all 3 pieces: 21 x 6 x 6" in third
    smallest = check(tmp_path / "three.obj", component=2)
    assert smallest.part_size == pytest.approx(np.array(largest.part_size) / 3.0)


def test_pieces_of_equal_area_are_in_the_order_of_their_centroids() -> None:
    twins = joined(moved(pear(), np.eye(3), np.array([5.0, 0, 0]), 1.0), pear())
    for part in (twins, shuffled(twins, 1), shuffled(twins, 2)):
        assert mesh_from(*part).vertices[:, 0].max() < 3 < mesh_from(*part, component=1).vertices[:, 0].min()


@pytest.mark.parametrize("component", [3, -1, 1.0, True, "1"])
def test_a_component_that_does_not_exist_is_refused(component: object) -> None:
    with pytest.raises(BadInputError, match=r"the mesh has 3 pieces; give a number from 0 to 2$"):
        mesh_from(*three(), component=component)  # type: ignore[arg-type]


def test_many_small_pieces_are_refused() -> None:
    with pytest.raises(BadInputError, match="falls apart into 1280 pieces, for its triangles do not meet; weld"):
        mesh_from(*MESHES["pear, loose by 1e-2"]())


@pytest.mark.parametrize(("ends", "start", "end"), [("loops 0 2", 0, 2), ("loops 2 0", 2, 0), ("LOOPS 1, 2", 1, 2)])
def test_ends_by_the_numbers_of_the_rims(ends: str, start: int, end: int) -> None:
    for part in (branch(), shuffled(branch()), moved(branch(), rotation(2), np.ones(3), 7.0)):
        mesh = mesh_from(*part)
        lengths = sorted((perimeter(mesh.vertices, loop) for loop in loops(mesh.faces)), reverse=True)
        found = annulus(mesh, ends)
        assert_annulus(found)
        for rim, number in zip(found.rims, (start, end), strict=True):
            assert perimeter(found.vertices, rim) == pytest.approx(lengths[number], rel=1e-12)
        assert found.ends.startswith(f"the open rims number {start} and {end}, at ")


def test_a_missing_face_is_an_end_if_requested() -> None:
    mesh = mesh_from(cone()[0], np.delete(cone()[1], 200, axis=0))
    assert len(annulus(mesh, "loops 0 2").rims[1]) == 3
    assert "filled 1 hole" in annulus(mesh).ends


@pytest.mark.parametrize(("ends", "words"), [
    ("loops 0 3", r"the part has 3 open rims, 0 to 2; `meshwind.check` lists them"),
    ("loops 1 1", "both are the same rim; give two numbers"), ("loops 1", "give auto, x, y, z or two points"),
    ("loops 0 -1", "give auto"), ("loops a b", "give auto"), ("loops 0 1 2", "or two open rims as in 'loops 0 1'"),
])  # fmt: skip
def test_numbers_of_rims_that_do_not_exist_are_refused(ends: str, words: str) -> None:
    with pytest.raises(BadInputError, match=words):
        annulus(mesh_from(*branch()), ends)


def test_loops_of_a_closed_part_are_refused() -> None:
    with pytest.raises(BadInputError, match=r"the part has no open rims; `meshwind\.check`"):
        annulus(mesh_from(*pear()), "loops 0 1")


def noticed(part: Part) -> list[str]:
    return [note for note in mesh_from(*part).repairs if note.startswith("noticed")]


def test_self_intersections_and_double_walls_are_noticed() -> None:
    first, second = noticed(MESHES["self-intersecting"]())
    assert first.startswith("noticed that the surface runs through itself: ") and "of 2848 edges" in first
    assert second.startswith("noticed a double wall: ")
    assert len(noticed(MESHES["pancake"]())) == 1


@pytest.mark.parametrize("part", [pear, cone, branch, lambda: tube(lambda z: 1e-2 + 0 * z), MESHES["stairs"]])
def test_a_sound_part_gives_no_notice(part: Callable[[], Part]) -> None:
    assert noticed(part()) == []


@pytest.mark.parametrize("value", ["part.stl", 3, None, Path("part.stl")])
def test_annulus_of_something_else_is_refused(value: object) -> None:
    with pytest.raises(BadInputError, match=r"^mesh is of type \w+; give a Mesh, as read\('part.stl'\) returns it$"):
        annulus(value)  # type: ignore[arg-type]


@pytest.mark.parametrize("value", [3, None, b"part.stl", ["part.stl"]])
def test_reading_something_else_is_refused(value: object) -> None:
    with pytest.raises(BadInputError, match=r"^mesh is of type \w+; give a path"):
        read(value)  # type: ignore[arg-type]


def test_ends_and_opening_of_other_types_are_refused() -> None:
    mesh = mesh_from(*pear())
    for ends in (3, None, ["x"]):
        with pytest.raises(BadInputError, match="give auto"):
            annulus(mesh, ends)  # type: ignore[arg-type]
    for opening in ("1", [1.0], True):
        with pytest.raises(BadInputError, match="give the radius of the hole at a pole"):
            annulus(mesh, "auto", opening)  # type: ignore[arg-type]


def write_stl(path: Path, part: Part, announced: int | None = None) -> None:
    corners = part[0][part[1]].astype("<f4").reshape(-1, 9)
    rows = np.zeros(len(corners), dtype=[("normal", "<f4", 3), ("corners", "<f4", 9), ("attribute", "<u2")])
    rows["corners"] = corners
    count = len(corners) if announced is None else announced
    path.write_bytes(b"meshwind".ljust(80) + count.to_bytes(4, "little") + rows.tobytes())


def test_a_truncated_binary_stl_says_how_many_triangles_are_missing(tmp_path: Path) -> None:
    write_stl(tmp_path / "part.stl", pear())
    assert isinstance(read(tmp_path / "part.stl"), Mesh)
    content = (tmp_path / "part.stl").read_bytes()
    (tmp_path / "part.stl").write_bytes(content[: 84 + 50 * 700 + 13])
    with pytest.raises(BadInputError) as caught:
        read(tmp_path / "part.stl")
    assert str(caught.value) == (
        "part.stl: is cut short: it announces 1280 triangles and holds 700; copy or export it again"
    )


def test_a_truncated_text_stl_is_refused(tmp_path: Path) -> None:
    facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
    (tmp_path / "part.stl").write_text("solid part\n" + 5 * facet)
    with pytest.raises(BadInputError, match="is cut short, its last line is not endsolid; copy or export it again"):
        read(tmp_path / "part.stl")


@pytest.mark.parametrize(("face", "words"), [
    ("f 1 2 9", "refers to vertex 9, but there are 4"), ("f 0 1 2", "refers to vertex 0: OBJ counts from 1"),
    ("f 1/1 2/2 0/3", "refers to vertex 0: OBJ counts from 1"),
    ("f -1 -2 -9", "refers to vertex -9: OBJ counts from 1"),
])  # fmt: skip
def test_an_obj_face_with_a_wrong_index_is_named(face: str, words: str, tmp_path: Path) -> None:
    points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    (tmp_path / "part.obj").write_text(f"# a part\n{points}f 1 3 2\nf 1 2 4\n{face}\nf 2 3 4\n")
    with pytest.raises(BadInputError) as caught:
        read(tmp_path / "part.obj")
    assert str(caught.value) == f"part.obj: face 3 in line 8 {words}; export the mesh again"


def test_obj_faces_counted_from_the_end_or_before_their_vertices_are_read(tmp_path: Path) -> None:
    vertices, faces = pear(2)
    save_obj(tmp_path / "part.obj", (vertices, faces))
    forward = read(tmp_path / "part.obj")
    save_obj(tmp_path / "part.obj", (vertices, faces - len(vertices) - 1))
    assert np.array_equal(read(tmp_path / "part.obj").faces, forward.faces)


def test_positions_are_written_to_the_precision_of_the_part() -> None:
    assert position_text(np.array([1e-17, -1e-17, 3.0]), 3.6) == "(0, 0, 3)"
    assert position_text(np.array([0.123456789, -2.0, 1e8]), 5.0) == "(0.1235, -2, 100000000)"
    assert position_text(np.array([1.23456e-40, 0, 0]), 1e-39) == "(1.2346e-40, 0, 0)"
    assert position_text(np.array([123456.7, 0, 0]), 2e5) == "(123460, 0, 0)"
