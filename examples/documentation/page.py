"""Documentation with tables and figures put in from the results that are kept, and a table of what they rest on."""

import re
from collections.abc import Iterator
from typing import Any

from documentation.claims import CLAIMS, TESTED
from documentation.kept import Kept, spans
from documentation.tables import TABLES

FIGURE = r"([\d.,e+-]*\d(?: to [\d.,e+-]*\d)?)"
"""A figure as it stands in a sentence, or the least and the largest of some."""
TABLE = r"(<!-- table {} -->\n).*?(\n\n<!-- end of table -->)"
"""A table between its marks, which do not show."""


def pattern(text: str) -> re.Pattern[str]:
    """What finds a sentence, broken anywhere into lines, with its figures as groups."""
    parts = (r"\s+".join(map(re.escape, part.split(" "))) for part in text.split("{}"))
    return re.compile(FIGURE.join(parts))


def filled(pages: dict[str, str], kept: Kept) -> dict[str, str]:
    """The pages with all tables and all figures of their sentences made anew; each is on one of them."""
    pages = dict(pages)
    for name, table in TABLES.items():
        page, _ = once(pages, re.compile(TABLE.format(name), re.DOTALL), f"the table {name}")
        pages[page] = put(pages[page], name, table(kept))
    for claim in CLAIMS:
        page, found = once(pages, pattern(claim.text), claim.text)
        figures = claim.figures(kept)
        if len(figures) != claim.text.count("{}"):
            raise LookupError(f"{len(figures)} figures for: {claim.text}")
        for group, figure in reversed(list(enumerate(figures, 1))):
            begin, end = found.span(group)
            pages[page] = pages[page][:begin] + figure + pages[page][end:]
    return pages


def put(page: str, name: str, table: str) -> str:
    """The page with a table between its marks."""
    new, many = re.subn(TABLE.format(name), lambda found: found[1] + table + found[2], page, flags=re.DOTALL)
    if many != 1:
        raise LookupError(f"the table {name} is marked {many} times")
    return new


def once(pages: dict[str, str], wanted: re.Pattern[str], what: str) -> tuple[str, re.Match[str]]:
    """The page that has what is wanted, and where it has it."""
    found = [(page, match) for page, text in pages.items() for match in wanted.finditer(text)]
    if len(found) != 1:
        raise LookupError(f"found {len(found)} times: {what}")
    return found[0]


def untrue(kept: Kept) -> list[str]:
    """Sentences that the results do not bear out, whatever figures they have."""
    return [claim.text for claim in CLAIMS if not claim.holds(kept)]


def traced() -> Iterator[dict[str, Any]]:
    """A row for each table and sentence: the files and lines of results, or the test, that it rests on."""
    for name, table in TABLES.items():
        kept = Kept()
        table(kept)
        yield {"claim": f"table {name}", "rests on": where(kept)}
    for claim in CLAIMS:
        kept = Kept()
        text = claim.text.format(*claim.figures(kept))
        claim.holds(kept)
        yield {"claim": text, "rests on": where(kept)}
    for text, test in TESTED.items():
        yield {"claim": text, "rests on": f"tests/{test}"}


def where(kept: Kept) -> str:
    """The lines that were read."""
    return ", ".join(f"{table}.csv: {spans(sorted(lines))}" for table, lines in kept.lines.items() if lines)
