"""A results folder is read back whole or refused, and exports appear in it together or not at all."""

import json
import subprocess
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from command import meshwind
from export_results import leave, waisted_results
from layup_shapes import bridged

from meshwind.core.errors import BadInputError
from meshwind.exporting.targets import TARGETS, ExportOptions, write_exports
from meshwind.path.paths import Status
from meshwind.results.folder import beside
from meshwind.results.reading import read_results

KEPT = "points", "uv", "on_surface", "gap", "normal", "slip", "family", "status"


def everything(folder: Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


def test_paths_and_surface_come_back(tmp_path: Path) -> None:
    paths = bridged()
    results = leave(tmp_path, paths)
    for name in KEPT:
        before, after = getattr(paths, name), getattr(results.paths, name)
        assert before.shape == after.shape
        assert before.dtype == after.dtype
        assert np.array_equal(before, after, equal_nan=True), name
        assert not after.flags.writeable
    assert np.array_equal(results.surface.control_points, paths.surface.control_points)
    assert results.units == "mm"
    assert results.name == "part.stl"
    assert results.band_width == results.layup.coverage.width
    assert results.report["quads"]["faces"] == len(results.layup.quads.quads) + len(results.layup.quads.triangles)
    assert {f.name for f in fields(paths)} >= set(KEPT)


def test_paths_not_at_rest_are_known_and_left_out(tmp_path: Path) -> None:
    paths = bridged()
    status = np.array(paths.status)
    status[3] = Status.STALLED
    object.__setattr__(paths, "status", status)
    results = leave(tmp_path, paths)
    assert np.flatnonzero(~results.at_rest).tolist() == [3]
    assert np.array_equal(results.paths.residual, paths.residual)
    done = write_exports(tmp_path, ["frames"])
    assert "frames: left out as not at rest: 1 of 32 paths" in done.notes
    assert not (tmp_path / "frames" / "path_003.csv").exists()


@pytest.mark.parametrize(("name", "content", "says"), [
    ("paths.vtp", None, "holds no paths.vtp"), ("surface.npz", None, "holds no surface.npz"),
    ("report.json", "{", "report.json cannot be used"), ("surface.npz", "xx", "surface.npz cannot be used"),
    ("paths.vtp", "<VTKFile", "paths.vtp cannot be used"), ("report.json", "[1]", "no figures in it"),
])  # fmt: skip
def test_spoilt_folders_are_refused(
    tmp_path: Path, name: str, content: str | None, says: str, capfd: pytest.CaptureFixture[str]
) -> None:
    waisted_results(tmp_path)
    (tmp_path / name).unlink()
    if content is not None:
        (tmp_path / name).write_text(content)
    with pytest.raises(BadInputError, match=says):
        read_results(tmp_path)
    assert capfd.readouterr().err == ""


def test_no_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(BadInputError, match="is no folder"):
        read_results(tmp_path / "none")


def test_exports_come_together_or_not_at_all(tmp_path: Path) -> None:
    waisted_results(tmp_path)
    before = everything(tmp_path)
    with pytest.raises(BadInputError, match="angle is -1"):
        write_exports(tmp_path, ["fibers", "frames"], options=ExportOptions(angle=-1.0))
    with pytest.raises(BadInputError, match="angle is -1"):
        write_exports(tmp_path, ["fibers", "frames"], tmp_path / "a" / "b", ExportOptions(angle=-1.0))
    assert everything(tmp_path) == before


def test_an_export_replaces_the_last_one_and_leaves_all_else(tmp_path: Path) -> None:
    waisted_results(tmp_path)
    before = set(everything(tmp_path))
    (tmp_path / "frames").mkdir()
    for name in ("path_999.csv", "mine.txt"):
        (tmp_path / "frames" / name).write_text("old")
    done = write_exports(tmp_path, ["inp", "frames"], options=ExportOptions(thickness=0.01))
    after = set(everything(tmp_path))
    assert before < after
    assert after - before == {str(file.relative_to(tmp_path)) for file in done.files} | {"frames", "frames/mine.txt"}
    assert (tmp_path / "frames" / "mine.txt").read_text() == "old"


def test_a_folder_where_a_file_belongs_stops_all(tmp_path: Path) -> None:
    (tmp_path / "b").mkdir()
    with pytest.raises(BadInputError, match="move it away"), beside(tmp_path) as staging:
        (staging / "a").write_text("x")
        (staging / "b").write_text("x")
    with pytest.raises(BadInputError, match="move it away"), beside(tmp_path) as staging:
        (staging / "c").mkdir()
        (staging / "c" / "d").write_text("x")
        (tmp_path / "c").write_text("x")
    assert everything(tmp_path) == ["b", "c"]


@pytest.mark.parametrize(("to", "given", "says"), [
    (["inp", "wings"], {}, "target 'wings' is not known; give inp, fibers, frames, step, viewer"),
    ([], {}, "nothing to export; give to \\(inp,"), (["inp"], {"shell": "hex"}, "shell is 'hex'; give grid or quads"),
    (["inp"], {"count": 3}, "elements is 3; give"), ([], {"formats": ["stl"]}, "format 'stl' is not known; give vtu"),
])  # fmt: skip
def test_what_cannot_be_exported_is_refused(tmp_path: Path, to: list[str], given: dict[str, object], says: str) -> None:
    with pytest.raises(BadInputError, match=says):
        write_exports(tmp_path, to, options=ExportOptions(**given))  # type: ignore[arg-type]


def run(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    return meshwind("export", *arguments)


def test_the_command_line(tmp_path: Path) -> None:
    waisted_results(tmp_path)
    out = tmp_path / "given"
    asked = "--to", "inp,fibers, frames", "--formats", "ply", "--shell", "quads", "--thickness", "0.01"
    done = run(tmp_path, *asked, "--out", out)
    assert done.stderr == ""
    assert done.returncode == 0
    lines = [line.split(None, 1) for line in done.stdout.splitlines()]
    assert {kind for kind, _ in lines} == {"note", "file"}
    decks = {"shell.inp", "shell_s4r.inp", "shell.json"}
    assert {"fibers.vtu", "fibers.vtk", *decks, "frames", "formats"} == {file.name for file in out.iterdir()}
    assert f"{out}/frames/path_000.csv and 31 more" in done.stdout
    assert "ply: no lines; paths and bridges are written as their points" in done.stdout
    assert json.loads((tmp_path / "report.json").read_text())["mesh"]["units"] == "mm"


def test_the_command_line_says_what_is_wrong_in_one_line(tmp_path: Path) -> None:
    for arguments, says in (((tmp_path, "--to", "inp"), "holds no paths.vtp"), ((tmp_path,), "nothing to export")):
        done = run(*arguments)
        assert done.returncode == 2
        assert done.stdout == ""
        assert len(done.stderr.splitlines()) == 1
        assert says in done.stderr
    assert everything(tmp_path) == []


def test_help_names_every_target() -> None:
    shown = run("--help").stdout
    assert all(f"{name}:" in shown for name in TARGETS)
