"""OBJ files in all the ways that the format allows give the same barrel; what is not read is named."""

from pathlib import Path

import numpy as np
import pytest
from barrels import BOTTOM, MIXED, POINTS, QUADS, TRIANGLES, Face, area, numbers, read_back, refusal, written

VERTICES = "".join(f"v {numbers(point)}\n" for point in POINTS)
FACES = "".join("f {} {} {}\n".format(*(k + 1 for k in face)) for face in TRIANGLES)
PLAIN = VERTICES + FACES


def faces(form: str, table: list[Face] = TRIANGLES, shift: int = 1) -> str:
    """Lines of faces; `form` is that of a corner."""
    return "".join("f " + " ".join(form.format(k + shift) for k in face) + "\n" for face in table)


SAME: dict[str, bytes | str] = {
    "plain": PLAIN,
    "tabs": PLAIN.replace(" ", "\t"),
    "tabs and blanks": PLAIN.replace(" ", " \t "),
    "blanks at the end": PLAIN.replace("\n", " \t\n"),
    "indented": PLAIN.replace("v ", "  v ").replace("f ", "\t f "),
    "far indented": PLAIN.replace("f ", 100 * " " + "f "),
    "Windows": PLAIN.replace("\n", "\r\n"),
    "old Mac": PLAIN.replace("\n", "\r"),
    "byte order mark": "\ufeff" + PLAIN,
    "UTF-16": PLAIN.encode("utf-16"),
    "mark of the end": PLAIN + "\x1a",
    "no last line end": PLAIN.rstrip("\n"),
    "blank lines": PLAIN.replace("\n", "\n\n  \n"),
    "continued": PLAIN.replace(" ", " \\\n"),
    "continued on Windows": PLAIN.replace(" ", " \\\n").replace("\n", "\r\n"),
    "continued and indented": PLAIN.replace(" ", " \\  \n\t"),
    "comments": "# v 1 2 3\n" + PLAIN.replace("\n", " # f 1 2 3\n"),
    "comment that ends in a backslash": PLAIN.replace("\nf", "\n# C:\\parts\\\nf"),
    "name that ends in a backslash": VERTICES + "usemtl C:\\parts\\\n" + FACES,
    "weights": VERTICES.replace("\n", " 0.5\n") + FACES,
    "colours": VERTICES.replace("\n", " 0.1 0.2 0.3\n") + FACES,
    "colours of some": VERTICES.replace("\n", " 0.1 0.2 0.3\n", 20) + FACES,
    "texture": VERTICES + "vt 0 0\n" + faces("{0}/1"),
    "texture and normals": VERTICES + "vt 0 0\nvn 0 0 1\n" + faces("{0}/1/1"),
    "normals": VERTICES + "vn 0 0 1\n" + faces("{0}//1"),
    "relative normals": VERTICES + "vn 0 0 1\n" + faces("{0}//-1"),
    "empty texture": VERTICES + faces("{0}/"),
    "all ways of a corner": VERTICES + "vt 0 0\nvn 0 0 1\n" + faces("{0}", TRIANGLES[:20])
    + faces("{0}/1", TRIANGLES[20:40]) + faces("{0}//1", TRIANGLES[40:60]) + faces("{0}/1/1", TRIANGLES[60:]),
    "quadrangles": VERTICES + faces("{0}", QUADS),
    "quadrangles and triangles": VERTICES + faces("{0}", MIXED),
    "relative": VERTICES + faces("{0}", shift=-len(POINTS)),
    "relative before a vertex": VERTICES + faces("{0}", shift=-len(POINTS)) + "v 7 7 7\n",
    "relative and textured": VERTICES + "vt 0 0\n" + faces("{0}/-1", shift=-len(POINTS)) + "v 7 7 7\n",
    "relative ring by ring": "".join(
        VERTICES[: VERTICES.index(line)] * (k == 0) + line + "\n" for k, line in enumerate(VERTICES.splitlines())
    ) + faces("{0}", shift=-len(POINTS)),
    "faces before vertices": FACES + VERTICES,
    "faces of old": VERTICES + FACES.replace("f ", "fo "),
    "capitals": VERTICES.upper() + FACES.upper(),
    "plus signs": PLAIN.replace(" ", " +").replace("+-", "-"),
    "Fortran's exponents": VERTICES.replace("\n", "D+00\n").replace("e-", "D-").replace("D-07D", "D-07")
    .replace("D-15D+00", "D-15") + FACES,
    "lines and points": VERTICES + "p 1 2\nl 1 2 3\n" + FACES,
    "names and looks": "mtllib a.mtl\no a\ng b c\ns 1\nusemtl d\nlod 1\nbevel off\nc_interp on\n" + PLAIN,
}  # fmt: skip


@pytest.mark.parametrize("way", SAME)
def test_all_ways_give_the_barrel(way: str, tmp_path: Path) -> None:
    held = read_back(written(tmp_path, "part.obj", SAME[way]))
    assert held.units == ""


def test_relative_indices_count_at_their_own_line_in_every_object(tmp_path: Path) -> None:
    moved = "".join(f"v {numbers(point + [0.0, 0.0, 200.0])}\n" for point in POINTS)
    relative = faces("{0}", shift=-len(POINTS))
    held = read_back(
        written(tmp_path, "part.obj", f"o a\n{VERTICES}{relative}o b\n{moved}{relative}"), 2.0 * area(), 160
    )
    assert held.faces.max() == 2 * len(POINTS) - 1 and np.array_equal(held.faces[80:], held.faces[:80] + len(POINTS))


def test_polygons_close_an_end(tmp_path: Path) -> None:
    closed = area() + area([BOTTOM])
    for corner in ("{0}", "{0}//1"):
        path = written(tmp_path, "part.obj", VERTICES + "vn 0 0 1\n" + faces(corner, [BOTTOM, *TRIANGLES]))
        read_back(path, closed, 86)


def test_a_concave_polygon_is_cut_in_its_own_shape(tmp_path: Path) -> None:
    arrow = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 1 1 0\nv 0 4 0\nf 1 2 3 4 5\n"
    read_back(written(tmp_path, "part.obj", arrow), 10.0, 3)


def test_small_faces_and_unknown_lines_are_told(tmp_path: Path) -> None:
    read_back(
        written(tmp_path, "part.obj", PLAIN + "f 1 2\nf 3\n"), warns="2 of 82 faces have fewer than three corners"
    )
    read_back(written(tmp_path, "part.obj", PLAIN + "volume 1 2\nvolume 3 4\n"), warns="2 lines begin with what is no")
    read_back(
        written(tmp_path, "part.obj", PLAIN + "vp 0 1\nsurf 0 1 0 1 1 2\ncurv 0 1 1 2\nend\nsurf 0 1 0 1 1 2\n"),
        warns="free-form geometry (2 surf, 1 curv) is not read",
    )


def test_what_cannot_be_read_is_refused_by_name(tmp_path: Path) -> None:
    spline = written(tmp_path, "part.obj", VERTICES + "cstype bspline\nsurf 0 1 0 1 1 2\nparm u 0 1\nend\n")
    assert refusal(spline) == "holds free-form geometry (1 surf) and no faces; export it as polygons"
    for word in ("call", "csh"):
        other = written(tmp_path, "part.obj", f"# a\n{word} other.obj\n{PLAIN}")
        assert refusal(other).startswith(f"{word} in line 2 takes in another file")


@pytest.mark.parametrize(("lines", "words"), [
    ("v 1 2\n", "vertex 49 in line 129 has fewer than three coordinates"),
    ("v 1 2 x\n", "vertex 49 in line 129 has 'x' where a number should be"),
    ("v 1,5 2,5 0,5\n", "vertex 49 in line 129 has '1,5' where a number should be; write numbers with decimal points"),
    ("f 1 2 x\n", "face 81 in line 129 has no vertex numbers"),
    ("f 1 2 3.5\n", "face 81 in line 129 has no vertex numbers"),
    ("f 1 2 /3\n", "face 81 in line 129 has no vertex numbers"),
    ("f 1/2/3 2/- 3\n", "face 81 in line 129 has no vertex numbers"),
    ("f 1 2 49\n", "face 81 in line 129 refers to vertex 49, but there are 48"),
    ("f 1 2 0\n", "face 81 in line 129 refers to vertex 0: OBJ counts from 1"),
    ("f 1 2 -49\n", "face 81 in line 129 refers to vertex -49: OBJ counts from 1"),
    ("f 1 \\\n2 3\nf 1 2 99\n", "face 82 in line 131 refers to vertex 99"),
])  # fmt: skip
def test_a_wrong_line_is_named(lines: str, words: str, tmp_path: Path) -> None:
    assert refusal(written(tmp_path, "part.obj", PLAIN + lines)).startswith(words)


def test_an_index_beyond_the_vertices_above_is_refused_though_more_follow(tmp_path: Path) -> None:
    early = written(tmp_path, "part.obj", "v 0 0 0\nv 1 0 0\nf -1 -2 -3\nv 0 1 0\n")
    assert refusal(early).startswith("face 1 in line 3 refers to vertex -3")


@pytest.mark.parametrize("header", ["# surface of a winding, lengths in cm", "# meshwind, lengths in cm"])
def test_the_unit_of_own_files_is_read(header: str, tmp_path: Path) -> None:
    assert read_back(written(tmp_path, "part.obj", f"{header}\n{PLAIN}")).units == "cm"
