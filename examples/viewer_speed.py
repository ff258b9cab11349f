"""The viewer's page: its size, the time until its first picture is there, and the frames a second of a part that turns.

    python examples/viewer_speed.py --out out/viewer_speed

Pages of several parts are opened from disk by Chromium without a window, which draws by software, each run in a browser
and a profile of its own.  The time goes from the navigation's start to the end of the frame that shows the first
picture; the frames are those that the browser asks for while the part is turned by a little in each.  Needs Chromium
with its driver.  Writes viewer_speed.csv, a row a page, with the best of the runs, as whatever else the machine does
only slows them, and with their medians.
"""

import argparse
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from shutil import which
from statistics import median
from typing import Any, NamedTuple

from benchmarks.browser import first_picture, frames_a_second, opened
from benchmarks.command import run
from charts.record import Results

DATA = Path(__file__).parents[1] / "data"
LAYERS = """
[[layer]]
kind = "helical"
paths = 24
revolutions = 0.4
band_width = 9
band_thickness = 0.3

[[layer]]
kind = "hoop"
band_width = 4
band_thickness = 0.3
repeat = 4
"""
"""A helical layer and four of narrow hoops."""
_FRAMES = 60


class Case(NamedTuple):
    """A page: a word for it, the mesh with the options of its winding, and whether it is that of a program."""

    name: str
    options: tuple[str, ...]
    program: bool = False


_CONTINUOUS = "--continuous", "--turn-start", "shaft", "--turn-end", "shaft"
_PINS = "--paths", "12", "--revolutions", "0.8", "--band-width", "6", "--continuous"
CASES = (
    Case("200 fibres", ("tank.ply", "--paths", "100")),
    Case("cast", ("cast.ply", "--paths", "40")),
    Case("filament", ("vase.stl", *_PINS, "--turn-start", "pins", "--turn-end", "pins")),
    Case("program", ("vase.stl", *_PINS, "--turn-start", "pins", "--turn-end", "pins"), True),
    Case("layers", ("tank.ply", "--layers", "{layers}", *_CONTINUOUS)),
)
QUICK = CASES[1]


def written(case: Case, work: Path) -> Path:
    """Wind a part, and write its page."""
    layers, out = work / "layers.toml", work / case.name.replace(" ", "-")
    layers.write_text(LAYERS, encoding="utf-8")
    mesh, *options = (each.format(layers=layers) for each in case.options)
    command = sys.executable, "-m", "meshwind"
    run([*command, "wind", str(DATA / mesh), *options, "--units", "mm", "--no-render", "--out", str(out)])
    run([*command, "program" if case.program else "export", str(out), "--to", "viewer"])
    return out / ("program.html" if case.program else "viewer.html")


def measured(case: Case, work: Path, runs: int) -> dict[str, Any]:
    """The row of a page."""
    page = written(case, work)
    chromium = which("chromium") or "", which("chromedriver") or ""
    times, frames, count = [], [], {}
    for number in range(runs):
        with opened(page, work / f"{case.name}-{number}", chromium) as browser:
            times.append(first_picture(browser))
            frames.append(frames_a_second(browser, _FRAMES))
            count = browser.execute_script(
                "return { fibres: fibres.count, particles: fibres.kind.length, triangles: part.count / 3,"
                " 'band triangles': band ? band.count / 3 : 0 }"
            )
    row = {"page": case.name, "runs": runs, **count, "bytes": page.stat().st_size}
    row |= {"first picture": min(times), "first picture median": median(times)}
    return row | {"frames a second": max(frames), "frames a second median": median(frames)}


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/viewer_speed"), help="folder for the table")
    parser.add_argument("--runs", type=int, default=5, help="times that each page is opened")
    parser.add_argument("--quick", action="store_true", help="one page alone")
    given = parser.parse_args()
    results = Results(given.out, "viewer_speed", given.quick or given.runs < 3)
    rows: list[dict[str, Any]] = []
    cases: Sequence[Case] = (QUICK,) if given.quick else CASES
    with tempfile.TemporaryDirectory() as folder:
        for case in cases:
            row = measured(case, Path(folder), given.runs)
            rows.append(row)
            print(f"{case.name}: {row['bytes'] / 1e6:.2f} MB, first picture after {row['first picture']:.2f} s, "
                  f"{row['frames a second']:.0f} frames a second", flush=True)  # fmt: skip
    results.table("viewer_speed", rows)
    results.finish(f"{len(rows)} pages")


if __name__ == "__main__":
    main()
