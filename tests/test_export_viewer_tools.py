"""The viewer's tools in a browser: fibres' figures, distances, clip plane, opacity, views, keys, and what it says."""

from pathlib import Path

import numpy as np
import pytest
from benchmarks.browser import first_picture, opened
from export_results import leave
from layup_shapes import bridged
from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select, WebDriverWait
from viewer_browser import pointed, rows, settled, severe

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.exporting.targets import write_exports
from meshwind.path.lengths import bridges, lengths
from meshwind.path.winding_angle import winding_angle
from meshwind.results.reading import Results, read_results, read_surface_grid
from meshwind.results.schema import NORMAL

MOST = 4_000_000
SOON = 3.0
"""Bytes of a page, and seconds to its first picture."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("tools")
    leave(out, bridged(8, particles=101))
    write_exports(out, ["viewer"])
    return out


@pytest.fixture(scope="module")
def results(folder: Path) -> Results:
    return read_results(folder)


@pytest.fixture(scope="module")
def page(folder: Path) -> Path:
    return folder / "viewer.html"


def click(browser: webdriver.Chrome, name: str) -> None:
    browser.find_element(By.ID, name).click()


def slide(browser: webdriver.Chrome, name: str, value: float) -> None:
    browser.execute_script(
        "const input = byId(arguments[0]); input.value = arguments[1]; input.dispatchEvent(new Event('input'))",
        name,
        value,
    )


def changed(before: Floats, after: Floats) -> float:
    return float((np.abs(after - before).max(axis=2) > 30.0).mean())


def shown(browser: webdriver.Chrome) -> tuple[float, str]:
    """The distance that the page shows, and what it says."""
    words = rows(browser, "measured")["distance A to B"].split()
    return float(words[0].replace(",", "")), browser.find_element(By.ID, "live").text


def test_a_click_shows_the_figures_of_a_fibre(browser: webdriver.Chrome, results: Results) -> None:
    before, paths = settled(browser), results.paths
    eye = np.array(browser.execute_script("return camera.eye"))
    each, spans, angle = lengths(paths), bridges(paths), np.degrees(winding_angle(paths))
    picked = []
    for k, n in np.argwhere(((paths.normal @ eye) > 0.85) & paths.on_surface)[::40][:6]:
        pointed(browser, paths.points[k, n], click=True)
        figures = rows(browser, "figures")
        k = int(figures["number"])
        picked.append(k)
        assert figures["family"] == ("+1" if paths.family[k] > 0 else "−1")
        assert figures["status"] == "taut equilibrium"
        for name, value, digits in (
            ("length", paths.length[k], 6), ("required friction", each.max_slip[k], 4),
            ("bridged length", each.bridged_length[k], 4), ("largest gap", each.max_gap[k], 4),
        ):  # fmt: skip
            told = float(figures[name].split()[0].replace(",", ""))
            assert told == pytest.approx(value, rel=0.6 * 10.0 ** (1 - digits), abs=1e-6), name
        assert figures["length"].endswith(" mm")
        assert figures["winding angle"] == f"{angle[k].min():.2f}° to {angle[k].max():.2f}°"
        assert int(figures["bridges"]) == int(((spans.path == k) & spans.resolved).sum())
    assert len(set(picked)) > 1
    assert changed(before, settled(browser)) > 1e-3  # it stands out in the view
    where = np.argwhere(((paths.normal @ eye) > 0.85) & paths.on_surface)[0]
    pointed(browser, paths.points[tuple(where)], click=True)
    assert int(rows(browser, "figures")["number"]) == where[0]
    Select(browser.find_element(By.ID, "fibreList")).select_by_value("5")
    assert rows(browser, "figures")["number"] == "5"
    assert browser.find_element(By.ID, "live").text.startswith("fibre 5, family")
    click(browser, "following")
    assert rows(browser, "figures")["number"] == "6"
    click(browser, "previous")
    assert rows(browser, "figures")["number"] == "5"
    Select(browser.find_element(By.ID, "fibreList")).select_by_value("-1")
    assert rows(browser, "figures") == {}
    assert changed(before, settled(browser)) == 0.0


def test_the_panel_lies_beside_the_part(browser: webdriver.Chrome) -> None:
    click(browser, "following")
    view, figures = (browser.find_element(By.ID, name).rect for name in ("view", "figures"))
    assert figures["x"] + figures["width"] <= view["x"] or figures["x"] >= view["x"] + view["width"]
    Select(browser.find_element(By.ID, "fibreList")).select_by_value("-1")


def test_a_distance_is_that_of_the_points(browser: webdriver.Chrome, results: Results) -> None:
    settled(browser)
    grid = read_surface_grid(results.folder, results.surface)
    eye = np.array(browser.execute_script("return camera.eye"))
    facing = np.flatnonzero(grid.point_data[NORMAL] @ eye > 0.9)
    a, b = facing[len(facing) // 5], facing[-len(facing) // 5]
    families = "show-family1", "show-family-1", "show-bridges"
    for name in families:
        click(browser, name)
    click(browser, "measure")
    assert "point A" in browser.find_element(By.ID, "measureHint").text
    for n in (a, b):
        pointed(browser, grid.points[n], click=True)
    pixel = browser.execute_script("return camera.height / canvas.clientHeight")
    told, said = shown(browser)
    expected = float(np.linalg.norm(grid.points[a] - grid.points[b]))
    assert expected > 20.0 * pixel
    assert told == pytest.approx(expected, abs=3.0 * pixel)
    measured = rows(browser, "measured")
    ends = [
        np.array(
            [float(each.replace("−", "-").replace(",", "")) for each in measured[f"{end} on the part"].split(", ")]
        )
        for end in "AB"
    ]
    assert told == pytest.approx(float(np.linalg.norm(ends[0] - ends[1])), rel=1e-3)
    assert said == f"distance {measured['distance A to B']}"
    click(browser, "measure")
    click(browser, "clear")
    assert rows(browser, "measured") == {}
    for name in families:
        click(browser, name)


def test_a_distance_between_fibres_is_that_of_their_particles(browser: webdriver.Chrome, results: Results) -> None:
    settled(browser)
    paths = results.paths
    facing = np.argwhere(
        (paths.normal @ np.array(browser.execute_script("return camera.eye")) > 0.9) & paths.on_surface
    )
    a, b = (paths.points[tuple(facing[k])] for k in (3, -3))
    click(browser, "measure")
    for point in (a, b):
        pointed(browser, point, click=True)
    assert list(rows(browser, "measured"))[:2] == ["A on the fibre", "B on the fibre"]
    pixel = browser.execute_script("return camera.height / canvas.clientHeight")
    assert shown(browser)[0] == pytest.approx(float(np.linalg.norm(a - b)), abs=3.0 * pixel)
    click(browser, "measure")
    click(browser, "clear")


def test_the_clip_plane_takes_away_what_is_beyond_it(browser: webdriver.Chrome) -> None:
    click(browser, "from+x")
    whole = settled(browser)
    full = np.asarray((whole < 250.0).any(axis=2))
    choice = Select(browser.find_element(By.ID, "clipAxis"))
    choice.select_by_visible_text("z")
    slide(browser, "clipAt", 0.3)
    half = settled(browser)
    extent = browser.execute_script("return extent[2]")
    told = browser.find_element(By.ID, "clipNow").text
    assert told.startswith("z ≤ ") and told.endswith(" mm")
    at = float(told.split()[2].replace("−", "-"))
    assert at == pytest.approx(extent[0] + 0.3 * (extent[1] - extent[0]), abs=1e-3 * np.ptp(extent))
    # z is up when seen from x
    middle = round(browser.execute_script("return camera.project([0, 0, arguments[0] - middle[2]])[1]", at))
    gone = full & ~np.asarray((half < 250.0).any(axis=2))
    assert gone[: middle - 8, 80:].mean() > 0.05 and gone[middle + 8 :].mean() < 5e-3
    click(browser, "clipOther")
    other = settled(browser)
    gone = full & ~np.asarray((other < 250.0).any(axis=2))
    assert gone[middle + 8 :].mean() > 0.05 and gone[: middle - 8].mean() < 5e-3
    click(browser, "clipFibres")  # fibres stay whole
    assert changed(other, settled(browser)) > 2e-3
    click(browser, "clipFibres")
    click(browser, "clipOther")
    choice.select_by_visible_text("off")
    assert np.array_equal(settled(browser), whole)
    click(browser, "reset")


def test_through_a_clear_part_the_far_fibres_show(browser: webdriver.Chrome) -> None:
    browser.execute_script("camera.turn(.2, .15)")  # far fibres lie behind near ones of a part that is so even
    before = settled(browser)

    def coloured(image: Floats) -> float:
        return float((np.ptp(image, axis=2) > 40.0).mean())

    slide(browser, "opacity", 0.3)
    assert coloured(settled(browser)) > 1.2 * coloured(before)
    assert browser.find_element(By.ID, "opacityNow").text == "30 %"
    slide(browser, "opacity", 1.0)
    assert np.array_equal(settled(browser), before)


def test_views_are_along_the_axes(browser: webdriver.Chrome) -> None:
    for name, eye in (("+x", [1, 0, 0]), ("-y", [0, -1, 0]), ("+z", [0, 0, 1])):
        click(browser, f"from{name}")
        assert browser.execute_script("return camera.eye") == pytest.approx(eye)
    click(browser, "reset")
    parallel = settled(browser)
    click(browser, "perspective")
    assert browser.find_element(By.ID, "perspective").get_attribute("aria-pressed") == "true"
    assert changed(parallel, settled(browser)) > 0.01
    click(browser, "reset")
    assert np.array_equal(settled(browser), parallel)


def test_all_goes_by_keys(browser: webdriver.Chrome) -> None:
    canvas = browser.find_element(By.ID, "plot")
    for _ in range(60):
        browser.switch_to.active_element.send_keys(Keys.TAB)
        if browser.switch_to.active_element == canvas:
            break
    assert browser.switch_to.active_element == canvas
    assert browser.execute_script("return getComputedStyle(canvas).outlineStyle") != "none"

    def press(*keys: str) -> str:
        canvas.send_keys(*keys)
        browser.execute_async_script("requestAnimationFrame(() => setTimeout(arguments[0], 30))")
        return browser.find_element(By.ID, "live").text

    assert press("y") == "seen from +y"
    assert press(Keys.SHIFT, "z") == "seen from −z"
    assert browser.execute_script("return camera.eye") == pytest.approx([0, 0, -1])
    press("b")
    eye = np.array(browser.execute_script("return camera.eye"))
    press(Keys.ARROW_LEFT)
    assert eye @ browser.execute_script("return camera.eye") == pytest.approx(np.cos(np.radians(5.0)))
    height = browser.execute_script("return camera.height")
    press("+")
    assert browser.execute_script("return camera.height") == pytest.approx(0.85 * height)
    assert press("]").startswith("fibre 0")
    assert press("[").startswith("fibre 15")
    assert press(Keys.ESCAPE) == "no fibre chosen"
    assert press("m") == "measuring: choose point A"
    press(Keys.ENTER)
    for _ in range(3):
        press(Keys.SHIFT, Keys.ARROW_DOWN)
    assert press(Keys.ENTER).startswith("distance ")
    assert shown(browser)[0] > 1.0
    assert press(Keys.ESCAPE) == "measuring ended"
    assert press("c").startswith("clip plane, x ≤")
    for _ in range(3):
        said = press("c")
    assert said == "clip plane off"
    click(browser, "clear")
    press("r")


def test_everything_has_a_name_for_those_who_hear_it(browser: webdriver.Chrome) -> None:
    for kind in ("button", "input", "select", "canvas", "section"):
        for element in browser.find_elements(By.TAG_NAME, kind):
            if element.is_displayed() or kind == "canvas":
                assert len(element.accessible_name) > 2, element.get_attribute("outerHTML")
    plot = browser.find_element(By.ID, "plot")
    assert plot.aria_role == "application" and plot.accessible_name.endswith("with 16 fibres")
    assert browser.find_element(By.ID, "live").get_attribute("aria-live") == "polite"


def test_fibres_are_laid_one_after_the_other(browser: webdriver.Chrome, results: Results) -> None:
    whole = settled(browser)
    total = float(lengths(results.paths).polyline_length.sum())
    assert float(browser.find_element(By.ID, "wound").get_property("max")) == pytest.approx(total, rel=1e-5)  # type: ignore[arg-type]
    slide(browser, "wound", 0.5 * total)
    here = rows(browser, "here")
    ends = np.cumsum(lengths(results.paths).polyline_length)
    assert here["fibre"].split(",")[0] == str(int(np.searchsorted(ends, 0.5 * total)))
    assert changed(whole, settled(browser)) > 5e-3
    slide(browser, "wound", total)
    assert np.array_equal(settled(browser), whole)


@pytest.mark.parametrize(("wide", "high"), [(360, 740), (800, 600), (1920, 1080), (3840, 2160)])
def test_nothing_lies_over_the_part_at_any_width(browser: webdriver.Chrome, wide: int, high: int) -> None:
    size = {"width": wide, "height": high, "deviceScaleFactor": 1, "mobile": False}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    browser.execute_async_script("requestAnimationFrame(() => setTimeout(arguments[0], 50))")
    boxes = {name: browser.find_element(By.ID, name).rect for name in ("view", "readout", "toolbar", "side")}
    if wide > 1200:
        del boxes["side"]
        boxes |= {name: browser.find_element(By.ID, name).rect for name in ("controls", "panel")}
    view = boxes.pop("view")
    assert view["width"] * view["height"] > 0.3 * wide * high
    for name, box in boxes.items():
        apart = (box["x"] + box["width"] <= view["x"] + 1, box["x"] >= view["x"] + view["width"] - 1,
                 box["y"] + box["height"] <= view["y"] + 1, box["y"] >= view["y"] + view["height"] - 1)  # fmt: skip
        assert any(apart), name
    assert browser.execute_script("return document.documentElement.scrollWidth") <= wide
    browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def test_no_errors_were_logged(browser: webdriver.Chrome) -> None:
    assert severe(browser) == []


def test_without_webgl_the_page_says_what_to_do(folder: Path, tmp_path: Path, chromium: tuple[str, str]) -> None:
    with opened(folder / "viewer.html", tmp_path, chromium, "--disable-3d-apis") as browser:
        assert "WebGL 2" in browser.find_element(By.ID, "failed").text
        Select(browser.find_element(By.ID, "fibreList")).select_by_value("3")
        assert rows(browser, "figures")["number"] == "3"
        slide(browser, "wound", 1.0)
        Select(browser.find_element(By.ID, "map")).select_by_index(1)
        assert severe(browser) == []


def test_two_hundred_fibres_are_small_and_soon_there(tmp_path: Path, chromium: tuple[str, str]) -> None:
    out = tmp_path / "out"
    mw.wind("data/tank.ply", paths=100, out=out, render=False)
    (file,) = write_exports(out, ["viewer"]).files
    assert file.stat().st_size < MOST
    with opened(file, tmp_path / "profile", chromium) as browser:
        took = [first_picture(browser)]
        if took[0] > SOON:  # a machine with much else to do
            browser.refresh()
            WebDriverWait(browser, 60).until(lambda seen: seen.find_elements(By.CSS_SELECTOR, "body[data-ready=yes]"))
            took.append(first_picture(browser))
        assert min(took) < SOON
        assert browser.execute_script("return fibres.count") == 200
        # what moves is drawn from far fewer pieces
        assert 3 * browser.execute_script("return coarseLines.pieces.length") < browser.execute_script(
            "return fibreLines.pieces.length"
        )
        assert (settled(browser) < 250.0).any(axis=2).mean() > 0.1
        assert severe(browser) == []
