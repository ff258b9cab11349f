"""The pictures of the README beside this file and of the site: parts of data/ wound, and a redesign.

    python examples/gallery.py --out examples/gallery

--only vase,tank takes some of them.
"""

import argparse
import re
import shlex
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image

import meshwind as mw

DATA = Path(__file__).parents[1] / "data"
SITE = Path(__file__).with_name("site")
PAGE = mw.Page(1000, 750)


@dataclass(frozen=True)
class Shown:
    """A part of data/ with its winding, and the picture of it that is shown."""

    mesh: str
    picture: str
    revolutions: float | str
    friction: float = 0.0
    paths: int = 16


SHOWN = {
    "vase": Shown("vase.stl", "winding", 0.35),
    "bottle": Shown("bottle.obj", "crossings", 0.55),
    "cast": Shown("cast.ply", "coverage", 1.5),
    "tank": Shown("tank.ply", "slip", 0.8, friction=0.2),
    "wing": Shown("wing.stl", "winding", 0.55, paths=24),
    "elbow": Shown("elbow.obj", "windability", 1.0),
    "mesh": Shown("elbow.obj", "quads", 1.0, paths=24),
}
ON_PAGES = {
    "foot": ("tutorial.md", "filament"),
    "vessel": ("how_to/pressure_vessel.md", "bands"),
    "socket": ("how_to/socket.md", "laminate"),
    "duct": ("how_to/duct.md", "filament"),
}
"""Folders of windings on pages of the site, the page of each, and the picture of it that is shown there."""


def main() -> None:
    """Wind, draw and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/gallery"), help="folder for the pictures")
    parser.add_argument("--only", default=",".join((*SHOWN, *ON_PAGES, "redesign")), help="names by commas")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    for name in given.only.split(","):
        (redesigned if name == "redesign" else as_written if name in ON_PAGES else wound)(name, given.out)
        print(f"wrote {given.out / name}.png", flush=True)


def wound(name: str, out: Path) -> None:
    """One part's picture."""
    shown = SHOWN[name]
    with TemporaryDirectory() as folder:
        run = Path(folder) / name
        mw.wind(
            DATA / shown.mesh,
            paths=shown.paths,
            revolutions=shown.revolutions,
            friction=shown.friction,
            units="mm",
            out=run,
            render=False,
        )
        mw.render(run, only=[shown.picture], page=PAGE)
        small(run / f"{shown.picture}.png", out / f"{name}.png")


def as_written(name: str, out: Path) -> None:
    """The picture of a winding by the command of a page, with the files that the page has."""
    page, picture = ON_PAGES[name]
    text = (SITE / page).read_text(encoding="utf-8").replace("\\\n", " ")
    with TemporaryDirectory() as folder:
        Path(folder, "data").symlink_to(DATA)
        for block in re.findall(r"```toml\n(.*?)```", text, re.DOTALL):
            Path(folder, block.split(":")[0].removeprefix("# ")).write_text(block, encoding="utf-8")
        (line,) = re.findall(rf"^meshwind wind .*--out {name}$", text, re.MULTILINE)
        subprocess.run([sys.executable, "-m", *shlex.split(line), "--no-render"], cwd=folder, check=True)
        mw.render(Path(folder) / name, only=[picture], page=PAGE)
        small(Path(folder) / name / f"{picture}.png", out / f"{name}.png")


def redesigned(name: str, out: Path) -> None:
    """A vase, before and after the redesign of its neck."""
    edited = mw.redesign(DATA / "vase.stl", revolutions=0.35, paths=8)
    with TemporaryDirectory() as folder:
        mw.write_redesign(edited, folder, units="mm")
        mw.render(folder, only=["redesign"], page=PAGE)
        small(Path(folder) / "redesign.png", out / f"{name}.png")


def small(picture: Path, out: Path) -> None:
    """Save a picture in 128 colours, which makes the file a quarter as large."""
    with Image.open(picture) as image:
        image.convert("RGB").quantize(128, dither=Image.Dither.NONE).save(out, optimize=True)


if __name__ == "__main__":
    main()
