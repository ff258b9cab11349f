"""The viewer's page in a browser without a window."""

from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path

import numpy as np
from PIL import Image
from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

from meshwind.core.cast import Floats

FLAGS = (
    "--headless=new --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
    "--disable-component-update --disable-sync --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader "
    "--window-size=1000,700"
)


@contextmanager
def opened(page: Path, profile: Path, chromium: tuple[str, str]) -> Iterator[webdriver.Chrome]:
    """A browser that shows a page; profile: an empty folder; chromium: the executables of browser and driver."""
    options = webdriver.ChromeOptions()
    for flag in (*FLAGS.split(), f"--user-data-dir={profile}"):
        options.add_argument(flag)
    options.binary_location, its_driver = chromium
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(its_driver))
    try:
        driver.get(page.as_uri())
        WebDriverWait(driver, 60).until(lambda seen: seen.find_elements(By.CSS_SELECTOR, "body[data-ready=yes]"))
        yield driver
    finally:
        driver.quit()


def settled(browser: webdriver.Chrome) -> Floats:
    """A screenshot of the part, taken when two frames in a row are alike."""
    last = np.zeros(0)
    for _ in range(40):
        browser.execute_async_script("requestAnimationFrame(() => setTimeout(arguments[0], 150))")
        with Image.open(BytesIO(browser.get_screenshot_as_png())) as shot:
            image = np.asarray(shot.convert("RGB"), dtype=float)[:, 260:880]
        if np.array_equal(image, last):
            return image
        last = image
    raise AssertionError("the picture does not come to rest")
