"""The viewer's page in a browser without a window."""

from io import BytesIO

import numpy as np
from PIL import Image
from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By

from meshwind.core.cast import Floats


def settled(browser: webdriver.Chrome) -> Floats:
    """A screenshot of the view, taken when its edges are smooth and two frames in a row are alike."""
    view, last = browser.find_element(By.ID, "view"), np.zeros(0)
    for _ in range(60):
        browser.execute_async_script("requestAnimationFrame(() => setTimeout(arguments[0], 60))")
        if browser.execute_script("return waiting || document.body.dataset.drawn !== 'smooth'"):
            continue
        with Image.open(BytesIO(view.screenshot_as_png)) as shot:
            image = np.asarray(shot.convert("RGB"), dtype=float)[1:-2]  # without the lines above and below
        if np.array_equal(image, last):
            return image
        last = image
    raise AssertionError("the picture does not come to rest")


def pointed(browser: webdriver.Chrome, point: Floats, click: bool = False) -> None:
    """Move the pointer to where a point of the part is seen, and click there."""
    canvas = browser.find_element(By.ID, "plot")
    x, y, wide, high = browser.execute_script(
        "const [x, y] = camera.project(plus(arguments[0], middle, -1));"
        "return [x, y, canvas.clientWidth, canvas.clientHeight]",
        point.tolist(),
    )
    chain = ActionChains(browser, duration=0)
    chain.move_to_element_with_offset(canvas, round(x - wide / 2), round(y - high / 2))
    (chain.click() if click else chain).perform()
    browser.execute_async_script("requestAnimationFrame(() => setTimeout(arguments[0], 30))")


def rows(browser: webdriver.Chrome, table: str) -> dict[str, str]:
    """The rows of a table of names and values."""
    found = browser.execute_script(
        "return Array.from(document.getElementById(arguments[0]).rows,"
        " row => Array.from(row.cells, cell => cell.textContent))",
        table,
    )
    return dict(found)


def severe(browser: webdriver.Chrome) -> list[str]:
    """Errors in the browser's log."""
    return [line["message"] for line in browser.get_log("browser") if line["level"] == "SEVERE"]
