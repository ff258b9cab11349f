"""Runs killed while they write: the folder holds one run's files, whole, and the next run tidies up."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from killed_writer import FOREIGN

from meshwind.core.errors import BadInputError
from meshwind.results.folder import prepare, writing

Sights = list[dict[str, Any]]
OLD = dict.fromkeys(("paths.vtp", "report.json", "winding.png"), "old") | {FOREIGN: "mine"}
NEW = dict.fromkeys(("bridges.vtp", "paths.vtp", "report.json"), "new")
MOMENTS = 24


def seen(*arguments: str | Path) -> Any:
    command = [sys.executable, str(Path(__file__).with_name("killed_writer.py")), *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=240, check=True)
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def steps(tmp_path_factory: pytest.TempPathFactory) -> list[Sights]:
    return seen("steps", tmp_path_factory.mktemp("steps"))


def within(part: dict[str, str], whole: dict[str, str]) -> bool:
    return part.items() <= whole.items()


def test_killed_at_any_step_nothing_is_mixed_or_half(steps: list[Sights]) -> None:
    """Files are of one run; where the report is there they are all there; and files of others stay."""
    sights, fresh = NEW | {FOREIGN: "mine"}, steps[0]
    assert len(fresh) > 25 and [sight["killed"] for sight in fresh] == (len(fresh) - 1) * [True] + [False]
    for sight in fresh:
        first = sight["first"]
        assert within(first, OLD) or within(first, sights)
        assert FOREIGN in first
        if "report.json" in first:
            assert first in (OLD, sights)


def test_killed_at_any_step_the_next_run_finishes_or_clears_away(steps: list[Sights]) -> None:
    then = [sight["then"] for sight in steps[0]]
    turn = then.index(NEW | {FOREIGN: "mine"})
    assert then == turn * [OLD] + (len(then) - turn) * [NEW | {FOREIGN: "mine"}]
    assert 5 < turn < len(then) - 5
    assert not any(sight["hidden"] for sight in steps[0])


def test_a_folder_that_was_not_there_appears_whole(steps: list[Sights]) -> None:
    for sight in steps[1]:
        assert sight["first"] in ({}, NEW) and sight["then"] == sight["first"]
        assert not sight["hidden"]
    assert steps[1][0]["first"] == {} and steps[1][-1]["first"] == NEW


def test_killed_at_random_times_real_results_are_whole(tmp_path: Path) -> None:
    """Every file by its hash, but the report, which holds times."""
    whole, sights = seen("moments", tmp_path, str(MOMENTS))
    reports = [held.pop("report.json") for held in whole]
    assert len(reports) == 2 and whole[0].keys() == whole[1].keys() and len(whole[0]) == 9
    assert len(sights) == MOMENTS
    for sight in sights:
        assert not sight["hidden"]
        for files in (sight["first"], sight["then"]):
            data = {name: content for name, content in files.items() if name != "report.json"}
            assert data in whole if "report.json" in files else any(within(data, held) for held in whole)
        assert not sight["then"] or "report.json" in sight["then"]
    assert sum(sight["killed"] for sight in sights) > MOMENTS // 2
    assert len({json.dumps(sight["then"]) for sight in sights}) > 1


def test_a_run_that_still_writes_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    with writing(tmp_path / "out") as staging:
        (staging / "report.json").write_text("first")
        prepare(tmp_path / "out")
        with writing(tmp_path / "out") as other:
            (other / "report.json").write_text("second")
        with pytest.raises(BadInputError, match="holds results already"):
            prepare(tmp_path / "out")
        assert (staging / "report.json").read_text() == "first"
        (tmp_path / "out" / "report.json").unlink()
    assert os.listdir(tmp_path / "out") == ["report.json"]
    assert (tmp_path / "out" / "report.json").read_text() == "first"


def test_a_run_that_comes_second_is_refused_at_its_end(tmp_path: Path) -> None:
    for out in (tmp_path / "there", tmp_path / "new"):
        if out.name == "there":
            out.mkdir()
        with pytest.raises(BadInputError, match="give another folder"), writing(out) as staging:
            (staging / "report.json").write_text("first")
            with writing(out) as other:
                (other / "report.json").write_text("second")
        assert os.listdir(out) == ["report.json"]
        assert (out / "report.json").read_text() == "second"
    assert sorted(os.listdir(tmp_path)) == ["new", "there"]
