"""The eye as a box or a mesh: where the axes turn it, and whether it meets the part."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from program_parts import work
from program_random import closed
from scipy.spatial.transform import Rotation

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.mesh.geometry.facet_tree import FacetTree
from meshwind.program.head import Head, frames, head_of, meets
from meshwind.program.machine import Eye, Machine, machine_of, read_machine
from meshwind.program.program import program
from meshwind.surface.grid import grid

LATHE = read_machine("lathe-4")
BOX = (30.0, 16.0, 10.0)


def with_eye(**eye: object) -> Machine:
    return replace(LATHE, eye=Eye(**eye))  # type: ignore[arg-type]


def body(**eye: object) -> Head:
    found = head_of(with_eye(**eye), 1.0)
    assert found is not None
    return found


def ball_of_triangles(radius: float) -> FacetTree:
    """A sphere of triangles, closed over its two small openings."""
    return FacetTree.of(*closed(grid(mw.shapes.sphere_band(radius, 0.05, 3.09, (48, 32)))))


def test_the_axes_turn_the_eye_onto_the_span() -> None:
    made = program(work(mw.shapes.ellipsoid(50.0, 40.0, 90.0, 0.5, 2.4, (24, 16))), LATHE)
    b, m = made.blocks, made.mandrel
    whole = frames(b, m, read_machine("lathe-5"))
    assert np.abs(np.swapaxes(whole, 1, 2) @ whole - np.eye(3)).max() < 1e-12
    assert np.linalg.det(whole) == pytest.approx(1.0)
    assert whole[:, :, 0] == pytest.approx(b.tangent, abs=1e-9)
    rolled, fixed = frames(b, m, LATHE), frames(b, m, read_machine("lathe-3"))
    e_r = m.frame[1:].T @ (m.inside(b.eye)[:, 1:] / b.eye_r[:, None]).T
    assert rolled[:, :, 2] == pytest.approx(e_r.T, abs=1e-9)
    flat = b.tangent - (b.tangent * e_r.T).sum(axis=1)[:, None] * e_r.T
    assert rolled[:, :, 0] == pytest.approx(flat / np.linalg.norm(flat, axis=1)[:, None], abs=1e-9)
    assert fixed[:, :, 1] == pytest.approx(np.broadcast_to(m.direction, b.point.shape), abs=1e-12)


def distance_to_box(points: Floats) -> Floats:
    """Distances (n,) of points in the eye's frame to its box."""
    middle, half = np.array([0.5 * BOX[0], 0.0, 0.0]), 0.5 * np.array(BOX)
    return np.asarray(np.linalg.norm(np.maximum(np.abs(points - middle) - half, 0.0), axis=1))


@pytest.mark.parametrize("radius", [8.0, 40.0])
def test_a_box_meets_a_sphere_where_it_is_nearer_than_its_radius(radius: float) -> None:
    """Corners, edges and faces of the box are met, as well as a sphere within the box and a box within the sphere."""
    random = np.random.default_rng(4)
    count = 600
    turned = Rotation.random(count, random_state=5).as_matrix()
    eyes = random.normal(size=(count, 3))
    eyes *= (random.uniform(0.0, radius + 40.0, count) / np.linalg.norm(eyes, axis=1))[:, None]
    # the sphere's middle, seen from the eye
    away = distance_to_box(-np.einsum("nji,nj->ni", turned, eyes))
    found = meets(body(box=BOX), ball_of_triangles(radius), eyes, turned)
    sag = 0.01 * radius
    assert found[away < radius - sag].all()
    assert not found[away > radius].any()
    assert 0.2 < found.mean() < 0.9


def test_what_is_wholly_inside_is_found() -> None:
    sphere, still = ball_of_triangles(100.0), np.eye(3)[None]
    assert meets(body(box=BOX), sphere, np.array([[5.0, 3.0, 1.0]]), still).all()
    assert meets(body(box=(900.0, 900.0, 900.0)), sphere, np.array([[-400.0, 0.0, 0.0]]), still).all()
    assert not meets(body(box=BOX), sphere, np.array([[101.0, 0.0, 0.0]]), still).any()


def test_a_box_that_goes_through_the_middle_of_a_large_triangle_is_found() -> None:
    large = body(box=(900.0, 900.0, 900.0))
    block = FacetTree.of(large.vertices, large.faces)
    still = np.broadcast_to(np.eye(3), (2, 3, 3))
    found = meets(body(box=BOX), block, np.array([[-10.0, 200.0, 50.0], [-31.0, 200.0, 50.0]]), still)
    assert found.tolist() == [True, False]


def write_obj(file: Path, vertices: Floats, faces: np.ndarray) -> None:
    file.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in vertices)
                    + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in faces))  # fmt: skip


def test_a_mesh_of_the_box_is_the_box(tmp_path: Path) -> None:
    box = body(box=BOX)
    write_obj(tmp_path / "eye.obj", box.vertices, box.faces)
    machine = machine_of(table(eye={"mesh": "eye.obj"}), str(tmp_path / "mine.toml"))
    assert machine.eye.mesh == str(tmp_path / "eye.obj")
    mesh = head_of(machine, 1.0)
    assert mesh is not None
    assert np.sort(mesh.vertices, axis=0) == pytest.approx(np.sort(box.vertices, axis=0))
    waist = work(mw.shapes.hyperboloid(15.0, 1.0, 60.0, (24, 16)), 1, 0.6, 0.2)
    told = [
        {fault.index for fault in program(waist, replace(each, clearance=6.0)).faults if fault.kind == "eye"}
        for each in (with_eye(box=BOX), replace(LATHE, eye=machine.eye))
    ]
    assert told[0] == told[1]
    inches = head_of(machine, 25.4)
    assert inches is not None
    assert inches.radius == pytest.approx(mesh.radius / 25.4)


def test_an_eye_that_meets_the_part_or_the_shaft_is_a_fault() -> None:
    """A box 150 wide along the roller beside a cylinder of which only the shaft reaches beyond the end."""
    convex = work(mw.shapes.sphere_band(50.0, 0.3, 2.8, (24, 16)), 1, 0.9, 0.3)
    clear = program(convex, replace(LATHE, eye=Eye(box=(5.0, 5.0, 5.0))))
    assert not clear.faults
    # it reaches inwards by half of its 60 mm, more than the clearance
    wide = program(convex, replace(LATHE, clearance=4.0, eye=Eye(box=(5.0, 5.0, 60.0))))
    assert {fault.kind for fault in wide.faults} == {"eye"}
    assert any(words.startswith("a longer span") for words in wide.remedies)
    b, m = wide.blocks, wide.mandrel
    turned = frames(b, m, LATHE)
    inner = b.eye - 30.0 * turned[:, :, 2]  # its lower face touches or not
    told = {fault.index for fault in wide.faults}
    deep = np.linalg.norm(inner, axis=1) < 49.5
    assert deep.any()
    band = np.abs(inner[:, 2]) < 45.0
    assert set(np.flatnonzero(deep & band)) <= told


def table(**more: object) -> dict[str, object]:
    """A machine of two axes as a table."""
    each = {"speed": 100.0, "acceleration": 100.0}
    return {
        "axes": [{"moves": "mandrel", "letter": "A", **each}, {"moves": "carriage", "letter": "X", **each}], **more
    }  # fmt: skip


@pytest.mark.parametrize(("eye", "words"), [
    (3.0, "give a table [eye] with ball, box or mesh"),
    ({"bal": 3.0}, "has no 'bal'; did you mean 'ball'"),
    ({"ball": -1.0}, "give a radius of at least 0"),
    ({"ball": 2.0, "box": [1.0, 1.0, 1.0]}, "give one of ball, box and mesh"),
    ({"box": 3.0}, "give a list of numbers"),
    ({"box": [1.0, 2.0]}, "give 3 lengths above 0"),
    ({"box": [1.0, 2.0, "a"]}, "give 3 lengths above 0"),
    ({"box": [1.0, 2.0, 0.0]}, "give 3 lengths above 0"),
    ({"mesh": 3}, "give text in quotes"),
    ({"mesh": "none.stl"}, "where there is no file"),
])  # fmt: skip
def test_a_wrong_eye_is_told_in_one_line(eye: object, words: str, tmp_path: Path) -> None:
    with pytest.raises(BadInputError) as error:
        machine_of(table(eye=eye), str(tmp_path / "mine.toml"))
    assert words in str(error.value)
    assert "\n" not in str(error.value)


def test_a_mesh_that_is_no_body_is_told_in_one_line(tmp_path: Path) -> None:
    box = body(box=BOX)
    write_obj(tmp_path / "open.obj", box.vertices, box.faces[:-2])
    with pytest.raises(BadInputError, match="has open edges; give a closed one"):
        body(mesh=str(tmp_path / "open.obj"))
    two = np.concatenate([box.vertices, box.vertices + 100.0])
    write_obj(tmp_path / "two.obj", two, np.concatenate([box.faces, box.faces + 8]))
    with pytest.raises(BadInputError, match="give one closed piece"):
        body(mesh=str(tmp_path / "two.obj"))
