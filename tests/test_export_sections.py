"""Elements of a deck share sections: angles, shares and axes within a tolerance, and nothing lost."""

import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from export_results import laminate, layered_results

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.exporting.elements import regular
from meshwind.exporting.material import read_material
from meshwind.exporting.plies import Ply, laid_on, plies
from meshwind.exporting.shell_deck import Deck, thicknesses, write_decks
from meshwind.exporting.shell_groups import SHARES, Laid, grouped
from meshwind.results.schema import SHELL, SHELL_S4R

TOLERANCE = 3.0


def cards(path: Path, keyword: str) -> list[list[str]]:
    """Each card that begins with the keyword, with its data lines."""
    found = re.split(r"^(?=\*[A-Z])", path.read_text(), flags=re.MULTILINE)
    return [
        [line for line in card.splitlines() if not line.startswith("**")] for card in found if card.startswith(keyword)
    ]


def named(card: list[str], what: str) -> str:
    return re.findall(rf"\b{what}=([^,\s]+)", card[0])[-1]


def numbers(line: str) -> list[float]:
    return [float(part) for part in line.split(",") if part.strip()]


@dataclass
class Written:
    """Direction (k, 3), layer by layer from the inside out, that a deck gives the elements, and thickness."""

    directions: list[list[Floats]]
    thickness: list[list[float]]
    count: int


def read(path: Path) -> Written:
    """The deck by its own words: CalculiX's layers name axes, Abaqus's have angles from the axes of each element."""
    axes = {named(card, "NAME"): np.array(numbers(card[1])) for card in cards(path, "*ORIENTATION") if "," in card[1]}
    each = {int(row[0]): np.array(row[1:]) for card in cards(path, "*DISTRIBUTION,") for row in map(numbers, card[2:])}
    members = {
        named(card, "ELSET"): [int(n) for line in card[1:] for n in numbers(line)] for card in cards(path, "*ELSET")
    }
    count = sum(map(len, members.values()))
    assert sorted(n for each in members.values() for n in each) == list(range(1, count + 1))
    directions: list[list[Floats]] = [[] for _ in range(count)]
    thickness: list[list[float]] = [[] for _ in range(count)]
    sections = cards(path, "*SHELL SECTION")
    for card in sections:
        for e in members[named(card, "ELSET")]:
            for line in card[1:]:
                row = [part.strip() for part in line.split(",")]
                thickness[e - 1].append(float(row[0]))
                if len(row) == 5:
                    turned = np.radians(float(row[3]))
                    directions[e - 1].append(np.cos(turned) * each[e][:3] + np.sin(turned) * each[e][3:])
                else:
                    directions[e - 1].append(axes[row[3]][:3])
    return Written(directions, thickness, len(sections))


def turned(ply: Ply, normal: Floats, by: Floats) -> Ply:
    """The ply turned in its plane, by radians (k,) towards s_u, which is the other way about the normal."""
    side = np.cross(ply.direction, normal)
    direction = np.cos(by)[:, None] * ply.direction + np.sin(by)[:, None] * side
    return replace(ply, direction=direction, angle=ply.angle + by)


@pytest.fixture(scope="module")
def deck(tmp_path_factory: pytest.TempPathFactory) -> Deck:
    """Three layers on a cylinder, whose angles vary along it by 12 degrees."""
    results = layered_results(tmp_path_factory.mktemp("sections"), laminate())
    elements = regular(laid_on(results), 600, results.surface)
    laid = plies(results, elements)
    by = np.radians(12.0) * np.sin(5.0 * elements.centre[:, 1])
    families = tuple(turned(ply, laid.normal, ply.family * by) for ply in laid.families)
    return Deck(elements, replace(laid, families=families), read_material(), results.units, tolerance=TOLERANCE)


def expected(deck: Deck) -> list[list[tuple[Floats, float]]]:
    """Direction and thickness of each layer on each element, from the inside out."""
    thick, found = thicknesses(deck), []
    for k in range(len(deck.elements)):
        layers: list[tuple[Floats, float]] = []
        for stack in deck.plies.stacks:
            order = (stack[0], stack[1], stack[0]) if len(stack) > 1 else stack
            for at, which in enumerate(order):
                part = 0.5 if len(stack) > 1 and at != 1 else 1.0
                if thick[which, k] > 0.0:
                    layers.append((deck.plies.families[which].direction[k], part * thick[which, k]))
        found.append(layers)
    return found


@pytest.mark.parametrize("name", [SHELL, SHELL_S4R])
@pytest.mark.parametrize("tolerance", [0.0, TOLERANCE])
def test_elements_have_their_own_layers_within_the_tolerance(
    deck: Deck, tmp_path: Path, name: str, tolerance: float
) -> None:
    """The directions of both programs' words agree with the fibres in space, so also in their sense of turning."""
    asked = replace(deck, tolerance=tolerance)
    notes = write_decks(tmp_path, asked)
    found = read(tmp_path / name)
    off, shares, total = [], [], thicknesses(asked).sum(axis=0)
    for k, layers in enumerate(expected(asked)):
        assert len(found.directions[k]) == len(layers)
        for (direction, thickness), there, thick in zip(layers, found.directions[k], found.thickness[k], strict=True):
            off.append(np.degrees(2.0 * np.arcsin(0.5 * np.linalg.norm(direction - there))))
            shares.append(abs(thick - thickness) / total[k])
        assert sum(found.thickness[k]) == pytest.approx(total[k], rel=1e-6)
    if tolerance == 0.0:
        assert found.count == len(deck.elements)
        assert max(off) < 1e-4 and max(shares) < 1e-8
        return
    fixed = 0.5 if name == SHELL else 0.0
    assert 0.3 * tolerance < max(off) < tolerance + fixed
    assert max(shares) < SHARES
    assert found.count < (0.9 if name == SHELL else 0.1) * len(deck.elements)
    text = (tmp_path / name).read_text()
    assert f"** {found.count} sections: angles of elements in one are within 3 degrees" in text
    assert any(f"{SHELL_S4R} {len(deck.groups)}" in note and "within 3 degrees" in note for note in notes)


def test_sections_keep_the_fibres_volume(deck: Deck) -> None:
    area = deck.elements.samples()[1].sum(axis=1)
    grouped_volume = (deck.groups.thickness[:, deck.groups.number] * area).sum(axis=1)
    assert grouped_volume == pytest.approx((thicknesses(deck) * area).sum(axis=1), rel=1e-12)


def test_elements_of_different_layers_share_no_section() -> None:
    """Also if one has next to nothing of a layer, or another thickness in all."""
    angle = np.array([[0.5, 0.5, 0.5, 0.5], [1.5, 1.5, 9.0, 1.5]])
    thickness = np.array([[1.0, 1.0, 1.0, 1.0], [1e-6, 2e-6, 0.0, 1e-6]])
    level: Ints = np.array([0, 0, 0, 1])
    groups = grouped(Laid(angle, thickness, np.ones(4)), level, TOLERANCE)
    assert groups.number.tolist() == [0, 0, 1, 2]
    assert groups.thickness[1] == pytest.approx([1.5e-6, 0.0, 1e-6])
    for bad in (-1.0, 46.0, float("nan")):
        with pytest.raises(BadInputError, match="degrees from 0 to 45"):
            grouped(Laid(angle, thickness, np.ones(4)), level, bad)
