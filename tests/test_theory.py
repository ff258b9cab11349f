"""The theory pages: every equation that the code cites is stated, and nothing is marked as context that is cited."""

import ast
import io
import re
import tokenize
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

import pytest

import meshwind.theory

ROOT = Path(__file__).parents[1]
PAGES = [f"meshwind.theory.{page.name}" for page in iter_modules(meshwind.theory.__path__)]
CODE = [
    file
    for folder in ("meshwind", "examples")
    for file in sorted((ROOT / folder).rglob("*.py"))
    if "theory" not in file.parts
]
NUMBER = r"[3-7]\.[1-9]\d?"
TAGGED = re.compile(rf"^    .*?((?: \({NUMBER}\))+)(?: (corrected))?,?(?: (context))?$", re.MULTILINE)
"""A line of a formula that ends in its number or numbers, and in marks."""
GROUP = re.compile(rf"\(({NUMBER})(?=[),;-]| to )([^()]*)\)")
"""A parenthesis that begins with an equation's number, and what else is in it."""
OTHERS = re.compile(r"\b(section \d\.\d|[Ff]ig(?:ure|\.)s? \d\.\d|[Tt]able \d\.\d|[Aa]lgorithm \d)\b")


def text(page: str) -> str:
    return import_module(page).__doc__ or ""


def stated() -> dict[str, set[str]]:
    """The equations of the pages, each with its marks."""
    marks: dict[str, set[str]] = {}
    for page in PAGES:
        for numbers, *others in TAGGED.findall(text(page)):
            for number in re.findall(NUMBER, numbers):
                marks.setdefault(number, set()).update(other for other in others if other)
    return marks


def words(file: Path) -> str:
    """All comments and strings of a file: what it says rather than what it computes."""
    source = file.read_text(encoding="utf-8")
    comments = [t.string for t in tokenize.generate_tokens(io.StringIO(source).readline) if t.type == tokenize.COMMENT]
    strings = [n.value for n in ast.walk(ast.parse(source)) if isinstance(n, ast.Constant) and isinstance(n.value, str)]
    return "\n".join(comments + strings)


def numbers(said: str) -> set[str]:
    """Numbers of equations, those between the ends of a range among them: (7.2 to 7.4), (7.2-7.4), (7.2, 7.4)."""
    found: set[str] = set()
    for first, rest in GROUP.findall(said):
        found |= {first, *re.findall(NUMBER, rest)}
        for end in re.findall(rf"^(?: to |-)({NUMBER})", rest):
            chapter = first[0]
            found |= {f"{chapter}.{k}" for k in range(int(first[2:]), int(end[2:]))}
    for first, end in re.findall(rf"\(({NUMBER})\) to \(({NUMBER})\)", said):
        found |= {f"{first[0]}.{k}" for k in range(int(first[2:]), int(end[2:]))}
    return found


def cited() -> dict[str, set[str]]:
    """Files by the numbers of the equations that they cite."""
    where: dict[str, set[str]] = {}
    for file in CODE:
        for number in numbers(words(file)):
            where.setdefault(number, set()).add(str(file.relative_to(ROOT)))
    return where


def test_ranges_of_numbers_are_read() -> None:
    assert numbers("by (7.2 to 7.4), (4.1, with lifted 5.2) and (6.1) to (6.3)") == {
        "7.2", "7.3", "7.4", "4.1", "5.2", "6.1", "6.2", "6.3",
    }  # fmt: skip
    assert numbers("3.4 s, (3.4 s against 1.9), section 5.2 (section 5.3), (2.5, 3.5)") == set()


def test_every_cited_equation_is_stated() -> None:
    assert {number: files for number, files in cited().items() if number not in stated()} == {}


def test_only_what_no_code_cites_is_marked_as_context() -> None:
    context = {number for number, marks in stated().items() if "context" in marks}
    assert context == set(stated()) - set(cited())


@pytest.mark.parametrize("chapter", "34567")
def test_a_chapter_is_stated_whole(chapter: str) -> None:
    """No gap in the numbers, so that a reader can follow one equation from another."""
    these = sorted(int(number[2:]) for number in stated() if number[0] == chapter)
    assert these == list(range(1, len(these) + 1))


def test_every_section_figure_table_and_algorithm_is_described() -> None:
    named = {name.lower().replace("fig.", "figure") for file in CODE for name in OTHERS.findall(words(file))}
    pages = "\n".join(map(text, PAGES)).lower()
    assert {name for name in named if name not in pages} == set()


def test_every_correction_is_in_the_errata() -> None:
    errata = text("meshwind.theory.errata")
    listed = set(re.findall(NUMBER, errata)) | {"3.6", "5.6"}  # within (3.5)-(3.7); printed as one with (5.7)
    assert {number for number, marks in stated().items() if "corrected" in marks} <= listed


def test_pages_are_listed_where_a_reader_begins() -> None:
    assert set(re.findall(r"^`(\w+)`", text("meshwind.theory"), re.MULTILINE)) == {
        page.rpartition(".")[2] for page in PAGES
    }
