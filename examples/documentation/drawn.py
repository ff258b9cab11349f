"""Figures of the site's theory, each with the code that draws it."""

import ast
from pathlib import Path
from typing import Any

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.util.docutils import SphinxDirective

FIGURES = Path(__file__).parents[1] / "figures"
"""A module for each page, a function for each figure, and the pictures that they wrote."""


def code_of(page: str, figure: str) -> str:
    """The source of the function that draws a figure."""
    text = (FIGURES / f"{page}.py").read_text(encoding="utf-8")
    (found,) = (each for each in ast.parse(text).body if isinstance(each, ast.FunctionDef) and each.name == figure)
    return "\n".join(text.splitlines()[found.lineno - 1 : found.end_lineno])


class Drawn(SphinxDirective):
    """A figure by its function's name, with a caption, and its code below, which a reader can open."""

    required_arguments = 1
    option_spec = {"alt": directives.unchanged_required}  # noqa: RUF012 as docutils declares it
    has_content = True

    def run(self) -> list[nodes.Node]:
        """Make the figure of what docname's module draws."""
        page, name = Path(self.env.docname).name, self.arguments[0]
        self.env.note_dependency(str(FIGURES / f"{page}.py"))
        picture = f"/../figures/{page}_{name}.png"
        figure = nodes.figure("", nodes.image(uri=picture, alt=self.options["alt"]), classes=["drawn"])
        caption = nodes.caption()
        text, problems = self.parse_inline(" ".join(self.content), lineno=self.content_offset)
        caption += text
        figure += caption
        code = code_of(page, name)
        opening = f"<details><summary>The code, in examples/figures/{page}.py</summary>"
        before, after = (nodes.raw("", tags, format="html") for tags in (opening, "</details>"))
        return [figure, *problems, before, nodes.literal_block(code, code, language="python"), after]


def add_figures(app: Any) -> None:
    """Have a site know the directive."""
    app.add_directive("drawn", Drawn)
