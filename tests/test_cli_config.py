"""`--config`: a file of options, which the command line overrides, and the file of each run, which repeats it."""

import json
import subprocess
import tomllib
from fractions import Fraction
from pathlib import Path

import pytest
from command import meshwind

import meshwind as mw

DATA = Path(__file__).parents[1] / "data"
TIMED = {"report.json"}


def wind(*arguments: str | Path, folder: Path) -> subprocess.CompletedProcess[str]:
    return meshwind("wind", *arguments, folder=folder)


def contents(folder: Path) -> dict[str, bytes]:
    return {file.name: file.read_bytes() for file in folder.iterdir() if file.name not in TIMED}


@pytest.fixture(scope="module")
def first(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run whose options come in part from a file, in part from the command line."""
    folder = tmp_path_factory.mktemp("config")
    (folder / "part.ply").write_bytes((DATA / "tank.ply").read_bytes())
    (folder / "sub").mkdir()
    lines = 'mesh = "../part.ply"', "paths = 7", 'revolutions = "5/12"', "band-width = 20", "render = false"
    (folder / "sub" / "my.toml").write_text("\n".join((*lines, 'out = "wound"', "particles = 201", 'units = "in"')))
    done = wind("--config", "sub/my.toml", "--paths", "3", "--units", "cm", folder=folder)
    assert done.returncode == 0, done.stderr
    return folder / "sub" / "wound"


def test_the_command_line_overrides_the_file(first: Path) -> None:
    report = json.loads((first / "report.json").read_text())
    assert report["winding"]["paths_per_family"] == 3
    assert report["winding"]["revolutions"] == 5 / 12
    assert report["winding"]["particles"] == 201
    assert report["mesh"]["units"] == "cm"
    assert report["coverage"]["band_width"] == 20.0
    assert not (first / "winding.png").exists()


def test_a_run_leaves_all_its_options(first: Path) -> None:
    text = (first / "meshwind.toml").read_text()
    assert text.startswith("# meshwind 0.")
    assert "# opening: not given" in text
    assert tomllib.loads(text) == {
        "mesh": "../../part.ply", "out": ".", "paths": 3, "revolutions": float(Fraction(5, 12)), "particles": 201,
        "friction": 0.0, "ends": "auto", "tolerance": 1e-5, "worst-fit": 0.1, "units": "cm",
        "band-width": 20.0, "render": False, "side": "outer", "opening-by": "auto", "continuous": False,
        "turn-start": "auto", "turn-end": "auto",
    }  # fmt: skip


def test_it_repeats_the_run_to_the_last_byte(first: Path, tmp_path: Path) -> None:
    """From another folder, into one beside the first: only the report, which holds times, differs."""
    again = first.with_name("again")
    done = wind("--config", first / "meshwind.toml", "--out", again, folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert contents(again) == contents(first)


def test_whatever_was_left_to_the_run_is_left_to_it_again(tmp_path: Path) -> None:
    options = {"paths": 2, "revolutions": "auto", "particles": None, "pins": None}
    mw.wind(DATA / "tank.ply", out=tmp_path / "run", render=False, **options)  # type: ignore[arg-type]
    held = tomllib.loads((tmp_path / "run" / "meshwind.toml").read_text())
    assert (held["revolutions"], held["particles"]) == ("auto", "auto") and "units" not in held
    assert (tmp_path / "run" / held["mesh"]).resolve() == (DATA / "tank.ply").resolve()


@pytest.mark.parametrize(("text", "says"), [
    ("path = 3", "my.toml: 'path' is no option; did you mean 'paths'?"),
    ("band_width = 3", "'band_width' is no option; did you mean 'band-width'?"),
    ("no-render = true", "'no-render' is no option; write render = false"),
    ("xyz = 3", "'xyz' is no option; give mesh, paths, "), ("[wind]\npaths = 3", "'wind' is no option; give mesh"),
    ("paths = 'many'", "paths is 'many'; give a whole number"), ("paths = 2.5", "paths is 2.5; give a whole number"),
    ("paths = true", "paths is True; give a whole number"), ("tolerance = '1'", "tolerance is '1'; give a number"),
    ("units = 3", "units is 3; give a text in quotes"), ("render = 'no'", "render is 'no'; give true or false"),
    ("mesh = 3", "mesh is 3; give a text in quotes"),
    ("revolutions = [1]", "revolutions is [1]; give a number or a text in quotes"),
    ("opening = 2024-01-01", "opening is datetime.date(2024, 1, 1); give a number"),
    ("revolutions = 0,5", "write decimals with a point"),
    (r'mesh = "C:\Users\me\part.stl"', "write folders with /, or the path in single quotes"),
    ("a b", "is not valid TOML"), ("paths = 3\npaths = 4", "is not valid TOML"), ("\0", "is not valid TOML"),
    ("paths = 0", "paths is 0; give a whole number from 1 up"), ("revolutions = -1", "revolutions is -1; give"),
])  # fmt: skip
def test_what_a_file_may_not_hold_is_refused_in_one_line(text: str, says: str, tmp_path: Path) -> None:
    (tmp_path / "my.toml").write_text(text)
    done = wind("part.stl", "--config", "my.toml", folder=tmp_path)
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1
    assert says in done.stderr
    assert [file.name for file in tmp_path.iterdir()] == ["my.toml"]


@pytest.mark.parametrize(("name", "content", "says"), [
    ("none.toml", None, "No such file"), (".", None, "Is a directory"), ("latin.toml", b"# \xe9", "not text in UTF-8"),
])  # fmt: skip
def test_files_that_cannot_be_read_are_refused(name: str, content: bytes | None, says: str, tmp_path: Path) -> None:
    if content is not None:
        (tmp_path / name).write_bytes(content)
    done = wind("part.stl", "--config", name, folder=tmp_path)
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert says in done.stderr


def test_a_mesh_has_to_come_from_somewhere(tmp_path: Path) -> None:
    (tmp_path / "my.toml").write_text("paths = 3")
    done = wind("--config", "my.toml", folder=tmp_path)
    assert done.returncode == 2
    assert "MESH" in done.stderr
