"""MSH files of all versions, as text and binary, in both byte orders, are read whole or refused in words."""

import re
import struct
from itertools import product
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest

import meshwind as mw
from meshwind.core.errors import BadInputError
from meshwind.mesh.geometry.areas_and_volumes import areas, volume
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.msh.elements import TYPES
from meshwind.mesh.io.read import load

AROUND = 10
TURN = 2.0 * np.pi * np.arange(AROUND) / AROUND
POINTS = np.concatenate([np.column_stack([r * np.cos(TURN), r * np.sin(TURN), np.full(AROUND, z)])
                         for r, z in ((20.0, 0.0), (23.0, 30.0), (22.0, 70.0))])  # fmt: skip
QUADS = [[k * AROUND + i, k * AROUND + (i + 1) % AROUND, (k + 1) * AROUND + (i + 1) % AROUND, (k + 1) * AROUND + i]
         for k in range(2) for i in range(AROUND)]  # fmt: skip
TRIANGLES = [face for q in QUADS[:6] for face in ([q[0], q[1], q[2]], [q[0], q[2], q[3]])]
FACES = np.array(TRIANGLES + [face for q in QUADS[6:] for face in ([q[0], q[1], q[2]], [q[0], q[2], q[3]])])
AREA = float(areas(POINTS, FACES).sum())
Elements = list[tuple[int, list[list[int]]]]
BARREL: Elements = [(15, [[0]]), (1, [[0, 1], [1, 2]]), (2, TRIANGLES), (3, QUADS[6:])]


class Writer:
    """Numbers as text or bytes."""

    def __init__(self, order: str) -> None:
        self.order, self.parts = order, list[bytes]()

    def put(self, kinds: str, *values: Any) -> None:
        """A row: i for whole numbers of four bytes, n for sizes, d for coordinates."""
        if self.order:
            self.parts.append(struct.pack(self.order + kinds.replace("n", "Q"), *values))
        else:
            words = [repr(float(v)) if k == "d" else str(v) for k, v in zip(kinds, values, strict=True)]
            self.parts.append((" ".join(words) + "\n").encode())

    def line(self, text: str) -> None:
        self.parts.append(text.encode() + b"\n")


def msh(version: str, order: str = "", elements: Elements = BARREL, points: Any = POINTS, first: int = 1, step: int = 1,
        parametric: bool = False, more: str = "") -> bytes:  # fmt: skip
    """A file; order: "" for text, "<" or ">" for binary; first, step: numbers of the nodes."""
    out = Writer(order)
    tags = [first + step * k for k in range(len(points))]
    count = sum(len(rows) for _, rows in elements)
    total = list(enumerate((kind, [tags[node] for node in row]) for kind, rows in elements for row in rows))
    if version != "1":
        out.line(f"$MeshFormat\n{version} {1 if order else 0} 8")
        if order:
            out.parts.append(struct.pack(order + "i", 1) + b"\n")
        out.line("$EndMeshFormat" + more)
    name = "NOD" if version == "1" else "ParametricNodes" if parametric and version[0] == "2" else "Nodes"
    out.line(f"${name}")
    if version[0] == "4":
        _by_entity(out, version, elements, tags, points, parametric)
    else:
        out.line(str(len(points)))
        for tag, point in zip(tags, points, strict=True):
            out.put("iddd" + ("iid" if name == "ParametricNodes" else ""), tag, *point,
                    *([1, 1, 0.5] if name == "ParametricNodes" else []))  # fmt: skip
        out.line(f"\n$ENDNOD\n$ELM\n{count}" if version == "1" else f"\n$End{name}\n$Elements\n{count}")
        for number, (kind, nodes) in total:
            head = [number + 1, kind, 1, 1, len(nodes)] if version == "1" else [number + 1, kind, 2, 7, 7]
            if order:
                head = [kind, 1, 2, number + 1, 7, 7]
            out.put("i" * (len(head) + len(nodes)), *head, *nodes)
        out.line("\n$ENDELM" if version == "1" else "\n$EndElements")
    return b"".join(out.parts)


def _by_entity(out: Writer, version: str, elements: Elements, tags: list[int], points: Any, parametric: bool) -> None:
    old, half, number = version == "4.0", len(points) // 2, 0
    out.put("nn" if old else "nnnn", 3, len(points), *([] if old else [min(tags), max(tags)]))
    for dimension, part in ((0, range(1)), (2, range(1, half)), (1, range(half, len(points)))):
        own = [0.5] * dimension if parametric else []
        out.put("iiin", *([1, dimension] if old else [dimension, 1]), int(parametric), len(part))
        if not old:
            for k in part:
                out.put("n", tags[k])
        for k in part:
            out.put("i" * old + "ddd" + "d" * len(own), *([tags[k]] if old else []), *points[k], *own)
    out.line("\n$EndNodes\n$Elements")
    count = sum(len(rows) for _, rows in elements)
    out.put("nn" if old else "nnnn", len(elements), count, *([] if old else [1, count]))
    for kind, rows in elements:
        out.put("iiin", *([1, 2] if old else [2, 1]), kind, len(rows))
        for row in rows:
            number += 1
            out.put(("i" if old else "n") * (1 + len(row)), number, *(tags[node] for node in row))
    out.line("\n$EndElements")


def read(folder: Path, content: bytes) -> FileMesh:
    (folder / "part.msh").write_bytes(content)
    return load(folder / "part.msh")


def refusal(folder: Path, content: bytes) -> str:
    with pytest.raises(BadInputError) as caught:
        read(folder, content)
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 400
    return str(caught.value)


def is_barrel(held: FileMesh) -> bool:
    return len(held.faces) == 40 and areas(held.vertices, held.faces).sum() == pytest.approx(AREA, rel=1e-12)


WAYS = [("1", ""), *product(("2", "2.2", "4.0", "4.1"), ("", "<", ">"))]


@pytest.mark.parametrize(("version", "order"), WAYS)
@pytest.mark.parametrize(("first", "step"), [(1, 1), (0, 1), (1000, 7), (5, 10_000)])
def test_every_version(version: str, order: str, first: int, step: int, tmp_path: Path) -> None:
    held = read(tmp_path, msh(version, order, first=first, step=step))
    assert is_barrel(held) and held.warnings == () and held.units == ""


@pytest.mark.parametrize(("version", "order"), WAYS[1:])
def test_nodes_with_coordinates_on_their_entity(version: str, order: str, tmp_path: Path) -> None:
    assert is_barrel(read(tmp_path, msh(version, order, parametric=True)))


@pytest.mark.parametrize("version", ["1", "2.2", "4.0", "4.1"])
def test_windows_line_ends(version: str, tmp_path: Path) -> None:
    assert is_barrel(read(tmp_path, msh(version).replace(b"\n", b"\r\n")))


@pytest.mark.parametrize("order", ["", "<"])
def test_other_sections_are_left_alone(order: str, tmp_path: Path) -> None:
    more = ('\n$PhysicalNames\n1\n2 1 "skin $Nodes"\n$EndPhysicalNames\n$Comments\nof Gmsh\n$EndComments'
            "\n$PartitionedEntities\n2\n0\n0 0 0 0\n$EndPartitionedEntities\n$Periodic\n0\n$EndPeriodic"
            "\n$NodeData\n1\n\"s\"\n$EndNodeData\n$NodeData\n1\n\"t\"\n$EndNodeData")  # fmt: skip
    assert is_barrel(read(tmp_path, msh("4.1", order, more=more)))


def test_elements_in_several_groups_count_once(tmp_path: Path) -> None:
    cube = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], dtype=float)
    elements: Elements = [(5, [list(range(8))]), (3, [[0, 1, 2, 3]]), (5, [list(range(8))]), (3, [[0, 1, 2, 3]])]
    for version, order in WAYS:
        (tmp_path / "part.msh").write_bytes(msh(version, order, elements, cube))
        mesh = mw.read(tmp_path / "part.msh")
        assert len(mesh.faces) == 12 and volume(mesh.vertices, mesh.faces) == pytest.approx(1.0)


SECOND: dict[int, tuple[str, Any]] = {9: ("triangle6", [(0, 1), (1, 2), (2, 0)]),
          16: ("quad8", [(0, 1), (1, 2), (2, 3), (3, 0)]),
          11: ("tetra10", [(0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3)]),
          17: ("hexahedron20", [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6),
                                (6, 7)]),
          18: ("wedge15", [(0, 1), (0, 2), (0, 3), (1, 2), (1, 4), (2, 5), (3, 4), (3, 5), (4, 5)]),
          19: ("pyramid13", [(0, 1), (0, 3), (0, 4), (1, 2), (1, 4), (2, 3), (2, 4), (3, 4)])}  # fmt: skip
MORE: dict[int, tuple[int, Any]] = {
    10: (16, [(0, 1, 2, 3)]),
    13: (18, [(0, 1, 4, 3), (0, 2, 5, 3), (1, 2, 5, 4)]),
    14: (19, [(0, 1, 2, 3)]),
    12: (17, [(0, 1, 2, 3), (0, 1, 5, 4), (0, 3, 7, 4), (1, 2, 6, 5), (2, 3, 7, 6), (4, 5, 6, 7), tuple(range(8))]),
}
"""Nodes amid edges and faces as the manual of Gmsh draws them ("Node ordering")."""
CORNERS = {"triangle6": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "quad8": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
           "tetra10": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
           "hexahedron20": [[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))],
           "wedge15": [[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (0, 1))],
           "pyramid13": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 1]]}  # fmt: skip


@pytest.mark.parametrize("number", [*SECOND, *MORE])
@pytest.mark.parametrize("version", ["2.2", "4.1"])
def test_nodes_of_second_order(number: int, version: str, tmp_path: Path) -> None:
    """The nodes amid straight sides change nothing, and each is used at its place."""
    kind, amid = SECOND[MORE[number][0] if number in MORE else number]
    corners = np.array(CORNERS[kind], dtype=float)
    places = [list(each) for each in amid] + [list(each) for each in (MORE[number][1] if number in MORE else [])]
    points = np.concatenate([corners, [corners[each].mean(axis=0) for each in places]])
    linear = {"triangle6": 2, "quad8": 3, "tetra10": 4, "hexahedron20": 5, "wedge15": 6, "pyramid13": 7}[kind]
    plain = read(tmp_path, msh("2.2", "", [(linear, [list(range(len(corners)))])], corners))
    held = read(tmp_path, msh(version, "", [(number, [list(range(len(points)))])], points))
    assert held.warnings == () and len(set(held.faces.ravel().tolist())) == len(points) - (number == 12)
    assert areas(held.vertices, held.faces).sum() == pytest.approx(areas(plain.vertices, plain.faces).sum(), rel=1e-12)
    solid, flat = volume(held.vertices, held.faces), volume(plain.vertices, plain.faces)
    assert solid == pytest.approx(flat, abs=1e-14)


def test_third_order_is_taken_flat_in_words(tmp_path: Path) -> None:
    points = np.concatenate([np.array(CORNERS["triangle6"], dtype=float), np.zeros((7, 3))])
    held = read(tmp_path, msh("4.1", "<", [(21, [list(range(10))])], points))
    assert held.warnings == ("1 cells of the kind 'triangle10' are taken flat between their corners",)
    assert areas(held.vertices, held.faces).sum() == pytest.approx(0.5)


@pytest.mark.parametrize("version", ["1", "2.2", "4.0", "4.1"])
def test_elements_that_are_not_known_are_named(version: str, tmp_path: Path) -> None:
    assert "its elements of the type 140 are not known" in refusal(tmp_path, msh(version, "", [*BARREL, (140, [[0]])]))


@pytest.mark.parametrize(("change", "says"), [
    ((b"$Nodes\n30", b"$Nodes\n31"), "its section $Nodes ends before all that it announces"),
    ((b"$Nodes\n30", b"$Nodes\n29"), "its section $Nodes goes on after all that it announces"),
    ((b"$Elements\n29", b"$Elements\n30"), "it announces 30, and 29 can be read"),
    ((b"$Elements\n29", b"$Elements\n28"), "it announces 28, and 28 can be read"),
    ((b"$EndElements", b""), "its section $Elements does not end"),
    ((b"$Nodes", b"$Knots"), "its section $Knots does not end"),
    ((b"2.2 0 8", b"5.0 0 8"), "it is of the version 5.0 of MSH, which is not read; save it as MSH 4.1"),
    ((b"2.2 0 8", b"2.2 1 8"), "its section $MeshFormat is damaged"),
    ((b"20.0", b"twenty"), "its section $Nodes holds something else than numbers"),
    ((b"\n3 1 2", b"\n3.5 1 2"), "is not whole"),
    ((b"\n30 ", b"\n29 "), "two of its nodes have the same number"),
    ((b"\n30 ", b"\n31 "), "an element refers to node 30, which is not in the file"),
    ((b"$MeshFormat", b"$Format"), "its section $Format does not end"),
])  # fmt: skip
def test_what_is_announced_is_compared(change: tuple[bytes, bytes], says: str, tmp_path: Path) -> None:
    whole = msh("2.2")
    assert change[0] in whole and says in refusal(tmp_path, whole.replace(*change, 1))


@pytest.mark.parametrize("order", ["", "<", ">"])
@pytest.mark.parametrize("version", ["2.2", "4.0", "4.1"])
def test_files_that_are_cut_short(version: str, order: str, tmp_path: Path) -> None:
    whole = msh(version, order)
    for share in (0.1, 0.4, 0.7, 0.95):
        assert "does not end" in refusal(tmp_path, whole[: int(share * len(whole))])


@pytest.mark.parametrize("version", ["4.0", "4.1"])
def test_the_counts_of_blocks_are_compared(version: str, tmp_path: Path) -> None:
    whole = msh(version)
    wrong = re.sub(rb"\$Elements\n4 29", rb"$Elements\n4 30", whole)
    assert wrong != whole and "it announces 30 elements, and has 29" in refusal(tmp_path, wrong)
    wrong = re.sub(rb"\$Nodes\n3 30", rb"$Nodes\n3 31", whole)
    assert wrong != whole and "it announces 31 nodes, and has 30" in refusal(tmp_path, wrong)


def test_other_files(tmp_path: Path) -> None:
    assert "it has no section $MeshFormat" in refusal(tmp_path, b"solid part\nendsolid part\n")
    assert "it has no section $Elements" in refusal(tmp_path, msh("2.2").partition(b"$Elements")[0])
    assert "it has two sections $Nodes" in refusal(tmp_path, msh("2.2") + b"$Nodes\n0\n$EndNodes\n")


@pytest.mark.parametrize("form", ["gmsh22", "gmsh"])
@pytest.mark.parametrize("binary", [False, True])
def test_files_by_meshio(form: str, binary: bool, tmp_path: Path) -> None:
    meshio.Mesh(POINTS, [("triangle", FACES)]).write(tmp_path / "part.msh", file_format=form, binary=binary)
    assert is_barrel(load(tmp_path / "part.msh"))


def test_the_table_of_types_agrees_with_meshio() -> None:
    from meshio.gmsh.common import _gmsh_to_meshio_type

    assert {number: TYPES[number].kind for number in _gmsh_to_meshio_type} == _gmsh_to_meshio_type
