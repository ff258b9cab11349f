"""The documentation site: its pages run as they stand and print what they say, and it is built without a warning."""

import contextlib
import io
import os
import re
import shlex
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from needs import STRICT
from typer.main import get_command

import meshwind as mw
from meshwind.cli.main import app

ROOT = Path(__file__).parents[1]
SITE = ROOT / "examples" / "site"
PAGES = {file.relative_to(SITE).as_posix(): file.read_text(encoding="utf-8") for file in sorted(SITE.rglob("*.md"))}
FENCE = re.compile(r"^```(sh|python|text|toml)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
NUMBER = re.compile(r"(\d[\d,]*(?:\.\d+)?(?:e-?\d+)?)")
DRAW = {"wind", "redesign"}
ROUNDING = 0.05
"""By how much of itself, or one of its last decimal, a figure may be off what is printed, as machines round each so."""


def test_all_public_names_are_on_the_pages() -> None:
    text = "".join(file.read_text(encoding="utf-8") for file in (SITE / "api").glob("*.rst"))
    listed = re.findall(r"^\.\. auto(?:function|class):: (\w+)$", text, re.MULTILINE)
    assert sorted([*listed, "shapes"]) == mw.__all__ and ".. automodule:: meshwind.surface.shapes\n" in text


def test_all_theory_is_on_the_pages() -> None:
    modules = {file.stem for file in (ROOT / "meshwind" / "theory").glob("*.py")} - {"__init__"}
    assert {file.stem for file in (SITE / "theory").glob("*.rst")} - {"index"} == modules
    for name in modules:
        page = (SITE / "theory" / f"{name}.rst").read_text(encoding="utf-8")
        assert f".. automodule:: meshwind.theory.{name}\n" in page


def test_all_of_the_readme_is_on_the_pages() -> None:
    """Every section is included somewhere, but for its last lines, which are about the files beside it."""
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    included = ""
    for text in PAGES.values():
        for first, last in re.findall(r'README\.md\n:start-after: "(#.+)"\n:end-before: "(.+)"', text):
            begin = readme.index(first.replace("\\n", "\n")) + len(first.replace("\\n", ""))
            included += readme[begin : readme.index(last, begin)]
    for section in re.split(r"^#+ .+$", re.sub(r"```.*?```", "", readme, flags=re.DOTALL), flags=re.MULTILINE):
        if section.strip():
            assert section.strip().splitlines()[0] in included


@pytest.mark.parametrize("page", [name for name, text in PAGES.items() if FENCE.search(text)])
def test_pages_run_and_print_what_they_say(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Block after block, as a reader would type it, without the pictures of `wind` and `redesign`."""
    (tmp_path / "data").symlink_to(ROOT / "data")
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    printed = ""
    for kind, block in FENCE.findall(PAGES[page]):
        if kind == "toml":
            name = re.match(r"# ([\w.]+\.toml)", block)
            assert name, "its first line is a comment with its name"
            Path(name[1]).write_text(block, encoding="utf-8")
        elif kind == "sh":
            printed = "".join(_output(line) for line in block.splitlines())
        elif kind == "python":
            with contextlib.redirect_stdout(io.StringIO()) as output:
                exec(compile(block, page, "exec"), names)
            printed = output.getvalue()
        else:
            for line in block.splitlines():
                assert any(_says(said, line) for said in printed.splitlines()), f"{line!r} is not in:\n{printed}"


def _output(line: str) -> str:
    """What a command prints; it must end well."""
    words = shlex.split(line, comments=True)
    assert words[0] == "meshwind"
    words += ["--no-render"] if words[1] in DRAW else []
    done = subprocess.run([sys.executable, "-m", *words], capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{line}\n{done.stdout}{done.stderr}"
    return done.stdout


def _says(said: str, quoted: str) -> bool:
    """Whether a line begins with the quoted one, figures within their rounding."""
    theirs, ours = NUMBER.split(said.rstrip()), NUMBER.split(quoted.rstrip())
    if len(theirs) < len(ours):
        return False
    for position, (one, other) in enumerate(zip(theirs, ours, strict=False)):
        if position % 2:
            a, b = (float(number.replace(",", "")) for number in (one, other))
            digit = 10.0 ** -len(other.partition(".")[2]) if "." in other and "e" not in other else 0.0
            if abs(a - b) > max(ROUNDING * abs(b), 1.01 * digit):
                return False
        elif not (one == other or (position == len(ours) - 1 and one.startswith(other))):
            return False
    return True


def test_figures_are_compared() -> None:
    assert _says("paths     24 of 24 at rest: length 7,504 mm", "paths     24 of 24 at rest: length 7,510 mm")
    assert _says("program   10790 blocks, 113 turns; 4 s", "program   10790 blocks, 113 turns")
    assert not _says("paths     24 of 24 at rest: length 7,504 mm", "paths     24 of 24 at rest: length 8,510 mm")
    assert not _says("paths     24 of 24 at rest", "paths     24 of 24 slide")


@pytest.mark.parametrize("page", ["gallery.md"])
def test_commands_in_tables_are_known(page: str) -> None:
    text = PAGES[page] + (ROOT / "examples" / "README.md").read_text(encoding="utf-8")
    lines = re.findall(r"`(meshwind [^`]+)`", text)
    assert len(lines) >= 8
    for line in lines:
        name, *arguments = shlex.split(line)[1:]
        command = get_command(app).commands[name]  # type: ignore[attr-defined]
        if name != "render":  # whose folder is that of the command before
            command.make_context(name, [str(ROOT / word) if word.startswith("data/") else word for word in arguments])


def test_it_is_built_without_a_warning(tmp_path: Path) -> None:
    """As the README says; then pages, links between them and pictures are there."""
    if find_spec("furo") is None or find_spec("myst_parser") is None:
        advice = "the generator of the site is missing (pip install '.[docs]')"
        (pytest.fail if os.environ.get(STRICT) else pytest.skip)(advice)
    line = re.search(r"^# build the documentation\n.* -m (sphinx .+)$", (ROOT / "README.md").read_text("utf-8"), re.M)
    assert line
    words = [str(tmp_path) if word == "out/site" else word for word in shlex.split(line[1])]
    assert {"--fail-on-warning", str(tmp_path)} <= set(words)
    built = subprocess.run([sys.executable, "-m", *words], cwd=ROOT, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stderr
    pages = {file: file.read_text(encoding="utf-8") for file in tmp_path.rglob("*.html") if "_modules" not in str(file)}
    assert len(pages) >= len(PAGES) + 12
    pictures = 0
    for file, text in pages.items():
        for target in re.findall(r'(?:href|src)="([^"#?:]+)[^":]*"', text):
            assert (file.parent / target).exists(), f"{target} in {file.name}"
            pictures += target.endswith(".png")
    assert pictures >= 10
    for name in mw.__all__:
        assert any(re.search(rf'id="meshwind\.(?:surface\.)?{name}"|id="module-meshwind.surface.{name}"', text)
                   for text in pages.values()), name  # fmt: skip
