"""Cells of every kind become triangles: polygons are cut without loss, and volume cells give their skin."""

from collections import Counter
from typing import Any

import meshio
import numpy as np
import pytest
from vtkmodules.vtkCommonDataModel import vtkGenericCell

import meshwind as mw
from meshwind.core.cast import Floats, Ints
from meshwind.mesh.geometry.areas_and_volumes import areas, volume
from meshwind.mesh.io.cells.kinds import faces_of
from meshwind.mesh.io.cells.polygons import cut_polygons
from meshwind.mesh.io.cells.surface import SIDES_OF_POLYHEDRA, surface_mesh
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.vtk.cells import VTK_KINDS


def block(kind: str, rows: Any) -> Any:
    return kind, (np.array([len(row) for row in rows]), np.concatenate([np.array(row) for row in rows]))


def polyhedra(cells: Any) -> Any:
    """A block of cells, each given by its sides."""
    sides = [side for cell in cells for side in cell]
    sizes, nodes = np.array([len(side) for side in sides]), np.array([node for side in sides for node in side])
    return SIDES_OF_POLYHEDRA, (sizes, nodes, np.array([len(cell) for cell in cells]))


def directed(faces: Ints) -> Counter[tuple[int, int]]:
    return Counter((int(a), int(b)) for face in faces for a, b in zip(face, np.roll(face, -1), strict=True))


def is_closed(faces: Ints) -> bool:
    edges = directed(faces)
    return set(edges.values()) == {1} and all(edges[b, a] == 1 for a, b in edges)


def size_of(mesh: FileMesh) -> float:
    return abs(volume(mesh.vertices, mesh.faces))


def flat_area(flat: Floats) -> float:
    x, y = flat.T
    return float(abs(x @ np.roll(y, -1) - y @ np.roll(x, -1))) / 2.0


def star(count: int, rng: np.random.Generator) -> Floats:
    turn = 2.0 * np.pi * (np.arange(count) + 0.3 * rng.random(count)) / count
    return np.column_stack([np.cos(turn), np.sin(turn)]) * rng.uniform(0.1, 1.0, count)[:, None]


def comb(teeth: int) -> Floats:
    top = [corner for k in range(teeth) for corner in ((k, 5), (k + 0.5, 1))]
    return np.array([(-0.5, 0), (teeth, 0), (teeth, 1), *top[::-1]], dtype=float)


def spiral(count: int) -> Floats:
    turn = np.linspace(0.0, 4.0 * np.pi, count)
    way = np.column_stack([np.cos(turn), np.sin(turn)])
    return np.concatenate([(1 + turn)[:, None] * way, ((2.5 + turn)[:, None] * way)[::-1]])


RNG = np.random.default_rng(5)
HANGING = [
    (0, 0),
    (1, 0),
    (2, 0),
    (3, 0),
    (3, 1),
    (2, 1),
    (1, 1),
    (1, 2),
    (1, 3),
    (2, 3),
    (3, 3),
    (3, 4),
    (0, 4),
    (0, 2),
]
KEYHOLE = [(0, 0), (4, 0), (4, 4), (0, 4), (0, 0), (1, 1), (1, 3), (3, 3), (3, 1), (1, 1)]
POLYGONS = {
    "arrow": [(0, 0), (4, 2), (0, 4), (1, 2)], "hanging nodes": HANGING, "with a hole": KEYHOLE,
    "square with nodes on its sides": [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (0, 1)],
    "triangle with a node on a side": [(0, 0), (2, 0), (2, 2), (1, 1)],
    "comb": comb(9), "spiral": spiral(40), **{f"star {count}": star(count, RNG) for count in (5, 8, 30, 200)},
}  # fmt: skip


@pytest.mark.parametrize("name", POLYGONS)
def test_polygons_lose_no_area_and_no_corner(name: str) -> None:
    flat = np.array(POLYGONS[name], dtype=float)
    turned = np.linalg.qr(RNG.normal(size=(3, 3)))[0]
    for start in range(0, len(flat), max(1, len(flat) // 16)):
        ring = np.roll(np.arange(len(flat)), start)
        points = np.column_stack([flat, np.zeros(len(flat))]) @ turned + RNG.normal(size=3)
        for order in (ring, ring[::-1]):
            faces, crossed = cut_polygons(points, np.array([len(flat)]), order)
            assert crossed == 0 and len(faces) == len(flat) - 2
            assert areas(points, faces).sum() == pytest.approx(flat_area(flat), rel=1e-12)
            assert areas(points, faces).min() > 1e-9
            edges = directed(faces)
            sides = {(int(a), int(b)) for a, b in zip(order, np.roll(order, -1), strict=True)}
            assert sides <= set(edges) and set(edges.values()) == {1}  # in the sense of the polygon
            assert all((b, a) in edges for a, b in set(edges) - sides)


def test_a_concave_polygon_among_others_stays_at_its_place() -> None:
    square, arrow = np.array([(0, 0), (2, 0), (2, 2), (0, 2)]), np.array(POLYGONS["arrow"])
    points = np.column_stack([np.concatenate([square, arrow, np.array(HANGING), square]), np.zeros(26)]).astype(float)
    faces, crossed = cut_polygons(points, np.array([4, 4, 14, 3]), np.arange(25))
    assert crossed == 0 and faces[0].tolist() == [0, 1, 2] and faces[1].tolist() == [0, 2, 3]
    assert [set(part.ravel().tolist()) for part in np.split(faces, [2, 4, 16])] == [
        set(range(4)), set(range(4, 8)), set(range(8, 22)), {22, 23, 24},
    ]  # fmt: skip


@pytest.mark.parametrize("bend", [0.0, 0.5, -0.5, 1.2])
def test_warped_quads_are_cut_from_their_first_corner(bend: float) -> None:
    points = np.array([[0, 0, 0], [1, 0, bend], [1, 1, 0], [0, 1, bend]])
    mesh = surface_mesh(points, [block("quad", [[0, 1, 2, 3]])])
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3]] and mesh.warnings == ()


@pytest.mark.parametrize("flat", [
    [(0, 0), (2, 2), (2, 0), (0, 2)], [(0, 0), (3, 3), (3, 0), (0, 2)], [(0, 0), (3, 3), (3, 0), (0, 2), (-1, 1)],
    [(np.cos(0.8 * np.pi * k), np.sin(0.8 * np.pi * k)) for k in range(5)],
])  # fmt: skip
def test_polygons_that_cross_themselves_are_counted(flat: list[tuple[float, float]]) -> None:
    points = np.column_stack([flat, np.zeros(len(flat))])
    kind = "quad" if len(flat) == 4 else "polygon"
    mesh = surface_mesh(points, [block(kind, [range(len(flat))])])
    assert len(mesh.faces) == len(flat) - 2
    assert mesh.warnings == ("polygons that cross themselves are cut by a fan: 1",)


def test_repeated_corners_and_lines_are_no_loss() -> None:
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [3, 0, 0.0]])
    rows = [[0, 1, 1, 2, 3, 0], [0, 1, 4, 5], [0, 1, 0, 1], [4, 4, 4, 5]]
    mesh = surface_mesh(points, [block("polygon", rows), block("quad", [[0, 1, 2, 2]])])
    assert areas(points, mesh.faces).sum() == pytest.approx(1.5) and mesh.warnings == ()


SECOND_ORDER = [22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32, 33, 34, 37]
LINEAR = [8, 9, 10, 11, 12, 13, 14, 15, 16]


def vtk_cell(number: int) -> Floats:
    """Nodes of a cell where VTK's class for it says that they are."""
    cell = vtkGenericCell.InstantiateCell(number)
    count = cell.GetNumberOfPoints()
    points = np.array(cell.GetParametricCoords(), dtype=float).reshape(-1, 3)[:count]
    for node in range(count):
        cell.GetPointIds().SetId(node, node)
    for edge in range(cell.GetNumberOfEdges()):
        ids = cell.GetEdge(edge).GetPointIds()
        first, second, *middle = (ids.GetId(k) for k in range(ids.GetNumberOfIds()))
        points[middle] = (points[first] + points[second]) / 2.0
    return points


@pytest.mark.parametrize("number", LINEAR + SECOND_ORDER)
def test_nodes_are_where_vtk_says(number: int) -> None:
    """The middle nodes of a cell with straight sides change no area and no volume; all but an inner one are used."""
    points, kind = vtk_cell(number), VTK_KINDS[number]
    mesh = surface_mesh(points, [block(kind, [range(len(points))])])
    corners = faces_of(kind).corners
    plain = surface_mesh(points, [block(kind.rstrip("0123456789"), [range(corners.max() + 1)])])
    assert areas(points, mesh.faces).sum() == pytest.approx(areas(points, plain.faces).sum(), rel=1e-12)
    assert size_of(mesh) == pytest.approx(size_of(plain), abs=1e-15) and mesh.warnings == ()
    inner = {29: {26}, 37: {18}}.get(number, set())
    assert set(mesh.faces.ravel().tolist()) == set(range(len(points))) - inner
    assert (areas(points, mesh.faces) > 1e-3).all()
    if len(corners) > 1:
        assert is_closed(mesh.faces)


@pytest.mark.parametrize(("kind", "count"), [
    ("triangle6", 4), ("quad8", 6), ("quad9", 8), ("tetra10", 16), ("hexahedron20", 36), ("hexahedron27", 48),
    ("wedge15", 26), ("pyramid13", 22), ("quadratic polygon", 8),
])  # fmt: skip
def test_middle_nodes_are_on_the_surface(kind: str, count: int) -> None:
    size = 10 if kind == "quadratic polygon" else faces_of(kind).least
    turn = 0.4 * np.pi * np.arange(5)
    ring = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(5)])
    known = {name.removeprefix("vtk-"): number for number, name in VTK_KINDS.items()}
    pentagon = np.concatenate([ring, (ring + np.roll(ring, -1, axis=0)) / 2])
    points = pentagon if kind == "quadratic polygon" else vtk_cell(known[kind])
    points = points + RNG.normal(scale=0.01, size=points.shape)
    mesh = surface_mesh(points, [block(kind, [range(size)])])
    assert len(mesh.faces) == count and set(directed(mesh.faces).values()) == {1}


@pytest.mark.parametrize("gone", [[-1], [-1, -1, -1], [0], "all"])
def test_missing_middle_nodes(gone: Any) -> None:
    points = vtk_cell(25)
    nodes = np.arange(20)
    if gone == "all":
        nodes[8:] = -1
    else:
        nodes[8 : 8 + len(gone)] = gone
    mesh = surface_mesh(points, [block("hexahedron20", [nodes])])
    assert size_of(mesh) == pytest.approx(1.0) and is_closed(mesh.faces) and (areas(points, mesh.faces) > 1e-3).all()
    with pytest.raises(ValueError, match="a cell refers to vertex"):
        surface_mesh(points, [block("hexahedron20", [np.where(np.arange(20) == 3, -1, nodes)])])
    with pytest.raises(ValueError, match="a cell refers to vertex"):
        surface_mesh(points, [block("hexahedron20", [np.where(np.arange(20) == 19, 20, nodes)])])


def test_cells_of_first_order_beside_those_of_second() -> None:
    """They share corners: the side between them is inner, and the outer ones fit together by the middle nodes."""
    above = np.array([[0, 0, 2], [1, 0, 2], [1, 1, 2], [0, 1, 2]], dtype=float)
    points = np.concatenate([vtk_cell(25), above])
    blocks = [block("hexahedron20", [range(20)]), block("hexahedron", [[4, 5, 6, 7, 20, 21, 22, 23]])]
    mesh = surface_mesh(points, [*blocks, block("quad", [[4, 5, 6, 7], [0, 1, 2, 3]])])
    assert is_closed(mesh.faces) and size_of(mesh) == pytest.approx(2.0)
    assert mesh.warnings == ("surface cells inside the solid are left out: 1",)


def test_third_order_is_flat_in_words() -> None:
    points = np.array([[0, 0, 0], [3, 0, 0], [0, 3, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0], [1, 2, 0], [0, 2, 0],
                       [0, 1, 0], [1, 1, 0]], dtype=float)  # fmt: skip
    mesh = surface_mesh(points, [block("triangle10", [range(10)]), block("line4", [[0, 1, 3, 4]])])
    assert mesh.faces.tolist() == [[0, 1, 2]]
    assert mesh.warnings == ("1 cells of the kind 'triangle10' are taken flat between their corners",)


CUBE = np.array([[x, y, z] for z in (0, 1, 2) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], dtype=float)
LOWER, UPPER = [0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]


@pytest.mark.parametrize(("more", "words"), [
    ([block("hexahedron", [LOWER])], ""),  # the same cell twice
    ([block("voxel", [[0, 1, 3, 2, 4, 5, 7, 6]])], ""),
    ([block("quad", [[0, 1, 2, 3]])], ""),  # on the skin
    ([block("triangle", [[0, 1, 2], [2, 3, 0]])], ""),
    ([block("quad9", [[4, 7, 6, 5, 0, 0, 0, 0, 0]])], "surface cells inside the solid are left out: 1"),
    ([block("vertex", [[0], [1]]), block("line3", [[0, 1, 2]]), block("polyline", [[0, 1, 2, 3]])], ""),
    ([block("spline", [[0, 1, 2]] * 3)], "3 of 5 cells are of the kind 'spline', which is not read; left out"),
])  # fmt: skip
def test_what_is_added_to_a_solid(more: Any, words: str) -> None:
    mesh = surface_mesh(CUBE, [block("hexahedron", [LOWER, UPPER]), *more])
    assert len(mesh.faces) == 20 and is_closed(mesh.faces) and size_of(mesh) == pytest.approx(2.0)
    assert mesh.warnings == ((words,) if words else ())


def test_a_quad_side_between_two_triangles_is_inner() -> None:
    """A hexahedron beside two tetrahedra, and a polyhedron whose lid is two triangles, without pyramids between."""
    points = np.concatenate([CUBE[:8], [[0.5, 0.5, 2.0]]])
    tetrahedra = block("tetra", [[4, 5, 6, 8], [4, 6, 7, 8]])
    mesh = surface_mesh(points, [block("hexahedron", [LOWER]), tetrahedra])
    assert is_closed(mesh.faces) and size_of(mesh) == pytest.approx(4 / 3) and len(mesh.faces) == 14
    sides = polyhedra([[[4, 6, 5], [4, 7, 6], [4, 5, 8], [5, 6, 8], [6, 7, 8], [7, 4, 8]]])
    mesh = surface_mesh(points, [block("hexahedron", [LOWER]), sides])
    assert is_closed(mesh.faces) and size_of(mesh) == pytest.approx(4 / 3)


@pytest.mark.parametrize("collapsed", [[0, 1, 2, 2, 4, 5, 6, 6], [0, 1, 2, 2, 4, 4, 4, 4], [0, 1, 2, 3, 4, 4, 4, 4]])
def test_collapsed_cells(collapsed: list[int]) -> None:
    mesh = surface_mesh(CUBE, [block("hexahedron", [collapsed])])
    assert is_closed(mesh.faces) and mesh.warnings == ()
    assert size_of(mesh) == pytest.approx({6: 1 / 2, 4: 1 / 6, 5: 1 / 3}[len(set(collapsed))])
    beside = surface_mesh(CUBE, [block("hexahedron", [collapsed, UPPER])]) if len(set(collapsed)) == 6 else mesh
    assert beside.faces.min() >= 0


def test_sides_of_more_than_two_cells_are_named() -> None:
    points = np.concatenate([CUBE[:8], [[0.5, 0.5, 2], [0.5, 0.5, 3]]])
    blocks = [block("hexahedron", [LOWER]), block("pyramid", [[4, 5, 6, 7, 8], [4, 5, 6, 7, 9]])]
    assert surface_mesh(points, blocks).warnings == (
        "sides that more than two volume cells share are taken as inside: 1",
    )


def test_polyhedra_with_large_sides_beside_prisms() -> None:
    turn = 2.0 * np.pi * np.arange(6) / 6
    rows = [np.column_stack([np.cos(turn), np.sin(turn), np.full(6, z)]) for z in (0.0, 1.0, 2.0)]
    sides = [[6 + k, 6 + (k + 1) % 6, 12 + (k + 1) % 6, 12 + k] for k in range(6)]
    polyhedron = polyhedra([[*sides, range(11, 5, -1), range(12, 18)]])
    mesh = surface_mesh(np.concatenate(rows), [block("hexagonal prism", [range(12)]), polyhedron])
    assert is_closed(mesh.faces) and size_of(mesh) == pytest.approx(3.0 * np.sqrt(3.0))


SIDES = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
"""Of the lower of the two cubes."""
ABOVE = [[UPPER[k] for k in side] for side in SIDES]
TURNED = [side[1:] + side[:1] for side in SIDES[::-1]]


@pytest.mark.parametrize("blocks", [
    [polyhedra([SIDES, ABOVE, SIDES])],
    [polyhedra([SIDES, SIDES, TURNED, ABOVE, ABOVE])],
    [polyhedra([SIDES]), block("hexahedron", [UPPER]), polyhedra([TURNED, ABOVE])],
    [block("hexahedron", [LOWER, UPPER]), polyhedra([SIDES, TURNED])],
    [polyhedra([[*SIDES, [0, 1], []], ABOVE, [], [[2, 3]], SIDES])],  # sides without area
], ids=["twice", "turned", "among others", "of a hexahedron", "without area"])  # fmt: skip
def test_polyhedra_that_are_given_twice_count_once(blocks: Any) -> None:
    mesh = surface_mesh(CUBE, blocks)
    assert len(mesh.faces) == 20 and is_closed(mesh.faces) and size_of(mesh) == pytest.approx(2.0)
    assert mesh.warnings == ()


def test_polyhedra_of_the_same_corners_are_no_copies() -> None:
    """Two prisms on the same six corners that share three sides of five; neither is the other."""
    turn = 2.0 * np.pi * np.arange(3) / 3
    points = np.concatenate([np.column_stack([np.cos(turn), np.sin(turn), np.full(3, z)]) for z in (0.0, 1.0)])
    prisms = [[[a, c, b], [d, e, f], [a, b, e, d], [b, c, f, e], [c, a, d, f]]
              for a, b, c, d, e, f in ((0, 1, 2, 3, 4, 5), (0, 1, 5, 3, 4, 2))]  # fmt: skip
    assert len(surface_mesh(points, [polyhedra(prisms)]).faces) == 4


@pytest.mark.parametrize("first", range(6))
@pytest.mark.parametrize("below", ["wedges", "hexahedra", "mixed"])
def test_a_large_side_on_several_smaller_ones_is_inner(below: str, first: int) -> None:
    turn = 2.0 * np.pi * np.arange(6) / 6
    rows = [np.column_stack([np.cos(turn), np.sin(turn), np.full(6, z)]) for z in (0.0, 1.0, 2.0)]
    sides = [[6 + k, 6 + (k + 1) % 6, 12 + (k + 1) % 6, 12 + k] for k in range(6)]
    ends = [[start + (k + first) % 6 for k in range(6)][::step] for start, step in ((6, -1), (12, 1))]
    every: dict[str, list[tuple[int, ...]]] = {
        "wedges": [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)],
        "hexahedra": [(0, 1, 2, 3), (0, 3, 4, 5)],
        "mixed": [(1, 2, 3), (1, 3, 4), (0, 1, 4, 5)],
    }
    blocks = [polyhedra([[*sides, *ends]])]
    for part in every[below]:
        kind = "wedge" if len(part) == 3 else "hexahedron"
        blocks.append(block(kind, [[*part, *(6 + k for k in part)]]))
    mesh = surface_mesh(np.concatenate(rows), blocks)
    assert is_closed(mesh.faces) and mesh.warnings == ()
    assert size_of(mesh) == pytest.approx(3.0 * np.sqrt(3.0))


def test_very_many_large_sides_at_one_node_take_no_memory_beyond_bounds() -> None:
    turn = np.linspace(0.0, 2.0 * np.pi, 80_001)
    ring = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(len(turn))])
    first = np.arange(1, 80_001, 4)[:, None]
    sides = np.column_stack([np.zeros(20_000, dtype=int), first + np.arange(4)])
    block = (SIDES_OF_POLYHEDRA, (np.full(20_000, 5), sides.ravel(), np.ones(20_000, dtype=int)))
    mesh = surface_mesh(np.concatenate([[[0.0, 0.0, 1.0]], ring]), [block])
    assert len(mesh.faces) == 60_000


def test_smaller_sides_that_leave_a_gap_do_not_cover_a_large_one() -> None:
    turn = 2.0 * np.pi * np.arange(6) / 6
    rows = [np.column_stack([np.cos(turn), np.sin(turn), np.full(6, z)]) for z in (0.0, 1.0, 2.0)]
    sides = [[6 + k, 6 + (k + 1) % 6, 12 + (k + 1) % 6, 12 + k] for k in range(6)]
    polyhedron = polyhedra([[*sides, range(11, 5, -1), range(12, 18)]])
    wedges = block("wedge", [[0, a, b, 6, 6 + a, 6 + b] for a, b in ((1, 2), (2, 3), (3, 4))])
    mesh = surface_mesh(np.concatenate(rows), [polyhedron, wedges])
    assert len(mesh.faces) == 2 * 4 + 6 * 2 + 2 * 3 + 5 * 2


def test_strips_keep_their_sense() -> None:
    points = np.array([[k // 2, k % 2, 0] for k in range(9)], dtype=float)
    blocks = [block("triangle strip", [range(8), [8, 7, 6], [0, 1]]), block("triangle", [[0, 2, 1]])]
    mesh = surface_mesh(points, blocks)
    a, b, c = (points[mesh.faces[:6, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    assert len(mesh.faces) == 8 and (normals[:, 2] == -1.0).all()


@pytest.mark.parametrize(("blocks", "says"), [
    ([block("spline", [[0, 1, 2]] * 3), block("line", [[0, 1]])], "its 3 cells are of kinds that are not read: spline"),
    ([block("hexahedron", [[0, 1, 2, 3]])], "hexahedron cells have the wrong number of nodes"),
    ([block("triangle", [[0, 1, 99]])], "a cell refers to vertex 99, counted from 0, but there are 12"),
    ([block("polygon", [[0, 1, 2, -1]])], "a cell refers to vertex -1, counted from 0"),
    ([block("triangle strip", [[0, 1, 2, 12]])], "a cell refers to vertex 12, counted from 0"),
    ([block("quadratic polygon", [[0, 1, 2, 4, 5]])], "polygons of second order have an odd number of nodes"),
])  # fmt: skip
def test_what_is_refused(blocks: Any, says: str) -> None:
    with pytest.raises(ValueError, match=says):
        surface_mesh(CUBE, blocks)


def test_a_block_of_many_cells() -> None:
    count = 12
    i, j, k = (each.ravel() for each in np.meshgrid(*[np.arange(count)] * 3, indexing="ij"))
    base, m = (i * (count + 1) + j) * (count + 1) + k, count + 1
    cells = np.column_stack([base + x * m * m + y * m + z for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))])
    points = np.stack(np.meshgrid(*[np.arange(m, dtype=float)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    mesh = surface_mesh(points, [("hexahedron", (np.full(len(cells), 8), cells.ravel()))])
    assert is_closed(mesh.faces) and len(mesh.faces) == 12 * count**2 and size_of(mesh) == pytest.approx(count**3)


def test_polygons_and_polyhedra_of_meshio() -> None:
    sides = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
    solid = meshio.Mesh(CUBE, [("polyhedron6", [sides]), ("hexahedron", np.array([UPPER]))])
    mesh = mw.read(solid)
    assert volume(mesh.vertices, mesh.faces) == pytest.approx(2.0) and len(mesh.faces) == 20
    flat = mw.read(meshio.Mesh(CUBE, [("polygon", [[0, 1, 2, 3], [2, 1, 5, 6]]), ("polygon", np.array([[5, 4, 1]]))]))
    assert areas(flat.vertices, flat.faces).sum() == pytest.approx(2.5)
