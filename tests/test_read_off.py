"""OFF files in all the ways of Geomview's manual give the same barrel; what is not read is named."""

import struct
from pathlib import Path

import pytest
from barrels import BOTTOM, MIXED, POINTS, TRIANGLES, Face, area, numbers, read_back, refusal, written

VERTICES = "".join(f"{numbers(point)}\n" for point in POINTS)


def faces(table: list[Face] = TRIANGLES, colour: str = "") -> str:
    return "".join(" ".join(map(str, [len(face), *face])) + f"{colour}\n" for face in table)


def off(head: str = "OFF\n48 80 120\n", more: str = "", rest: str | None = None) -> str:
    """A file; `more` follows the coordinates of each vertex."""
    return head + VERTICES.replace("\n", f"{more}\n") + (faces() if rest is None else rest)


COLOURS = ["", " 1", " 255 0 0", " 0.1 0.2 0.3", " 0.1 0.2 0.3 1.0"]
SAME: dict[str, bytes | str] = {
    "plain": off(),
    "counts in the first line": off("OFF 48 80 120\n"),
    "counts in lines of their own": off("OFF\n48\n80\n0\n"),
    "no keyword": off("48 80 120\n"),
    "no edges": off("OFF\n48 80\n"),
    "edges 0": off("OFF\n48 80 0\n"),
    "small letters": off("off\n48 80 0\n"),
    "indented": off().replace("\n", "\n  \t"),
    "Windows": off().replace("\n", "\r\n"),
    "old Mac": off().replace("\n", "\r"),
    "byte order mark": "\ufeff" + off(),
    "UTF-16": off().encode("utf-16"),
    "comments": "# 48 80 0\n\n" + off("OFF # a\n\n48 80 120 # b\n# c\n").replace("\n", " # d 1 2\n\n"),
    "colours": off("COFF\n48 80 0\n", " 0.5 0.5 0.5 1.0"),
    "whole colours of three": off("COFF\n48 80 0\n", " 255 0 0"),
    "normals": off("NOFF\n48 80 0\n", " 0 0 1"),
    "colours and normals": off("CNOFF\n48 80 0\n", " 0 0 1 0.5 0.5 0.5 1.0"),
    "normals and colours": off("NCOFF\n48 80 0\n", " 0 0 1 0.5 0.5 0.5 1.0"),
    "texture": off("STOFF\n48 80 0\n", " 0.5 0.5"),
    "all": off("STCNOFF\n48 80 0\n", " 0 0 1 0.5 0.5 0.5 1.0 0.5 0.5"),
    "colours that the keyword does not tell": off("OFF\n48 80 0\n", " 255 0 0 255"),
    "homogeneous": off("4OFF\n48 80 0\n", " 1.0"),
    "three dimensions": off("nOFF\n3\n48 80 0\n"),
    "three dimensions in the first line": off("nOFF 3\n48 80 0\n"),
    "colours of faces": off(rest="".join(faces([f], COLOURS[k % 5]) for k, f in enumerate(TRIANGLES))),
    "mixed faces": off("OFF\n48 60 0\n", rest=faces(MIXED)),
    "mixed faces of colours": off("OFF\n48 60 0\n", rest=faces(MIXED, " 0.5 0.5 0.5")),
    "two vertices in a line": "OFF\n48 80 0\n"
    + "".join(a + " " + b + "\n" for a, b in zip(*[iter(VERTICES.splitlines())] * 2, strict=True)) + faces(),
    "a number in a line": "OFF\n48 80 0\n" + VERTICES.replace(" ", "\n") + faces().replace(" ", "\n"),
    "faces in one line": off(rest=faces().replace("\n", " ")),
}  # fmt: skip


@pytest.mark.parametrize("way", SAME)
def test_all_ways_give_the_barrel(way: str, tmp_path: Path) -> None:
    assert read_back(written(tmp_path, "part.off", SAME[way])).units == ""


def test_homogeneous_points_are_divided(tmp_path: Path) -> None:
    doubled = "".join(f"{numbers(2.0 * point)} 2.0\n" for point in POINTS)
    read_back(written(tmp_path, "part.off", f"4OFF\n48 80 0\n{doubled}{faces()}"))
    read_back(written(tmp_path, "part.off", f"4nOFF 3\n48 80 0\n{doubled}{faces()}"))
    far = doubled.replace(" 2.0\n", " 0.0\n", 1)
    assert refusal(written(tmp_path, "part.off", f"4OFF\n48 80 0\n{far}{faces()}")).startswith(
        "has vertices at infinity"
    )


@pytest.mark.parametrize("colour", ["", " 7", " 0.5 0.5 0.5 1"])
def test_an_octagon_closes_the_barrel(colour: str, tmp_path: Path) -> None:
    closed = written(tmp_path, "part.off", off("OFF\n48 81 0\n", rest=faces([*TRIANGLES, BOTTOM], colour)))
    read_back(closed, area() + area([BOTTOM]), 86)


def binary(table: list[Face], options: str = "", more: int = 0, colours: tuple[int, ...] = (0,)) -> bytes:
    """A binary file; `more` numbers follow the coordinates, and face k has colours[k] numbers of colour."""
    out = f"{options}OFF BINARY\n".encode() + struct.pack(">3i", len(POINTS), len(table), 0)
    for point in POINTS.tolist():
        out += struct.pack(f">{3 + more}f", *point, *([1.0] * more))
    for k, face in enumerate(table):
        colour = colours[k % len(colours)]
        out += struct.pack(f">{len(face) + 2}i{colour}f", len(face), *face, colour, *([0.5] * colour))
    return out


@pytest.mark.parametrize("content", [
    binary(TRIANGLES), binary(MIXED), binary(TRIANGLES, colours=(4,)), binary(MIXED, colours=(0, 3, 4)),
    binary(TRIANGLES, "C", 4), binary(MIXED, "N", 3), binary(MIXED, "STCN", 9), binary(TRIANGLES, "4", 1),
])  # fmt: skip
def test_binary_files_give_the_barrel(content: bytes, tmp_path: Path) -> None:
    read_back(written(tmp_path, "part.off", content))
    read_back(written(tmp_path, "part.off", content + b"1234567"), warns="7 bytes after the last element are not read")
    words = "is cut short: it announces 48 vertices and "
    assert refusal(written(tmp_path, "part.off", content[:-1])).startswith(words)
    assert refusal(written(tmp_path, "part.off", content[:300])).startswith(words)


def test_what_is_left_out_is_told(tmp_path: Path) -> None:
    read_back(
        written(tmp_path, "part.off", off() + "3 0 1 2\n\n3 0 1 2\n"), warns="2 lines after the last face are not"
    )
    small = off("OFF\n48 82 0\n", rest=faces([*TRIANGLES, (0, 1), (5,)]))
    read_back(written(tmp_path, "part.off", small), warns="2 of 82 faces have fewer than three corners; left out")


@pytest.mark.parametrize(("content", "words"), [
    (off()[:-9], "face 80 in line 130 announces 3 corners and is followed by 0 numbers"),
    (off()[:-11], "is cut short: it announces 48 vertices and 80 faces and holds 127 lines"),
    (off()[:900], "is cut short: it announces 48 vertices and 80 faces and holds"),
    (off("nOFF\n4\n48 80 0\n", " 1"), "has points of 4 dimensions (nOFF), which are not read"),
    (off().replace("3 0 1 9\n", "3 0 1\n"), "face 1 in line 51 announces 3 corners and is followed by 2 numbers"),
    (off().replace("3 0 1 9\n", "3.5 0 1 9\n"), "face 1 in line 51 announces 3.5 corners"),
    (off().replace("3 0 1 9\n", "-3 0 1 9\n"), "face 1 in line 51 announces -3 corners"),
    (off().replace("3 0 1 9\n", "3 0 1 9 3 0 1 9 8\n"), "face 1 in line 51 announces 3 corners and is followed by 8"),
    (off().replace("3 0 1 9\n", "3 0 1 x\n"), "line 51 has 'x' where a number should be"),
    (off().replace("20.0 0.0 0.0\n", "20,0 0.0 0.0\n"), "line 3 has '20,0' where a number should be; write"),
    (off().replace("20.0 0.0 0.0\n", "20.0 0.0 0.0 1.0\n"), "vertex 2 in line 4 has 3 numbers, and the first one 4"),
    (off().replace("3 0 1 9\n", "3 0 1 99\n"), "cannot be read as OFF (face 1 refers to vertex 99, counted from 0"),
    (off().replace("3 0 1 9\n", "3 0 1.5 9\n"), "cannot be read as OFF (a face refers to a vertex by a number"),
    (off("OFF\nmany\n"), "cannot be read as OFF (its first lines do not count vertices and faces)"),
    (off("OFF BINARY\n"), "is cut short: it announces"),
])  # fmt: skip
def test_a_wrong_file_is_refused_with_the_reason(content: str, words: str, tmp_path: Path) -> None:
    assert refusal(written(tmp_path, "part.off", content)).startswith(words)
