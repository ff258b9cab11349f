"""Curves over the length of the part, drawn on a page."""

from typing import Any

import numpy as np
from PIL import Image

from meshwind.core.cast import Floats
from meshwind.pictures.page import Page

_DPI = 100.0
LABEL, TICKS = 17.0, 15.0
"""Sizes of text, for a page of 1600 x 1200."""


class Curves:
    """A figure as large as a page, without a background."""

    def __init__(self, page: Page) -> None:
        # late: the process that draws parts needs them for few pictures
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        self._page = page
        self._figure = Figure(figsize=(page.width / _DPI, page.height / _DPI), dpi=_DPI, facecolor="none")
        self._agg = FigureCanvasAgg(self._figure)

    def axes(self, box: tuple[float, float, float, float], stations: Floats) -> Any:
        """Axes over stations (s,) in a box: left, base, width and height, for a page of 1600 x 1200."""
        page, s = self._page, self._page.unit
        left, width = (s * box[k] / page.width for k in (0, 2))
        base, height = (s * box[k] / page.height for k in (1, 3))
        made = self._figure.add_axes((left, base, width, height), facecolor="none")
        made.set_xlim(stations.min(), stations.max())
        made.grid(color="#dddddd", linewidth=s)
        made.tick_params(labelsize=TICKS * s, length=6 * s, width=s)
        for side, spine in made.spines.items():
            spine.set_visible(side in ("left", "bottom"))
            spine.set_linewidth(s)
        return made

    def along(self, units: str) -> str:
        """Words for the axis along the part."""
        return f"distance along the part{f', {units}' if units else ''}"

    def on(self, image: Any) -> Any:
        """The figure drawn on an image of the page."""
        self._agg.draw()
        drawn = Image.fromarray(np.asarray(self._agg.buffer_rgba()))
        image.alpha_composite(drawn) if self._page.transparent else image.paste(drawn, (0, 0), drawn)
        return image
