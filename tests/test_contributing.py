"""CONTRIBUTING.md names what there is: packages in their order, files, and the names in them."""

import re
from pathlib import Path

import pytest
from test_architecture import ORDER

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
MODULES = [room for room in ORDER if (ROOT / "meshwind" / room).is_dir()]


def packages() -> dict[str, str]:
    """The rows of the table of packages: name, and the cell that says where to begin."""
    table = TEXT.split("| package | is for | begin with |\n")[1].split("\n\n")[0]
    rows = [[cell.strip() for cell in row.strip("|").split("|")] for row in table.splitlines()[1:]]
    return {row[0].strip("`"): row[2] for row in rows}


def test_packages_are_listed_in_their_order() -> None:
    assert list(packages()) == MODULES


@pytest.mark.parametrize("package", MODULES)
def test_files_to_begin_with_are_there(package: str) -> None:
    for name in re.findall(r"`([\w/]+\.py)`", packages()[package]):
        assert any((folder / name).is_file() for folder in (ROOT / "meshwind", ROOT / "meshwind" / package)), name


def test_files_are_there() -> None:
    for name in re.findall(r"`((?:meshwind|tests|examples|\.ci)/[\w/.]+)`", TEXT):
        assert (ROOT / name).exists(), name
    for name in re.findall(r"`(test_\w+\.py)`", TEXT):
        assert (ROOT / "tests" / name).is_file(), name


def test_names_are_in_their_files() -> None:
    named = re.findall(r"`(\w+)(?:\(\))?`\s(?:in|of)\s`(meshwind/[\w/]+\.py)`", TEXT)
    assert len(named) >= 8
    for name, file in named:
        assert re.search(rf"\b{name}\b", (ROOT / file).read_text(encoding="utf-8")), f"{name} in {file}"
