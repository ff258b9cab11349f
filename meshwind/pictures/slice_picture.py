"""slice.png: the part before and after a redesign where a plane cuts it along the worst bridge."""

from typing import Any

import numpy as np
from matplotlib.collections import LineCollection

from meshwind.appearance.looks import round_below
from meshwind.appearance.words import quantity
from meshwind.pictures import canvas
from meshwind.pictures.curves import LABEL, TICKS, Curves
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import SliceScene

_BEFORE, _AFTER, _FIBRE, _GAP = "#8a8f94", "#2f6da8", "#b3541e", "#c2185b"
_LEFT, _BASE, _ROOM = canvas.LEFT + 110.0, 130.0, 60.0
"""Margins of the curves, and room above them for the legend, for a page of 1600 x 1200."""
_SHOWN = 0.2
"""Of the height: at least so much is taken by the gap."""


def draw(scene: SliceScene, page: Page) -> Any:
    """Draw both profiles, the fibre and its gap."""
    s, curves = page.unit, Curves(page)
    width, height = page.width / s - _LEFT - canvas.LEFT, page.height / s - canvas.TOP - _BASE - _ROOM
    (x, low), (to, high) = scene.low, scene.high
    here = curves.axes((_LEFT, _BASE, width, height), np.array([x, to]))
    stretch, high, low = _stretched(scene, (to - x) * height / width)
    here.set_ylim(low, high)
    for lines, colour, name in ((scene.before, _BEFORE, "before"), (scene.after, _AFTER, "after")):
        here.add_collection(
            LineCollection(list(lines), colors=colour, linewidths=3.0 * s, label=name, capstyle="round")
        )
    here.plot(*scene.fibre.T, color=_FIBRE, linewidth=2.0 * s, label="fibre before")
    if len(scene.fibre_after):
        style = dict(color=_FIBRE, linewidth=2.0 * s, linestyle=(0, (4, 2)))
        here.plot(*scene.fibre_after.T, label="the same fibre after", **style)
    here.plot(*scene.gap.T, color=_GAP, linewidth=2.5 * s, marker="_", markersize=18 * s)
    size = float(np.linalg.norm(scene.gap[1] - scene.gap[0]))
    here.annotate(
        f"  gap {quantity(size, scene.frame.units, 3)}", scene.gap.mean(axis=0), color=_GAP, fontsize=LABEL * s,
        va="center",
    )  # fmt: skip
    unit = f", {scene.frame.units}" if scene.frame.units else ""
    here.set_xlabel(f"along the fibre's span{unit}", fontsize=LABEL * s)
    drawn = "" if stretch == 1.0 else f" (drawn {stretch:g} times as high)"
    here.set_ylabel(f"height{unit}{drawn}", fontsize=LABEL * s)
    here.legend(frameon=False, fontsize=TICKS * s, ncols=4, loc="lower right", bbox_to_anchor=(1.0, 1.0))
    image = curves.on(canvas.blank(page))
    canvas.titled(image, page, scene.frame)
    return image


def _stretched(scene: SliceScene, true: float) -> tuple[float, float, float]:
    """By what heights are stretched so that the gap is seen, and the highest and lowest that are shown.

    true: the height that is shown with the same scale both ways.
    """
    low, high = scene.low[1], scene.high[1]
    gap = float(np.ptp(scene.gap[:, 1]))
    wanted = max(1.0, min(true / max(high - low, 1e-300), _SHOWN * true / max(gap, 1e-300)))
    stretch = 1.0 if wanted < 2.0 else round_below(wanted)
    spare = 0.5 * (true / stretch - (high - low))
    return stretch, high + spare, low - spare
