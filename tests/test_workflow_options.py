"""Options: bad ones are refused with one line before anything is read, and defaults are the same everywhere."""

import inspect
from collections.abc import Callable
from dataclasses import fields
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import meshwind as mw
from meshwind.cli.redesign import redesign
from meshwind.cli.wind import wind
from meshwind.core.option import options_of
from meshwind.editing.options import EditOptions, WindingOptions
from meshwind.workflow.options import Options

BAD: list[tuple[dict[str, Any], str]] = [
    ({"paths": 0}, "paths is 0; give a whole number from 1 up"),
    ({"paths": 2.5}, "paths is 2.5; give a whole number from 1 up"),
    ({"paths": True}, "paths is True; give a whole number from 1 up"),
    ({"paths": "12"}, "paths is '12'; give a whole number from 1 up"),
    ({"particles": 2}, "particles is 2; give a whole number from 3 up"),
    ({"revolutions": float("inf")}, "revolutions is inf; give a number from 0 up"),
    ({"revolutions": -1}, "revolutions is -1; give a number from 0 up"),
    ({"revolutions": "0,5"}, "revolutions is '0,5'; give a number as in 0.5 or 5/12, or auto"),
    ({"revolutions": [0.5, 0.8]}, "revolutions is [0.5, 0.8]; give a number from 0 up"),
    ({"paths": 3.0}, "paths is 3.0; give a whole number from 1 up"),
    ({"continuous": "no"}, "continuous is 'no'; give true or false"),
    ({"friction": [0.1, 0.2]}, "tables and functions are for solve(..., friction=...)"),
    ({"paths": "all"}, "paths is 'all'; give a whole number from 1 up"),
    ({"revolutions": 50.1}, "revolutions is 50.1; give a number from 0 to 50"),
    ({"friction": -0.2}, "friction is -0.2; give a number from 0 to 10"),
    ({"friction": float("nan")}, "friction is nan; give a number from 0 to 10"),
    ({"friction": "sticky"}, "friction is 'sticky'; give a coefficient such as 0.2, or field:NAME"),
    ({"friction": "field:"}, "friction is 'field:'; give a coefficient such as 0.2, or field:NAME"),
    ({"ends": "foo"}, "ends 'foo'"),
    ({"ends": None}, "give auto, x, y, z"),
    ({"component": -1}, "component is -1; give a whole number from 0 up"),
    ({"opening": 0}, "opening is 0; give a number above 0"),
    ({"opening": float("nan")}, "opening is nan; give a number above 0"),
    ({"tolerance": float("nan")}, "tolerance is nan; give a number from 1e-12 to 1"),
    ({"tolerance": 0.0}, "tolerance is 0; give a number from 1e-12 to 1"),
    ({"worst_fit": 0.0}, "worst_fit is 0; give a number above 0"),
    ({"threshold": -0.1}, "threshold is -0.1; give a number from 0 up"),
    ({"revolutions": "many"}, "revolutions is 'many'; give a number as in 0.5 or 5/12, or auto"),
    ({"spacing": 0.0}, "spacing is 0; give a number above 0"),
    ({"band_width": float("nan")}, "band_width is nan; give a number above 0"),
    ({"tex": -1.0}, "tex is -1; give a number above 0"),
    ({"tows": 1.5}, "tows is 1.5; give a whole number from 1 up"),
    ({"fibre_volume": 1.5}, "fibre_volume is 1.5; give a number above 0 and up to 1"),
    ({"fibre_density": 2.6}, "fibre_density says nothing without tex"),
    ({"fibre_density": 1800.0, "tex": 800.0}, "fibre_density is 1800 g/cm3, more than any solid; give 1.8 for kg/m3"),
    ({"resin_density": 1200.0, "tex": 800.0}, "resin_density is 1200 g/cm3, more than any solid; give 1.2 for kg/m3"),
    ({"band_thickness": 0.2}, "band_thickness needs the band's width"),
    ({"band_thickness": 0.2, "tex": 800.0}, "give one of both"),
    ({"angle": 30.0, "revolutions": 0.5}, "give one of them"),
    ({"pins": ""}, "pins is ''; give the path of a CSV file"),
    ({"pins": 3}, "pins is 3; give the path of a CSV file"),
    ({"pins": "pins.csv", "spacing": 1.0}, "give one of both"),
    ({"units": "milimeter"}, "units is 'milimeter'; give mm, cm, m, um, in, ft, or"),
    ({"paths": 100000}, "100000 paths per family of 401 particles and 0.5 revolutions would need about 15,028 GB"),
    ({"particles": 10**9}, "would need about"),
]


@pytest.mark.parametrize(("options", "says"), BAD, ids=[str(options) for options, _ in BAD])
def test_bad_options_are_refused_before_reading(options: dict[str, Any], says: str) -> None:
    with pytest.raises(mw.BadInputError) as caught:
        mw.wind("no/such/file.stl", **options)
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(("mesh", "says"), [(3, "of type int"), (None, "of type NoneType"), (np.eye(3), "ndarray")])
def test_what_is_no_mesh_is_refused(mesh: Any, says: str) -> None:
    with pytest.raises(mw.BadInputError, match=says):
        mw.wind(mesh)


@pytest.mark.parametrize("out", ["", "  ", 3])
def test_a_folder_without_a_name_is_refused(out: Any) -> None:
    with pytest.raises(mw.BadInputError, match="give the path of a folder"):
        mw.wind("no/such/file.stl", out=out)


def test_wind_takes_every_option_with_its_default() -> None:
    parameters = inspect.signature(mw.wind).parameters
    for option in fields(Options):
        assert parameters[option.name].default == option.default, option.name
        assert option.name in options_of(Options)


def test_redesign_takes_its_options_with_their_defaults() -> None:
    parameters = inspect.signature(mw.redesign).parameters
    each = (*fields(Options), *fields(EditOptions), *fields(WindingOptions))  # of one name the last counts
    defaults = {option.name: option.default for option in each}
    for name in set(parameters) - {"mesh", "progress"}:
        assert parameters[name].default == defaults[name], name
    assert inspect.signature(redesign).parameters["revolutions"].default == defaults["revolutions"] == "auto"


def test_the_command_line_has_the_same_defaults() -> None:
    parameters = inspect.signature(wind).parameters
    for option in fields(Options):
        default = parameters[option.name].default
        wanted = option.default
        is_text = options_of(Options)[option.name].read is not None and wanted is not None
        assert default == (str(wanted) if is_text else wanted), option.name


def test_numbers_of_any_kind_are_taken() -> None:
    options = Options(paths=np.int32(5), revolutions=Fraction(5, 12), opening=np.float32(2), tolerance=1)  # type: ignore[arg-type]
    assert (options.paths, options.revolutions, options.opening, options.tolerance) == (5, 5 / 12, 2.0, 1.0)
    assert [type(value) for value in (options.paths, options.revolutions, options.opening)] == [int, float, float]
    assert Options(revolutions=100, particles=801).revolutions == 100.0
    assert (Options().revolutions, Options().turns) == (None, 0.5)


def test_the_library_takes_the_words_of_the_command() -> None:
    assert Options(revolutions="5/8").revolutions == 0.625
    assert WindingOptions("0.5,5/8").several == WindingOptions(np.array([0.5, 0.625])).several == (0.5, 0.625)  # type: ignore[arg-type]
    assert WindingOptions("1/2").revolutions == 0.5
    words = mw.wind("data/tank.ply", paths="auto", particles="auto", revolutions="1/5", band_width=40.0).options
    assert words == Options(paths=None, particles=None, revolutions=0.2, band_width=40.0)


TUBE = mw.shapes.cylinder(radius=1.0, length=3.0)
MISTAKES: list[tuple[Callable[[], object], str]] = [
    (lambda: mw.Page("800", 600), "size is 800x600; give two numbers of pixels"),  # type: ignore[arg-type]
    (lambda: mw.render("no", page=(800, 600)), "page is of type tuple; give a Page"),  # type: ignore[arg-type]
    (lambda: mw.render("no", only="cover"), "picture 'cover' is not known"),
    (lambda: mw.render("no", animate="avi"), "movie 'avi' is not known"),
    (lambda: mw.render(TUBE), "folder is of type Surface; give a folder of results"),  # type: ignore[arg-type]
    (lambda: mw.families(TUBE, paths="3", revolutions=0.5), "paths is '3'; give a whole number"),  # type: ignore[arg-type]
    (lambda: mw.families(TUBE, paths=3, revolutions="5/8"), "revolutions is '5/8'; give a number"),  # type: ignore[arg-type]
    (lambda: mw.solve((0, 0), (0, 1), (0, 1)), "surface is of type tuple; give a Surface"),  # type: ignore[arg-type]
    (lambda: mw.read(([[0, 0, 0]], [[0, 1, 2], [0, 1, 2, 3]])), "different numbers of corners"),
]


@pytest.mark.parametrize(("made", "says"), MISTAKES, ids=[says for _, says in MISTAKES])
def test_mistakes_in_a_script_are_named(made: Callable[[], object], says: str) -> None:
    with pytest.raises(mw.BadInputError) as caught:
        made()
    assert says in str(caught.value) and "--" not in str(caught.value)


def test_a_result_shows_itself_in_one_line() -> None:
    result = mw.wind(Path(__file__).parents[1] / "data" / "tank.ply", paths=2, revolutions=0.25)
    assert repr(result) == "<meshwind Result: tank.ply, 4 of 4 paths at rest>"
    assert result.report()["winding"]["revolutions"] == 0.25


def test_long_stages_say_how_they_go_on(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("meshwind.workflow.clock._EVERY", -1.0)
    said: list[str] = []
    mw.wind(
        "data/elbow.obj", angle=30.0, paths=5, particles=101, continuous=True, render=False, out=tmp_path / "out",
        progress=said.append,
    )  # fmt: skip
    stages = [each for each in said if "," not in each]
    assert {"choose", "wind"} < set(stages)
    for stage, words in (("choose", "revolutions"), ("wind", "a pattern near"), ("wind", "5 paths a family")):
        assert any(each.startswith(f"{stage}, ") and words in each for each in said)
