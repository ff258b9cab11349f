"""Other states of rest close by are found where there are some, nowhere else, and are what a solve with them gives."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.path import Paths
from meshwind.path.other_rests import ASIDE, FAR, LOOSER
from meshwind.path.paths import SLID
from meshwind.run.summary import run_lines
from meshwind.workflow.notes import about_other_rests

DATA = Path(__file__).parents[1] / "data"


def fitted(name: str) -> mw.Surface:
    return mw.fit(mw.flatten(mw.annulus(mw.read(DATA / name))), 1e-5)


def barrel() -> mw.Surface:
    return mw.shapes.revolution(lambda z: 1 - 0.3 * (z - 1) ** 2, 0.0, 2.0)


def wound(surface: mw.Surface, paths: int, revolutions: float, friction: float, particles: int = 401) -> Paths:
    ends = mw.families(surface, paths, revolutions)
    return mw.solve(surface, ends.start, ends.end, family=ends.family, friction=friction, particles=particles)


def apart(one: Floats, other: Floats) -> float:
    """Largest distance of the particles (n, 3) of one path from those of another."""
    return float(cKDTree(one).query(other)[0].max())


@pytest.fixture(scope="module")
def bottle() -> mw.Surface:
    return fitted("bottle.obj")


def test_paths_of_few_and_of_many_particles_are_slid_together() -> None:
    """One that bridges needs more than one that lies on the part all along, and still the latter can be looked at."""
    surface = fitted("cast.ply")
    ends = mw.families(surface, 24, 0.625)
    paths = mw.solve(surface, ends.start[14:16], ends.end[14:16], family=ends.family[14:16], friction=0.2)
    assert not paths.on_surface[0].all() and paths.on_surface[1].all()
    assert paths.other_rests.found.tolist() == [True, True]


def test_a_state_that_less_friction_leads_to_is_found(bottle: mw.Surface) -> None:
    paths = wound(bottle, 6, 0.55, 0.15)
    rests = paths.other_rests
    assert np.flatnonzero(rests.found).tolist() == [10]
    assert rests.status[10] == 0
    assert rests.shift[10] == 0.0
    assert -LOOSER <= rests.friction[10] < 0.0
    ends = mw.families(bottle, 6, 0.55)
    there, before = (
        mw.solve(bottle, ends.start[10:11], ends.end[10:11], friction=0.15 * (1.0 + change))
        for change in (rests.friction[10], rests.friction[10] + LOOSER / 4)
    )
    assert there.length[0] == pytest.approx(rests.length[10], rel=SLID)
    assert apart(paths.points[10], there.points[0]) > 0.9 * rests.apart[10] > FAR * bottle.size
    assert apart(paths.points[10], before.points[0]) < 0.3 * rests.apart[10]  # the edge lies between the two


def test_a_state_that_a_shift_leads_to_is_found(bottle: mw.Surface) -> None:
    paths = wound(bottle, 6, 0.45, 0.15)
    rests = paths.other_rests
    assert np.flatnonzero(rests.found).tolist() == [6]
    assert rests.friction[6] == 0.0
    assert 0.0 < rests.shift[6] <= rests.most_shifted == ASIDE * bottle.size
    assert rests.apart[6] > 25.0
    assert abs(rests.length[6] - paths.length[6]) > 5.0
    assert np.isnan(rests.moved[6])
    others = np.arange(12) != 6
    assert np.isnan(rests.apart[others]).all()
    assert (rests.moved[others] < FAR * bottle.size).all()


def test_a_path_that_moves_far_in_proportion_has_none(bottle: mw.Surface) -> None:
    rests = wound(bottle, 6, 0.45, 0.3).other_rests
    assert rests.moved.max() > FAR * bottle.size
    assert not rests.found.any()


def test_a_path_that_would_slide_off_is_found(bottle: mw.Surface) -> None:
    paths = wound(bottle, 6, 0.9, 0.1)
    rests = paths.other_rests
    assert np.flatnonzero(rests.found).tolist() == [11]
    assert rests.status[11] in (1, 2)
    assert np.isnan(rests.apart[11])
    assert not rests.found[paths.status != 0].any()
    (note,) = about_other_rests(paths, "mm")
    assert "path 11 would not rest (the fibre slides off" in note.text


@pytest.mark.parametrize("surface", [
    mw.shapes.cylinder(radius=1.0, length=3.0), barrel(), fitted("vase.stl"),
], ids=["cylinder", "barrel", "vase"])  # fmt: skip
@pytest.mark.parametrize("revolutions", [0.3, 0.8])
def test_smooth_parts_have_none_and_move_as_stated(surface: mw.Surface, revolutions: float) -> None:
    paths = wound(surface, 2, revolutions, 0.2)
    rests = paths.other_rests
    assert not rests.found.any()
    assert (rests.status == -1).all()
    ends = mw.families(surface, 2, revolutions)
    for change in (-0.9, -0.5, 0.3, 0.7):
        between = mw.solve(surface, ends.start, ends.end, friction=0.2 * (1.0 + LOOSER * change))
        for k in range(len(paths)):
            coarse = 1e-3 * paths.length[k]
            assert apart(paths.points[k], between.points[k]) <= rests.moved[k] + coarse


def test_a_fibre_that_stays_moves_with_its_starting_curve() -> None:
    radius, length, n = 1.0, 3.0, 401
    paths = wound(mw.shapes.cylinder(radius, length), 1, 0.5, 0.4)
    rests = paths.other_rests
    np.testing.assert_allclose(rests.moved, rests.most_shifted, rtol=0.01)
    # unrolled, the surface is a plane: the left of a line is square to it
    t = np.linspace(0.0, 1.0, n)
    way = np.array([np.pi * radius, length]) / np.hypot(np.pi * radius, length)
    for share in (-0.8, -0.3, 0.5):
        by = share * rests.most_shifted * np.sin(np.pi * t)
        curve = np.column_stack([0.5 * t - way[1] * by / (2.0 * np.pi * radius), t + way[0] * by / length])
        other = mw.solve(paths.surface, [curve[0]], [curve[-1]], initial=[curve], friction=0.4)
        assert apart(paths.points[0], other.points[0]) <= rests.moved[0]


@pytest.mark.parametrize("particles", [3, 4, 10, 51])
def test_few_particles_do(particles: int) -> None:
    assert not wound(barrel(), 1, 0.3, 0.2, particles).other_rests.found.any()


def test_none_are_looked_for_without_friction_or_from_elsewhere() -> None:
    surface = barrel()
    for paths in (wound(surface, 1, 0.3, 0.0), replace(wound(surface, 1, 0.3, 0.2), asked=None)):
        assert not paths.other_rests.found.any()
        assert np.isnan(paths.other_rests.moved).all()


def test_a_part_of_the_paths_has_the_same(bottle: mw.Surface) -> None:
    paths = wound(bottle, 6, 0.45, 0.15)
    part = paths.subset(np.array([2, 6])).other_rests
    assert part.found.tolist() == [False, True]
    assert part.apart[1] == paths.other_rests.apart[6]


def test_the_report_and_the_summary_say_so() -> None:
    result = mw.wind(DATA / "bottle.obj", paths=6, revolutions=0.45, friction=0.15)
    report = result.report()
    rests = report["paths"]["other_rests"]
    (found,) = rests["found"]
    assert (found["path"], found["name"], found["friction"]) == (6, "converged", 0.0)
    assert rests["friction"] == LOOSER
    assert 0.0 < found["shift"] <= rests["shift"]
    said = "1 of 12 paths rests close to another state: path 6 would lie 31 mm away if it were laid 1.6 mm"
    assert sum(said in line for line in run_lines(report)) == 1
    smooth = mw.wind(DATA / "tank.ply", paths=2, revolutions=0.3, particles=51)
    assert "other_rests" not in smooth.report()["paths"]
    assert not any("another state" in str(note) for note in smooth.notes)


def test_the_note_names_three_paths_and_counts_the_others(bottle: mw.Surface) -> None:
    paths = wound(bottle, 6, 0.55, 0.15)
    rests, five = paths.other_rests, np.array([10] * 5)
    many = replace(rests, **{
        name: getattr(rests, name)[five] for name in ("apart", "length", "status", "friction", "shift")
    })  # fmt: skip
    paths = paths.subset(five)
    vars(paths)["other_rests"] = many
    (note,) = about_other_rests(paths, "mm")
    assert note.text.startswith("5 of 5 paths rest close to another state: path 0 would lie 15 mm away if friction")
    assert note.text.count("% lower") == 3
    assert note.text.endswith("2 more paths in the report")
