"""STL files, binary and of text, give the same barrel; counts that are wrong and what is left out are told."""

import struct
from pathlib import Path

import pytest
from barrels import BOTTOM, MIXED, POINTS, TRIANGLES, Face, area, numbers, read_back, refusal, written


def facets(table: list[Face], attribute: int = 0) -> bytes:
    return b"".join(struct.pack("<12fH", 0, 0, 1, *POINTS[list(face)].ravel(), attribute) for face in table)


def header(count: int, words: bytes = b"by hand") -> bytes:
    return words.ljust(80) + struct.pack("<I", count)


def text(table: list[Face], name: str = "barrel") -> str:
    rows = [f"solid {name}"]
    for face in table:
        rows += ["facet normal 0 0 1", "  outer loop", *(f"    vertex {numbers(POINTS[k])}" for k in face)]
        rows += ["  endloop", "endfacet"]
    return "\n".join([*rows, f"endsolid {name}", ""])


SOUND = header(80) + facets(TRIANGLES)
PLAIN = text(TRIANGLES)
SAME: dict[str, bytes | str] = {
    "binary": SOUND,
    "binary of header 0": bytes(80) + SOUND[80:],
    "binary that begins with solid": header(80, b"solid part") + facets(TRIANGLES),
    "binary of colours": header(80, b"COLOR=\x80\x80\x80\xff") + facets(TRIANGLES, 0x7FFF),
    "two binary solids": header(30) + facets(TRIANGLES[:30]) + header(50) + facets(TRIANGLES[30:]),
    "two binary solids that begin with solid":
        header(30, b"solid a") + facets(TRIANGLES[:30]) + header(50, b"solid b") + facets(TRIANGLES[30:]),
    "80 binary solids": b"".join(header(1) + facets([face]) for face in TRIANGLES),
    "text": PLAIN,
    "two solids": text(TRIANGLES[:30], "a") + text(TRIANGLES[30:], "b"),
    "no name": text(TRIANGLES, ""),
    "capitals": PLAIN.upper(),
    "Windows": PLAIN.replace("\n", "\r\n"),
    "old Mac": PLAIN.replace("\n", "\r"),
    "tabs": PLAIN.replace(" ", "\t"),
    "no indents": PLAIN.replace("\n  ", "\n").replace("\n  ", "\n"),
    "far indents": PLAIN.replace("\n", "\n" + 80 * " "),
    "blank lines": "\n\n" + PLAIN.replace("\n", "\n\n"),
    "byte order mark": "\ufeff" + PLAIN,
    "UTF-16": PLAIN.encode("utf-16"),
    "bytes of other alphabets": PLAIN.replace("barrel", "tönnchen").encode("latin-1"),
    "a name of keywords": PLAIN.replace("barrel", "vertex 1 endloop"),
    "a long name": PLAIN.replace("barrel", 300 * "part "),
    "normals that are not numbers": PLAIN.replace("normal 0 0 1", "normal nan -nan inf"),
    "words apart": PLAIN.replace("endl", "end l").replace("endf", "end  f").replace("ends", "end s"),
    "a facet in a line": PLAIN.replace("\n ", " ").replace("\nendfacet", " endfacet"),
    "one line": PLAIN.replace("\n", " ") + "\n",
    "text after the end": PLAIN + "\n\n",
    "quadrangles": text(MIXED),
    "zeros after the end": PLAIN.encode() + bytes(9),
    "an end of old systems": PLAIN.encode() + b"\x1a",
    "exponents": PLAIN.replace(".0\n", ".0E+00\n"),
}  # fmt: skip


@pytest.mark.parametrize("way", SAME)
def test_all_ways_give_the_barrel(way: str, tmp_path: Path) -> None:
    assert read_back(written(tmp_path, "part.stl", SAME[way])).units == ""


def test_a_loop_of_eight_closes_the_barrel(tmp_path: Path) -> None:
    read_back(written(tmp_path, "part.stl", text([*TRIANGLES, BOTTOM])), area() + area([BOTTOM]), 86)


@pytest.mark.parametrize("count", [0, 1, 79, 81, 1000, 2**32 - 1])
def test_a_wrong_count_is_told_and_the_length_counts(count: int, tmp_path: Path) -> None:
    path = written(tmp_path, "part.stl", header(count) + facets(TRIANGLES))
    held = read_back(path, warns=f"the file announces {count} triangles and is as long as 80; all 80 are read")
    assert ("if it was cut short, copy or export it again" in held.warnings[0]) == (count > 80)


@pytest.mark.parametrize("more", [1, 2, 49])
def test_bytes_after_the_last_triangle_are_told(more: int, tmp_path: Path) -> None:
    path = written(tmp_path, "part.stl", SOUND + b"x" * more)
    read_back(path, warns=f"{more} bytes after the last triangle are not read")


@pytest.mark.parametrize("more", [50, 100, 512, 4096])
def test_zeros_after_the_last_triangle_are_no_triangles(more: int, tmp_path: Path) -> None:
    read_back(written(tmp_path, "part.stl", SOUND + bytes(more)), warns=f"{more} zeros after the last triangle")


def test_a_length_that_is_no_whole_number_is_refused(tmp_path: Path) -> None:
    assert refusal(written(tmp_path, "part.stl", SOUND[:-13])) == (
        "is cut short: it announces 80 triangles and holds 79; copy or export it again"
    )
    assert refusal(written(tmp_path, "part.stl", header(0) + facets(TRIANGLES)[:-13])).startswith(
        "announces 0 triangles and is as long as 79 and a part of one"
    )
    two = header(30) + facets(TRIANGLES[:30]) + header(50) + facets(TRIANGLES[30:])
    assert refusal(written(tmp_path, "part.stl", two[:-13])).startswith("announces 30 triangles and is as long as")


@pytest.mark.parametrize(("was", "becomes", "words"), [
    ("\nendsolid barrel\n", "\n", "is cut short, its last line is not endsolid; copy or export it again"),
    ("  endloop\n", "", "line 7, 'endfacet', is not in its place, so that a facet is not whole"),
    ("  outer loop\n", "", "line 3, 'vertex 20.0 0.0 0.0', is not in its place"),
    ("endfacet\n", "", "line 8, 'facet normal 0 0 1', is not in its place"),
    ("facet normal 0 0 1\n", "", "line 2, 'outer loop', is not in its place"),
    ("endloop\n", "endloop\ncolour 1 0 0\n", "line 8, 'colour 1 0 0', is no statement of STL"),
    ("vertex 20.0 0.0 0.0", "vertx 20.0 0.0 0.0", "line 4, 'vertx 20.0 0.0 0.0', is no statement of STL"),
    ("vertex 20.0 0.0 0.0", "vertex 20,0 0,0 0,0", "line 4 has '20,0' where a number should be; write"),
    ("vertex 20.0 0.0 0.0", "vertex 20.0 0.0", "the vertex in line 4 has not three coordinates"),
    ("vertex 20.0 0.0 0.0", "vertex 20.0 0.0 0.0 1.0", "the vertex in line 4 has not three coordinates"),
    ("vertex 20.0 0.0 0.0", "vertex 20.0 0.0 zero", "line 4 has 'zero' where a number should be"),
])  # fmt: skip
def test_a_wrong_line_is_named(was: str, becomes: str, words: str, tmp_path: Path) -> None:
    assert was in PLAIN
    assert refusal(written(tmp_path, "part.stl", PLAIN.replace(was, becomes, 1))).startswith(words)


def test_a_loop_of_two_is_told(tmp_path: Path) -> None:
    path = written(tmp_path, "part.stl", text([*TRIANGLES, (0, 1)]))
    read_back(path, warns="1 of 81 faces have fewer than three corners; left out")


def test_a_part_cut_within_a_solid_that_another_follows_is_refused(tmp_path: Path) -> None:
    first = text(TRIANGLES[:30], "a")
    cut = first[: first.rindex("  endloop")]
    assert "is not in its place" in refusal(written(tmp_path, "part.stl", cut + text(TRIANGLES[30:], "b")))


def test_lines_between_facets_are_told(tmp_path: Path) -> None:
    path = written(tmp_path, "part.stl", PLAIN.replace("endfacet\n", "endfacet\ncolour 1 0 0\n", 3))
    read_back(path, warns="3 lines are no statements of STL, the first one in line 9; left out")


def test_bytes_in_the_other_order_are_told(tmp_path: Path) -> None:
    rows = b"".join(struct.pack(">12fH", 0, 0, 1, *POINTS[list(face)].ravel(), 0) for face in TRIANGLES)
    path = written(tmp_path, "part.stl", bytes(80) + struct.pack(">I", 80) + rows)
    read_back(path, warns="stored highest byte first, against the format; read as stored")
