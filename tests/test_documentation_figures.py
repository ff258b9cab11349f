"""Tables and figures of README and the site are those of the results that are kept, and each is traced to them."""

import ast
import csv
import re

import pytest
from documentation.claims import CLAIMS, TESTED, Claim
from documentation.documents import ROOT, documents
from documentation.kept import RESULTS, Kept, spans
from documentation.page import TABLE, filled, once, pattern, traced, untrue
from documentation.tables import NEEDED, TABLES
from documentation.words import figure, span

PAGES = documents()
ALL = "\n".join(PAGES.values())
AGAIN = "; run python examples/documentation_tables.py"


def flat(text: str) -> str:
    return re.sub(r"\s+", " ", text)


@pytest.mark.parametrize("name", TABLES)
def test_tables_are_made_from_what_is_kept(name: str) -> None:
    found = re.search(TABLE.format(name), ALL, re.DOTALL)
    assert found, f"no page has the table {name}"
    assert f"{found[1]}{TABLES[name](Kept())}{found[2]}" == found[0], f"the table {name} is another" + AGAIN


@pytest.mark.parametrize("claim", CLAIMS, ids=lambda claim: claim.figures.__name__)
def test_sentences_have_the_figures_of_what_is_kept(claim: Claim) -> None:
    assert flat(claim.text.format(*claim.figures(Kept()))) in flat(ALL), AGAIN
    assert claim.holds(Kept()), f"the results do not bear out: {claim.text}"


def test_every_sentence_and_table_is_traced() -> None:
    with (RESULTS.with_name("claims.csv")).open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert rows == list(traced()), AGAIN
    assert len(rows) == len(TABLES) + len(CLAIMS) + len(TESTED) and all(row["rests on"] for row in rows)


def test_what_is_kept_is_what_is_needed() -> None:
    assert {file.stem for file in RESULTS.iterdir()} == set(NEEDED)
    kept = Kept()
    for table in TABLES.values():
        table(kept)
    for claim in CLAIMS:
        claim.figures(kept)
        claim.holds(kept)
    assert set(kept.lines) == set(NEEDED)


def test_tests_that_sentences_rest_on_are_there() -> None:
    for words, place in TESTED.items():
        file, name = place.split("::")
        tree = ast.parse((ROOT / "tests" / file).read_text(encoding="utf-8"))
        assert name in {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}, place
        assert flat(words) in flat(ALL), words


def test_another_figure_or_table_is_seen_and_put_right() -> None:
    claim = CLAIMS[1]
    page, found = once(PAGES, pattern(claim.text), claim.text)
    begin, end = found.span(1)

    def holding(words: str) -> dict[str, str]:
        return PAGES | {page: PAGES[page][:begin] + words + PAGES[page][end:]}

    assert filled(holding("9,999"), Kept()) == PAGES != holding("9,999")
    for name in TABLES:
        row = TABLES[name](Kept()).splitlines()[-1]
        wrong = {each: text.replace(row, "| none |") for each, text in PAGES.items()}
        assert wrong != PAGES and filled(wrong, Kept()) == PAGES
    with pytest.raises(LookupError, match="found 0 times"):
        filled(holding("many"), Kept())
    assert not untrue(Kept())


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [(0.7466, 2, "0.75"), (47.2, 2, "47"), (1283.0, 2, "1,300"), (1.54e-5, 2, "1.5e-5"), (2e-5, 2, "2e-5"),
     (0.0, 2, "0"), (9.96, 2, "10"), (99.6, 2, "100"), (0.0996, 2, "0.10"), (8.64, 1, "9"), (0.00144, 2, "1.4e-3")],
)  # fmt: skip
def test_figures_are_written_with_few_digits(value: float, digits: int, text: str) -> None:
    assert figure(value, digits) == text


def test_spans_are_written_once() -> None:
    assert span([3.0, 1.0, 2.0]) == "1.0 to 3.0"
    assert span([1.001, 1.0]) == "1.0"
    assert spans([7, 2, 3, 4]) == "2-4 7"
