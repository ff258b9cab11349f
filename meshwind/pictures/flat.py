"""Draws what has no part in space: curves and charts, which need no window."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from meshwind.pictures import angles_picture, rounds_picture, scenes, slice_picture, unrolled_picture
from meshwind.pictures.drawings import Drawing, save

_DRAWN_BY: dict[type, Callable[..., Any]] = {
    scenes.AnglesScene: angles_picture.draw,
    scenes.RoundsScene: rounds_picture.draw,
    scenes.SliceScene: slice_picture.draw,
    scenes.UnrolledScene: unrolled_picture.draw,
}


def draw(file: Path, drawing: Drawing) -> None:
    """Draw a flat scene into a file."""
    save(_DRAWN_BY[type(drawing.scene)](drawing.scene, drawing.page), file)
