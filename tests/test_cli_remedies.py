"""What stands in a command's way is told with its remedy: to a person, to a script, and to one who wants quiet."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from export_results import waisted_results

DATA = Path(__file__).parents[1] / "data"


def meshwind(*arguments: str | Path, folder: Path, driver: bool = True) -> subprocess.CompletedProcess[str]:
    """The command in a folder; without a driver EGL finds none."""
    blind = {"__EGL_VENDOR_LIBRARY_DIRS": str(folder / "none"), "VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow"}
    command = [sys.executable, "-m", "meshwind", *map(str, arguments)]
    return subprocess.run(
        command, capture_output=True, text=True, timeout=180, cwd=folder, env=os.environ | ({} if driver else blind)
    )


@pytest.mark.parametrize("arguments", [
    ["wind"], ["wind", "none.obj"], ["wind", "part.obj"], ["wind", "part.obj", "--paths", "2.5"], ["check", "."],
    ["wind", "part.obj", "--out", "part.obj"], ["render", "."], ["export", "."], ["info", "none.obj"],
    ["redesign", "none.obj"],
])  # fmt: skip
def test_an_error_is_told_to_scripts_in_the_same_words(arguments: list[str], tmp_path: Path) -> None:
    (tmp_path / "part.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    plain, done = meshwind(*arguments, folder=tmp_path), meshwind(*arguments, "--json", folder=tmp_path)
    assert plain.returncode == done.returncode == 2
    assert done.stdout == ""
    told = json.loads(done.stderr)
    assert told["exit_status"] == 2
    assert plain.stderr.splitlines()[-1] == f"meshwind: error: {told['error']}"
    assert [file.name for file in tmp_path.iterdir()] == ["part.obj"]


def test_without_a_driver_all_but_pictures_is_written(tmp_path: Path) -> None:
    """In the summary, in JSON and to those who asked for quiet: what to install."""
    wind = "wind", DATA / "tank.ply", "--paths", "2", "--out"
    told = meshwind(*wind, "one", folder=tmp_path, driver=False)
    assert told.returncode == 0
    assert told.stdout.count("apt-get install libegl1 libgl1-mesa-dri") == 1
    there = {file.name for file in (tmp_path / "one").iterdir()}
    assert {"paths.vtp", "bridges.vtp", "crossings.vtp", "quads.vtu", "surface.vtu", "report.json"} <= there
    assert not there & {"winding.png", "sheet.png"}
    quiet = meshwind(*wind, "two", "--quiet", folder=tmp_path, driver=False)
    assert quiet.stdout == ""
    assert [line.startswith("meshwind: warning: no picture") for line in quiet.stderr.splitlines()] == [True]
    drawn = meshwind("render", "one", "--out", "drawn", "--json", folder=tmp_path, driver=False)
    assert drawn.returncode == 2
    assert "apt-get install libegl1 libgl1-mesa-dri" in json.loads(drawn.stderr)["error"]
    assert not (tmp_path / "drawn").exists()


@pytest.mark.parametrize(("arguments", "hidden", "remedy"), [
    (["export", "run", "--to", "viewer"], ["plotly"], 'pip install "meshwind[viewer]"'),
    (["export", "run", "--to", "step"], ["OCP"], "pip install 'meshwind[cad]'"),
    (["render", "run", "--animate", "mp4"], ["imageio_ffmpeg"], 'pip install "meshwind[movie]"'),
])  # fmt: skip
def test_an_extra_that_is_missing_names_its_remedy(
    arguments: list[str], hidden: list[str], remedy: str, tmp_path: Path
) -> None:
    """Python is told that the packages are not there, and no program is on the path."""
    (tmp_path / "run").mkdir()
    waisted_results(tmp_path / "run")
    before = {file.name for file in (tmp_path / "run").iterdir()}
    code = f"""import importlib.util as u, sys
find = u.find_spec
u.find_spec = lambda name, *more: None if name in {hidden} else find(name, *more)
sys.argv = ["meshwind", *{arguments}]
from meshwind.cli import main
main()"""
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=tmp_path, env=os.environ | {"PATH": ""}
    )
    assert done.returncode == 2
    assert remedy in done.stderr.splitlines()[-1]
    assert {file.name for file in (tmp_path / "run").iterdir()} == before
