"""The short examples from outside: they run, and make the pictures that they say."""

import csv
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "examples" / "README.md").read_text(encoding="utf-8")


def run(script: str, out: Path, *options: str) -> None:
    command = [sys.executable, str(ROOT / "examples" / script), "--out", str(out), *options]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr


def test_moving_ends_makes_its_picture(tmp_path: Path) -> None:
    run("moving_ends.py", tmp_path)
    assert (tmp_path / "moving_ends.png").stat().st_size > 10_000


@pytest.mark.usefixtures("opengl")
def test_the_gallery_makes_its_pictures(tmp_path: Path) -> None:
    run("gallery.py", tmp_path, "--only", "tank")
    assert (tmp_path / "tank.png").stat().st_size > 10_000


def test_filament_cost_measures_each_thing(tmp_path: Path) -> None:
    run("filament_cost.py", tmp_path, "--quick", "--only", "ball")
    rows = list(csv.DictReader((tmp_path / "filament_cost.csv").read_text(encoding="utf-8").splitlines()))
    assert [(row["circuits"], row["particles"]) for row in rows] == [("8", "51"), ("4", "101"), ("8", "101")]
    assert all(float(row["closing over solving"]) > 0.0 and int(row["passes"]) > 0 for row in rows)


@pytest.mark.usefixtures("chromium")
def test_viewer_speed_measures_a_page(tmp_path: Path) -> None:
    run("viewer_speed.py", tmp_path, "--quick", "--runs", "1")
    (row,) = csv.DictReader((tmp_path / "viewer_speed.csv").read_text(encoding="utf-8").splitlines())
    assert int(row["fibres"]) > 0 and 1e5 < int(row["bytes"]) < 4e6
    assert float(row["first picture"]) > 0.0 < float(row["frames a second"])


def test_the_page_names_what_there_is() -> None:
    scripts = {path.name for path in (ROOT / "examples").glob("*.py")}
    assert set(re.findall(r"examples/(\w+\.py)", PAGE)) == scripts
    pictures = {path.name for path in (ROOT / "examples" / "gallery").iterdir()}
    assert set(re.findall(r"\(gallery/([\w.]+)\)", PAGE)) <= pictures
    for name in re.findall(r"data/([\w.]+)", PAGE):
        if not name.endswith("/"):
            assert (ROOT / "data" / name).is_file()


def test_scripts_load_from_any_folder(tmp_path: Path) -> None:
    """What each imports is found beside it; the fuzzer's library is not among those for the tests."""
    scripts = sorted(str(path) for path in (ROOT / "examples").glob("*.py") if path.name != "fuzz_readers.py")
    code = f"import runpy, sys; sys.path[0] = {str(ROOT / 'examples')!r}; [runpy.run_path(p) for p in {scripts}]"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=300, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
