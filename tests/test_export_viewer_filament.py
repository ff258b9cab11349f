"""The viewer's page of a continuous winding: a slider along the filament, and what is said beside it."""

import json
from pathlib import Path

import numpy as np
import pytest
from selenium import webdriver
from selenium.webdriver.common.by import By
from viewer_browser import settled, severe

import meshwind as mw
from meshwind.core.cast import Floats, Ints
from meshwind.exporting.packing import packed, packed_short
from meshwind.exporting.targets import write_exports
from meshwind.exporting.viewer import page_data
from meshwind.exporting.viewer_filament import FilamentData
from meshwind.filament.course import Kind
from meshwind.results.reading import read_results


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("viewer") / "out"
    mw.wind("data/tank.ply", paths=5, particles=101, band_width=9.0, continuous=True, turn_end="shaft", out=out,
            render=False)  # fmt: skip
    write_exports(out, ["viewer"])
    return out


@pytest.fixture(scope="module")
def data(folder: Path) -> FilamentData:
    found = page_data(read_results(folder))["filament"]
    assert found is not None
    assert json.loads(json.dumps(found)) == found
    return found


@pytest.fixture(scope="module")
def page(folder: Path) -> Path:
    return folder / "viewer.html"


def unpacked(data: FilamentData, name: str) -> Floats | Ints:
    import base64

    array = data[name]  # type: ignore[literal-required]
    return np.frombuffer(base64.b64decode(array["data"]), dtype=f"<{array['type']}")


def test_arrays_are_packed_and_unpacked() -> None:
    assert packed(np.array([1, 2])) == {"type": "u1", "data": "AQI="}
    assert [packed(np.array([-1, value]))["type"] for value in (1, 32767, 32768)] == ["i2", "i2", "i4"]
    assert packed_short(np.array([0.25, np.nan]))["type"] == "f2"
    assert packed_short(np.array([1e-9, 1.0]))["type"] == "f4"  # float16 would lose it


def test_triangles_are_in_the_order_of_laying(browser: webdriver.Chrome, data: FilamentData) -> None:
    triangles = np.array(browser.execute_script("return Array.from(strips.triangles)")).reshape(-1, 3)
    ends = np.array(browser.execute_script("return Array.from(strips.ends)"))
    rows = (triangles // data["across"]).max(axis=1)
    assert (np.diff(rows) >= 0).all()
    sizes = unpacked(data, "sizes")
    assert len(triangles) == 2 * (data["across"] - 1) * (sizes - 1).sum()
    assert [int((rows <= row).sum()) for row in (0, 1, 57, len(ends) - 1)] == ends[[0, 1, 57, -1]].tolist()
    assert np.array_equal(
        browser.execute_script("return [half(0x3555), half(0xc000), half(1)]"), [1365 / 4096, -2, 2**-24]
    )


def test_the_page_has_what_the_filament_does(folder: Path, data: FilamentData) -> None:
    laid = unpacked(data, "laid")
    (filament,) = read_results(folder).filaments
    assert data["total"] == pytest.approx(float(filament.course.arc_length[-1]))
    assert unpacked(data, "circuit").max() == 4
    course, kinds = filament.course, unpacked(data, "kind")
    for kind, words in ((Kind.BRIDGE, "over a hollow"), (Kind.LAID, "on the part")):
        inside = (
            np.flatnonzero((course.kind[1:-1] == kind) & (course.kind[:-2] == kind) & (course.kind[2:] == kind))[0] + 1
        )
        row = int(np.searchsorted(laid, course.arc_length[inside]))
        assert data["words"][int(kinds[row])] == words
    passed = unpacked(data, "passed")
    assert (np.diff(passed) >= 0).all() and passed.max() == 9


def test_the_slider_winds_the_band_and_says_where_it_is(browser: webdriver.Chrome, data: FilamentData) -> None:
    def colourful() -> float:
        return float((np.ptp(settled(browser), axis=2) > 60.0).mean())

    def wind(share: float) -> str:
        browser.execute_script(
            "const s = document.getElementById('wound'); s.value = arguments[0] * s.max;"
            "s.dispatchEvent(new Event('input'))", share,
        )  # fmt: skip
        return browser.find_element(By.ID, "here").text

    whole = colourful()
    slider = browser.find_element(By.ID, "wound")
    assert float(slider.get_property("value")) == pytest.approx(data["total"], rel=1e-6)  # type: ignore[arg-type]
    text = wind(0.32)
    half = colourful()
    row = int(np.searchsorted(unpacked(data, "laid"), 0.32 * data["total"], side="right")) - 1
    assert f"circuit {unpacked(data, 'circuit')[row] + 1}" in text
    assert f"angle {unpacked(data, 'angle')[row]:.1f}°" in text
    assert browser.find_element(By.TAG_NAME, "body").get_attribute("data-wound") == str(row)
    wind(0.0)
    assert colourful() < 0.1 * half < 0.1 * whole
    browser.find_element(By.ID, "play").click()
    # stopped by the page itself: a slow machine must neither miss the start nor the end
    browser.execute_async_script(
        "const done = arguments[0], s = document.getElementById('wound'), late = Date.now() + 20000;"
        "const look = () => s.value > 0 || Date.now() > late"
        " ? (document.getElementById('play').click(), done()) : setTimeout(look, 20); look()"
    )
    assert 0.0 < float(slider.get_property("value")) < data["total"]  # type: ignore[arg-type]
    browser.execute_async_script("setTimeout(arguments[0], 500)")  # a frame may still be on its way
    wind(1.0)
    assert colourful() == pytest.approx(whole, rel=1e-3)
    assert severe(browser) == []
