"""angles.png: the winding angle and the cover over the length of the part."""

from typing import Any

import numpy as np

from meshwind.pictures import canvas
from meshwind.pictures.curves import Curves
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import AnglesScene

_ANGLE, _COVER = "#2f6da8", "#b3541e"
_COVER_SHARE = 0.3
"""Share of the height that the cover takes."""
_LEFT, _BASE, _GAP = canvas.LEFT + 110, 130.0, 40.0
"""Margins of the curves, for a page of 1600 x 1200."""


def draw(scene: AnglesScene, page: Page) -> Any:
    """Draw the curves."""
    s, curves = page.unit, Curves(page)
    width, height = page.width / s - _LEFT - canvas.LEFT, page.height / s - canvas.TOP - _BASE
    low = (height - _GAP) * _COVER_SHARE if scene.cover is not None else -_GAP
    upper = curves.axes((_LEFT, _BASE + low + _GAP, width, height - low - _GAP), scene.stations)
    least, usual, most = scene.angles
    upper.fill_between(scene.stations, least, most, color=_ANGLE, alpha=0.25, linewidth=0.0, label="least to largest")
    upper.plot(scene.stations, usual, color=_ANGLE, linewidth=2.5 * s, label="median")
    upper.set_ylim(max(0.0, 5.0 * np.floor(least.min() / 5.0 - 0.5)), min(90.0, 5.0 * np.ceil(most.max() / 5.0 + 0.5)))
    upper.set_ylabel("winding angle, degrees", fontsize=17 * s)
    upper.legend(frameon=False, fontsize=15 * s, ncols=2, loc="lower right", bbox_to_anchor=(1.0, 1.0))
    last = upper
    if scene.cover is not None:
        upper.tick_params(labelbottom=False)
        last = curves.axes((_LEFT, _BASE, width, low), scene.stations)
        last.axhline(1.0, color=canvas.INK, linewidth=s, linestyle=(0, (4, 3)))
        last.plot(scene.stations, scene.cover, color=_COVER, linewidth=2.5 * s)
        last.set_ylim(0.0, 1.15 * max(float(scene.cover.max()), 1.0))
        last.set_ylabel("cover of a family", fontsize=17 * s)
    last.set_xlabel(curves.along(scene.frame.units), fontsize=17 * s)
    image = curves.on(canvas.blank(page))
    canvas.titled(image, page, scene.frame)
    return image
