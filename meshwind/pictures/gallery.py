"""All pictures of a winding by name, and the sheet that shows them on one page."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from meshwind.pictures.angles_scene import angles_scene
from meshwind.pictures.drawings import Drawing
from meshwind.pictures.filament_scene import bands_scene, filament_scene
from meshwind.pictures.laminate_scene import laminate_scene
from meshwind.pictures.layers_scene import layers_scene
from meshwind.pictures.layup_scenes import crossings_scene, quads_scene, slip_scene, unrolled_scene
from meshwind.pictures.map_scene import coverage_scene, fit_map_scene, windability_scene
from meshwind.pictures.page import LEAST, Page
from meshwind.pictures.scenes import Frame, Scene
from meshwind.pictures.subject import Subject
from meshwind.pictures.winding_scene import winding_scene
from meshwind.results.schema import (
    FILAMENTS,
    FIT,
    FIT_ERROR,
    LAMINATE_PICTURE,
    OF_FILAMENT,
    OF_LAMINATE,
    PICTURES,
    SHEET,
    picture,
)

CELL = 800, 600
"""Largest size of a picture on the sheet, in pixels."""
_SCENES: tuple[Callable[[Subject], Scene], ...] = (
    winding_scene, crossings_scene, coverage_scene, layers_scene, windability_scene, slip_scene, fit_map_scene,
    unrolled_scene, quads_scene, angles_scene, filament_scene, bands_scene, laminate_scene,
)  # fmt: skip
"""In the order of PICTURES."""


def scenes_of(of: Subject) -> dict[str, Scene]:
    """Scenes of a winding by name of the picture."""
    return {name: make(of) for name, make in makers_of(of).items()}


def makers_of(of: Subject) -> dict[str, Callable[[Subject], Scene]]:
    """What makes the scenes of a winding, by name of the picture.

    That of the fit error is missing if the error is not known, and those of a filament or a laminate if there is none.
    """
    lacking = {FIT} if FIT_ERROR not in of.maps else set()
    lacking |= {FILAMENTS, LAMINATE_PICTURE} - set(names_of(of))
    return {name: make for name, make in zip(PICTURES, _SCENES, strict=True) if name not in lacking}


def names_of(of: Subject) -> tuple[str, ...]:
    """Names of the pictures that are first of a continuous winding or of one with layers, as far as it is one."""
    names = (*(OF_FILAMENT if of.filaments else ()), *(OF_LAMINATE if of.laminate is not None else ()))
    return tuple(dict.fromkeys(names))


def placed(
    scenes: Mapping[str, Scene], names: Sequence[str], page: Page, out: Path, cells: Path
) -> dict[Path, Drawing]:
    """Drawings of scenes by file: those of the names in `out` and, for a sheet, all others in `cells`, small.

    The latter are seen from one side, which takes half as long to draw.
    """
    drawings = {}
    for name, scene in scenes.items():
        if name in names:
            drawings[out / picture(name)] = Drawing(scene, page)
        elif SHEET in names:
            drawings[cells / picture(name)] = Drawing(one_sided(scene), cell(page))
    return drawings


def one_sided(scene: Any) -> Scene:
    """A scene that has a frame, as all of PICTURES have, seen from one side alone."""
    frame: Frame = scene.frame
    seen: Scene = replace(scene, frame=replace(frame, view=replace(frame.view, both=False)))
    return seen


def cell(page: Page) -> Page:
    """The page for a picture that is drawn for the sheet alone: the same shape in a smaller size."""
    share = min(CELL[0] / page.width, CELL[1] / page.height, 1.0)
    share = max(share, LEAST / min(page.width, page.height))
    return replace(page, width=round(share * page.width), height=round(share * page.height))


class Sheet:
    """A sheet of pictures of the same shape, row by row, which are taken from their files one by one."""

    def __init__(self, pictures: Sequence[Path], transparent: bool = False) -> None:
        self._pictures = list(pictures)
        self._mode, self._paper = ("RGBA", "#ffffff00") if transparent else ("RGB", "#ffffff")
        self._taken: dict[Path, Any] = {}

    def take(self, name: str) -> None:
        """Take the pictures of a name, if any is on the sheet, while others are still drawn."""
        from PIL import Image  # late, as all that draws

        for file in self._pictures:
            if file.name == name:
                with Image.open(file) as opened:
                    opened.thumbnail(CELL, Image.Resampling.LANCZOS)
                    self._taken[file] = opened.convert(self._mode)

    def write(self, sheet: Path) -> None:
        """Write the sheet, when all are drawn."""
        from PIL import Image

        for file in self._pictures:
            if file not in self._taken:
                self.take(file.name)
        columns, rows = layout(len(self._pictures))
        images = [self._taken[file] for file in self._pictures]
        width, height = (max(image.size[k] for image in images) for k in (0, 1))
        page = Image.new(self._mode, (columns * width, rows * height), self._paper)
        for k, image in enumerate(images):
            page.paste(image, (k % columns * width, k // columns * height))
        page.save(sheet, compress_level=1)


def layout(count: int) -> tuple[int, int]:
    """Columns and rows for `count` pictures, with few blanks and about as many columns as rows."""
    choices = [(columns, -(-count // columns)) for columns in range(1, count + 1) if columns <= 4]
    return min(choices, key=lambda shape: (shape[0] * shape[1] - count) + 1.5 * abs(shape[0] - shape[1]))
