"""Several windings that one part is to hold: one edit whose rows are those of all."""

from pathlib import Path

import numpy as np
import pytest
from coarse_parts import coarse_vase
from test_editing import hyperboloid

import meshwind as mw
from meshwind.core.parsing import several_turns
from meshwind.editing.edit import edit
from meshwind.editing.options import EditOptions, WindingOptions
from meshwind.editing.redesign import redesign
from meshwind.editing.result import Outcome
from meshwind.editing.windings import Course
from meshwind.surface import Surface

DATA = Path(__file__).parents[1] / "data"
ALONG, ACROSS = Course(0.0, 8, 61), Course(0.25, 8, 61)


def pinched() -> Surface:
    """A tube whose cross-section is a peanut, and which has no waist: only hoops bridge it."""
    net = np.array(mw.shapes.cylinder(1.0, 3.0, (16, 16)).control_points)
    angle = np.arctan2(net[..., 1], net[..., 0])
    net[..., :2] *= (1.0 + 0.3 * np.cos(2.0 * angle))[..., None]
    return Surface(net)


def bridges(surface: Surface, course: Course) -> bool:
    return bool(course.laid(surface).gap.max() > 1e-6 * surface.size)


def test_a_part_for_two_windings_holds_both_and_one_for_either_does_not() -> None:
    surface = Surface(hyperboloid().control_points * [1.3, 1.0, 1.0])
    assert bridges(surface, ALONG) and bridges(surface, ACROSS)
    both, first, other = (edit(surface, each) for each in ((ALONG, ACROSS), (ALONG,), (ACROSS,)))
    assert all(each.outcome is Outcome.WINDABLE for each in (both, first, other))
    assert not bridges(both.surface, ALONG) and not bridges(both.surface, ACROSS)
    assert bridges(other.surface, ALONG) or bridges(first.surface, ACROSS)
    moved = [np.linalg.norm(each.surface.control_points - surface.control_points) for each in (both, first, other)]
    assert moved[0] >= max(moved[1:]) * (1 - 1e-3)  # more is demanded


def test_a_winding_given_twice_is_as_if_given_once() -> None:
    surface = hyperboloid()
    once, twice = edit(surface, (ALONG,)), edit(surface, (ALONG, ALONG))
    assert twice.surface.control_points == pytest.approx(once.surface.control_points, abs=1e-3)
    assert twice.bridged == once.bridged == 0.0


def test_hoops_fill_a_hollow_that_helices_along_it_do_not_see() -> None:
    surface = pinched()
    hoops = Course(0.0, 1, 61, (0.2, 0.8), 10.0, 0.2)
    assert not bridges(surface, ALONG) and bridges(surface, hoops)
    found = edit(surface, (ALONG, hoops))
    assert found.outcome is Outcome.WINDABLE
    assert not bridges(found.surface, hoops) and not bridges(found.surface, ALONG)
    low = Course(0.0, 1, 61, (0.2, 0.8), 10.0, 0.11)
    assert low.laid(found.surface).gap.max() < 0.02 * hoops.laid(surface).gap.max()  # a band half as wide, between them


def test_bridges_that_are_left_name_their_winding() -> None:
    found = edit(hyperboloid(), (ALONG, ACROSS), EditOptions(bound=0.1, rounds=2))
    assert found.outcome is Outcome.OUT_OF_REACH
    assert {each.winding for each in found.left} == {0, 1}
    gaps = [each.gap for each in found.left]
    assert gaps == sorted(gaps, reverse=True)
    for number, paths in enumerate(found.wound):
        assert max(each.gap for each in found.left if each.winding == number) == paths.gap.max()


def test_two_layers_at_once_on_the_vase_and_each_wound_anew_does_not_bridge() -> None:
    found = redesign(coarse_vase(), revolutions=[0.3, 0.8], paths=8, particles=201)
    assert found.windable and found.settled and len(found.windings) == 2
    assert min(found.before.gaps) > 0.1
    for turns, limit in zip((0.3, 0.8), found.after.gaps, strict=True):
        again = mw.wind(found.mesh, revolutions=turns, paths=8, particles=201)
        assert again.settled and again.paths.gap.max() == pytest.approx(limit, abs=1e-12)
        assert again.report()["paths"]["bridged_fraction"] == 0.0


def test_layers_of_a_laminate_are_held_each(tmp_path: Path) -> None:
    file = tmp_path / "laminate.toml"
    file.write_text(
        '[[layer]]\nkind = "helical"\nrevolutions = 0.8\npaths = 6\n'
        '[[layer]]\nkind = "hoop"\nband_width = 20\nband_thickness = 0.3\nfrom = 0.3\nto = 0.7\n',
        encoding="utf-8",
    )
    found = redesign(DATA / "vase.stl", layers=file, particles=201)
    assert [each.is_hoop for each in found.windings] == [False, True]
    assert found.windable and found.before.gaps[0] > 0.05
    assert found.windings[0].paths == 6 and found.windings[1].between == (0.3, 0.7)


@pytest.mark.parametrize(
    ("text", "value"), [("0.5", 0.5), ("5/12", 5 / 12), ("auto", "auto"), ("0.3, 0.8,5/12", (0.3, 0.8, 5 / 12))]
)
def test_revolutions_are_one_number_or_several(text: str, value: object) -> None:
    assert several_turns(text) == value


def test_what_says_nothing_clear_is_refused() -> None:
    with pytest.raises(mw.BadInputError, match="stands alone"):
        several_turns("0.3,auto")
    with pytest.raises(mw.BadInputError, match="give one of both"):
        WindingOptions(0.3, "layers.toml")
    with pytest.raises(mw.BadInputError, match="give one number or more"):
        WindingOptions(())
    with pytest.raises(mw.BadInputError, match="from 0 up"):
        WindingOptions((0.3, -1.0))
