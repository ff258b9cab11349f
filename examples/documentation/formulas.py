"""Formulas of the site as MathML, which browsers typeset themselves, and equations under the numbers of the source.

Nothing is loaded from elsewhere and no LaTeX is needed: docutils translates.  An equation's label is its number, so
that ``:eq:`4.16``` is a link that reads (4.16) from whatever page.
"""

import re
from itertools import cycle
from typing import Any

from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.domains.math import MathDomain
from sphinx.util.logging import getLogger

logger = getLogger(__name__)


class Numbered(MathDomain):
    """Equations whose number is their label, in place of their count."""

    def note_equation(self, docname: str, labelid: str, location: Any = None) -> None:
        """Keep the label as the number; warns where two equations have the same."""
        super().note_equation(docname, labelid, location)
        self.equations[labelid] = (docname, labelid)  # type: ignore[assignment]


def markup(formula: nodes.Element, block: bool) -> str:
    """The MathML of a formula; one that docutils cannot read is a warning, and stands as it is written."""
    try:
        return norms(str(tex2mathml(formula.astext(), as_block=block)))
    except Exception as error:  # noqa: BLE001 its MathError is no public name
        logger.warning("cannot typeset %s: %s", formula.astext(), error, location=formula)
        return f"<code>{nodes.unescape(formula.astext())}</code>"


def norms(written: str) -> str:
    """Its bars as pairs, which without this have the room of operators around them."""
    forms = cycle(("prefix", "postfix"))
    return re.sub(r"<mo[^>]*>\|</mo>", lambda _: f'<mo form="{next(forms)}" stretchy="false">|</mo>', written)


def inline(page: Any, node: nodes.math) -> None:
    """Write a formula that stands in a sentence."""
    page.body.append(markup(node, block=False))
    raise nodes.SkipNode


def displayed(page: Any, node: nodes.math_block) -> None:
    """Write one that has a line of its own, its number at the end of the line."""
    page.body.append(page.starttag(node, "div", CLASS="equation"))
    page.body.append(f'<div class="formula">{markup(node, block=True)}</div>')
    if node["number"]:
        page.body.append(f'<a class="eqno" href="#{node["ids"][0]}">({node["number"]})</a>')
    page.body.append("</div>\n")
    raise nodes.SkipNode


def typeset(app: Any) -> None:
    """Have a site's formulas written so."""
    app.add_domain(Numbered, override=True)
    app.add_html_math_renderer("mathml", (inline, None), (displayed, None))
    app.config.html_math_renderer = "mathml"
