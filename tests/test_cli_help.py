"""Help, its examples, and completion: they name what there is, and what they show can be typed."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
import typer

from meshwind.appearance.view import NAMED
from meshwind.cli import export, render
from meshwind.cli.main import app
from meshwind.core.option import options_of
from meshwind.core.units import MILLIMETRES
from meshwind.exporting.formats import FORMATS
from meshwind.exporting.targets import GRID, QUADS, TARGETS
from meshwind.mesh.opening.choose_ends import parse_ends
from meshwind.workflow.options import Options

OPTIONS = options_of(Options)
COMMANDS = typer.main.get_command(app).commands  # type: ignore[attr-defined]
EXAMPLES = {line.strip() for command in (typer.main.get_command(app), *COMMANDS.values())
            for line in (command.epilog or "").splitlines() if line.strip().startswith("meshwind")}  # fmt: skip


def shown(*arguments: str) -> str:
    command = [sys.executable, "-m", "meshwind", *arguments, "--help"]
    return subprocess.run(command, capture_output=True, text=True, check=True, timeout=60).stdout


@pytest.mark.parametrize("name", [None, *COMMANDS])
def test_help_ends_with_examples(name: str | None) -> None:
    help_, own = shown(*([name] if name else [])), name or ""
    before, examples = help_.split("\nExamples:\n")
    assert re.findall(rf"^  meshwind {own}", examples, re.MULTILINE)
    assert all(line.startswith("  ") or not line for line in examples.splitlines())
    assert all(line == line.rstrip() for line in help_.splitlines())
    assert "Other options:\n  --help" in before or name is None


def test_options_stand_in_groups() -> None:
    help_ = shown("wind")
    for group, option in (("The part", "--units"), ("The fibres", "--paths"), ("The surface", "--tolerance"),
                          ("Files", "--config"), ("What is printed", "--json")):  # fmt: skip
        section = help_.split(f"\n{group}:\n")[1].split("\n\n")[0]
        assert f"  {option}" in section


@pytest.mark.parametrize("example", sorted(EXAMPLES))
def test_examples_can_be_typed(example: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Names, types and files of configuration are right; nothing is run."""
    (tmp_path / "part-wound").mkdir()
    (tmp_path / "part-wound" / "meshwind.toml").write_text('mesh = "../part.stl"\npaths = 12\n')
    monkeypatch.chdir(tmp_path)
    _, name, *arguments = shlex.split(example)
    if "--help" not in arguments:
        assert COMMANDS[name].make_context(name, arguments).params


def complete(words: str) -> list[str]:
    """What the shell is offered for the last word."""
    typed = words.split(" ")
    environment = os.environ | {
        "_MESHWIND_COMPLETE": "complete_bash", "COMP_WORDS": words, "COMP_CWORD": f"{len(typed) - 1}",
    }  # fmt: skip
    code = "import sys; sys.argv = ['meshwind']; from meshwind.cli import main; main()"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment, timeout=60)
    return done.stdout.split()


@pytest.mark.parametrize(("words", "offered"), [
    ("meshwind ex", ["export"]), ("meshwind wind --rev", ["--revolutions"]),
    ("meshwind wind --units i", ["in"]),
    ("meshwind wind --ends ", ["auto", "x", "y", "z", "loops"]), ("meshwind wind --revolutions ", ["auto"]),
    ("meshwind export d --to inp,f", ["inp,fibers", "inp,frames"]),
    ("meshwind export d --formats ply,", [f"ply,{name}" for name in FORMATS if name != "ply"]),
    ("meshwind export d --shell q", ["quads"]), ("meshwind render d --only s", ["slip", "sheet"]),
    ("meshwind render d --animate m", ["mp4"]), ("meshwind render d --view i", ["iso"]),
])  # fmt: skip
def test_completion(words: str, offered: list[str]) -> None:
    assert complete(words) == offered


def test_the_names_are_those_of_the_library() -> None:
    assert tuple(TARGETS) == export.TARGETS
    assert tuple(FORMATS) == export.FORMATS
    assert tuple(MILLIMETRES) == OPTIONS["units"].words
    assert (GRID, QUADS) == export.SHELLS
    assert ("auto", *NAMED) == render.VIEWS
    for name in OPTIONS["ends"].words:
        parse_ends(f"{name} 0 1" if name == "loops" else name)
