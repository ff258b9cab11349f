"""What a band is made of, and what follows from it: thickness, masses, and the files and tables that tell them."""

from math import atan, pi
from pathlib import Path

import numpy as np
import pytest
from layup_shapes import drawn
from scipy.integrate import quad

import meshwind as mw
from meshwind.core.errors import BadInputError
from meshwind.filament.levels import levels, station
from meshwind.filament.stations import circuits_to_cover, covers, to_cover
from meshwind.run.layer_table import layer_table
from meshwind.run.summary import run_lines
from meshwind.surface.interpolate import interpolate
from meshwind.workflow.band_plan import band_plan
from meshwind.workflow.covering import Laid, lay_until_covered
from meshwind.workflow.layer_plans import LayerPlan
from meshwind.workflow.options import Options

TANK = Path(__file__).parents[1] / "data" / "tank.ply"
RUN = Options(band_width=4.0, tex=800.0, resin_density=1.1)


def columns(file: Path) -> np.ndarray:  # type: ignore[type-arg]
    return np.genfromtxt(file, delimiter=",", names=True)


@pytest.mark.parametrize(("layer", "thickness", "tex"), [
    ({}, 0.185185185, 800.0),  # the figures of a commercial program's vessel
    ({"tows": 2}, 0.37037037, 800.0),
    ({"band_width": 8.0}, 0.0925925926, 800.0),
    ({"tex": 400.0, "fibre_volume": 0.5}, 0.1111111111, 400.0),
    ({"band_thickness": 0.3}, 0.3, None),
])  # fmt: skip
def test_a_layer_takes_from_the_run_what_it_does_not_say(
    layer: dict[str, float], thickness: float, tex: float | None
) -> None:
    plan = LayerPlan("hoop", **layer)  # type: ignore[arg-type]
    band = band_plan(RUN, "mm", plan)
    assert band.thickness == pytest.approx(thickness, rel=1e-8)
    assert (band.roving and band.roving.tex) == tex
    assert plan.ply(RUN, "mm").laying.thickness == band.thickness


def test_units_are_those_of_the_part() -> None:
    inches = band_plan(Options(band_width=4.0 / 25.4, tex=800.0, resin_density=1.1), "in")
    assert inches.thickness == pytest.approx(0.185185185 / 25.4, rel=1e-8)
    assert inches.masses(424245.5 / 25.4) == pytest.approx((339.40, 138.27), abs=0.01)
    with pytest.raises(BadInputError, match="unit is not known"):
        band_plan(RUN, "")


@pytest.mark.parametrize(("run", "layer", "says"), [
    ({}, {"tows": 2}, "tows says nothing without tex"),
    ({"tex": 800.0}, {"tex": 800.0, "band_thickness": 0.1}, "give one of both"),
    ({"tex": 800.0, "band_thickness": 0.1}, {}, "give one of both"),
])  # fmt: skip
def test_material_that_says_too_much_or_too_little(run: dict[str, float], layer: dict[str, float], says: str) -> None:
    with pytest.raises(BadInputError, match=says):
        band_plan(Options(**run), "mm", LayerPlan("hoop", **layer))  # type: ignore[arg-type]


def test_masses_and_thickness_of_one_filament(tmp_path: Path) -> None:
    """Fibre is tex times length; volume is width times thickness times length; the csv holds what the report says."""
    wound = mw.wind(TANK, paths=9, revolutions=0.3, particles=101, band_width=15.0, tex=1200.0, tows=4, continuous=True,
                    friction=0.2, out=tmp_path, render=False)  # fmt: skip
    report = wound.report()
    layer, fibre = report["pattern"][0], report["fibre"]
    thick = 4.8 / 1.8 / 0.6 / 15.0
    assert layer["fibre_mass"] == pytest.approx(4.8e-3 * layer["fibre_length"], rel=1e-12)
    assert layer["fibre_mass"] is not None
    assert layer["resin_mass"] == pytest.approx(layer["fibre_mass"] * (0.4 * 1.2) / (0.6 * 1.8), rel=1e-12)
    assert fibre["fibre_mass"] is not None and fibre["fibre_mass"] < layer["fibre_mass"]  # without its turnarounds
    over = wound.plain.thickness
    assert over is not None and fibre["band_thickness"] == pytest.approx(thick)
    assert over.volume == pytest.approx(15.0 * thick * wound.paths.length.sum(), rel=1e-9)
    assert layer["thickness"] == fibre["thickness"] == {"min": over.min, "median": over.median, "max": over.max}
    rows = columns(tmp_path / "laminate.csv")
    assert rows.dtype.names == ("v", "z", "layer", "angle", "thickness", "cover") and len(rows) == 65
    assert [rows["angle"].min(), rows["angle"].max()] == pytest.approx([layer["angle"]["min"], layer["angle"]["max"]])
    assert [rows["cover"].min(), rows["cover"].max()] == pytest.approx([layer["cover"]["min"], layer["cover"]["max"]])
    shown = report["angle_stations"]
    assert [each["v"] for each in shown] == pytest.approx(np.linspace(0.0, 1.0, 9))
    assert [each["angle"]["median"] for each in shown] == pytest.approx(rows["angle"][::8])
    lines = run_lines(report)
    assert sum(line.startswith("angle ") for line in lines) == 1
    head, row = layer_table(report, "mm")
    assert head.split()[1:4] == ["layer", "circuits", "angle"] and f"{layer['fibre_mass']:.4g}" in row
    assert len(head) == len(row)  # figures stand under their names
    assert any("the band is 0.296 mm thick: 4 tows of 1200 tex" in line for line in lines)


def test_a_thickness_that_is_not_known_is_left_empty(tmp_path: Path) -> None:
    wound = mw.wind(TANK, paths=4, revolutions=0.3, particles=51, band_width=15.0, out=tmp_path, render=False)
    rows = columns(tmp_path / "laminate.csv")
    assert np.isnan(rows["thickness"]).all() and np.isfinite(rows["cover"]).all()
    fibre = wound.report()["fibre"]
    assert (fibre["fibre_mass"], fibre["resin_mass"], fibre["thickness"]) == (None, None, None)
    assert layer_table(wound.report(), "mm") == []


def test_what_is_to_be_covered_is_an_integral_along_the_level_line() -> None:
    """Ellipse 80 x 30, fibres whose slope changes around it: the mean cosine times the length is 1.8 % off."""

    def place(u: np.ndarray, v: np.ndarray) -> np.ndarray:  # type: ignore[type-arg]
        return np.stack([80.0 * np.cos(2 * pi * u), 30.0 * np.sin(2 * pi * u), 400.0 * v], axis=-1)

    def turned(u: float) -> float:
        return 0.8 + 0.1 * float(np.sin(4 * pi * u))

    def speed(u: float) -> float:
        return 2 * pi * float(np.hypot(80.0 * np.sin(2 * pi * u), 30.0 * np.cos(2 * pi * u)))

    surface, v = interpolate(place, (192, 16)), np.linspace(0.0, 1.0, 101)
    lines = [np.stack([u + turned(u) * v, v], axis=1) for u in np.arange(48) / 48]
    paths = drawn(surface, np.array(lines), np.ones(48))
    exact = quad(lambda u: np.cos(atan(turned(u) * speed(u) / 400.0)) * speed(u), 0.0, 1.0, epsabs=1e-8)[0]
    needed, many = to_cover(paths, np.array([0.0]))
    assert many.tolist() == [48]
    assert needed[0, 0] == pytest.approx(exact, rel=2e-5)
    mean = np.mean([np.cos(atan(turned(u) * speed(u) / 400.0)) for u in np.arange(48) / 48])
    assert abs(mean * levels(surface).length[0] / exact - 1.0) > 0.01
    assert covers(paths, np.array([0.0]), 5.0)[0] == pytest.approx(48 * 5.0 / exact, rel=2e-5)


def test_the_family_that_covers_less_decides() -> None:
    tube = mw.shapes.cylinder(50.0, 400.0)
    v = np.linspace(0.0, 1.0, 51)
    lines = [np.stack([k / 24 + turns * v, v], axis=1) for turns in (0.2, -1.0) for k in range(24)]
    paths = drawn(tube, np.array(lines), np.repeat([1, -1], 24))
    straight = 2 * pi * 50.0 * np.cos(atan(0.2 * 2 * pi * 50.0 / 400.0))
    assert covers(paths, v, 10.0) == pytest.approx(np.full(51, 240.0 / straight), rel=1e-6)
    assert circuits_to_cover(paths, levels(tube), 10.0) == int(np.ceil(straight / 10.0))


def test_paths_are_added_until_they_cover() -> None:
    """Trials that count too few are made up for: 45 degrees on radius 50 take 22.2144 bands of 10."""
    tube = mw.shapes.cylinder(50.0, 400.0)
    counted = []

    def lay(count: int) -> Laid:
        counted.append(count)
        ends = mw.families(tube, count, 400.0 / (2 * pi * 50.0))
        return Laid(mw.solve(tube, ends.start, ends.end, family=ends.family, particles=51))

    laid, note = lay_until_covered(lay, 20, 10.0)
    assert counted == [20, 23] and len(laid.paths) == 46
    assert "23 paths of each family cover the part: 1.035 times" in note.text and not note.warning


def test_places_are_named_in_any_case() -> None:
    lines = levels(mw.shapes.cylinder(50.0, 400.0))
    assert station("V=0.25", lines) == 0.25
    assert station("Fraction=0.5", lines) == station("fraction=0.5", lines)
    assert station("Z=100", lines) == station("z=100", lines)


def test_a_band_wider_than_the_part_is_told() -> None:
    """120 across: a width in the wrong unit is seen in no other figure, as the cover is said to be enough."""
    for width, told in ((119.0, 0), (6000.0, 1)):
        found = mw.wind(TANK, paths=2, particles=101, band_width=width, units="mm").report()["notes"]
        assert sum("give band_width in the part's unit" in line and "120 mm across" in line for line in found) == told
