"""Tables of pins as spreadsheets of several languages write them, and what cannot be told of them."""

from pathlib import Path

import numpy as np
import pytest
from command import meshwind

from meshwind import shapes
from meshwind.core.errors import BadInputError
from meshwind.planning.pins import pin_table, read_pins

TUBE = shapes.cylinder(1.0, 3.0)
WANTED = [[0.0, 0.0, 0.25, 1.0], [0.5, 0.1, -0.125, 0.9]]
NAMES = ("u0", "v0", "u1", "v1")


def written(folder: Path, content: str | bytes) -> Path:
    path = folder / "pins.csv"
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


GOOD = {
    "commas": "u0,v0,u1,v1\n0,0,0.25,1\n0.5,0.1,-0.125,0.9\n",
    "semicolons and decimal commas": "u0;v0;u1;v1\n0,0;0,0;0,25;1,0\n0,5;0,1;-0,125;0,9\n",
    "semicolons and points": "u0;v0;u1;v1\n0.0;0;0.25;1\n.5;0.1;-1.25e-1;0.9\n",
    "tabs and decimal commas": "u0\tv0\tu1\tv1\n0\t0\t0,25\t1\n0,5\t0,1\t-0,125\t0,9\n",
    "blanks": "u0  v0   u1   v1\n  0   0  0.25  1\n0.5 0.1 -0.125 0.9\n",
    "quoted": '"u0","v0","u1","v1"\n"0","0","0.25","1"\n"0.5","0.1","-0.125","0.9"\n',
    "quoted decimal commas": 'u0,v0,u1,v1\n0,0,"0,25",1\n"0,5","0,1","-0,125","0,9"\n',
    "trailing separators": "u0;v0;u1;v1;;\n0;0;0,25;1;;\n0,5;0,1;-0,125;0,9;\n;;;;;\n",
    "upper case and blanks": " U0 ; V0 ; U1 ; V1 \n 0 ; 0 ; 0,25 ; 1 \n0,5;0,1;-0,125;0,9",
    "comments": "# pins of the dome\n\nu0,v0,u1,v1\n# first\n0,0,0.25,1\n\n  # second\n0.5,0.1,-0.125,0.9\n",
    "names in a comment": "# made by hand\n# u0 v0 u1 v1\n0 0 0.25 1\n0.5 0.1 -0.125 0.9\n",
    "sep": "sep=;\nu0;v0;u1;v1\n0;0;0,25;1\n0,5;0,1;-0,125;0,9\n",
    "sep of another sign": '"SEP=|"\nu0|v0|u1|v1\n0|0|0.25|1\n0.5|0.1|-0.125|0.9\n',
    "Windows lines": "u0;v0;u1;v1\r\n0;0;0,25;1\r\n0,5;0,1;-0,125;0,9\r\n",
    "Mac lines": "u0,v0,u1,v1\r0,0,0.25,1\r0.5,0.1,-0.125,0.9\r",
    "a column more": "name;u0;v0;u1;v1\npin A;0;0;0,25;1\npin B;0,5;0,1;-0,125;0,9\n",
    "remarks at the end": "Nr.;u0;v0;u1;v1;Bemerkung\n1;0;0;0,25;1;links, oben\n2;0,5;0,1;-0,125;0,9;\n",
    "remarks of one row": "u0,v0,u1,v1,a,b\n0,0,0.25,1\n0.5,0.1,-0.125,0.9,,late\n",
    "bars": "u0 | v0 | u1 | v1\n0 | 0 | 0,25 | 1\n0,5 | 0,1 | -0,125 | 0,9\n",
    "exponents": "u0;v0;u1;v1\r\n0,00E+00;0;2,5E-01;1,00E+00\r\n5,0E-01;1E-01;-1,25E-01;9,0E-01\r\n",
    "names in another order": "v1;u1;v0;u0\n1;0,25;0;0\n0,9;-0,125;0,1;0,5\n",
    "a typographic minus": "u0;v0;u1;v1\n0;0;0,25;1\n0,5;0,1;\u22120,125;0,9\n",
}


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize("kind", GOOD)
def test_numbers_are_read_whatever_parts_them(kind: str, encoding: str, tmp_path: Path) -> None:
    table = pin_table(written(tmp_path, GOOD[kind].encode(encoding)))
    assert table.numbers(NAMES).tolist() == WANTED


def test_big_endian_text_with_a_byte_order_mark_is_read(tmp_path: Path) -> None:
    content = b"\xfe\xff" + GOOD["tabs and decimal commas"].encode("utf-16-be")
    assert pin_table(written(tmp_path, content)).numbers(NAMES).tolist() == WANTED


def test_pins_in_space_with_decimal_commas(tmp_path: Path) -> None:
    path = written(tmp_path, "x0;y0;z0;x1;y1;z1;revolutions\n1,0;0;0;1;0;3;0,5\n")
    assert read_pins(path, TUBE, 0.3).end[0, 0] - read_pins(path, TUBE, 0.3).start[0, 0] == pytest.approx(0.0, abs=0.51)


BAD = {
    "u0;v0;u1;v1\n0,5;0;0.25;1\n": "row 2 has a comma in a number and row 2 a point, with columns parted by semicolons",
    "u0;v0;u1;v1\n0;0;0.25;1\n\n1,234.5;0;1;1": "row 4 has a comma in a number and row 2 a point",
    "u0\tv0\tu1\tv1\n1,234\t0\t2\t1\n": "row 2 has a comma in a number, which may part decimals or thousands",
    "u0,v0,u1,v1\n0,0,0,0,0,25,1,0\n": "row 2 is not 4 numbers, as commas part both columns and decimals",
    "u0,v0,u1,v1\n0,0,0,0,25\n": "row 2 is not 4 numbers, as commas part both columns and decimals",
    "x0;y0;z0;x1;y1;z1;revolutions\n1.040,0;0;0;1;0;9,5;1\n": "'1.040,0' has a point between its thousands",
    "u0,v0,u1,v1\n0;0;0.25;1\n": "row 2 is parted by semicolons, but the names by commas",
    "# top\nu0;v0;u1;v1\n0;0;1;1\n\n0\t0\t1\t1\n": "row 5 is parted by tabs, but the names by semicolons",
    "u0;v0;u1;v1\n0;0;1\n": "row 2 is not 4 numbers, parted by semicolons",
    "0;0;0,25;1\n": "its first row is numbers; name the columns above: u0,v0,u1,v1 or x0,y0,z0",
    "0,0,0.25,1\n0,0,0.25,1\n": "its first row is numbers",
    "a;b\n1;2\n": "its first row is 'a;b'; name the columns u0,v0,u1,v1",
    "u0;v0,u1;v1\n0;0;1;1\n": "its first row is 'u0;v0,u1;v1'; name the columns",
    "u0,v0,u1,v1,u0\n0,0,1,1,2\n": "two columns are named u0",
    'u0,v0,u1,v1\n"0,0,1,1\n': "row 2 is not 4 numbers",
    "u0,v0,u1,v1\n1_0,0,1,1\n": "row 2 is not 4 numbers",
    "# note\n\nu0,v0,u1,v1\n0,0,1,1\n# note\n0,0,inf,1\n": "row 6 holds NaN or infinite",
    "# note\nu0,v0,u1,v1\n0,0,0,1.5\n": "row 3 has v outside",
    "# note\n# note\n": "holds no pins",
    "sep=": "its first row is 'sep='",
}


@pytest.mark.parametrize("text", BAD)
def test_what_cannot_be_told_is_refused_with_the_line_of_the_file(text: str, tmp_path: Path) -> None:
    with pytest.raises(BadInputError) as caught:
        read_pins(written(tmp_path, text), TUBE, 0.5)
    words = str(caught.value)
    assert BAD[text] in words
    assert words.startswith("pins.csv: ") and "; " in words and "\n" not in words and len(words) < 400


def test_rows_of_both_senses_keep_their_line(tmp_path: Path) -> None:
    path = written(tmp_path, "x0,y0,z0,x1,y1,z1\n\n1,0,0,1,0,3\n# next\n1,0,1,1,0,1\n")
    with pytest.raises(BadInputError, match="row 5 starts and ends in one point"):
        read_pins(path, TUBE, 0.0)


@pytest.mark.parametrize("content", [b"\x80\x81\x82", "u0,v0".encode("utf-16-le"), b"\xff\xfe\0", b"\xff\xfe\0\xd8"])
def test_what_is_no_text_is_refused(content: bytes, tmp_path: Path) -> None:
    with pytest.raises(BadInputError, match="cannot be read as CSV, as it is not text in UTF-8; save it"):
        pin_table(written(tmp_path, content))


def test_many_rows_are_read_quickly(tmp_path: Path) -> None:
    values = np.random.default_rng(0).random((20_000, 4))
    np.savetxt(tmp_path / "pins.csv", values, "%.17g", ";", header="u0;v0;u1;v1")
    assert (pin_table(tmp_path / "pins.csv").numbers(NAMES) == values).all()


def run(*arguments: str, folder: Path) -> tuple[int, str]:
    done = meshwind(*arguments, folder=folder)
    return done.returncode, done.stderr


def test_wrong_or_missing_pins_are_refused_before_anything_is_read(tmp_path: Path) -> None:
    (tmp_path / "part.stl").write_text("not a mesh, which comes later")
    written(tmp_path, "u0;v0;u1;v1\n0,0;0.0;0,25;1,0\n")
    code, said = run("wind", "part.stl", "--pins", "pins.csv", "--quiet", folder=tmp_path)
    assert code == 2 and said.startswith("meshwind: error: pins.csv: row 2 has a comma")
    code, said = run("wind", "part.stl", "--pins", "none.csv", "--quiet", folder=tmp_path)
    assert code == 2 and "none.csv: there is no such file" in said
    assert not (tmp_path / "part-wound").exists()
