"""With --json an error is JSON as well, with the words of the error line."""

import json
from pathlib import Path

import pytest
from command import meshwind


@pytest.mark.parametrize("arguments", [
    ["wind"], ["wind", "none.obj"], ["wind", "part.obj"], ["wind", "part.obj", "--paths", "2.5"], ["check", "."],
    ["wind", "part.obj", "--out", "part.obj"], ["render", "."], ["export", "."], ["info", "none.obj"],
    ["redesign", "none.obj"],
])  # fmt: skip
def test_an_error_has_the_same_words_as_json(arguments: list[str], tmp_path: Path) -> None:
    (tmp_path / "part.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    plain, done = (meshwind(*arguments, *more, folder=tmp_path) for more in ((), ("--json",)))
    assert plain.returncode == done.returncode == 2
    assert done.stdout == ""
    printed = json.loads(done.stderr)
    assert printed["exit_status"] == 2
    assert plain.stderr.splitlines()[-1] == f"meshwind: error: {printed['error']}"
    assert [file.name for file in tmp_path.iterdir()] == ["part.obj"]
