"""Messages speak of arguments to a script, and of options to who types a command."""

import re
from pathlib import Path

import pytest
from command import meshwind

import meshwind as mw
from meshwind.core.spoken import argument, as_command, called

PACKAGE = Path(mw.__file__).parent
DATA = PACKAGE.parent / "data"
OPTION = re.compile(r"--[a-z]|`meshwind ")
WRITTEN = re.compile(r"[\"' (]--[a-z]|`meshwind [a-z]")
"""An option or a command in a text of the code."""
WRONG = [
    ("wind", {"paths": None}, "need band_width, no pins", "need --band-width, no pins"),
    ("wind", {"turn_end": "pins"}, "set continuous as well", "set --continuous as well"),
    ("wind", {"band_thickness": 1.0}, "give band_width as well", "give --band-width as well"),
    ("wind", {"worst_fit": 1e-9}, "raise worst_fit, now 1e-09", "raise --worst-fit, now 1e-09"),
    ("wind", {"ends": "loops 0 0"}, "`meshwind.check` lists", "`meshwind check` lists"),
    ("export", {}, "give to (inp, ", "give --to (inp, "),
]


def test_words_for_both() -> None:
    assert argument("band_width") == "band_width"
    assert [argument("particles", 801), argument("turn_end", "cap"), argument("ends", "'loops i j'")] == [
        "particles=801", "turn_end='cap'", "ends='loops i j'",
    ]  # fmt: skip
    assert called("check") == "`meshwind.check`"
    assert called("wind", "MESH", continuous=True) == "`meshwind.wind(mesh, continuous=True)`"
    with as_command():
        assert argument("band_width") == "--band-width"
        assert [argument("particles", 801), argument("overwrite", True)] == ["--particles 801", "--overwrite"]
        assert called("wind", "MESH", out="DIR") == "`meshwind wind MESH --out DIR`"
    assert argument("band_width") == "band_width"


@pytest.mark.parametrize(("function", "given", "says", "its"), WRONG)
def test_an_error_speaks_the_language_of_its_caller(
    function: str, given: dict[str, object], says: str, its: str, tmp_path: Path
) -> None:
    mesh = DATA / "tank.ply"
    if function == "export":
        mw.wind(mesh, paths=3, particles=51, out=tmp_path / "run", render=False)
        mesh = tmp_path / "run"
    with pytest.raises(mw.BadInputError) as caught:
        getattr(mw, function)(mesh, **given)
    assert says in str(caught.value) and not OPTION.search(str(caught.value))
    words = [f"--{name.replace('_', '-')}={'auto' if value is None else value}" for name, value in given.items()]
    done = meshwind(function, mesh, *words, folder=tmp_path)
    assert done.returncode == 2 and its in done.stderr


def test_notes_speak_of_arguments() -> None:
    result = mw.wind(DATA / "tank.ply", paths=3, particles=51, revolutions=0.3, continuous=True, friction=0.3)
    notes = [note.text for note in result.notes]
    assert any("turn_start='cap' and turn_end='cap'" in text for text in notes)
    assert not any(OPTION.search(text) for text in notes)


def test_no_message_of_the_library_names_an_option() -> None:
    """But for what is written into meshwind.toml, and examples of commands in docstrings."""
    found = []
    for file in PACKAGE.rglob("*.py"):
        name = file.relative_to(PACKAGE).as_posix()
        if name.startswith(("cli/", "theory/")) or name == "results/config_file.py":
            continue
        code = re.sub(r'"""(.*?)"""', "", file.read_text(encoding="utf-8"), flags=re.DOTALL)
        found += [
            f"{name}: {line.strip()}"
            for line in code.splitlines()
            if re.search(r"[\"' (]--[a-z]|`meshwind [a-z]", line.split("#")[0])
        ]
    assert found == []
