"""The whole of a run with revolutions, spacing, band, its material and pins, in its files and its report."""

import json
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest

import meshwind as mw
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import turns
from meshwind.pictures.layup_scenes import unrolled_scene
from meshwind.pictures.revolutions_picture import draw_revolutions
from meshwind.pictures.subject import subject_of
from meshwind.planning.revolutions import choose_revolutions
from meshwind.results.reading import read_results
from meshwind.run.summary import run_lines
from meshwind.surface import shapes

DATA = Path(__file__).parents[1] / "data"


def test_auto_winds_within_its_bound_and_says_why(tmp_path: Path) -> None:
    result = mw.wind(DATA / "tank.ply", revolutions="auto", paths=8, particles=145, out=tmp_path, render=False)
    report = json.loads((tmp_path / "report.json").read_text())
    assert result.settled and result.chosen is not None
    choice = report["revolutions"]
    assert report["winding"]["revolutions"] == choice["chosen"] == result.revolutions
    assert choice["holding"]["by"] == "Clairaut"
    assert choice["chosen"] < choice["holding"]["high"] < choice["further"]["with_friction"]
    assert choice["pressing"]["share"] == pytest.approx(1.0)
    assert any("slide off" in note for note in report["notes"])
    assert report["windability"]["convex"] == pytest.approx(1.0)
    assert report["crossings"]["own_family"] == 0
    assert np.sum(report["crossings"]["by_region"]) == report["crossings"]["count"]


def test_spacing_width_and_mass_are_in_the_report(tmp_path: Path) -> None:
    mw.wind(DATA / "elbow.obj", revolutions=1.0, paths=6, particles=145, spacing=15.0, band_width=4.0,
            tex=600.0, tows=2, fibre_volume=0.5, out=tmp_path, render=False)  # fmt: skip
    report = json.loads((tmp_path / "report.json").read_text())
    near = report["spacing"]
    assert near["neighbours"]["max"] <= 15.0
    assert near["kept"] == pytest.approx(near["neighbours"]["max"])
    assert near["paths_added"] > 0 and near["partings"] == []
    assert near["widest_gap"] == pytest.approx(near["neighbours"]["max"] - 4.0)
    cover = report["coverage"]
    assert cover["band_width"] == 4.0
    assert sum(cover[share] for share in ("bare", "once", "twice", "more")) == pytest.approx(1.0)
    assert cover["on_part"] == pytest.approx(1.0, abs=5e-3)
    assert cover["bare_caps"] == pytest.approx([np.pi * 30**2] * 2, rel=1e-3)
    fibre = report["fibre"]
    assert fibre["fibre_mass"] == pytest.approx(0.0012 * report["paths"]["length_total"])
    assert fibre["resin_mass"] == pytest.approx(fibre["fibre_mass"] * 1.2 / 1.8)
    assert fibre["band_thickness"] == pytest.approx(1.2 / 1.8 / 0.5 / 4.0)
    assert report["quads"]["convex_inner"] >= 0.95
    layers = meshio.read(tmp_path / "surface.vtu").point_data["layers"]
    assert (layers == 0).mean() == pytest.approx(cover["bare"], abs=0.05)


def test_pins_take_the_place_of_even_ends(tmp_path: Path) -> None:
    rows = [f"{u},0,{u + sense * 0.8},1" for u in (0.0, 0.1, 0.5, 0.7) for sense in (1, -1)]
    (tmp_path / "pins.csv").write_text("u0,v0,u1,v1\n" + "\n".join(rows))
    result = mw.wind(DATA / "vase.stl", pins=tmp_path / "pins.csv", particles=97)
    assert result.paths.uv[:4, 0, 0].tolist() == [0.0, 0.1, 0.5, 0.7]
    assert result.paths.family.tolist() == [1] * 4 + [-1] * 4
    assert result.settled
    assert result.report()["winding"]["paths_per_family"] == 4


def test_neighbours_that_part_are_said_to_in_figures_summary_and_picture(tmp_path: Path) -> None:
    mw.wind(DATA / "cast.ply", revolutions=1.5, paths=24, particles=145, out=tmp_path, render=False)
    results = read_results(tmp_path)
    near = results.report["spacing"]
    assert len(near["partings"]) == 2 and near["widest_parting"] == near["neighbours"]["max"]
    assert near["kept"] < 0.25 * near["widest_parting"]
    (line,) = [line for line in run_lines(results.report) if "neighbours" in line]
    assert line.endswith("mm apart, but 2 pairs that part round a body, by up to 122 mm")
    assert results.partings.tolist() == near["partings"]
    outlines = unrolled_scene(subject_of(results)).parted
    assert len(outlines) == 2
    assert (np.ptp(outlines[..., 0], axis=1) < 2.0).all()  # to the strand that is next, not round the part


def test_partings_are_reported() -> None:
    result = mw.wind(DATA / "cast.ply", revolutions=2.0, paths=8, particles=145, spacing=15.0)
    assert any("no fibre rests between" in note.text for note in result.notes)
    assert result.report()["spacing"]["kept"] <= 15.0


def test_the_picture_of_the_choice_is_drawn(tmp_path: Path) -> None:
    barrel = shapes.revolution(lambda z: 1.0 - 0.3 * (z - 1.0) ** 2, 0.0, 2.0, (64, 48))
    draw_revolutions(tmp_path / "revolutions.png", choose_revolutions(barrel, paths=6, further=False), "barrel")
    assert (tmp_path / "revolutions.png").stat().st_size > 20000


def test_a_choice_of_which_no_number_holds_is_told_and_drawn(tmp_path: Path) -> None:
    barrel = shapes.revolution(lambda z: 1.0 - 0.3 * (z - 1.0) ** 2, 0.0, 2.0, (64, 48))
    chosen = choose_revolutions(barrel, paths=6, further=False)
    none = replace(chosen, feasible=replace(chosen.feasible, low=0.0, high=0.0, by="trials"))
    assert "no number was found that keeps every fibre" in none.why
    draw_revolutions(tmp_path / "revolutions.png", none, "barrel")
    assert (tmp_path / "revolutions.png").stat().st_size > 20000


def test_turns_are_a_number_a_fraction_or_auto() -> None:
    assert [turns(text) for text in ("0.5", "5/12", "auto", " AUTO ")] == [0.5, 5 / 12, "auto", "auto"]
    with pytest.raises(BadInputError, match="or auto"):
        turns("some")
