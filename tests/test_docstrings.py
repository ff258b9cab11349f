"""Docstrings of all that `import meshwind` shows: complete by numpydoc's rules, and with examples that run."""

import ast
import doctest
import inspect
import re
from collections.abc import Iterator
from functools import cached_property
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import Any

import pytest
from docutils.frontend import get_default_settings
from docutils.parsers.rst import Parser
from docutils.utils import new_document
from numpydoc.docscrape import get_doc_object
from numpydoc.validate import validate

import meshwind as mw
import meshwind.theory

DATA = Path(__file__).parents[1] / "data"
SPARED = {
    "GL01",  # the summary starts right after the quotes
    "ES01",  # a summary may say it all
    "SA01",  # not everything has a relative
}
"""Rules of numpydoc that the house does not follow."""


def documented() -> Iterator[tuple[str, Any]]:
    """All public names with their objects, and the public methods and properties of public classes and their bases."""
    for name in mw.__all__:
        shown = getattr(mw, name)
        if inspect.ismodule(shown):
            functions = [f for f in vars(shown).values() if inspect.isfunction(f) and f.__module__ == shown.__name__]
            yield from ((f"{name}.{f.__name__}", f) for f in functions if not f.__name__.startswith("_"))
            continue
        yield name, shown
        for kind in shown.__mro__ if inspect.isclass(shown) else ():
            for member, value in vars(kind).items() if kind.__module__.startswith("meshwind") else ():
                if not member.startswith("_") and (inspect.isfunction(value) or _as_property(value)):
                    yield f"{kind.__name__ if kind is not shown else name}.{member}", value


def _as_property(value: object) -> Any:
    """The function behind a property, or None."""
    return value.fget if isinstance(value, property) else value.func if isinstance(value, cached_property) else None


SOLVES = {"solve_deck", "Solution"}
DRAWS = {"render", "draw_redesign", "Views.plot", "Picture", "Picture.save"}
PUBLIC = dict(documented())
WHOLE = [name for name, shown in PUBLIC.items() if not _as_property(shown)]
"""What has sections: classes, functions and methods."""


def test_everything_public_is_looked_at() -> None:
    assert {"wind", "Paths.advice", "Surface.frames", "shapes.cone", "Layup.bands"} <= set(PUBLIC)


@pytest.mark.parametrize("name", sorted(set(PUBLIC) - set(WHOLE)))
def test_a_property_is_a_phrase_that_ends(name: str) -> None:
    summary = (inspect.getdoc(_as_property(PUBLIC[name])) or "").split("\n")[0]
    assert summary[:1].isupper() and summary.endswith(".")


@pytest.mark.parametrize("name", WHOLE)
def test_a_docstring_follows_numpydoc(name: str) -> None:
    shown = PUBLIC[name]
    spared = set(SPARED)
    if inspect.isclass(shown):
        read = get_doc_object(shown, config={"show_class_members": False})
        attributes = [part for entry in read["Attributes"] for part in entry.name.split(", ")]
        if issubclass(shown, Exception):
            spared.add("PR01")
        elif attributes:  # made by meshwind rather than by the user: fields instead of parameters
            spared.add("PR01")
            of = vars(shown)
            fields = list(of.get("_member_map_") or of["__dataclass_fields__"])
            assert attributes == fields
    faults = [fault for fault in validate(get_doc_object(shown))["errors"] if fault[0] not in spared]
    assert faults == []


@pytest.mark.parametrize("page", ["meshwind", "meshwind.theory", *(
    f"meshwind.theory.{page.name}" for page in iter_modules(meshwind.theory.__path__)
)])  # fmt: skip
def test_glossary_and_theory_can_be_rendered(page: str) -> None:
    """As reStructuredText, without a warning, which docutils would raise."""
    text = inspect.getdoc(import_module(page)) or ""
    parser = Parser()
    settings = get_default_settings(parser)
    settings.halt_level, settings.report_level = 2, 5
    parser.parse(text, new_document(page, settings))


@pytest.mark.parametrize("name", WHOLE)
def test_defaults_are_those_of_the_signature(name: str) -> None:
    try:
        signature = inspect.signature(PUBLIC[name]).parameters
    except ValueError:  # an exception has none
        return
    for entry in get_doc_object(PUBLIC[name])["Parameters"]:
        said = re.search(r"default (.+)$", entry.type)
        for parameter in entry.name.split(", "):
            default = signature[parameter].default
            if said is None:
                assert ("optional" in entry.type) == (default is not inspect.Parameter.empty), parameter
            elif isinstance(default, bool | int | str | tuple) and " and " not in said[1]:
                assert ast.literal_eval(said[1]) == default, parameter
            elif isinstance(default, float) and "pi" not in said[1]:
                assert float(said[1]) == default, parameter


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize("name", sorted(set(WHOLE) - DRAWS - SOLVES))
def test_examples_run(name: str) -> None:
    assert _failures(name) == ""


@pytest.mark.usefixtures("opengl", "folder")
@pytest.mark.parametrize("name", sorted(DRAWS))
def test_examples_that_draw_run(name: str) -> None:
    assert _failures(name) == ""


@pytest.mark.usefixtures("calculix", "folder")
@pytest.mark.parametrize("name", sorted(SOLVES))
def test_examples_that_solve_run(name: str) -> None:
    assert _failures(name) == ""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A working directory of its own, with the sample parts in data/."""
    (tmp_path / "data").symlink_to(DATA)
    monkeypatch.chdir(tmp_path)


def _failures(name: str) -> str:
    """What doctest says of an object's examples: nothing where they hold."""
    test = doctest.DocTestParser().get_doctest(inspect.getdoc(PUBLIC[name]) or "", {}, name, None, 0)
    said: list[str] = []
    doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(test, out=said.append)
    return "".join(said)
