"""Each table has a legend beside it, and begins with the names of its columns, which pandas and NumPy read."""

import csv
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import meshwind as mw
from meshwind.program.targets import write_program

DATA = Path(__file__).parents[1] / "data"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("run") / "out"
    mw.wind(
        DATA / "tank.ply", paths=5, revolutions=0.3, particles=51, continuous=True, friction=0.3, band_width=4.0,
        band_thickness=0.2, out=out, render=False, units="in",
    )  # fmt: skip
    write_program(out, again=False)
    mw.export(out, "frames")
    return out


def legend(file: Path) -> dict[str, tuple[str, str]]:
    with file.open(newline="") as stream:
        rows = list(csv.reader(stream))
    assert rows[0] == ["column", "unit", "meaning"]
    assert all(meaning for _, _, meaning in rows[1:])
    return {name: (unit, meaning) for name, unit, meaning in rows[1:]}


@pytest.mark.parametrize(("table", "says", "lengths"), [
    ("laminate.csv", "laminate_columns.csv", {"z", "thickness"}),
    ("program.csv", "program_columns.csv", {"arc_length", "x", "y", "z", "free_length", "eye_x", "eye_r"}),
])  # fmt: skip
def test_a_legend_has_each_column_with_its_unit(folder: Path, table: str, says: str, lengths: set[str]) -> None:
    held, read = legend(folder / says), pd.read_csv(folder / table)
    assert list(held) == read.columns.tolist()
    assert {name for name, (unit, _) in held.items() if unit == "in"} == lengths
    assert np.loadtxt(folder / table, delimiter=",", skiprows=1).shape == read.shape


def test_frames_have_a_legend_of_all_their_columns(folder: Path) -> None:
    held = legend(folder / "frames" / "columns.csv")
    files = [file for file in (folder / "frames").iterdir() if file.name != "columns.csv"]
    assert len(files) > 5
    columns = {name for file in files for name in pd.read_csv(file, nrows=1).columns}
    assert columns <= set(held)
    assert held["x"][0] == held["width"][0] == "mm"  # whatever the unit of the part
    path = pd.read_csv(folder / "frames" / "path_000.csv")
    assert path.columns.tolist() == list(held)[-len(path.columns) :]


def test_legends_go_when_a_folder_is_wound_anew(folder: Path) -> None:
    mw.wind(DATA / "tank.ply", paths=3, particles=51, out=folder, render=False, overwrite=True)
    assert not [file.name for file in folder.rglob("*columns.csv")]
