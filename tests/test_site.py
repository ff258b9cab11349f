"""README and the site: their pages run as they stand and print what they say, and it is built without a warning."""

import contextlib
import io
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

import pytest
from command import meshwind
from documentation.documents import README, ROOT, SITE, documents
from documentation.drawn import FIGURES, code_of
from needs import STRICT
from typer.main import get_command

import meshwind as mw
from meshwind.cli.main import app

PAGES = documents()
FENCE = re.compile(r"^```(sh|python|text|toml)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
NUMBER = re.compile(r"(\d[\d,]*(?:\.\d+)?(?:e-?\d+)?)")
WINDS = {"wind", "redesign"}
DRAWN = [f"examples/site/{page}" for page in ("command/pictures.md", "how_to/library.md", "notebooks/vessel.ipynb")]
"""Pages of which a command or a line of Python draws."""
SOLVED = ["examples/site/how_to/solver.md"]
"""Pages of which a command runs CalculiX, and draws."""

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


def test_typeset_equations_have_their_plain_text() -> None:
    """Under the same number, and each page links to the functions that hold its equations."""
    labels = {}
    for file in (SITE / "theory").glob("*.rst"):
        text = file.read_text(encoding="utf-8")
        labels[file.stem] = re.findall(r"^\.\. math::\n   :label: (.*)$", text, re.MULTILINE)
        if labels[file.stem]:
            plain = (ROOT / "meshwind" / "theory" / f"{file.stem}.py").read_text(encoding="utf-8")
            assert [number for number in labels[file.stem] if f"({number})" not in plain] == []
            linked = text.partition("In the code\n")[2]
            assert all(f":eq:`{number}`" in linked for number in labels[file.stem]), file.stem
    assert sum(map(len, labels.values())) >= 12


def test_figures_of_the_theory_are_drawn_and_small() -> None:
    drawn = {}
    for file in (SITE / "theory").glob("*.rst"):
        for name in re.findall(r"^\.\. drawn:: (\w+)$", file.read_text(encoding="utf-8"), re.MULTILINE):
            drawn[f"{file.stem}_{name}.png"] = code_of(file.stem, name)
    pictures = {file.name: file.stat().st_size for file in FIGURES.glob("*.png")}
    assert set(drawn) == set(pictures) and len(drawn) >= 12
    assert max(pictures.values()) < 150_000
    assert all(code.startswith("def ") and "-> Figure" in code for code in drawn.values())


def test_every_page_is_listed() -> None:
    """Each is in one list of contents below the index, and what README links to is there."""
    lists = {"index": SITE / "index.md", **{f"{room}/index": SITE / room / "index.rst" for room in ("api", "theory")}}
    listed = []
    for file in lists.values():
        room = file.parent.relative_to(SITE)
        for block in re.findall(r"toctree.*?\n\n(.*?)(?:```|\Z)", file.read_text(encoding="utf-8"), re.DOTALL):
            listed += [(room / name).as_posix() for name in block.split()]
    pages = [file.relative_to(SITE).with_suffix("").as_posix() for file in SITE.rglob("*.*") if is_page(file)]
    assert sorted([*listed, "index"]) == sorted(pages)
    links = [target for target in re.findall(r"\]\(([^)#]+)[^)]*\)", PAGES[README]) if "://" not in target]
    assert len(links) > 10 and all((ROOT / target).is_file() for target in links)


def is_page(file: Path) -> bool:
    return file.suffix in {".md", ".rst", ".ipynb"}


@pytest.mark.parametrize("notebook", sorted(SITE.rglob("*.ipynb")), ids=lambda file: file.name)
def test_notebooks_hold_no_results(notebook: Path) -> None:
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    code = [cell for cell in cells if cell["cell_type"] == "code"]
    assert code and not any(cell["outputs"] or cell["execution_count"] for cell in code)


def test_readme_is_for_newcomers() -> None:
    assert len(PAGES[README].split()) <= 2500


class Made(NamedTuple):
    """What a command printed, and the folders and files that it made."""

    printed: str
    files: list[Path]


@pytest.fixture(scope="module")
def made() -> dict[str, Made]:
    """Commands that have run, so that what several pages wind is wound once."""
    return {}


@pytest.mark.parametrize(
    "page", [name for name, text in PAGES.items() if FENCE.search(text) and name not in {*DRAWN, *SOLVED}]
)
def test_pages_run_and_print_what_they_say(
    page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, made: dict[str, Made]
) -> None:
    read(page, tmp_path, monkeypatch, made)


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize("page", DRAWN)
def test_pages_that_draw_run(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, made: dict[str, Made]) -> None:
    read(page, tmp_path, monkeypatch, made)


@pytest.mark.usefixtures("calculix", "opengl")
@pytest.mark.parametrize("page", SOLVED)
def test_pages_that_solve_run(
    page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, made: dict[str, Made]
) -> None:
    read(page, tmp_path, monkeypatch, made)


def read(page: str, folder: Path, monkeypatch: pytest.MonkeyPatch, made: dict[str, Made]) -> None:
    """Block after block, as a reader would type it, without the pictures of `wind` and `redesign`."""
    (folder / "data").symlink_to(ROOT / "data")
    monkeypatch.chdir(folder)
    names: dict[str, object] = {}
    printed = ""
    for kind, block in FENCE.findall(PAGES[page]):
        if kind == "toml":
            name = re.match(r"# ([\w.]+\.toml)", block)
            assert name, "its first line is a comment with its name"
            Path(name[1]).write_text(block, encoding="utf-8")
        elif kind == "sh":
            lines = block.replace("\\\n", " ").splitlines()
            lines = [line for line in lines if page != README or line.startswith("meshwind ")]
            printed = "".join(run(line, folder, made) for line in lines)
        elif kind == "python":
            with contextlib.redirect_stdout(io.StringIO()) as output:
                exec(compile(block, page, "exec"), names)
            printed = output.getvalue()
        else:
            for line in block.splitlines():
                assert any(_says(said, line) for said in printed.splitlines()), f"{line!r} is not in:\n{printed}"


def run(line: str, folder: Path, made: dict[str, Made]) -> str:
    """What a command prints, which must end well; one that winds is run once for all pages that have it."""
    words = shlex.split(line, comments=True)
    assert words[0] == "meshwind"
    if words[1] not in WINDS:
        return output(words)
    key = shlex.join(words)
    if key in made:
        for each in made[key].files:
            shutil.copytree(each, folder / each.name)
        return made[key].printed
    before = set(folder.iterdir())
    printed = output([*words, "--no-render"])
    if not any(Path(word).suffix == ".toml" for word in words):
        made[key] = Made(printed, sorted(set(folder.iterdir()) - before))
    return printed


def output(words: list[str]) -> str:
    """What a command prints that ends well."""
    done = meshwind(*words[1:])
    assert done.returncode == 0, f"{shlex.join(words)}\n{done.stdout}{done.stderr}"
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


def test_commands_in_tables_are_known() -> None:
    text = PAGES["examples/site/gallery.md"] + (ROOT / "examples" / "README.md").read_text(encoding="utf-8")
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
    line = re.search(r"^# build the documentation\n.* -m (sphinx .+)$", PAGES[README], re.M)
    assert line
    words = [str(tmp_path) if word == "out/site" else word for word in shlex.split(line[1])]
    assert {"--fail-on-warning", str(tmp_path)} <= set(words)
    built = subprocess.run([sys.executable, "-m", *words], cwd=ROOT, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stderr
    pages = {file: file.read_text(encoding="utf-8") for file in tmp_path.rglob("*.html") if "_modules" not in str(file)}
    assert len(pages) >= len(PAGES) + 11
    pictures = 0
    for file, text in pages.items():
        for target in re.findall(r'(?:href|src)="([^"#?:]+)[^":]*"', text):
            assert (file.parent / target).exists(), f"{target} in {file.name}"
            pictures += target.endswith(".png")
        for loaded in re.findall(r'<(?:script|link|img)[^>]* (?:src|href)="([^"]+)"', text):
            assert "://" not in loaded, f"{loaded} is loaded from elsewhere by {file.name}"
    assert pictures >= 10
    for page in ("equilibrium", "geodesics", "bridging", "layups", "comparisons"):
        text = pages[tmp_path / "theory" / f"{page}.html"]
        assert text.count("<math ") >= 10 and 'class="eqno"' in text and "<details>" in text
    for name in mw.__all__:
        assert any(re.search(rf'id="meshwind\.(?:surface\.)?{name}"|id="module-meshwind.surface.{name}"', text)
                   for text in pages.values()), name  # fmt: skip
