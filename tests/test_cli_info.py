"""`meshwind info`: what a mesh holds, what a run found, what this installation can do."""

import json
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest
from coarse_parts import coarse_vase, saved
from command import meshwind
from export_results import waisted_results

import meshwind as mw

DATA = Path(__file__).parents[1] / "data"


def info(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    return meshwind("info", *arguments)


def test_a_mesh() -> None:
    done = info(DATA / "tank.ply")
    assert done.returncode == 0
    lines = done.stdout.splitlines()
    assert lines[:2] == [
        "mesh      tank.ply: 240 mm long, 120 x 120 mm across; mm assumed; see --units",
        "file      PLY, 5000 vertices, 9996 faces",
    ]
    assert lines[2].startswith("size      120 x 120 x 240, diagonal")
    assert lines[3].startswith("piece     0: ")
    assert lines[4] == "shape     closed, genus 0"
    assert lines[5] == "fields    none"
    assert "verdict" not in done.stdout


def test_a_mesh_with_fields_and_rims(tmp_path: Path) -> None:
    waisted_results(tmp_path)
    printed = json.loads(info(tmp_path / "surface.vtu", "--json").stdout)
    assert {"coverage", "angle", "windability"} <= set(printed["fields"])
    assert len(printed["rims"]) == 2
    assert printed["format"] == "VTU"


def test_a_run(tmp_path: Path) -> None:
    mw.wind(DATA / "tank.ply", paths=2, out=tmp_path, render=False, units="mm", command="meshwind wind tank.ply")
    done = info(tmp_path)
    labels = [line.split()[0] for line in done.stdout.splitlines()]
    assert labels == ["run", "part", "mesh", "surface", "fitted", "paths", "coverage", "angle", "seconds"]
    assert f"meshwind wind tank.ply (meshwind {mw.__version__})" in done.stdout
    assert "4 of 4 at rest" in done.stdout
    assert json.loads(info(tmp_path, "--json").stdout) == json.loads((tmp_path / "report.json").read_text())


def test_a_redesign_which_its_own_options_repeat(tmp_path: Path) -> None:
    given = (
        "redesign",
        saved(coarse_vase(), tmp_path / "vase.ply"),
        "--paths",
        "2",
        "--particles",
        "101",
        "--revolutions",
        "0.8",
        "--no-render",
        "--out",
        tmp_path / "r",
    )
    made = meshwind(*given)
    assert made.returncode == 0, made.stderr
    lines = info(tmp_path / "r").stdout.splitlines()
    assert lines[0].startswith("run       meshwind redesign ")
    assert lines[1:] == made.stdout.splitlines()[:-1]
    again = meshwind("redesign", "--config", tmp_path / "r" / "meshwind.toml", "--out", tmp_path / "s")
    assert again.returncode == 0, again.stderr
    for name in ("edited.ply", "edited.vtu", "meshwind.toml"):
        assert (tmp_path / "s" / name).read_bytes() == (tmp_path / "r" / name).read_bytes()


def test_this_installation() -> None:
    done = info("--json")
    assert done.returncode == 0
    printed = json.loads(done.stdout)
    assert printed["meshwind"] == mw.__version__ == version("meshwind")
    assert printed["libraries"]["numpy"] == version("numpy")
    assert None not in printed["libraries"].values()
    assert printed["extras"] == {"cad": True, "pandas": True}


@pytest.mark.parametrize(("name", "content", "says"), [
    ("none", None, "file not found"), ("report.json", "{}", "lacks figures"), ("report.json", "[", "cannot be used"),
    ("report.json", '{"mesh": 3}', "lacks figures"), ("mine.txt", "x", "holds no report.json"),
])  # fmt: skip
def test_what_holds_nothing_is_refused(name: str, content: str | None, says: str, tmp_path: Path) -> None:
    if content is not None:
        (tmp_path / name).write_text(content)
    done = info(tmp_path if content is not None else tmp_path / name)
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1
    assert says in done.stderr


def test_the_version() -> None:
    done = subprocess.run([sys.executable, "-m", "meshwind", "--version"], capture_output=True, text=True, check=True)
    assert done.stdout == f"meshwind {mw.__version__}\n"
