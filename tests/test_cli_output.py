"""What the commands print: JSON and nothing else with --json, nothing but warnings with --quiet; exit codes as ever."""

import json
import subprocess
from pathlib import Path
from typing import Any

import pytest
from command import meshwind
from export_results import waisted_results
from test_cli import from_outside

DATA = Path(__file__).parents[1] / "data"


def read(done: subprocess.CompletedProcess[str]) -> Any:
    def refuse(word: str) -> None:
        raise ValueError(word)

    return json.loads(done.stdout, parse_constant=refuse)


def test_wind_as_json_is_the_report(tmp_path: Path) -> None:
    done = from_outside("wind", DATA / "tank.ply", "--out", tmp_path, "--paths", "2", "--no-render", "--json")
    assert done.returncode == 0
    printed, report = read(done), json.loads((tmp_path / "report.json").read_text())
    assert printed.pop("folder") == str(tmp_path)
    assert printed == report
    assert done.stderr == ""


def test_wind_in_quiet_says_only_what_went_wrong(tmp_path: Path) -> None:
    """Three turns do not hold on a closed part: still status 3."""
    options = "--paths", "2", "--revolutions", "3", "--no-render", "--quiet"
    done = meshwind("wind", DATA / "tank.ply", "--out", tmp_path, *options)
    assert done.returncode == 3
    assert done.stdout == ""
    assert done.stderr
    assert all(line.startswith("meshwind: warning: ") for line in done.stderr.splitlines())
    assert "not at rest" in done.stderr


def test_quiet_json_is_nothing_but_json(tmp_path: Path) -> None:
    done = meshwind("wind", DATA / "tank.ply", "--out", tmp_path, "--paths", "2", "--no-render", "--quiet", "--json")
    assert (done.returncode, done.stderr) == (0, "")
    assert read(done)["paths"]["converged"] == 4


def test_check(tmp_path: Path) -> None:
    done = meshwind("check", DATA / "tank.ply", "--quiet")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    (tmp_path / "flat.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    done = meshwind("check", tmp_path / "flat.obj", "--json")
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert read(done)["problem"] in done.stderr


def test_export(tmp_path: Path) -> None:
    waisted_results(tmp_path)
    printed = read(meshwind("export", tmp_path, "--to", "fibers,inp", "--thickness", "0.01", "--json"))
    decks = {"shell.inp", "shell.json", "shell_s4r.inp"}
    assert {Path(file).name for file in printed["files"]} == {"fibers.vtu", "fibers.vtk", *decks}
    assert all(Path(file).is_file() for file in printed["files"])
    assert any("elements" in note for note in printed["notes"])


@pytest.mark.usefixtures("opengl")
def test_render(tmp_path: Path) -> None:
    waisted_results(tmp_path)
    done = meshwind("render", tmp_path, "--only", "coverage", "--size", "320x240", "--quiet")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert (tmp_path / "coverage.png").is_file()


@pytest.mark.parametrize("command", ["wind", "check", "render", "export"])
def test_errors_leave_standard_output_empty(command: str, tmp_path: Path) -> None:
    done = meshwind(command, tmp_path / "none", "--json", "--quiet")
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1
