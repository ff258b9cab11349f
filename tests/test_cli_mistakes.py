"""What newcomers type: each mistake is answered by one line that says what to type instead, and nothing is written."""

from pathlib import Path

import pytest
from command import meshwind

DATA = Path(__file__).parents[1] / "data"
MISTAKES = {
    "part.ply": "No such command 'part.ply'; to wind a mesh type `meshwind wind part.ply`",
    "rnder run": "Did you mean 'render'?",
    "wind": "Missing argument 'MESH'; see `",
    "wind prt.ply": "prt.ply: file not found; did you mean part.ply?",
    "wind part": "part: file not found; did you mean part.ply?",
    "wind elsewhere/part.ply": "part.ply: file not found; there is no folder elsewhere",
    "wind quite-another.stl": "file not found; give the path of a triangle mesh",
    "wind folder": "folder: is a folder; give the path of a triangle mesh",
    "wind letter": "unknown format ''; convert the mesh to one of STL,",
    "wind part.ply --path 24": "No such option: --path (Possible options: --paths)",
    "wind part.ply --paths 1.5": "paths is '1.5'; give a whole number, or auto",
    "wind part.ply --band-width 5mm": "Invalid value for '--band-width': give a number",
    "wind part.ply --revolutions 0,5": "revolutions is '0,5'; give a number as in 0.5 or 5/12, or auto",
    "wind part.ply --units furlongs": "units is 'furlongs'; give mm, cm, m, um, in, ft",
    "wind part.ply --ends loops 0 1": "put a value with spaces in quotes",
    "wind part.ply out": "name the folder for the results by --out",
    "wind part.ply --out": "Option '--out' requires an argument; see `meshwind wind --help`",
    "wind part.ply --opening 500": "opening 500 is too large at (0, 0, -120); give a radius between",
    "check part.ply --component -1": "component is -1; give a whole number from 0 up",
    "export part.ply --to viewer": "part.ply is no folder; give one that `meshwind wind MESH --out DIR` left",
    "render folder --size big": "size is 'big'; give width and height in pixels, as in 1920x1080",
}


@pytest.mark.parametrize("typed", MISTAKES)
def test_mistakes(typed: str, tmp_path: Path) -> None:
    (tmp_path / "part.ply").write_bytes((DATA / "tank.ply").read_bytes())
    (tmp_path / "letter").write_text("dear engineer")
    (tmp_path / "folder").mkdir()
    before = sorted(tmp_path.rglob("*"))
    done = meshwind(*typed.split(), folder=tmp_path)
    complaint = [line for line in done.stderr.splitlines() if not line.endswith("...")]
    assert done.returncode == 2
    assert len(complaint) == 1
    assert complaint[0].startswith("meshwind: error: ")
    assert MISTAKES[typed] in complaint[0]
    assert done.stdout == ""
    assert sorted(tmp_path.rglob("*")) == before
