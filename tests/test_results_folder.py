"""Files appear whole and together, or nothing does."""

from pathlib import Path

import pytest

from meshwind.core.errors import BadInputError
from meshwind.results.folder import prepare, writing


def everything(folder: Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


def test_files_move_in_and_others_stay(tmp_path: Path) -> None:
    out = tmp_path / "run"
    out.mkdir()
    (out / "notes.txt").write_text("mine")
    (out / "report.json").write_text("old")
    with writing(out, overwrite=True) as staging:
        (staging / "report.json").write_text("new")
        (staging / "paths.vtp").write_text("x")
        assert (out / "report.json").read_text() == "old"
    assert everything(tmp_path) == ["run", "run/notes.txt", "run/paths.vtp", "run/report.json"]
    assert (out / "report.json").read_text() == "new"
    assert (out / "notes.txt").read_text() == "mine"


def test_results_of_an_earlier_run_do_not_stay_beside_a_new_report(tmp_path: Path) -> None:
    (tmp_path / "winding.png").write_text("of the last run")
    (tmp_path / "photo.png").write_text("mine")
    with pytest.raises(RuntimeError), writing(tmp_path, overwrite=True):
        raise RuntimeError
    assert everything(tmp_path) == ["photo.png", "winding.png"]
    with writing(tmp_path, overwrite=True) as staging:
        (staging / "report.json").write_text("new")
    assert everything(tmp_path) == ["photo.png", "report.json"]


def test_missing_parents_are_made(tmp_path: Path) -> None:
    with writing(tmp_path / "a" / "b") as staging:
        (staging / "f").write_text("x")
    assert everything(tmp_path) == ["a", "a/b", "a/b/f"]


@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt, OSError])
def test_a_failure_in_the_middle_leaves_nothing(tmp_path: Path, error: type[BaseException]) -> None:
    kept = tmp_path / "kept"
    kept.mkdir()
    (kept / "f").write_text("old")
    for out in (tmp_path / "a" / "b", kept):
        with pytest.raises((error, BadInputError)), writing(out) as staging:
            (staging / "f").write_text("half")
            raise error
    assert everything(tmp_path) == ["kept", "kept/f"]
    assert (kept / "f").read_text() == "old"


def test_a_full_disk_is_reported_in_one_line(tmp_path: Path) -> None:
    with pytest.raises(BadInputError) as caught, writing(tmp_path / "a"):
        raise OSError(28, "No space left on device")
    assert str(caught.value) == f"cannot write to {tmp_path / 'a'}: No space left on device; give another folder"


def test_prepare_leaves_no_trace(tmp_path: Path) -> None:
    prepare(tmp_path / "a" / "b")
    prepare(tmp_path)
    assert everything(tmp_path) == []


@pytest.mark.parametrize("below", ["", "under", "far/under"])
def test_a_file_in_the_way_is_refused(tmp_path: Path, below: str) -> None:
    (tmp_path / "file").write_text("x")
    out = tmp_path / "file" / below
    for enter in (prepare, lambda out: writing(out).__enter__()):
        with pytest.raises(BadInputError, match="give a"):
            enter(out)
    assert everything(tmp_path) == ["file"]


def test_a_folder_that_cannot_be_written_is_refused() -> None:
    with pytest.raises(BadInputError, match="give another folder"):
        prepare(Path("/proc/nowhere/at/all"))


def test_a_dangling_link_is_refused(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "gone" / "further")
    with pytest.raises(BadInputError, match="give another folder"):
        prepare(tmp_path / "link")
    assert everything(tmp_path) == ["link"]


def test_a_folder_where_a_file_belongs_stops_all_of_them(tmp_path: Path) -> None:
    (tmp_path / "out" / "b").mkdir(parents=True)
    with pytest.raises(BadInputError, match="move it away"), writing(tmp_path / "out") as staging:
        (staging / "a").write_text("x")
        (staging / "b").write_text("x")
    assert everything(tmp_path) == ["out", "out/b"]
