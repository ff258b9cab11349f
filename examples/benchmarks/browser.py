"""The viewer's page in a browser without a window, drawn by software: until when it is there, and how fast it turns."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

FLAGS = (
    "--headless=new --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
    "--disable-component-update --disable-sync --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader "
    "--window-size=1000,700"
)
_TURNING = """
const [many, done] = arguments, warm = 10;
let count = 0, begin = 0;
const step = () => {
  if (count === warm) begin = performance.now();
  if (count++ === warm + many) return done(1000 * many / (performance.now() - begin));
  camera.turn(.04, .01);
  requestAnimationFrame(step);
};
step();
"""


@contextmanager
def opened(page: Path, profile: Path, chromium: tuple[str, str], *more: str) -> Iterator[webdriver.Chrome]:
    """A browser that shows a page; profile: an empty folder; chromium: the executables of browser and driver.

    more: further flags of the browser.
    """
    options = webdriver.ChromeOptions()
    for flag in (*FLAGS.split(), *more, f"--user-data-dir={profile}"):
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


def first_picture(browser: webdriver.Chrome) -> float:
    """Seconds from the navigation's start until the frame with the first picture was shown."""
    return 1e-3 * float(browser.execute_script("return document.body.dataset.after"))


def frames_a_second(browser: webdriver.Chrome, many: int) -> float:
    """Frames a second while the part turns, over so many frames."""
    return float(browser.execute_async_script(_TURNING, many))
