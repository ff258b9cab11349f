"""What goes wrong with a deck or with CalculiX is one line, and leaves no file."""

import json
import sys
from collections.abc import Callable
from pathlib import Path
from shutil import copytree

import pytest
from export_results import plain_results

import meshwind as mw
from meshwind.cli.main import app
from meshwind.results.schema import SHELL, SHELL_ABOUT, SOLVED, SOLVED_FIGURES, SOLVED_PICTURE
from meshwind.solving.calculix import run
from meshwind.solving.deck import ReadDeck, read_deck
from meshwind.solving.tables import read_tables


@pytest.fixture(scope="module")
def exported(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("exported")
    plain_results(folder)
    mw.export(folder, "inp", thickness=0.02, elements=100, axial=1.0)
    return folder


@pytest.fixture
def folder(exported: Path, tmp_path: Path) -> Path:
    """A run with a deck."""
    return copytree(exported, tmp_path / "run")


def program(folder: Path, *lines: str) -> str:
    """A program in the place of CalculiX."""
    file = folder / "other"
    file.write_text("\n".join([f"#!{sys.executable}", "import os, sys", *lines]) + "\n")
    file.chmod(0o755)
    return str(file)


def refused(folder: Path, match: str, ccx: str = "ccx") -> None:
    before = sorted(file.name for file in folder.iterdir())
    with pytest.raises(mw.BadInputError, match=match) as raised:
        mw.solve_deck(folder, ccx=ccx, render=False)
    assert "\n" not in str(raised.value)
    assert sorted(file.name for file in folder.iterdir()) == before


def test_a_deck_calculix_and_their_match_are_asked_for(folder: Path) -> None:
    refused(folder, "no program 'ccx-of-old' .* apt-get install calculix-ccx", "ccx-of-old")
    text = (folder / SHELL).read_text()
    (folder / SHELL).write_text(text.replace("*SHELL SECTION", "*SOLID SECTION"))
    refused(folder, "is no deck as it is exported", sys.executable)
    (folder / SHELL).write_text(text)
    about = json.loads((folder / SHELL_ABOUT).read_text())
    (folder / SHELL_ABOUT).write_text(json.dumps(about | {"run": "0" * 16}))
    refused(folder, "is of another run than", sys.executable)
    (folder / SHELL_ABOUT).write_text(json.dumps(about | {"material": {"name": "x", "strengths_mpa": {"xt": 3}}}))
    refused(folder, "shell.json is damaged; write it again", sys.executable)
    (folder / SHELL_ABOUT).unlink()
    refused(folder, "shell.json is missing", sys.executable)
    (folder / SHELL).unlink()
    refused(folder, "has no shell.inp to solve; write it first: `meshwind.export` with to='inp'", sys.executable)


@pytest.mark.parametrize(
    ("lines", "match"),
    [
        (
            ["print(' *ERROR in allocation: no room\\n   for it\\n'); sys.exit(201)"],
            "failed on shell.inp: .*no room for it",
        ),
        (["print('*ERROR: increment size smaller than minimum'); sys.exit(201)"], "the load is too large"),
        (["sys.exit(7)"], "ended with status 7"),
        (["os.kill(os.getpid(), 9)"], "by signal 9; it may lack memory"),
        (["print('matrix is singular'); sys.exit(1)"], "something is not held"),
        (["pass"], "ended with status 0"),
        (["print('Job finished')"], "wrote no results"),
        (["print('Job finished'); open('shell.dat', 'w').close()"], "no displacements of all nodes and elements"),
    ],
)
def test_what_calculix_says_is_one_line(folder: Path, lines: list[str], match: str) -> None:
    refused(folder, match, program(folder, *lines))


def test_a_file_that_is_no_program_is_refused(folder: Path) -> None:
    (folder / "other").write_bytes(b"\x7fELF")
    (folder / "other").chmod(0o755)
    refused(folder, "cannot run", str(folder / "other"))


@pytest.fixture(scope="module")
def tables(exported: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, ReadDeck]:
    """What CalculiX writes of a deck, and the deck."""
    work = tmp_path_factory.mktemp("work")
    return run("ccx", exported / SHELL, work).read_text(), read_deck(exported / SHELL)


@pytest.mark.usefixtures("calculix")
@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda text: text.replace(text.split("stresses")[1].split()[20], "nan", 1), "not numbers"),
        (lambda text: text.replace("P1_", "M1_"), "not of this deck: axes M1"),
        (lambda text: text.replace("for set NALL", "for set END"), "wrote no displacements of all"),
        (lambda text: text[: text.index(" strains ")], r"no strains of all nodes and elements.*\(E\)"),
        (lambda text: text[: int(0.9 * len(text))].rpartition("\n")[0], "points with stresses"),
        (lambda text: text[: int(0.9 * len(text))], "rows of"),
        (lambda text: text.replace("\n         2 ", "\n         3 ", 1), "displacements of"),
    ],
)
def test_results_that_are_not_the_decks_are_refused(
    tables: tuple[str, ReadDeck], tmp_path: Path, change: Callable[[str], str], match: str
) -> None:
    text, deck = tables
    (tmp_path / "shell.dat").write_text(text)
    assert len(read_tables(tmp_path / "shell.dat", deck).stress) == 8 * 3 * len(deck)
    (tmp_path / "shell.dat").write_text(change(text))
    with pytest.raises(mw.BadInputError, match=match):
        read_tables(tmp_path / "shell.dat", deck)


@pytest.mark.usefixtures("calculix")
def test_a_part_that_nothing_holds_is_refused(folder: Path) -> None:
    text = (folder / SHELL).read_text()
    assert "*BOUNDARY\nSTART, 1, 6\n" in text
    (folder / SHELL).write_text(text.replace("*BOUNDARY\nSTART, 1, 6\n", ""))
    refused(folder, "more than its size: it is not held")


@pytest.mark.usefixtures("calculix", "opengl")
def test_the_command_line(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Lines, files and a picture; a new deck takes the place of what was solved."""

    def said(*words: str | Path) -> str:
        assert app([*map(str, words)], standalone_mode=False) == 0
        return capsys.readouterr().out

    assert said("solve", folder, "--quiet") == ""
    assert {SOLVED, SOLVED_FIGURES, SOLVED_PICTURE} <= {file.name for file in folder.iterdir()}
    figures = json.loads(said("solve", folder, "--no-render", "--json", "--out", folder / "other"))
    assert figures["largest"]["load_factor"] == pytest.approx(1.0 / figures["largest"]["exposure"])
    assert [Path(file).name for file in figures.pop("files")] == [SOLVED_FIGURES, SOLVED]
    assert json.loads((folder / SOLVED_FIGURES).read_text()) == figures
    lines = said("solve", folder, "--no-render").splitlines()
    assert [line.split(None, 1)[0] for line in lines if line[0] != " "] == [
        "part",
        "moved",
        "exposure",
        "load",
        "file",
        "file",
    ]
    mw.export(folder, "inp", thickness=0.02, elements=100)
    assert not {SOLVED, SOLVED_FIGURES, SOLVED_PICTURE} & {file.name for file in folder.iterdir()}
