"""unrolled.png: the chart as an image, a pixel's colour being its position in space, with the fibres on it."""

from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from meshwind.core.cast import Floats
from meshwind.pictures import canvas
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import UnrolledScene

_BRIDGING = "#b0127b"
_PARTED = "#333333"
"""Between neighbours that part round a body."""
_PALE = 0.55
"""Share of white mixed into the image, so that the fibres stand out."""
_VEIL = 0.35
"""Opacity of the strips between neighbours that part."""
_DPI = 100.0


def draw(scene: UnrolledScene, page: Page) -> Any:
    """Draw the chart."""
    s = page.unit
    figure = Figure(figsize=(page.width / _DPI, page.height / _DPI), dpi=_DPI, facecolor="none")
    agg = FigureCanvasAgg(figure)
    left, top = s * (canvas.LEFT + 90), s * canvas.TOP
    width, height = page.width - left - s * (canvas.RIGHT + 10), page.height - top - s * 110
    axes = figure.add_axes(
        (left / page.width, 1.0 - (top + height) / page.height, width / page.width, height / page.height)
    )
    _fill(axes, scene, s, width)
    agg.draw()
    drawn = Image.fromarray(np.asarray(agg.buffer_rgba()))
    image = canvas.blank(page)
    image.paste(drawn, (0, 0), drawn) if not page.transparent else image.alpha_composite(drawn)
    pen = canvas.titled(image, page, scene.frame)
    rows = [(canvas.FAMILY[name], words) for name, words in canvas.NAMES.items()]
    rows += [(_BRIDGING, "bridging")] if scene.bridging.any() else []
    rows += [(_PARTED, "parting")] if len(scene.parted) else []
    canvas.legend(pen, page, rows if scene.converged.all() else [*rows, (canvas.LOOSE, "not at rest")])
    return image


def _fill(axes: Any, scene: UnrolledScene, s: float, width: float) -> None:
    """Draw image, fibres and labels of the axes."""
    thick = min(1.6 * s, 0.16 * width / len(scene.uv))
    axes.imshow(_PALE + (1.0 - _PALE) * scene.image, extent=(0.0, 1.0, 0.0, 1.0), origin="lower", aspect="auto")
    for outline in scene.parted:
        for turn in np.arange(np.floor(outline[:, 0].min()), np.ceil(outline[:, 0].max())):
            axes.fill(*(outline - [turn, 0.0]).T, facecolor=_PARTED, alpha=_VEIL, edgecolor="none")
    for path, (uv, family) in enumerate(zip(scene.uv, scene.family, strict=True)):
        colour = canvas.FAMILY[int(family)] if scene.converged[path] else canvas.LOOSE
        axes.plot(*_wrapped(uv), color=colour, linewidth=thick)
        off = np.where(scene.bridging[path][:, None], uv, np.nan)
        if scene.bridging[path].any():
            axes.plot(*_wrapped(off), color=_BRIDGING, linewidth=1.8 * thick)
    axes.set(xlim=(0.0, 1.0), ylim=(0.0, 1.0))
    axes.set_xlabel("u: turns around the part", fontsize=18 * s, color=canvas.INK)
    axes.set_ylabel("v: from end to end", fontsize=18 * s, color=canvas.INK)
    axes.tick_params(labelsize=15 * s, length=6 * s, width=s, colors=canvas.INK)


def _wrapped(uv: Floats) -> tuple[Floats, Floats]:
    """A path (n, 2) with u in [0, 1], broken where it crosses u = 0."""
    turn = np.floor(uv[:, 0])
    parts = []
    known = turn[np.isfinite(turn)]
    for k in np.arange(known.min(), known.max() + 1.0):
        near = (uv[:, 0] > k - 0.5) & (uv[:, 0] < k + 1.5)
        parts += [np.where(near[:, None], uv - [k, 0.0], np.nan), np.full((1, 2), np.nan)]
    both = np.concatenate(parts)
    return both[:, 0], both[:, 1]
