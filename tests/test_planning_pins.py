"""Pins from a file: both forms, what they are moved to, and wrong files."""

from pathlib import Path

import numpy as np
import pytest

from meshwind.core.errors import BadInputError
from meshwind.path import solve
from meshwind.planning.pins import read_pins
from meshwind.surface import shapes

ELBOW = shapes.elbow(3.0, 1.0, spans=(48, 32))


def written(folder: Path, text: str) -> Path:
    path = folder / "pins.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_parametric_pins_are_taken_as_they_are(tmp_path: Path) -> None:
    pins = read_pins(written(tmp_path, "u0,v0,u1,v1\n0.5,0,-0.25,1\n0,0.1,1.5,0.9\n\n"), ELBOW, 0.7)
    assert pins.start.tolist() == [[0.0, 0.1], [0.5, 0.0]]  # family +1 first
    assert pins.end.tolist() == [[1.5, 0.9], [-0.25, 1.0]]
    assert pins.family.tolist() == [1, -1]


def test_points_are_moved_to_the_surface_and_turned_both_ways(tmp_path: Path) -> None:
    wanted = np.array([[0.13, 0.0], [0.71, 1.0], [0.4, 0.3], [0.9, 0.6]])
    points = ELBOW.points(wanted) + 0.01 * ELBOW.normals(wanted)
    points[:2] = ELBOW.points(wanted[:2])  # off a rim the nearest point is on it
    rows = [",".join(repr(float(x)) for x in (*points[a], *points[b])) for a, b in ((0, 1), (2, 3))]
    pins = read_pins(written(tmp_path, "x0,y0,z0,x1,y1,z1\n" + "\n".join(rows)), ELBOW, 1.2)
    assert pins.family.tolist() == [1, 1, -1, -1]
    assert pins.start == pytest.approx(wanted[[0, 2, 0, 2]], abs=1e-6)
    turn = pins.end[:, 0] - pins.start[:, 0]
    assert np.abs(turn - [1.2, 1.2, -1.2, -1.2]).max() <= 0.5
    assert np.mod(pins.end[:, 0], 1.0) == pytest.approx(np.array([0.71, 0.9, 0.71, 0.9]), abs=1e-6)
    laid = solve(ELBOW, pins.start, pins.end, particles=97, family=pins.family)
    assert (laid.status == 0).all()
    assert laid.points[0, 0] == pytest.approx(points[0], abs=1e-6)


def test_a_column_of_revolutions_is_used(tmp_path: Path) -> None:
    points = ELBOW.points(np.array([[0.2, 0.0], [0.3, 1.0]]))
    row = ",".join(repr(float(x)) for x in points.ravel())
    pins = read_pins(written(tmp_path, f"x0,y0,z0,x1,y1,z1,revolutions\n{row},-1\n{row},2\n"), ELBOW, 0.5)
    assert pins.end[:, 0] - pins.start[:, 0] == pytest.approx(np.array([2.1, -0.9]), abs=1e-6)


WRONG = [
    ("", "holds no pins"),
    ("u0,v0,u1,v1\n", "holds no pins"),
    ("a,b\n1,2\n", "name the columns u0,v0,u1,v1 or x0,y0,z0"),
    ("u0,v0,u1,v1\n0,0,1\n", "row 2 is not 4 numbers"),
    ("u0,v0,u1,v1\n0,0,1,1\n0,0,x,1\n", "row 3 is not 4 numbers"),
    ("u0,v0,u1,v1\n0,0,nan,1\n", "row 2 holds NaN"),
    ("u0,v0,u1,v1\n0,0,1,1.5\n", "row 2 has v outside"),
    ("u0,v0,u1,v1\n0.5,0.5,0.5,0.5\n", "row 2 starts and ends in one point"),
    ("x0,y0,z0,x1,y1,z1\n90,0,0,0,0,3\n", "row 2 has a pin"),
]


@pytest.mark.parametrize(("text", "says"), WRONG)
def test_wrong_files_are_refused_in_one_line(tmp_path: Path, text: str, says: str) -> None:
    with pytest.raises(BadInputError) as caught:
        read_pins(written(tmp_path, text), ELBOW, 0.5)
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_file_that_is_missing_or_no_text_is_refused(tmp_path: Path) -> None:
    with pytest.raises(BadInputError, match="no such file"):
        read_pins(tmp_path / "none.csv", ELBOW, 0.5)
    (tmp_path / "pins.csv").write_bytes(bytes(range(128, 256)))
    with pytest.raises(BadInputError, match="cannot be read as CSV"):
        read_pins(tmp_path / "pins.csv", ELBOW, 0.5)
    with pytest.raises(BadInputError, match="cannot be read as CSV"):
        read_pins(tmp_path, ELBOW, 0.5)
