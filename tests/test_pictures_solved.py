"""The picture of a solved deck: each element in its own colour, and a ring where the first ply fails."""

from dataclasses import replace

import numpy as np
import pytest
from export_results import plain_results

import meshwind as mw
from meshwind.exporting.shell_about import ReadAbout, Strengths, read_about
from meshwind.pictures.solved_scene import solved_scene
from meshwind.results.schema import SHELL, SHELL_ABOUT
from meshwind.solving.deck import read_deck
from meshwind.solving.fields import Solved, solved
from meshwind.solving.figures import figures, lines
from meshwind.solving.tables import Tables

WORST = 17


@pytest.fixture(scope="module")
def held(tmp_path_factory: pytest.TempPathFactory) -> tuple[Solved, ReadAbout]:
    """A deck with stresses along the fibres that grow from element to element but for one, which has the most."""
    folder = tmp_path_factory.mktemp("solved")
    plain_results(folder)
    mw.export(folder, "inp", thickness=0.02, elements=100)
    deck, about = read_deck(folder / SHELL), read_about(folder / SHELL_ABOUT)
    element = np.repeat(np.arange(len(deck)), 24)
    place = np.tile(np.repeat(np.arange(3), 8), len(deck))
    stress = np.zeros((len(element), 6))
    stress[:, 0] = element
    stress[(element == WORST) & (place == 1), 0] = 1000.0
    moved = 1e-3 * np.ones_like(deck.points) * np.arange(len(deck.points))[:, None] / len(deck.points)
    return solved(deck, Tables(moved, stress, 1e-6 * stress, element, place), "mm", about.strengths), about


def test_each_element_has_its_own_colour_and_the_worst_a_ring(held: tuple[Solved, ReadAbout]) -> None:
    done, about = held
    made = figures(done, about, about.deck)
    scene = solved_scene(done, made)
    each = scene.shares.reshape(-1, 4)
    assert (each == each[:, :1]).all() and int(each[:, 0].argmax()) == WORST
    assert scene.worst is not None and np.array_equal(scene.worst.point, done.deck.centre[WORST])
    assert scene.worst.words == ("ring: fails first", "ply 2 of 3", "layer 1, family -1")
    assert np.array_equal(scene.part.points, done.deck.points[done.deck.faces].reshape(-1, 3))
    assert made["largest"]["stress"] == [1000.0, 0.0, 0.0] and made["largest"]["number"] == WORST + 1
    assert made["largest"]["load_factor"] == pytest.approx(2.55)  # xt is 2550 MPa
    assert "fails at 2.55 times the load" in scene.frame.subtitle
    assert done.plies[1, -1].stress[WORST].tolist() == [1000.0, 0.0, 0.0]
    assert done.plies[1, 1].stress[WORST].tolist() == [WORST, 0.0, 0.0]


def test_without_strengths_it_shows_the_displacement(held: tuple[Solved, ReadAbout]) -> None:
    done, about = replace(held[0], worst=None), replace(held[1], strengths=Strengths({}, -0.5))
    made = figures(done, about, about.deck)
    scene = solved_scene(done, made)
    assert scene.worst is not None and np.array_equal(scene.worst.point, done.deck.points[-1])
    assert scene.worst.words == ("ring: where it", "moves most") and "displacement" in scene.frame.title
    assert [line.split()[0] for line in lines(made)] == ["part", "moved"]
    assert "no strengths are known" in made["notes"][0]
