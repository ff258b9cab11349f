"""What the commands print: JSON and nothing else with --json, nothing but warnings with --quiet; exit codes as ever."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from export_results import waisted_results

DATA = Path(__file__).parents[1] / "data"


def meshwind(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "meshwind", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=120)


def read(done: subprocess.CompletedProcess[str]) -> Any:
    def refuse(word: str) -> None:
        raise ValueError(word)

    return json.loads(done.stdout, parse_constant=refuse)


def test_wind_as_json_is_the_report(tmp_path: Path) -> None:
    done = meshwind("wind", DATA / "tank.ply", "--out", tmp_path, "--paths", "2", "--no-render", "--json")
    assert done.returncode == 0
    told, report = read(done), json.loads((tmp_path / "report.json").read_text())
    assert told.pop("folder") == str(tmp_path)
    assert told == report
    assert done.stderr == ""


@pytest.mark.parametrize("as_json", [[], ["--json"]])
def test_wind_in_quiet_says_only_what_went_wrong(as_json: list[str], tmp_path: Path) -> None:
    """Three turns do not hold on a closed part: still status 3."""
    options = "--paths", "2", "--revolutions", "3", "--no-render", "--quiet", *as_json
    done = meshwind("wind", DATA / "tank.ply", "--out", tmp_path, *options)
    assert done.returncode == 3
    if as_json:
        assert len(read(done)["paths"]["not_converged"]) == 4
        assert done.stderr == ""
    else:
        assert done.stdout == ""
        assert done.stderr
        assert all(line.startswith("meshwind: warning: ") for line in done.stderr.splitlines())
        assert "not at rest" in done.stderr


def test_quiet_is_silent_where_all_is_well(tmp_path: Path) -> None:
    done = meshwind("wind", DATA / "tank.ply", "--out", tmp_path, "--paths", "2", "--no-render", "--quiet")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert (tmp_path / "report.json").is_file()


def test_check(tmp_path: Path) -> None:
    assert read(meshwind("check", DATA / "tank.ply", "--json"))["vertices"] == 5000
    done = meshwind("check", DATA / "tank.ply", "--quiet")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    (tmp_path / "flat.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    for way in ("--json", "--quiet"):
        done = meshwind("check", tmp_path / "flat.obj", way)
        assert done.returncode == 2
        assert len(done.stderr.splitlines()) == 1
        if way == "--json":
            assert read(done)["problem"] in done.stderr
        else:
            assert done.stdout == ""


def test_export_and_render(tmp_path: Path) -> None:
    waisted_results(tmp_path)
    told = read(meshwind("export", tmp_path, "--to", "fibers,inp", "--json"))
    assert {Path(file).name for file in told["files"]} == {"fibers.vtu", "fibers.vtk", "shell.inp", "shell_s4r.inp"}
    assert all(Path(file).is_file() for file in told["files"])
    assert any("elements" in note for note in told["notes"])
    done = meshwind("export", tmp_path, "--to", "fibers", "--quiet")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    draw = "render", tmp_path, "--only", "coverage", "--size", "320x240"
    assert read(meshwind(*draw, "--json"))["files"] == [str(tmp_path / "coverage.png")]
    done = meshwind(*draw, "--quiet")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


@pytest.mark.parametrize("command", ["wind", "check", "render", "export"])
def test_errors_leave_standard_output_empty(command: str, tmp_path: Path) -> None:
    for way in ("--json", "--quiet"):
        done = meshwind(command, tmp_path / "none", way)
        assert done.returncode == 2
        assert done.stdout == ""
        assert len([line for line in done.stderr.splitlines() if not line.endswith("...")]) == 1
