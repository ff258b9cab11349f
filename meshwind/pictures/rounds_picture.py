"""rounds.png: the largest gap, the bridged share and the largest move over the rounds of a redesign."""

from typing import Any

import numpy as np

from meshwind.pictures import canvas
from meshwind.pictures.curves import LABEL, TICKS, Curves
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import RoundsScene

_COLOURS = "#b3541e", "#2f6da8", "#1c7c3c"
_LEFT, _BASE, _GAP = canvas.LEFT + 120.0, 130.0, 40.0
"""Margins of the curves, for a page of 1600 x 1200."""
_LOWEST = 0.3
"""Of the least gap that is no contact, or of the threshold: where contact is drawn on the logarithmic scale."""


def draw(scene: RoundsScene, page: Page) -> Any:
    """Draw three curves one above the other."""
    s, curves, count = page.unit, Curves(page), len(scene.gaps)
    unit = f", {scene.frame.units}" if scene.frame.units else ""
    width = page.width / s - _LEFT - canvas.LEFT
    height = (page.height / s - canvas.TOP - _BASE - 2 * _GAP) / 3.0
    rows = (
        (f"largest gap{unit}", scene.gaps), ("bridged, %", 100.0 * scene.bridged),
        (f"largest move{unit}", scene.moves),
    )  # fmt: skip
    made = []
    for k, (name, values) in enumerate(rows):
        here = curves.axes((_LEFT, _BASE + (2 - k) * (height + _GAP), width, height), np.array([-0.2, count - 0.8]))
        shown = _above(values, scene.threshold) if k == 0 else values
        here.plot(np.arange(count), shown, color=_COLOURS[k], linewidth=2.5 * s, marker="o", markersize=9 * s)
        for stage in np.flatnonzero(np.diff(scene.stages)):
            here.axvline(stage + 0.5, color=canvas.INK, linewidth=s, linestyle=(0, (4, 3)))
        here.set_ylabel(name, fontsize=LABEL * s)
        here.set_xticks(np.arange(count), [""] * count if k < 2 else list(scene.names))
        made.append(here)
    made[0].set_yscale("log")
    made[0].axhline(scene.threshold, color=canvas.INK, linewidth=s)
    made[0].text(-0.18, scene.threshold, "counts as none", ha="left", va="bottom", fontsize=TICKS * s)
    for here in made[1:]:
        here.set_ylim(0.0, None)
    made[2].set_xlabel("stage and round", fontsize=LABEL * s)
    image = curves.on(canvas.blank(page))
    canvas.titled(image, page, scene.frame)
    return image


def _above(gaps: Any, threshold: float) -> Any:
    """Gaps as they are drawn where contact, 0, has a place on the scale as well."""
    return np.maximum(gaps, _LOWEST * min([threshold, *gaps[gaps > 0.0]]))
