"""The viewer in a browser: opens from disk without network or errors, and does what its controls say."""

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from export_results import leave, plain_results
from layup_shapes import bridged
from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select
from viewer_browser import opened, settled

from meshwind.appearance.looks import MAPS
from meshwind.core.cast import Floats
from meshwind.exporting.targets import write_exports
from meshwind.exporting.viewer import page_data
from meshwind.path.paths import Status

BLUE, ORANGE = (0, 114, 178), (230, 159, 0)


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("viewer")
    paths = bridged(8, particles=101)
    status = np.array(paths.status)
    status[5] = Status.STALLED
    object.__setattr__(paths, "status", status)
    leave(folder, paths)
    (file,) = write_exports(folder, ["viewer"]).files
    assert [each.name for each in folder.glob("viewer*")] == ["viewer.html"]
    return file


@pytest.fixture(scope="module")
def browser(
    page: Path, tmp_path_factory: pytest.TempPathFactory, chromium: tuple[str, str]
) -> Iterator[webdriver.Chrome]:
    with opened(page, tmp_path_factory.mktemp("chromium"), chromium) as driver:
        yield driver


def share(image: Floats, colour: tuple[int, int, int]) -> float:
    return float((np.abs(image - colour).max(axis=2) < 12.0).mean())


def test_it_opens_without_network_or_errors(browser: webdriver.Chrome, page: Path) -> None:
    settled(browser)
    assert [line for line in browser.get_log("browser") if line["level"] == "SEVERE"] == []
    events = [json.loads(entry["message"])["message"] for entry in browser.get_log("performance")]
    asked = {each["params"]["request"]["url"] for each in events if each["method"] == "Network.requestWillBeSent"}
    assert page.as_uri() in asked
    assert not [url for url in asked if not url.startswith(("file:", "data:", "blob:", "chrome:"))]
    assert {url for url in asked if url.startswith("file:")} == {page.as_uri()}


def test_the_part_fills_the_page_and_is_not_cut_off(browser: webdriver.Chrome) -> None:
    image = settled(browser)
    assert share(image, BLUE) > 0.002
    assert share(image, ORANGE) > 0.002
    full = np.asarray((image < 250.0).any(axis=2))
    assert full.mean() > 0.12
    assert not full[0].any() and not full[-1].any() and not full[:, 0].any()


def test_a_click_hides_a_family_and_brings_it_back(browser: webdriver.Chrome) -> None:
    before = settled(browser)
    browser.find_element(By.ID, "family1").click()
    hidden = settled(browser)
    assert share(hidden, BLUE) < 0.05 * share(before, BLUE)
    assert share(hidden, ORANGE) > 0.8 * share(before, ORANGE)
    browser.find_element(By.ID, "family1").click()
    assert share(settled(browser), BLUE) > 0.9 * share(before, BLUE)


def test_bridges_what_is_not_at_rest_and_the_part_go(browser: webdriver.Chrome) -> None:
    seen = [settled(browser)]
    names = "bridges", "loose", "part"
    for name in names:
        browser.find_element(By.ID, name).click()
        seen.append(settled(browser))
        assert (np.abs(seen[-1] - seen[-2]).max(axis=2) > 20.0).mean() > 5e-4
    assert (seen[-1] == 255.0).all(axis=2).mean() > 0.9
    for name in names:
        browser.find_element(By.ID, name).click()
    assert np.array_equal(settled(browser), seen[0])


def test_maps_are_chosen_by_name(browser: webdriver.Chrome) -> None:
    choice = Select(browser.find_element(By.ID, "map"))
    offered = [option.text for option in choice.options]
    assert offered == ["none", *(look.title for name, look in MAPS.items() if name not in ("fit_error", "uncertainty"))]
    plain = settled(browser)
    for title in ("coverage", "windability"):
        choice.select_by_visible_text(title)
        image = settled(browser)
        assert (np.abs(image - plain).max(axis=2) > 30.0).mean() > 0.08
        plain = image
    bars = browser.find_elements(By.CSS_SELECTOR, "#plot .colorbar text")
    assert "that press" in " ".join(bar.text for bar in bars)
    choice.select_by_visible_text("none")


def test_values_show_under_the_pointer(browser: webdriver.Chrome) -> None:
    settled(browser)
    plot, tip = browser.find_element(By.ID, "plot"), browser.find_element(By.ID, "tip")
    shown: set[str] = set()
    for x in range(-48, 49, 8):
        ActionChains(browser, duration=0).move_to_element_with_offset(plot, x, 90).perform()
        browser.execute_async_script("setTimeout(arguments[0], 120)")
        if tip.is_displayed():
            shown.add(tip.text)
    parts = [text for text in shown if text.startswith("part")]
    fibres = [text for text in shown if text.startswith("fibre")]
    assert parts and all("coverage" in text and "winding angle" in text for text in parts)
    assert fibres and all("slip" in text and "length so far" in text for text in fibres)


def test_it_turns_to_the_end_and_back(browser: webdriver.Chrome) -> None:
    ActionChains(browser).move_to_element(browser.find_element(By.ID, "name")).perform()
    before = settled(browser)
    browser.find_element(By.ID, "top").click()
    assert (np.abs(settled(browser) - before).max(axis=2) > 30.0).mean() > 0.02
    browser.find_element(By.ID, "front").click()
    assert (np.abs(settled(browser) - before).max(axis=2) > 30.0).mean() < 1e-3


def test_the_page_holds_the_numbers_of_the_run(tmp_path: Path) -> None:
    results = plain_results(tmp_path)
    data = page_data(results)
    assert [line["words"] for line in data["fibres"]] == ["family +1", "family −1"]  # no bridges, all at rest
    assert sum(line["count"] for line in data["fibres"]) == results.paths.gap.size
    assert np.linalg.norm(data["camera"]["eye"]) == pytest.approx(1.0)
    assert data["units"] == "mm"
    assert json.loads(json.dumps(data, allow_nan=False)) == data
