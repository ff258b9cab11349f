"""A folder that is wound anew loses all that was exported of the earlier run, and nothing else."""

from pathlib import Path

import pytest
from command import meshwind
from export_results import waisted_results

from meshwind.core.errors import BadInputError
from meshwind.exporting.formats import FORMATS
from meshwind.exporting.targets import TARGETS, ExportOptions, write_exports
from meshwind.results.folder import exports_in, writing
from meshwind.results.schema import RESULTS

DATA = Path(__file__).parents[1] / "data"
FOREIGN = (
    "notes.txt", "shell.inp.bak", "my_shell.inp", "fibers.csv", "photo.png", "surface.stl", "frames/mine.csv",
    "frames/path_a.csv", "formats/surface.stl", "formats/other.vtu", "deeper/frames/path_000.csv", "deeper/shell.inp",
)  # fmt: skip


def everything(folder: Path) -> set[str]:
    return {file.relative_to(folder).as_posix() for file in folder.rglob("*") if file.is_file()}


def exported(folder: Path) -> None:
    waisted_results(folder)
    write_exports(folder, tuple(TARGETS), options=ExportOptions(thickness=0.01, formats=tuple(FORMATS)))


def test_all_that_an_export_writes_is_known(tmp_path: Path) -> None:
    exported(tmp_path)
    assert everything(tmp_path) - RESULTS == set(exports_in(tmp_path))
    assert "viewer.html" in RESULTS
    assert {"shell.inp", "fibers.vtu", "surface.step", "frames/all.csv", "formats/paths.h5"} <= set(
        exports_in(tmp_path)
    )


def test_only_exports_go(tmp_path: Path) -> None:
    exported(tmp_path)
    for name in FOREIGN:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("mine")
    with writing(tmp_path, overwrite=True) as staging:
        (staging / "report.json").write_text("new")
    assert everything(tmp_path) == {*FOREIGN, "report.json"}
    assert all((tmp_path / name).read_text() == "mine" for name in FOREIGN)


def test_folders_of_exports_go_where_they_are_empty(tmp_path: Path) -> None:
    exported(tmp_path)
    with writing(tmp_path, overwrite=True) as staging:
        (staging / "report.json").write_text("new")
    assert [path.name for path in tmp_path.iterdir()] == ["report.json"]


def test_exports_are_not_replaced_without_being_asked(tmp_path: Path) -> None:
    (tmp_path / "frames").mkdir()
    (tmp_path / "frames" / "path_000.csv").write_text("of another run")
    with pytest.raises(BadInputError, match="holds results already"), writing(tmp_path) as staging:
        (staging / "report.json").write_text("new")
    assert everything(tmp_path) == {"frames/path_000.csv"}


def test_from_the_command_line(tmp_path: Path) -> None:
    for arguments in (
        ["wind", str(DATA / "tank.ply"), "--out", "run", "--paths", "2", "--no-render"],
        ["export", "run", "--to", "fibers,frames,viewer"],
    ):
        assert meshwind(*arguments, folder=tmp_path).returncode == 0
    assert {"fibers.vtu", "viewer.html", "frames/path_003.csv"} <= everything(tmp_path / "run")
    (tmp_path / "run" / "frames" / "robot.txt").write_text("mine")
    again = "wind", "--config", "run/meshwind.toml", "--quiet", "--overwrite"
    assert meshwind(*again, folder=tmp_path).returncode == 0
    assert not exports_in(tmp_path / "run")
    assert everything(tmp_path / "run") >= {"report.json", "frames/robot.txt"}
    assert "viewer.html" not in everything(tmp_path / "run")
