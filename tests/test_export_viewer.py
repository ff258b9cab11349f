"""The viewer in a browser: opens from disk without network or errors, and does what its controls say."""

import base64
import json
from pathlib import Path

import numpy as np
import pytest
from export_results import leave, plain_results
from layup_shapes import bridged
from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select
from viewer_browser import pointed, settled, severe

from meshwind.appearance.looks import MAPS
from meshwind.core.cast import Floats
from meshwind.exporting.targets import write_exports
from meshwind.exporting.viewer import page as render_page
from meshwind.exporting.viewer import page_data
from meshwind.exporting.viewer_fibres import fibre_data
from meshwind.layup.bands import bands
from meshwind.path.lengths import bridging
from meshwind.path.paths import Status
from meshwind.results.reading import read_results
from meshwind.results.schema import QUADS
from meshwind.results.vtk_reading import read_faces

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


def share(image: Floats, colour: tuple[int, int, int]) -> float:
    return float((np.abs(image - colour).max(axis=2) < 12.0).mean())


def test_it_opens_without_network_or_errors(browser: webdriver.Chrome, page: Path) -> None:
    settled(browser)
    assert severe(browser) == []
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
    assert not full[0].any() and not full[-1].any() and not full[:, 0].any() and not full[:, -1].any()


def test_a_click_hides_a_family_and_brings_it_back(browser: webdriver.Chrome) -> None:
    before = settled(browser)
    browser.find_element(By.ID, "show-family1").click()
    hidden = settled(browser)
    assert share(hidden, BLUE) < 0.05 * share(before, BLUE)
    assert share(hidden, ORANGE) > 0.8 * share(before, ORANGE)
    browser.find_element(By.ID, "show-family1").click()
    assert share(settled(browser), BLUE) > 0.9 * share(before, BLUE)


def test_bridges_what_is_not_at_rest_and_the_part_go(browser: webdriver.Chrome) -> None:
    seen = [settled(browser)]
    names = "bridges", "loose", "part"
    for name in names:
        browser.find_element(By.ID, f"show-{name}").click()
        seen.append(settled(browser))
        assert (np.abs(seen[-1] - seen[-2]).max(axis=2) > 20.0).mean() > 5e-4
    assert (seen[-1] == 255.0).all(axis=2).mean() > 0.9
    for name in names:
        browser.find_element(By.ID, f"show-{name}").click()
    assert np.array_equal(settled(browser), seen[0])


def test_the_quads_between_crossings_can_be_shown(browser: webdriver.Chrome, page: Path) -> None:
    before = settled(browser)
    quads = read_faces(page.parent / QUADS).quads
    box = browser.find_element(By.ID, "show-quads")
    assert not box.is_selected() and f"{len(quads)} quads" in box.find_element(By.XPATH, "..").text
    box.click()
    assert (np.abs(settled(browser) - before).max(axis=2) > 30.0).mean() > 2e-3
    box.click()
    assert np.array_equal(settled(browser), before)


def test_bridges_stay_when_families_go(browser: webdriver.Chrome) -> None:
    families = [browser.find_element(By.ID, f"show-family{sign}") for sign in ("1", "-1")]
    for family in families:
        family.click()
    alone = settled(browser)
    browser.find_element(By.ID, "show-bridges").click()
    assert (np.abs(settled(browser) - alone).max(axis=2) > 30.0).mean() > 2e-3
    browser.find_element(By.ID, "show-bridges").click()
    for family in families:
        family.click()
    assert share(settled(browser), BLUE) > 0.002


def test_maps_are_chosen_by_name(browser: webdriver.Chrome) -> None:
    choice = Select(browser.find_element(By.ID, "map"))
    offered = [option.text for option in choice.options]
    assert offered == [
        "plain",
        *(look.title for name, look in MAPS.items() if name not in ("fit_error", "uncertainty")),
    ]
    plain = settled(browser)
    for title in ("coverage", "windability"):
        choice.select_by_visible_text(title)
        image = settled(browser)
        assert (np.abs(image - plain).max(axis=2) > 30.0).mean() > 0.08
        plain = image
    legend = browser.find_element(By.ID, "mapLegend").text
    assert legend.startswith("windability: share of the directions that press") and "0.75" in legend
    choice.select_by_visible_text("plain")


def test_discrete_maps_have_a_colour_for_each_class(browser: webdriver.Chrome) -> None:
    choice = Select(browser.find_element(By.ID, "map"))
    browser.execute_script(
        "look.opacity = 1; for (const id of ['family1', 'family-1', 'bridges', 'loose']) byId('show-' + id).click()"
    )
    choice.select_by_visible_text("layers of band")
    classes = settled(browser)
    entries = browser.find_elements(By.CSS_SELECTOR, "#mapLegend li")
    assert [entry.text for entry in entries][-2:] == ["1 layer", "bare"]
    hues = [np.array([int(part) for part in entry.find_element(By.TAG_NAME, "i").value_of_css_property(
        "background-color").split("(")[1].split(")")[0].split(",")[:3]], dtype=float) for entry in entries]  # fmt: skip
    # light alone tells places of a class apart: each has the proportions of its class's colour
    drawn = classes[(np.ptp(classes, axis=2) > 3.0)]
    own = [hue / np.linalg.norm(hue) for hue in hues]
    away = np.min(
        [np.abs(drawn / np.linalg.norm(drawn, axis=1, keepdims=True) - each).max(axis=1) for each in own], axis=0
    )
    assert len(drawn) > 0.05 * classes[..., 0].size
    assert (away < 0.03).mean() > 0.9  # all but smoothed edges
    # within a cell between nodes of several classes there is one colour, however near one looks
    choice.select_by_visible_text("class")
    assert browser.execute_script(
        "const map = surface.maps.find(each => each.name === byId('map').value);"
        "for (let i = 0; i < rows - 1; i++) for (let j = 0; j < columns - 1; j++) {"
        "  const [a, b] = [i * columns + j, (i + 1) * columns + j + 1], normal = at(part.normals, a);"
        "  if (map.values[a] === map.values[b] || dot(normal, camera.eye) < .9) continue;"
        "  const [p, q] = [at(part.points, a), at(part.points, b)];"
        "  [camera.target, camera.height] = [plus(p, plus(q, p, -1), .5), .2 * Math.hypot(...plus(q, p, -1))];"
        "  redraw(); return true;"
        "} return false;"
    )
    near = settled(browser)
    centre = near[near.shape[0] // 2 - 60 : near.shape[0] // 2 + 60, near.shape[1] // 2 - 60 : near.shape[1] // 2 + 60]
    hue = centre / np.linalg.norm(centre, axis=2, keepdims=True)
    assert np.ptp(hue.reshape(-1, 3), axis=0).max() < 0.02
    browser.find_element(By.ID, "reset").click()
    # a scale in steps has fewer colours than one that is even
    counts = []
    choice.select_by_visible_text("windability")
    for _ in range(2):
        seen = settled(browser).reshape(-1, 3)
        seen = seen[np.ptp(seen, axis=1) > 3.0]
        hue, many = np.unique(
            np.rint(50.0 * seen / np.linalg.norm(seen, axis=1, keepdims=True)), axis=0, return_counts=True
        )
        counts.append(int((many > 20).sum()))
        browser.find_element(By.ID, "stepped").click()
    assert 3 * counts[0] < 2 * counts[1]
    choice.select_by_visible_text("plain")
    browser.execute_script("for (const id of ['family1', 'family-1', 'bridges', 'loose']) byId('show-' + id).click()")


def test_layers_are_those_of_the_bands_between_nodes_too(browser: webdriver.Chrome, page: Path) -> None:
    results = read_results(page.parent)
    Select(browser.find_element(By.ID, "map")).select_by_visible_text("layers of band")
    browser.execute_script(
        "for (const input of document.querySelectorAll('#shown input'))"
        "  input.checked = input.id === 'show-part'; showKinds()"
    )
    seen = []
    for view in ("bestSide()", "camera.turn(2.1, .3)", "camera.turn(2.1, -.3)"):  # all around, over the seam
        browser.execute_script(view)
        seen += browser.execute_script(
            "draw(false);"
            "const found = [], pixel = new Uint8Array(4), map = surface.maps.find(each => each.name === 'layers');"
            "const hue = rgb => { const long = Math.hypot(...rgb); return Array.from(rgb, each => each / long); };"
            "const hues = map.classes.map(each => hue(fraction(each.colour)));"
            "for (let x = 4.5; x < canvas.clientWidth; x += 7) for (let y = 4.5; y < canvas.clientHeight; y += 7) {"
            "  const met = hitBody(part, camera.ray(x, y));"
            "  if (!met || dot(at(part.normals, met.n), camera.eye) < .3) continue;"
            "  gl.readPixels(Math.floor(x), canvas.height - 1 - Math.floor(y), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);"
            "  const away = hues.map(each => Math.hypot(...plus(each, hue(pixel.slice(0, 3)), -1)));"
            "  found.push([...partUv(met), away.indexOf(Math.min(...away)),"
            "    map.classes.findIndex(each => each.words === Object.fromEntries(saidOf({ what: 'part', ...met })[1])"
            "      [map.title])]);"
            "} return found"
        )
    u, v, drawn, said = np.array(seen).T
    laid = bands(results.paths, results.layup.bands.width, 24)
    there = laid.at(np.stack([u, v], axis=1))
    assert len(seen) > 1000 and len(np.unique(there)) > 2 and np.ptp(u) > 0.98
    assert (drawn == there).mean() > 0.97  # all but edges
    assert (said == there).mean() > 0.999
    browser.execute_script(
        "for (const input of document.querySelectorAll('#shown input'))"
        "  input.checked = input.id !== 'show-quads'; showKinds()"
    )
    Select(browser.find_element(By.ID, "map")).select_by_visible_text("plain")
    browser.find_element(By.ID, "reset").click()


def test_values_show_under_the_pointer_and_not_over_the_part(browser: webdriver.Chrome, page: Path) -> None:
    settled(browser)
    paths = read_results(page.parent).paths
    facing = (paths.normal @ np.array(browser.execute_script("return camera.eye"))) > 0.8
    readout = browser.find_element(By.ID, "readout")
    k, n = np.argwhere(facing & paths.on_surface)[40]
    pointed(browser, paths.points[k, n])
    assert readout.text.split("\n")[0] == f"fibre {k}"
    assert f"required friction\n{float(f'{paths.slip[k, n]:.3g}'):g}" in readout.text or paths.slip[k, n] < 1e-3
    browser.execute_script("for (const id of ['family1', 'family-1', 'bridges', 'loose']) byId('show-' + id).click()")
    pointed(browser, paths.points[k, n])
    assert readout.text.startswith("part") and "coverage" in readout.text and "winding angle" in readout.text
    browser.execute_script("for (const id of ['family1', 'family-1', 'bridges', 'loose']) byId('show-' + id).click()")
    view = browser.find_element(By.ID, "view").rect
    assert readout.rect["y"] > view["y"] + view["height"] - 1.0


def test_it_turns_to_the_end_and_back(browser: webdriver.Chrome) -> None:
    before = settled(browser)
    browser.find_element(By.ID, "top").click()
    assert (np.abs(settled(browser) - before).max(axis=2) > 30.0).mean() > 0.02
    browser.find_element(By.ID, "front").click()
    assert (np.abs(settled(browser) - before).max(axis=2) > 30.0).mean() < 1e-3


def test_the_page_holds_the_numbers_of_the_run(tmp_path: Path) -> None:
    results = plain_results(tmp_path)
    data = page_data(results)
    fibres, paths = data["fibres"], results.paths
    assert fibres["step"] == 1 and len(fibres["figures"]) == len(paths)
    assert [each["length"] for each in fibres["figures"]] == pytest.approx(paths.length, rel=1e-6)
    points = np.frombuffer(base64.b64decode(fibres["points"]["data"]), dtype="<f4").reshape(3, -1).T
    assert points == pytest.approx(paths.points.reshape(-1, 3), rel=1e-6, abs=1e-6)
    assert np.linalg.norm(data["camera"]["eye"]) == pytest.approx(1.0)
    assert data["units"] == "mm"
    assert json.loads(json.dumps(data, allow_nan=False))["surface"] == data["surface"]


def test_long_fibres_are_thinned_and_the_page_says_so(page: Path) -> None:
    results = read_results(page.parent)
    whole, thin = fibre_data(results), fibre_data(results, -(-results.paths.gap.size // 3) + 4 * len(results.paths))
    assert thin["step"] == 3 and thin["figures"] == whole["figures"]
    kept, sizes = [np.frombuffer(base64.b64decode(thin[name]["data"]), dtype="u1") for name in ("off", "sizes")]  # type: ignore[literal-required]
    off = bridging(results.paths)
    changes = (off[:, 1:] != off[:, :-1]).sum()
    ends = np.cumsum(sizes)
    inside = np.ones(len(kept) - 1, dtype=bool)
    inside[ends[:-1] - 1] = False
    assert ((kept[1:] != kept[:-1]) & inside).sum() == changes > 0  # no bridge is lost, nor longer


def test_too_many_quads_are_left_out_and_the_page_says_so(page: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    results = read_results(page.parent)
    assert page_data(results)["quads"] is not None
    monkeypatch.setattr("meshwind.exporting.viewer_quads._MOST", 3)
    data = page_data(results)
    assert data["quads"] is None and any("too many for the page" in note for note in data["notes"])


def test_names_cannot_break_the_page() -> None:
    made = render_page("</title>/*DATA*/<b>", '{"a":"/*SCRIPT*/"}')
    assert made.count('{"a":"/*SCRIPT*/"}') == 1 and "&lt;/title>/*DATA*/&lt;b>" in made
