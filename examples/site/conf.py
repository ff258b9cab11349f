"""How Sphinx makes the site of README, the pages beside this file, theory and docstrings, without a second copy."""

import re
import sys
from pathlib import Path
from typing import Any

from myst_parser.parsers.sphinx_ import MystParser

import meshwind

sys.path.insert(0, str(Path(__file__).parents[1]))

from documentation.documents import as_markdown
from documentation.drawn import add_figures
from documentation.formulas import typeset

project = "meshwind"
author = "The meshwind authors"
copyright = author
version = release = meshwind.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.viewcode"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext", ".ipynb": "notebook"}
nitpicky = False  # docstrings put file fields and words of the glossary in the same quotes as names
default_role = "py:obj"

myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence"]

autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the docstrings have the types, in words
napoleon_google_docstring = False
napoleon_custom_sections = [("Attributes", "params_style")]  # names that share a line are no single target
napoleon_use_rtype = False
maximum_signature_line_length = 88

html_theme = "furo"
html_title = f"meshwind {version}"
html_static_path = ["static"]
html_css_files = ["pages.css"]
html_copy_source = False
html_show_sphinx = False


class Notebook(MystParser):
    """Shows a notebook as the page that it says, without what it printed when it last ran."""

    supported = ("notebook",)

    def parse(self, inputstring: str, document: Any) -> None:
        """Read its cells as Markdown."""
        super().parse(as_markdown(inputstring), document)


NUMBERED = re.compile(r"(\s+\S.*?)\s{2,}(\(\d+\.\d[^)]*\).*)")
"""A line of an equation, and its number with what is said of it."""
NUMBER = 62
"""Column of these numbers, with which also what is said of them has room on a page of usual width."""
PAGES = "".join(file.read_text(encoding="utf-8") for file in Path(__file__).with_name("api").glob("*.rst"))
LISTED = {name.rpartition(".")[2]: name for name in re.findall(r"^\.\. autoclass:: ([\w.]+)$", PAGES, re.MULTILINE)}
"""Classes of the library's pages, to which a reader goes on from what a function returns, by their names."""
RETURNED = re.compile(rf"^(:returns: )\*({'|'.join(LISTED)})\*")


def setup(app: Any) -> None:
    """Have docstrings changed as they are read, notebooks shown, formulas typeset, and figures known."""
    typeset(app)
    add_figures(app)
    app.add_source_parser(Notebook)
    app.connect("autodoc-process-docstring", nearer)


def nearer(app: Any, what: str, name: str, thing: object, options: Any, lines: list[str]) -> None:
    """Move the numbers of equations, which end at column 118 in the code, onto the page; take bars as they stand."""
    del app, name, thing, options
    whole(what, lines)
    lines[:] = [RETURNED.sub(lambda found: f"{found[1]}`~{LISTED[found[2]]}`", line) for line in lines]
    plain = what == "function" and not any(line.endswith("::") for line in lines)
    for number, line in enumerate(lines):
        if found := NUMBERED.fullmatch(line):
            equation, rest = found.groups()
            lines[number] = equation + " " * max(2, NUMBER - len(equation)) + rest
        elif plain and "|" in line:  # norms, which are no names of substitutions
            parts = line.split("``")
            lines[number] = "``".join(part.replace("|", "\\|") if k % 2 == 0 else part for k, part in enumerate(parts))


def whole(what: str, lines: list[str]) -> None:
    """Put together the sentence of a property that was taken for "type: what it is" at its colon."""
    for number, line in enumerate(lines):
        if what == "property" and line.startswith(":type: "):
            del lines[number]
            lines[0] = f"{line.removeprefix(':type: ')}: {lines[0]}"
            return
