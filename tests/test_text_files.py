"""Configuration files and studies as editors write them, and files that are missing while a folder is there."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from meshwind.core.errors import BadInputError
from meshwind.core.parsing import read_toml

DATA = Path(__file__).parents[1] / "data"
BOM = b"\xef\xbb\xbf"
"""Byte order mark of UTF-8, as Windows' editors put it first."""


def run(*arguments: str, folder: Path) -> tuple[int, str, str]:
    command = [sys.executable, "-m", "meshwind", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=240, cwd=folder)
    return done.returncode, done.stdout, done.stderr


@pytest.mark.parametrize(
    "data", [BOM + b"paths = 4\n", b"paths = 4\r\n", BOM + b"\r\n# four\r\npaths = 4", b"paths = 4\r"]
)
def test_a_byte_order_mark_and_any_line_ends_are_no_error(data: bytes, tmp_path: Path) -> None:
    (tmp_path / "some.toml").write_bytes(data)
    assert read_toml(tmp_path / "some.toml", "config") == {"paths": 4}


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be", "utf-32"])
def test_other_encodings_are_named(encoding: str, tmp_path: Path) -> None:
    (tmp_path / "some.toml").write_bytes("paths = 4\n".encode(encoding))
    with pytest.raises(BadInputError, match=r"some.toml is text in UTF-16 or UTF-32; save it as UTF-8"):
        read_toml(tmp_path / "some.toml", "config")


def test_the_command_line_takes_a_config_and_a_study_with_a_byte_order_mark(tmp_path: Path) -> None:
    content = f"mesh = {json.dumps(str(DATA / 'tank.ply'))}\r\npaths = 2\r\nparticles = 41\r\n"
    (tmp_path / "config.toml").write_bytes(BOM + content.encode())
    code, _, said = run("wind", "--config", "config.toml", "--no-render", "--out", "out", "--quiet", folder=tmp_path)
    assert (code, said) == (0, "")
    assert json.loads((tmp_path / "out" / "report.json").read_text())["winding"]["paths_per_family"] == 2
    code, _, said = run("sweep", "config.toml", "--out", "table", "--quiet", folder=tmp_path)
    assert (code, said) == (0, "")
    (tmp_path / "config.toml").write_bytes(content.encode("utf-16"))
    for command in ("wind", "--config", "config.toml"), ("sweep", "config.toml"):
        code, _, said = run(*command, folder=tmp_path)
        assert code == 2 and "config.toml is text in UTF-16 or UTF-32; save it as UTF-8" in said


@pytest.mark.parametrize(("command", "folder"), [("wind", "part-wound"), ("redesign", "part-redesigned")])
def test_a_missing_mesh_comes_before_a_folder_that_is_there(command: str, folder: str, tmp_path: Path) -> None:
    (tmp_path / folder).mkdir()
    (tmp_path / folder / "report.json").write_text("{}")
    code, shown, said = run(command, "part.stl", folder=tmp_path)
    assert (code, shown) == (2, "")
    assert said == "meshwind: error: part.stl: file not found; give the path of a triangle mesh (STL, OBJ, PLY, ...)\n"


def test_a_missing_config_is_named_first(tmp_path: Path) -> None:
    code, _, said = run("wind", "part.stl", "--config", "none.toml", folder=tmp_path)
    assert code == 2 and said.startswith("meshwind: error: cannot read the config none.toml: No such file")
