"""The short examples from outside: they run, and make the pictures that they say."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "examples" / "README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("script", "options", "made"),
    [
        ("moving_ends.py", (), "moving_ends.png"),
        ("gallery.py", ("--only", "tank"), "tank.png"),
    ],
)
def test_an_example_makes_its_picture(script: str, options: tuple[str, ...], made: str, tmp_path: Path) -> None:
    command = [sys.executable, str(ROOT / "examples" / script), "--out", str(tmp_path), *options]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / made).stat().st_size > 10_000


def test_the_page_names_what_there_is() -> None:
    scripts = {path.name for path in (ROOT / "examples").glob("*.py")} - {"data_mesher.py", "data_shapes.py"}
    assert set(re.findall(r"examples/(\w+\.py)", PAGE)) == scripts
    pictures = {path.name for path in (ROOT / "examples" / "gallery").iterdir()}
    assert set(re.findall(r"\(gallery/([\w.]+)\)", PAGE)) <= pictures
    for name in re.findall(r"data/([\w.]+)", PAGE):
        if not name.endswith("/"):
            assert (ROOT / "data" / name).is_file()
