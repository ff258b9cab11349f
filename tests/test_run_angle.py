"""The winding angle that is asked for, and as many paths as cover the part."""

from dataclasses import replace
from math import atan, cos, degrees, pi, radians, tan
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from layup_shapes import drawn, revolved

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.filament.closing import close_layer
from meshwind.filament.ends import LayerPlan as ClosingPlan
from meshwind.filament.ends import Wish
from meshwind.filament.levels import levels
from meshwind.filament.settling import lay
from meshwind.filament.stations import angles_at, median_angle, wound_angle
from meshwind.layup.direction import directions
from meshwind.layup.direction import winding_angle as angle_map
from meshwind.path import Paths
from meshwind.surface import Surface
from meshwind.surface.interpolate import interpolate
from meshwind.workflow.angle_search import Hunt, hunt, survey
from meshwind.workflow.helices import Helices, Turned


def helices(surface: Surface) -> Helices:
    return Helices(surface, (0.0, 1.0), 0.0, levels(surface))


def test_a_cylinder_is_covered_by_23_circuits() -> None:
    """Radius 50, length 400, 45 degrees, band 10: 22.2144, so 23."""
    tube = helices(mw.shapes.cylinder(50.0, 400.0))
    turns = tube.turned_to(radians(45.0)).revolutions
    assert degrees(atan(turns * 2 * pi * 50.0 / 400.0)) == pytest.approx(45.0, abs=0.06)
    assert tube.circuits(400.0 * tan(radians(45.0)) / (2 * pi * 50.0), 10.0) == 23


def test_an_elliptic_spar_is_covered_by_26_circuits() -> None:
    """Half axes 80 and 30, perimeter 363.668628, 45 degrees, band 10: 25.7153, so 26."""

    def place(u: np.ndarray, v: np.ndarray) -> np.ndarray:  # type: ignore[type-arg]
        return np.stack([80.0 * np.cos(2 * pi * u), 30.0 * np.sin(2 * pi * u), 400.0 * v], axis=-1)

    spar = helices(interpolate(place, (192, 16)))
    assert 363.668628 * cos(radians(45.0)) / 10.0 == pytest.approx(25.7153, abs=1e-4)
    assert spar.circuits(400.0 / 363.668628, 10.0) == 26


def test_a_cone_is_covered_at_its_large_end() -> None:
    """Diameters 98 to 54 over 120, 30 degrees at the large end: 44.4381 bands of 6, so 45."""
    cone = helices(mw.shapes.cone(49.0, 27.0, 120.0))
    turns = cone.turned_to(radians(30.0), "V=0").revolutions
    assert 360.0 * turns == pytest.approx(194.919942, abs=1.0)  # the angle is met to 0.05 degrees
    assert cone.circuits(194.919942 / 360.0, 6.0) == 45


@pytest.mark.parametrize(("part", "friction"), [("tank.ply", 0.2), ("elbow.obj", 0.2), ("cast.ply", 0.0)])
def test_the_angle_is_met_in_the_files(part: str, friction: float, tmp_path: Path) -> None:
    """Measured from paths.vtp alone: steps of the fibre against the level lines of the fitted surface."""
    angle = 30.0
    result = mw.wind(f"data/{part}", angle=angle, angle_at="v=0.5", friction=friction, paths=6,
                     particles=201, out=tmp_path, render=False)  # fmt: skip
    fibres = pv.read(tmp_path / "paths.vtp")
    uv, points = fibres.point_data["uv"].reshape(12, -1, 2), np.asarray(fibres.points).reshape(12, -1, 3)
    found = []
    for path, at in zip(points, uv, strict=True):
        k = min(max(int(np.searchsorted(at[:, 1], 0.5)), 1), len(at) - 1)
        step, delta = path[k] - path[k - 1], 1e-5
        middle = 0.5 * (at[k] + at[k - 1])
        level = np.diff(result.surface.points([middle - [delta, 0.0], middle + [delta, 0.0]]), axis=0)[0]
        found.append(degrees(np.arcsin(abs(step @ level) / np.linalg.norm(step) / np.linalg.norm(level))))
    assert np.median(found) == pytest.approx(angle, abs=0.5)
    assert str(angle).removesuffix(".0") in " ".join(result.report()["notes"])
    assert result.report()["winding"]["revolutions"] == result.revolutions


def test_enough_paths_to_cover_as_one_filament(tmp_path: Path) -> None:
    result = mw.wind("data/tank.ply", paths=None, band_width=15.0, angle=35.0, friction=0.2, particles=101,
                     continuous=True, out=tmp_path, render=False)  # fmt: skip
    figures = result.report()["pattern"][0]
    assert figures["circuits"] == result.report()["winding"]["paths_per_family"] > 12
    # a few paths more than it takes, where with them the filament closes at the angle
    assert 1.0 <= figures["cover"]["min"] < 1.2
    assert 'paths = "auto"' in (tmp_path / "meshwind.toml").read_text()


def test_an_angle_out_of_reach_is_wound_at_the_nearest_with_a_warning() -> None:
    """On a domed tank r sin(angle) is constant along a fibre, so that small openings allow no 88 degrees."""
    result = mw.wind("data/tank.ply", angle=88.0, paths=4, particles=101)
    (warning,) = [note for note in result.notes if "88 degrees" in note.text]
    assert warning.warning and "is out of reach" in warning.text and "slide off" in warning.text
    assert result.settled  # no fibre is given away for a degree
    at = angles_at(result.paths, np.array([float(warning.text.split("v=")[1].split(":")[0])]))
    assert f"wound at {degrees(np.median(at)):.1f}" in warning.text


def test_the_angle_is_no_other_where_the_chart_is_oblique() -> None:
    """A cylinder whose lines u = 0 wind as well: the angle is still that from the axis, in maps as at stations."""

    def place(u: np.ndarray, v: np.ndarray) -> np.ndarray:  # type: ignore[type-arg]
        turned = 2 * pi * (u + 0.3 * v)
        return np.stack([50.0 * np.cos(turned), 50.0 * np.sin(turned), 400.0 * v], axis=-1)

    surface, v = interpolate(place, (192, 16)), np.linspace(0.0, 1.0, 101)
    paths = drawn(surface, np.array([np.stack([k / 6 + 0.4 * v, v], axis=1) for k in range(6)]), np.ones(6))
    wanted = atan(0.7 * 2 * pi * 50.0 / 400.0)
    assert angles_at(paths, v) == pytest.approx(np.full((6, 101), wanted), abs=1e-5)
    assert angle_map(paths, 24, 9) == pytest.approx(np.full((24, 9), wanted), abs=1e-5)
    tangents, signed = directions(paths, np.array([[0.1, 0.3], [0.7, 0.9]]))
    assert signed == pytest.approx(np.full(2, wanted), abs=1e-5)
    assert tangents[:, 2] == pytest.approx(np.full(2, cos(wanted)), abs=1e-5)


@pytest.mark.parametrize("paths", [None, 30])
def test_a_filament_has_the_angle_that_was_asked_for(paths: int | None) -> None:
    """With as many paths as cover, and with a number few patterns of which close: then it waits as hoops."""
    result = mw.wind("data/elbow.obj", paths=paths, band_width=8.0, angle=30.0, continuous=True)
    assert np.degrees(np.median(angles_at(result.paths, np.array([0.5])))) == pytest.approx(30.0, abs=0.5)
    assert result.closed is not None and result.closed.pattern.filaments == 1
    assert paths is None or len(result.paths) == 2 * paths
    assert not [note for note in result.notes if "closes at" in note.text]


def test_a_filament_whose_angle_is_out_of_reach_keeps_all_its_paths() -> None:
    """The pattern next to the most revolutions that hold is beyond them; it is not wound."""
    result = mw.wind("data/tank.ply", paths=None, band_width=25.0, angle=30.0, continuous=True)
    assert result.closed is not None and result.closed.left_out == 0 and result.settled
    assert any("is out of reach" in note.text for note in result.notes)


def test_revolutions_are_found_in_few_trials() -> None:
    tried: list[float] = []

    def measure(turns: float) -> float | None:
        """A tangent that grows with the square root, up to where paths slide off."""
        tried.append(turns)
        return None if turns > 3.0 else atan(turns**0.5)

    found = hunt(measure, radians(50.0), 0.7, 1e-4, 100.0)
    assert found.revolutions == pytest.approx(tan(radians(50.0)) ** 2, rel=1e-3) and found.within
    assert len(tried) <= 6
    gone = hunt(measure, radians(75.0), 0.7, 1e-4, 100.0)
    assert gone.revolutions == pytest.approx(3.0, rel=1e-2) and gone.lost == pytest.approx(3.0, rel=1e-2)
    assert not gone.within
    leap = hunt(lambda turns: radians(20.0 if turns < 0.83 else 38.0), radians(30.0), 0.5, 1e-4, 100.0)
    assert leap.within and leap.reached == radians(38.0)


def test_a_flat_wing_has_the_angle_that_most_of_its_paths_hold() -> None:
    """Round its edges paths of a few particles stall at a third of the revolutions that paths of many hold."""
    wing = helices(mw.fit(mw.flatten(mw.annulus(mw.read("data/wing.stl")))))
    turned = wing.turned_to(radians(20.0))
    assert turned.met
    laid = wing.laid(24, turned.revolutions, 401)
    held = laid.status == 0
    assert held.mean() >= 0.75
    assert degrees(median_angle(laid.subset(held), turned.v, 96)) == pytest.approx(20.0, abs=0.2)


def test_the_median_of_many_paths_follows_from_a_few() -> None:
    """On a tube whose one side is shorter angles differ round it: 24 paths tell the median of 90."""

    def place(u: np.ndarray, v: np.ndarray) -> np.ndarray:  # type: ignore[type-arg]
        t = 2 * pi * u
        return np.stack([80.0 * np.cos(t), 30.0 * np.sin(t), (400.0 + 100.0 * np.cos(t)) * v], axis=-1)

    surface = interpolate(place, (64, 16))
    few, many = (
        mw.solve(surface, ends.start, ends.end, family=ends.family, particles=101)
        for ends in (mw.families(surface, count, 0.6, phase=0.13) for count in (24, 90))
    )
    exact = float(np.median(angles_at(many, np.array([0.5]))))
    assert median_angle(few, 0.5, 90, 0.13) == pytest.approx(exact, abs=radians(0.2))
    assert median_angle(many, 0.5, 90, 0.13) == pytest.approx(exact, abs=1e-12)


@pytest.mark.parametrize(("options", "line"), [
    ({"angle": 95.0}, "angle is 95; give a number from 0 to 89"),
    ({"angle": 30.0, "revolutions": 0.5}, "give one of them"),
    ({"angle_at": "z=3"}, "without an angle"),
    ({"paths": None}, "need band_width"),
    ({"angle": 30.0, "angle_at": "z=1e9"}, "lies off the part"),
])  # fmt: skip
def test_what_cannot_be_asked_for(options: dict[str, object], line: str) -> None:
    with pytest.raises(BadInputError, match=line):
        mw.wind("data/tank.ply", **options)  # type: ignore[arg-type]


def test_a_filament_meets_its_angle_where_the_median_leaps() -> None:
    """On the cast paths come to rest in one place or another: 24 of them tell the angle of all a degree off."""
    surface = mw.fit(mw.flatten(mw.annulus(mw.read("data/cast.ply"))))
    wish = Wish(0.19853, radians(20.0))
    closed = close_layer(surface, ClosingPlan(54, 0.2184, grows=True, angle=wish))
    assert closed.left_out == 0
    found = np.degrees(np.nanmedian(angles_at(closed.paths, np.array([wish.v]))))
    assert found == pytest.approx(20.0, abs=0.5)
    turned = Turned(closed.revolutions, wish.v, wish.wanted, radians(20.4))
    assert turned.moved(closed.paths) == ()
    (note,) = Turned(closed.revolutions, wish.v, wish.wanted - radians(1.0), radians(19.0)).moved(closed.paths)
    assert "instead of 19.00" in note.text


def test_a_long_cone_of_a_flat_spar_has_its_angle() -> None:
    """Half axes 60 and 25 that taper to 0.7: about sin(a) = 0.7 is the most, after many turns round sharp edges."""

    def place(u: Floats, v: Floats) -> Floats:
        t, share = 2.0 * pi * u, 1.0 - 0.3 * v
        return np.stack([60.0 * share * np.cos(t), 25.0 * share * np.sin(t), 900.0 * v], axis=-1)

    spar = helices(interpolate(place, (96, 24)))
    turned = spar.turned_to(radians(40.0))
    assert turned.met and turned.revolutions > 4.0
    laid = spar.laid(12, turned.revolutions, 401)
    assert (laid.status == 0).all()
    assert degrees(median_angle(laid, turned.v, 96)) == pytest.approx(40.0, abs=0.5)


def test_angles_that_fall_at_first_are_looked_for_all_over() -> None:
    def measure(turns: float) -> float | None:
        return None if turns > 2.0 else radians(19.0 + 8.0 * abs(turns - 0.2))

    nothing = Hunt(0.5, radians(21.4), np.inf, False)
    low = survey(measure, radians(18.0), 1e-3, (0.005, 1.0), nothing)
    assert low.revolutions == pytest.approx(0.2, abs=0.01) and degrees(low.reached) == pytest.approx(19.0, abs=0.1)
    met = survey(measure, radians(20.0), 1e-3, (0.005, 1.0), nothing)
    assert abs(met.reached - radians(20.0)) <= 1e-3 and met.within
    assert measure(met.revolutions) == pytest.approx(met.reached)
    # past ranges where no path comes to rest
    past = survey(lambda r: None if r < 0.5 else radians(20.0 * r), radians(30.0), 1e-3, (0.01, 4.0), nothing)
    assert past.revolutions == pytest.approx(1.5, abs=0.01)
    assert survey(lambda _: None, radians(30.0), 1e-3, (0.01, 4.0), nothing) == nothing


def test_a_hunt_ends_soon_where_an_angle_is_out_of_reach() -> None:
    tried: list[float] = []

    def measure(turns: float) -> float | None:
        """From 20 degrees up to where paths slide off, at 45."""
        tried.append(turns)
        return None if turns > 1.0 else radians(20.0 + 25.0 * turns)

    gone = hunt(measure, radians(80.0), 1.3, 1e-3, 100.0, brink=0.06)
    assert degrees(gone.reached) == pytest.approx(45.0, abs=1.5) and len(tried) <= 6
    tried.clear()
    # nearer to it the brink is looked for more closely
    near = hunt(measure, radians(45.8), 1.3, 1e-3, 100.0, brink=0.06)
    assert degrees(near.reached) == pytest.approx(45.0, abs=0.15)
    tried.clear()
    low = hunt(measure, radians(5.0), 1.0, 1e-3, 100.0, least=0.02)
    assert low.revolutions == min(tried) == 0.02 and len(tried) <= 8


@pytest.fixture(scope="module")
def tank() -> Surface:
    return mw.fit(mw.flatten(mw.annulus(mw.read("data/tank.ply"))))


def counted(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Paths of each trial from now on."""
    tried: list[int] = []

    def lay(surface: Surface, start: Floats, end: Floats, **options: Any) -> Paths:
        tried.append(len(start))
        return mw.solve(surface, start, end, **options)

    monkeypatch.setattr("meshwind.workflow.helices.solve", lay)
    return tried


def test_every_path_holds_where_half_a_degree_less_allows_it(tank: Surface, monkeypatch: pytest.MonkeyPatch) -> None:
    """At 24.2 degrees a path in twelve slides off, at 23.9 none does."""
    parts = replace(helices(tank), paths=12)
    turned = parts.turned_to(radians(24.25))
    laid = parts.laid(12, turned.revolutions, 401)
    assert turned.met and (laid.status == 0).all()
    assert degrees(median_angle(laid, turned.v, 12)) == pytest.approx(24.25, abs=0.5)
    solves = counted(monkeypatch)
    out = parts.turned_to(radians(60.0))
    assert not out.met and degrees(out.reached) == pytest.approx(23.9, abs=0.1)
    assert len(solves) <= 14 and sum(solves) <= 150
    assert (parts.laid(12, out.revolutions, 401).status == 0).all()
    assert f"{degrees(out.had[1]):.1f} degrees" in out.shortfall


def test_an_angle_is_met_with_the_paths_that_are_wound() -> None:
    """On the bottle eight paths a family have 13.7 degrees where of twelve more than a quarter slide off."""
    bottle = replace(helices(mw.fit(mw.flatten(mw.annulus(mw.read("data/bottle.obj"))))), paths=12)
    for angle in (11.5, 14.0):
        turned = bottle.turned_to(radians(angle))
        held = bottle.laid(12, turned.revolutions, 401).status == 0
        assert held.mean() >= (0.75 if angle > 12.0 else 1.0)
        assert turned.met == (angle < 12.0)


def test_the_paths_that_are_left_have_the_angle() -> None:
    """Of a flat wing's 6 a family 2 do not come to rest; of 12 with 3 the others had 46.2 degrees for 45 of all."""
    surface, wish = mw.fit(mw.flatten(mw.annulus(mw.read("data/wing.stl")))), Wish(0.174, radians(45.0))
    _, paths, left_out = lay(surface, ClosingPlan(6, 2.43, 0.2, 101, angle=wish))
    assert left_out > 0
    assert degrees(wound_angle(paths, wish.v)) == pytest.approx(45.0, abs=0.5)


def test_the_widest_place_of_a_cylinder_between_domes_is_its_middle() -> None:
    """A fit of it is wider by some 2e-4 just beside the domes; on a bulge the widest place is the widest."""

    def vessel(v: Floats) -> Floats:
        past = np.clip(np.abs(v - 0.5) - 0.3, 0.0, None)
        return 50.0 - 400.0 * past**2 + 0.012 * np.exp(-(((v - 0.78) / 0.02) ** 2))

    assert helices(revolved(vessel)).turned_to(radians(20.0)).v == pytest.approx(0.5, abs=0.01)
    assert helices(revolved(lambda v: 50.0 - 20.0 * (v - 0.6) ** 2)).turned_to(radians(20.0)).v == pytest.approx(
        0.6, abs=0.005
    )


@pytest.mark.parametrize(("place", "words"), [
    (None, "v=0.5, the widest place,"), ("0.5", "v=0.5"), ("V = 0.5", "v=0.5"), ("z=30", "z=30 (v=0.5)"),
])  # fmt: skip
def test_the_place_of_an_angle_is_named_once(place: str | None, words: str) -> None:
    turned = Turned(1.4, 0.5, radians(45.0), radians(45.0))
    assert turned.taken(place) == f"45 degrees at {words} take 1.4 revolutions"
