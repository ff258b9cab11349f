"""The viewer's bands where they cross over a dent: the one that is wound later is seen, and picked."""

from pathlib import Path

import numpy as np
import pytest
from mesh_shapes import tube
from selenium import webdriver
from selenium.webdriver.common.by import By
from viewer_browser import severe

import meshwind as mw
from meshwind.exporting.targets import write_exports

LAYERS = """
[[layer]]
kind = "helical"
paths = 6
revolutions = 0.4
band_width = 0.15
band_thickness = 0.004

[[layer]]
kind = "hoop"
band_width = 0.15
band_thickness = 0.004
"""
CROSSINGS = """
const found = [], pixel = new Uint8Array(4), wide = canvas.clientWidth, high = canvas.clientHeight;
const hue = rgb => { const length = Math.hypot(...rgb); return Array.from(rgb, each => each / length); };
draw(arguments[0]);
gl.bindFramebuffer(gl.FRAMEBUFFER, null);
for (let x = 4.5; x < wide; x += 4) for (let y = 4.5; y < high; y += 4) {
  const ray = camera.ray(x, y), met = [], first = hitBody(part, ray);
  if (!first || gear.some(({ body }) => hitBody(body, ray))) continue;
  eachMet(band, ray, band.count, true, (t, k) => {
    const n = band.triangles[k + 2], row = Math.floor(n / wound.across);
    if (t < first.t && dot(at(band.normals, n), camera.eye) > .3) met.push([row, t]);
  });
  met.sort((one, other) => one[0] - other[0]);
  if (met.length < 2 || !met.every(([row]) => wound.over[row])) continue;
  const last = met.at(-1), nearest = Math.min(...met.map(each => each[1]));
  gl.readPixels(Math.floor(x), canvas.height - 1 - Math.floor(y), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
  const shade = hue(colourAt(wound.colours, wound.laid[last[0]] / wound.total));
  found.push([last[1] - nearest, Math.hypot(...plus(hue(pixel.slice(0, 3)), shade, -1)),
    hitBand(ray).n / wound.across - last[0]]);
}
return found;
"""
"""At places where bands cross: how far the later one lies behind the nearest, how far the colour that is drawn is from
its own, and what is picked, over its row."""


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Helices bridge the dent, and hoops on them lie in it, as layers do not see each other's bridges."""
    folder = tmp_path_factory.mktemp("order")
    layers, out = folder / "layers.toml", folder / "out"
    layers.write_text(LAYERS, encoding="utf-8")
    vertices, faces = tube(np.ones_like, around=48, along=36)
    angle, z = np.arctan2(vertices[:, 1], vertices[:, 0]), vertices[:, 2] - 1.5
    vertices[:, :2] *= 1.0 - 0.3 * np.exp(-((z / 0.5) ** 2) - (angle / 0.6) ** 2)[:, None]
    made = mw.wind((vertices, faces), layers=layers, particles=101, continuous=True, turn_start="pins",
                   turn_end="pins", out=out, render=False)  # fmt: skip
    assert made.paths.gap.max() > 0.05
    write_exports(out, ["viewer"])
    return out / "viewer.html"


def test_where_bands_cross_the_later_one_is_seen(browser: webdriver.Chrome) -> None:
    size = float(browser.execute_script("return size"))
    browser.find_element(By.ID, "reset").click()
    seen = ("camera.from([1, 0, 0], [0, 0, 1])", True), ("camera.turn(.3, .4)", False), ("setPerspective(true)", False)
    for view, smoothly in seen:
        browser.execute_script(view)
        behind, colour, picked = np.array(browser.execute_script(CROSSINGS, smoothly)).T
        deep = behind > 0.005 * size  # more than order lifts bands: in the air
        assert deep.sum() > 15 and len(deep) > 200
        assert (colour[deep] < 0.1).mean() > 0.9
        assert (colour < 0.1).mean() > 0.95  # all but edges
        assert (np.abs(picked) < 2.0).mean() > 0.95


def test_from_within_the_part_hides_its_bands(browser: webdriver.Chrome) -> None:
    browser.find_element(By.ID, "reset").click()
    shown = browser.execute_script(
        "for (const input of document.querySelectorAll('#shown input'))"
        "  if (input.checked !== ['show-part', 'show-band'].includes(input.id)) input.click();"
        "camera.from([1, 0, 1], [0, 0, 1]);"
        "draw(false);"
        "const found = [], pixel = new Uint8Array(4), wide = canvas.clientWidth, high = canvas.clientHeight;"
        "gl.bindFramebuffer(gl.FRAMEBUFFER, null);"
        "for (let x = 4.5; x < wide; x += 4) for (let y = 4.5; y < high; y += 4) {"
        "  const first = hitBody(part, camera.ray(x, y));"
        "  if (!first || dot(at(part.normals, first.n), camera.eye) > -.2) continue;"
        "  let clear = true;"  # of the near rim's turnarounds
        "  eachMet(band, camera.ray(x, y), band.count, true, t => { if (t < first.t - .02 * size) clear = false; });"
        "  if (!clear) continue;"
        "  gl.readPixels(Math.floor(x), canvas.height - 1 - Math.floor(y), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);"
        "  found.push(Math.max(...pixel.slice(0, 3)) - Math.min(...pixel.slice(0, 3)));"
        "} return found"
    )
    colourful = np.array(shown) > 30.0
    assert len(colourful) > 200 and colourful.mean() < 0.015
    browser.find_element(By.ID, "reset").click()


def test_no_errors_were_logged(browser: webdriver.Chrome) -> None:
    assert severe(browser) == []
