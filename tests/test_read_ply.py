"""PLY files of text and of both byte orders, with all that may stand beside the faces, give the same barrel."""

import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from barrels import (
    BOTTOM,
    MIXED,
    POINTS,
    QUADS,
    ROUND,
    STRIPS,
    TRIANGLES,
    Face,
    area,
    numbers,
    read_back,
    refusal,
    strip,
    written,
)  # fmt: skip

from meshwind.core.errors import BadInputError
from meshwind.mesh.io.read import load
from meshwind.mesh.io.scalars import read_scalars, scalar_names

ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
CODES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d",
         "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I", "int64": "q",
         "uint64": "Q", "float32": "f", "float64": "d"}  # fmt: skip
Table = tuple[str, list[str], list[list[Any]]]
"""An element: name, properties as in the header, and rows of numbers and lists."""


def ply(order: str, *tables: Table, head: str = "", end: str = "\n") -> bytes:
    """A file of some elements; `head` are lines after the format, `end` ends each line of the header."""
    lines = ["ply", f"format {order} 1.0", *head.splitlines()]
    body = b""
    for name, properties, rows in tables:
        lines += [f"element {name} {len(rows)}", *(f"property {entry}" for entry in properties)]
        body += b"".join(_row(ORDERS[order], properties, row) for row in rows)
    return (end.join([*lines, "end_header"]) + end).encode() + body


def _row(order: str, properties: list[str], row: list[Any]) -> bytes:
    out = b""
    for entry, value in zip(properties, row, strict=True):
        kinds = [CODES[word] for word in entry.split()[:-1] if word != "list"]
        values = [*value] if isinstance(value, list | tuple) else [value]
        both = [len(values), *values] if len(kinds) == 2 else values
        if order:
            out += struct.pack(order + kinds[0] * (len(kinds) == 2) + kinds[-1] * len(values), *both)
        else:
            out += (" ".join(map(repr, both)) + " ").encode()
    return out if order else out.rstrip() + b"\n"


def vertices(kind: str = "double") -> Table:
    return "vertex", [f"{kind} {axis}" for axis in "xyz"], POINTS.tolist()


def faces(table: list[Face] = TRIANGLES, kinds: str = "uchar int", name: str = "vertex_indices") -> Table:
    return "face", [f"list {kinds} {name}"], [[face] for face in table]


def strips(*lists: list[int], kinds: str = "int int") -> Table:
    return "tristrips", [f"list {kinds} vertex_indices"], [[each] for each in lists]


WIDE = [[*([k % 7, 0.5]), *point, [1.0] * (k % 3), k % 2] for k, point in enumerate(POINTS.tolist())]
TABLES: dict[str, list[Table]] = {
    "plain": [vertices(), faces()],
    "single precision": [vertices("float32"), faces()],
    "sizes in the names": [vertices("float64"), faces(kinds="uint8 int32")],
    "other integers": [vertices(), faces(kinds="ushort ushort", name="vertex_index")],
    "signed bytes": [vertices(), faces(kinds="char char")],
    "long integers": [vertices(), faces(kinds="int64 uint64")],
    "unsigned integers": [vertices(), faces(kinds="uint uint")],
    "indices as floats": [vertices(), faces(kinds="int float")],
    "faces first": [faces(), vertices()],
    "quadrangles": [vertices(), faces(QUADS)],
    "quadrangles and triangles": [vertices(), faces(MIXED)],
    "triangles by turns": [vertices(), faces([MIXED[(7 * k) % 60] for k in range(60)])],
    "long lengths": [vertices(), faces(MIXED, kinds="int int")],
    "wide vertices": [
        ("vertex", ["uchar red", "float u", *vertices()[1], "list uchar float w", "short s"], WIDE), faces()],
    "faces with texture": [vertices(), (
        "face", ["list uchar float texcoord", "uchar flag", "list uchar int vertex_indices", "int texnumber"],
        [[[0.5] * (k % 7), 1, face, 0] for k, face in enumerate(MIXED)])],
    "texture of one length": [vertices(), (
        "face", ["list uchar int vertex_indices", "list uchar float texcoord"],
        [[face, 6 * [0.5]] for face in TRIANGLES])],
    "elements about": [("material", ["int a", "list uchar float b"], [[1, [1.0, 2.0]], [2, []]]), vertices(),
                       ("edge", ["int vertex1", "int vertex2"], [[0, 1], [1, 2]]), faces(MIXED),
                       ("camera", ["float view_px"], [[0.0]])],
    "a strip": [vertices(), strips(STRIPS)],
    "strips": [vertices(), strips(*(strip(ring) for ring in range(5)))],
    "strips of each kind": [
        vertices(), strips([*strip(0), -1, *strip(1)], strip(2), [*strip(3), -1, -1], [-1, *strip(4)])],
    "unsigned strips": [vertices(), strips([2**32 - 1 if k < 0 else k for k in STRIPS], kinds="uint uint")],
    "faces and a strip": [vertices(), faces(TRIANGLES[:16]), strips(STRIPS[2 * ROUND + 3 :])],
    "a strip and mixed faces": [vertices(), strips(STRIPS[: 2 * ROUND + 3]), faces(MIXED[8:])],
    "empty faces and a strip": [vertices(), faces([]), strips(STRIPS)],
}  # fmt: skip


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("what", TABLES)
def test_all_elements_give_the_barrel(what: str, order: str, tmp_path: Path) -> None:
    read_back(written(tmp_path, "part.ply", ply(order, *TABLES[what])))


@pytest.mark.parametrize("order", ORDERS)
def test_headers_may_have_remarks_and_other_line_ends(order: str, tmp_path: Path) -> None:
    for end in ("\n", "\r\n", "\r", " \n"):
        for head in ("comment made by hand\nobj_info num_cols 4\n", "comment element vertex 4\ncomment\n\n"):
            read_back(written(tmp_path, "part.ply", ply(order, vertices(), faces(MIXED), head=head, end=end)))


@pytest.mark.parametrize("order", ORDERS)
def test_the_last_line_of_a_header_may_end_otherwise(order: str, tmp_path: Path) -> None:
    unix, windows = (ply(order, vertices(), faces(MIXED), end=end) for end in ("\n", "\r\n"))
    read_back(written(tmp_path, "part.ply", unix.replace(b"end_header\n", b"end_header\r\n")))
    read_back(written(tmp_path, "part.ply", windows.replace(b"end_header\r\n", b"end_header\n")))


def test_data_that_begin_with_a_line_feed_are_not_taken_for_the_header(tmp_path: Path) -> None:
    first = POINTS.copy()
    first[0, 0] = np.frombuffer(b"\n\n\n\n\n\n\n\n", "<f8")[0]
    table: Table = ("vertex", vertices()[1], first.tolist())
    for end in ("\n", "\r", "\r\n"):
        path = written(tmp_path, "part.ply", ply("binary_little_endian", table, faces(TRIANGLES[2:-2]), end=end))
        assert np.array_equal(load(path).vertices, first)


TEXT = ply("ascii", vertices(), faces(MIXED))


def test_text_may_wrap_lines_and_be_of_another_system(tmp_path: Path) -> None:
    head, _, body = TEXT.partition(b"end_header\n")
    for changed in (
        body.replace(b" ", b"\n"),
        body.replace(b"\n", b"\r\n"),
        body.replace(b" ", b"\t"),
        b"\n \n" + body,
    ):
        read_back(written(tmp_path, "part.ply", head + b"end_header\n" + changed))
    read_back(written(tmp_path, "part.ply", b"\xef\xbb\xbf" + TEXT))
    read_back(written(tmp_path, "part.ply", TEXT.decode().encode("utf-16")))


def test_an_octagon_closes_the_barrel(tmp_path: Path) -> None:
    for order in ORDERS:
        path = written(tmp_path, "part.ply", ply(order, vertices(), faces([BOTTOM, *MIXED])))
        read_back(path, area() + area([BOTTOM]), 86)


@pytest.mark.parametrize("order", ORDERS)
def test_what_is_not_read_is_told(order: str, tmp_path: Path) -> None:
    patch: Table = ("patches", ["list uchar int vertex_indices"], [[QUADS[0]], [QUADS[1]]])
    path = written(tmp_path, "part.ply", ply(order, vertices(), patch, faces()))
    read_back(path, warns="holds 2 rows of the element 'patches', which is not known; left out beside the faces")
    path = written(tmp_path, "part.ply", ply(order, vertices(), faces([*TRIANGLES, (0, 1), (2,)])))
    read_back(path, warns="2 of 82 faces have fewer than three corners; left out")
    more = written(tmp_path, "part.ply", ply(order, vertices(), faces()) + b"1 2 3 4\n")
    read_back(more, warns="4 numbers after" if order == "ascii" else "8 bytes after the last element")
    assert refusal(written(tmp_path, "part.ply", ply(order, vertices(), patch))).startswith(
        "holds 2 rows of the element 'patches', which is not known, and has no faces; export it"
    )
    grid: Table = ("range_grid", ["list uchar int vertex_indices"], [[[k]] for k in range(40)] + [[[]]] * 8)
    scan = ply(order, vertices(), grid, head="obj_info num_cols 8\nobj_info num_rows 6\n")
    assert "holds a range grid of 48 points (8 x 6), which is not a mesh" in refusal(written(tmp_path, "a.ply", scan))


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("table", ["plain", "quadrangles and triangles", "faces with texture", "a strip"])
def test_cut_files_say_what_is_missing(table: str, order: str, tmp_path: Path) -> None:
    whole = ply(order, *TABLES[table])
    count = len(TABLES[table][1][2])
    name = TABLES[table][1][0]
    last = _row(ORDERS[order], *TABLES[table][1][1:2], TABLES[table][1][2][-1])
    before = _row(ORDERS[order], *TABLES[table][1][1:2], TABLES[table][1][2][-2 if count > 1 else -1])
    words = "is cut short: it announces {} rows of '{}' and holds {}; copy or export it again"
    cut = len(last) if order == "ascii" else 1
    assert refusal(written(tmp_path, "part.ply", whole[:-cut])) == words.format(count, name, count - 1)
    if count > 1:
        two = whole[: -len(last) - (len(before) if order == "ascii" else 1)]
        assert refusal(written(tmp_path, "part.ply", two)) == words.format(count, name, count - 2)
    points = ply(order, TABLES[table][0], ("face", [], []))
    head = whole.index(b"end_header\n") + len(b"end_header\n")
    rest = len(points) - points.index(b"end_header\n") - len(b"end_header\n")
    vertices_only = whole[: head + rest - (0 if order == "ascii" else 3)]
    if order == "ascii":
        vertices_only = whole[: whole[: head + rest - 1].rindex(b"\n") + 1]
    assert refusal(written(tmp_path, "part.ply", vertices_only)) == words.format(48, "vertex", 47)


@pytest.mark.parametrize(("was", "becomes", "words"), [
    (b"\n3 0 1 9\n", b"\n3 0 1\n", "line 58 has 3 numbers, where row 1 of 'face' has 4 by the file's header"),
    (b"\n3 0 1 9\n", b"\n3 0 1 9 1\n", "line 58 has 5 numbers, where row 1 of 'face' has 4 by the file's header"),
    (b"\n3 0 1 9\n", b"\n2.5 0 1 9\n", "cannot be read as PLY (row 1 has a list of 2.5 numbers)"),
    (b"uchar int", b"float int", "cannot be read as PLY (its list 'vertex_indices' has a length that is not whole)"),
    (b"uchar int", b"uchar long", "cannot be read as PLY (its header has the line"),
    (b"vertex_indices", b"corners", "cannot be read as PLY (its element face has no list vertex_indices)"),
    (b"double x", b"double w", "cannot be read as PLY (its vertices have no x, y and z)"),
    (b"element face", b"element vertex", "cannot be read as PLY (its header declares an element twice)"),
    (b"ascii", b"binary", "cannot be read as PLY (its header has the line"),
    (b"\n3 0 1 9\n", b"\n1e308 0 1 9\n", "cannot be read as PLY (row 1 has a list of 1e+308 numbers)"),
    (b"\n3 0 1 9\n", b"\n-3 0 1 9\n", "cannot be read as PLY (row 1 has a list of -3 numbers)"),
    (b"format ascii 1.0\n", b"", "cannot be read as PLY (its header names no format)"),
    (b"end_header", b"", "cannot be read as PLY (its header does not end)"),
    (b"\n20.0 0.0 0.0", b"\n20,0 0.0 0.0", "line 10 has '20,0' where a number should be; write"),
    (b"\n20.0 0.0 0.0", b"\n20.0 0.0", "line 10 has 2 numbers, where row 1 of 'vertex' has 3 by the file's header"),
    (b"\n20.0 0.0 0.0", b"\n20.0 0.0 0.0 1", "line 10 has 4 numbers, where row 1 of 'vertex' has 3"),
    (b"\n20.0 0.0 0.0", b"\n20.0 - 0.0", "line 10 has '-' where a number should be"),
])  # fmt: skip
def test_a_wrong_file_is_refused_with_the_reason(was: bytes, becomes: bytes, words: str, tmp_path: Path) -> None:
    text = ply("ascii", vertices(), faces())
    assert was in text
    assert refusal(written(tmp_path, "part.ply", text.replace(was, becomes, 1))).startswith(words)


def test_the_unit_of_own_files_is_read(tmp_path: Path) -> None:
    path = written(tmp_path, "part.ply", ply("ascii", vertices(), faces(), head="comment meshwind, lengths in m\n"))
    assert read_back(path).units == "m"


@pytest.mark.parametrize("order", ORDERS)
def test_scalars_are_found_beside_lists(order: str, tmp_path: Path) -> None:
    values = [0.5 + 0.25 * (k % 4) for k in range(len(POINTS))]
    table: Table = ("vertex", ["list uchar int near", "float mu", *vertices()[1]],
                    [[[1] * (k % 3), values[k], *point] for k, point in enumerate(POINTS.tolist())])  # fmt: skip
    patch: Table = ("face", ["list uchar float texcoord", "list uchar int vertex_indices", "char a", "double nu"],
                    [[(k % 5) * [0.5], face, 1, float(k)] for k, face in enumerate(MIXED)])  # fmt: skip
    path = written(tmp_path, "part.ply", ply(order, table, patch))
    assert scalar_names(path) == ("a", "mu", "nu")
    on_points, on_faces = read_scalars(path, "mu"), read_scalars(path, "nu")
    assert np.array_equal(on_points.values, values) and np.array_equal(on_points.points, POINTS)
    assert np.array_equal(on_faces.values, np.arange(len(MIXED)))
    assert on_faces.points == pytest.approx(np.array([POINTS[list(face)].mean(axis=0) for face in MIXED]), rel=1e-12)
    with pytest.raises(BadInputError, match="is cut short: it announces 60 rows of 'face'"):
        read_scalars(written(tmp_path, "part.ply", path.read_bytes()[:-9]), "mu")


def test_numbers_are_written_with_all_digits() -> None:
    assert numbers(POINTS[1]).split() == [repr(float(value)) for value in POINTS[1]]


@pytest.mark.parametrize("length", [-1, -(2**62), 2**62])
@pytest.mark.parametrize("row", [0, 5, 59])
def test_lengths_that_cannot_be_are_refused(length: int, row: int, tmp_path: Path) -> None:
    for kind, order in list(ORDERS.items())[1:]:
        rows = [struct.pack(f"{order}q{len(face)}i", len(face), *face) for face in MIXED]
        rows[row] = struct.pack(f"{order}q", length) + rows[row][8:]
        head = ply(kind, vertices(), faces([], "int64 int")).replace(b"element face 0", b"element face 60")
        words = refusal(written(tmp_path, "part.ply", head + b"".join(rows)))
        assert "is cut short: it announces 60 rows of 'face'" in words or "has a list of -" in words
