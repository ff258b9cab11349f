"""What must not move of a mesh, and how far the rest may: fields, boxes and picked faces, vertex by vertex."""

from pathlib import Path

import meshio
import numpy as np
import pytest
from sample_parts import shapes as shapes_of_parts
from sample_parts.mesher import Part, triangulate

import meshwind as mw
from meshwind.editing.bound import Bound, bound_of
from meshwind.editing.edit import edit
from meshwind.editing.edited_mesh import displacement
from meshwind.editing.frozen_part import frozen_part
from meshwind.editing.options import EditOptions
from meshwind.editing.redesign import redesign
from meshwind.editing.region import parse
from meshwind.mesh import mesh_from
from meshwind.surface import Surface, shapes
from meshwind.workflow.options import Options

VASE = mesh_from(*triangulate(Part("vase.stl", shapes_of_parts.vase, closed=False, vertices=1200), 0))
"""The vase of the sample parts with fewer vertices: its programs are a tenth as large."""
MIDDLE = VASE.vertices[:, 2].min() + 0.5 * np.ptp(VASE.vertices[:, 2])
BOX = f"x>0 & y>0 & {MIDDLE - 20:.6f}<z<{MIDDLE + 20:.6f}"


def in_box(points: np.ndarray) -> np.ndarray:
    return (points[:, 0] > 0) & (points[:, 1] > 0) & (np.abs(points[:, 2] - MIDDLE) < 20 - 1e-6)


@pytest.fixture(scope="module")
def with_fields(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The vase with a field of its points that is 1 in a box, and one of its cells that grows from bottom to top."""
    file = tmp_path_factory.mktemp("fields") / "vase.vtu"
    centres = VASE.vertices[VASE.faces].mean(axis=1)
    grown = 0.2 + 4.0 * (centres[:, 2] - VASE.vertices[:, 2].min()) / np.ptp(VASE.vertices[:, 2])
    mesh = meshio.Mesh(
        VASE.vertices, [("triangle", VASE.faces)],
        point_data={"held": in_box(VASE.vertices).astype(float)}, cell_data={"room": [grown]},
    )  # fmt: skip
    meshio.write(file, mesh)
    return file


def moved(part: mw.Mesh | Path, **options: object) -> np.ndarray:
    found = redesign(part, revolutions=0.3, paths=4, particles=101, rounds=1, **options)  # type: ignore[arg-type]
    return found.displacement


@pytest.mark.parametrize("how", ["box", "field", "faces", "list"])
def test_frozen_vertices_move_by_exactly_0_and_others_move(how: str, with_fields: Path, tmp_path: Path) -> None:
    picked = np.flatnonzero(in_box(VASE.vertices)[VASE.faces].all(axis=1))
    (tmp_path / "picked.txt").write_text("\n".join(map(str, picked)), encoding="utf-8")
    words = {
        "box": BOX,
        "field": "field:held",
        "faces": ", ".join(f"faces:{k}" for k in picked[:40]) + f", faces:{picked[40]}-{picked[40]}",
        "list": f"faces:{tmp_path / 'picked.txt'}",
    }
    part = with_fields if how == "field" else VASE
    moves = moved(part, frozen=words[how])
    still = in_box(VASE.vertices if how != "field" else mw.read(with_fields).vertices)
    if how in ("faces", "list"):
        still = np.zeros(len(VASE.vertices), dtype=bool)
        still[VASE.faces[picked if how == "list" else picked[:41]]] = True
    assert still.sum() > 20
    assert (moves[still] == 0.0).all()
    assert np.linalg.norm(moves, axis=1).max() > 3.0
    edges = VASE.faces[still[VASE.faces].any(axis=1)]  # nor is there a tear: what lies next to it hardly moves
    assert np.linalg.norm(moves[edges], axis=2).max() < 0.1 * np.linalg.norm(moves, axis=1).max()


def test_no_vertex_moves_further_than_its_own_bound(with_fields: Path) -> None:
    part = mw.read(with_fields)
    moves = moved(with_fields, bound="field:room")
    size = np.linalg.norm(moves, axis=1)
    room = 0.2 + 4.0 * (part.vertices[:, 2] - part.vertices[:, 2].min()) / np.ptp(part.vertices[:, 2])
    slack = 4.0 * 5.0 / np.ptp(part.vertices[:, 2])  # centres of cells lie so far from corners
    assert (size <= room + slack).all() and size.max() > 1.0
    assert (size > 0.8 * room).any()


def test_a_bound_for_each_vertex_holds_exactly_and_0_lets_nothing_move() -> None:
    bound = np.where(VASE.vertices[:, 0] > 0.0, 0.0, 2.0)
    size = np.linalg.norm(moved(VASE, bound=bound), axis=1)
    assert (size[bound == 0.0] == 0.0).all()
    assert (size <= bound * (1 + 1e-12)).all() and size.max() > 1.9


def test_a_bound_of_a_surface_is_that_of_the_vertices_that_hang_on_it() -> None:
    chart = mw.flatten(mw.annulus(VASE))
    surface = mw.fit(chart, 1e-4)
    each = 1.0 + np.random.default_rng(4).uniform(size=len(VASE.vertices))
    bound = Bound(each).on(surface, chart)
    assert isinstance(bound, np.ndarray)
    direction = np.random.default_rng(5).standard_normal(surface.control_points.shape)
    direction /= np.linalg.norm(direction, axis=2, keepdims=True)
    change = direction * bound.reshape(direction.shape[:2])[..., None]
    moves = displacement(chart, surface, Surface(surface.control_points + change))
    size = np.linalg.norm(moves, axis=1)
    assert (size <= each * (1 + 1e-12)).all()
    assert bound.min() == pytest.approx(each.min(), rel=0.05) and bound.max() > bound.min()


def test_a_field_of_one_value_is_the_same_as_the_number() -> None:
    surface = shapes.hyperboloid(1.0, 0.6, 1.5, (16, 16))
    many = np.full(surface.control_points.size // 3, 0.1)
    one, field = (edit(surface, Options(8, 0.0, 61), EditOptions(bound=each, rounds=2)) for each in (0.1, many))
    assert (one.surface.control_points == field.surface.control_points).all()


def test_a_part_that_is_held_by_a_bound_of_0_says_so() -> None:
    surface = shapes.hyperboloid(1.0, 0.6, 1.5, (16, 16))
    bound = np.full(surface.control_points.shape[:2], np.inf)
    bound[:, 3:-3] = 0.0
    found = edit(surface, Options(8, 0.0, 61), EditOptions(bound=bound.ravel(), rounds=1))
    assert found.left and all("a bound of 0" in each.held_by for each in found.left)


def test_boxes_and_faces_are_read() -> None:
    region = parse("0<x<1 & z>2, v<0.1, faces:3-5, faces:9")
    assert [len(box) for box in region.boxes] == [2, 1] and region.faces.tolist() == [3, 4, 5, 9]
    points = np.array([[0.5, 0.0, 3.0], [0.5, 0.0, 1.0], [2.0, 0.0, 3.0], [2.0, 0.0, 1.0]])
    uv = np.array([[0.0, 0.5]] * 3 + [[0.0, 0.05]])
    assert region.contains(uv, points, None).tolist() == [True, False, False, True]


@pytest.mark.parametrize("text", ["faces:", "faces:7-3", "x>0 & ", "faces:no such file"])
def test_what_names_no_region_is_refused(text: str) -> None:
    with pytest.raises(mw.BadInputError, match="give ranges"):
        parse(text)


def test_what_does_not_fit_the_mesh_is_refused() -> None:
    with pytest.raises(mw.BadInputError, match="give numbers from 0 to"):
        frozen_part(f"faces:{len(VASE.faces)}", VASE, VASE)
    opened = mw.annulus(VASE)
    with pytest.raises(mw.BadInputError, match=f"one for each of {len(VASE.vertices)} vertices"):
        bound_of(np.ones(3), VASE, VASE, opened)
    with pytest.raises(mw.BadInputError, match="negative or NaN"):
        bound_of(np.full(len(VASE.vertices), -1.0), VASE, VASE, opened)
    with pytest.raises(mw.BadInputError, match="0 everywhere"):
        bound_of(np.zeros(len(VASE.vertices)), VASE, VASE, opened)
    with pytest.raises(mw.BadInputError, match="give a length"):
        EditOptions(bound="far")
