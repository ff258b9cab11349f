"""angles.png: the winding angle and the cover over the length of the part."""

from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from meshwind.pictures import canvas
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import AnglesScene

_ANGLE, _COVER = "#2f6da8", "#b3541e"
_DPI = 100.0
_COVER_SHARE = 0.3
"""Share of the height that the cover takes."""


def draw(window: Any, scene: AnglesScene, page: Page) -> Any:
    """Draw the curves; the window is not needed."""
    del window
    s = page.unit
    figure = Figure(figsize=(page.width / _DPI, page.height / _DPI), dpi=_DPI, facecolor="none")
    agg = FigureCanvasAgg(figure)
    left, top, bottom = s * (canvas.LEFT + 110), s * canvas.TOP, s * 130
    width, height = page.width - left - s * canvas.LEFT, page.height - top - bottom
    gap = s * 40 if scene.cover is not None else 0.0
    low = (height - gap) * _COVER_SHARE if scene.cover is not None else 0.0

    def axes(base: float, high: float) -> Any:
        box = (left / page.width, base / page.height, width / page.width, high / page.height)
        made = figure.add_axes(box, facecolor="none")
        made.set_xlim(scene.stations[0], scene.stations[-1])
        made.grid(color="#dddddd", linewidth=s)
        made.tick_params(labelsize=15 * s, length=6 * s, width=s)
        for side, spine in made.spines.items():
            spine.set_visible(side in ("left", "bottom"))
            spine.set_linewidth(s)
        return made

    upper = axes(bottom + low + gap, height - low - gap)
    least, usual, most = scene.angles
    upper.fill_between(scene.stations, least, most, color=_ANGLE, alpha=0.25, linewidth=0.0, label="least to largest")
    upper.plot(scene.stations, usual, color=_ANGLE, linewidth=2.5 * s, label="median")
    upper.set_ylim(max(0.0, 5.0 * np.floor(least.min() / 5.0 - 0.5)), min(90.0, 5.0 * np.ceil(most.max() / 5.0 + 0.5)))
    upper.set_ylabel("winding angle, degrees", fontsize=17 * s)
    upper.legend(frameon=False, fontsize=15 * s, ncols=2, loc="lower right", bbox_to_anchor=(1.0, 1.0))
    last = upper
    if scene.cover is not None:
        upper.tick_params(labelbottom=False)
        last = axes(bottom, low)
        last.axhline(1.0, color=canvas.INK, linewidth=s, linestyle=(0, (4, 3)))
        last.plot(scene.stations, scene.cover, color=_COVER, linewidth=2.5 * s)
        last.set_ylim(0.0, 1.15 * max(float(scene.cover.max()), 1.0))
        last.set_ylabel("cover of a family", fontsize=17 * s)
    unit = f", {scene.frame.units}" if scene.frame.units else ""
    last.set_xlabel(f"distance along the part{unit}", fontsize=17 * s)
    agg.draw()
    drawn = Image.fromarray(np.asarray(agg.buffer_rgba()))
    image = canvas.blank(page)
    image.paste(drawn, (0, 0), drawn) if not page.transparent else image.alpha_composite(drawn)
    canvas.titled(image, page, scene.frame)
    return image
