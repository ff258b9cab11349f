"""Parts that all pictures share, on their page: rooms, colours, typeface, legend, ruler and axes."""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import get_data_path
from PIL import Image, ImageDraw, ImageFont

from meshwind.appearance.looks import Scale, colour_map, round_below
from meshwind.appearance.view import View
from meshwind.pictures.page import DESIGNED, Page
from meshwind.pictures.scenes import Frame

LEFT, RIGHT, TOP, BOTTOM = 60, 285, 150, 120
"""Margins around the part, for a page of 1600 x 1200: title above, ruler below, legend to the right."""
PAPER, INK, FAINT = "#ffffff", "#1c1c1c", "#5a5a5a"
PART, INSIDE = "#e6e2da", "#8f8a82"
FAMILY = {1: "#0072b2", -1: "#e69f00"}  # Okabe and Ito's blue and orange, which every eye distinguishes
LOOSE = "#7a7a7a"
NAMES = {1: "family +1", -1: "family −1"}
_MARGIN = 14
"""Least distance of the legend from the right edge."""
BETWEEN, _SMALLER = 40.0, 1.25
"""Distance between two views, and the factor by which the part may be larger in one."""
_BAR_TOP, _BAR_BOTTOM, _BAR_WIDTH = 470, 930, 34

Box = tuple[float, float, float, float]
"""Left, top, width and height in pixels."""


def room(page: Page) -> Box:
    """The box that the part is drawn in."""
    s = page.unit
    return s * LEFT, s * TOP, page.width - s * (LEFT + RIGHT), page.height - s * (TOP + BOTTOM)


def legend_left(page: Page) -> float:
    """Left edge, in pixels, of text to the right of the part."""
    return page.width - page.unit * (RIGHT - 20)


def rooms(page: Page, view: View) -> list[Box]:
    """The boxes that the part is drawn in: two for a view of both sides that would not be much larger in one.

    In perspective there is one, as the part would be seen at a slant in two.
    """
    whole = room(page)
    left, top, width, height = whole
    gap = page.unit * BETWEEN
    wide, high = (width - gap) / 2.0, (height - gap) / 2.0
    if view.upright:
        pair = [(left, top, wide, height), (left + wide + gap, top, wide, height)]
    else:
        pair = [(left, top, width, high), (left, top + high + gap, width, high)]
    two = view.both and not page.perspective and _scale(pair[0], view) <= _SMALLER * _scale(whole, view)
    return pair if two else [whole]


def _scale(box: Box, view: View) -> float:
    """Mesh units per pixel at which a view fills a box."""
    return float(max(view.width / box[2], view.height / box[3]))


def fitting(page: Page, view: View) -> float:
    """Mesh units per pixel at which the view fills the room for it."""
    return _scale(rooms(page, view)[0], view)


def middle(box: Box) -> tuple[float, float]:
    """The middle of a box."""
    return box[0] + 0.5 * box[2], box[1] + 0.5 * box[3]


def blank(page: Page) -> Any:
    """An empty picture."""
    mode, colour = ("RGBA", f"{PAPER}00") if page.transparent else ("RGB", PAPER)
    return Image.new(mode, (page.width, page.height), colour)


def titled(image: Any, page: Page, frame: Frame) -> Any:
    """Write title and subtitle, small enough for the page; return a pen for the image."""
    drawn, s = pen(image), page.unit
    for words, top, size, colour in ((frame.title, 36, 38, INK), (frame.subtitle, 88, 25, FAINT)):
        wide = drawn.textlength(words, font=face(page, size)) / (page.width - 2.0 * s * LEFT)
        drawn.text((s * LEFT, s * top), words, colour, font=face(page, size / max(wide, 1.0)))
    return drawn


def pen(image: Any) -> Any:
    """A pen for an image."""
    return ImageDraw.Draw(image)


def face(page: Page, size: float) -> Any:
    """The typeface that Matplotlib contains, so that the picture is the same on every machine."""
    return ImageFont.truetype(str(Path(get_data_path(), "fonts", "ttf", "DejaVuSans.ttf")), max(size * page.unit, 1.0))


def legend(pen: Any, page: Page, rows: list[tuple[str, str]]) -> None:
    """Draw the legend: a stroke and its text per row, small enough for the page."""
    s = page.unit
    x, y = legend_left(page), s * (TOP + 40)
    room = page.width - x - s * (58 + _MARGIN)
    wide = max((pen.textlength(words, font=face(page, 25)) for _, words in rows), default=0.0)
    size = 25 / max(wide / room, 1.0)
    for k, (colour, words) in enumerate(rows):
        pen.rectangle((x, y + s * (44 * k + 10), x + s * 44, y + s * (44 * k + 17)), fill=colour)
        pen.text((x + s * 58, y + s * (44 * k + 14)), words, INK, font=face(page, size), anchor="lm")


def scale_bar(image: Any, pen: Any, page: Page, scale: Scale) -> None:
    """Draw a scale with its text and marks."""
    colour_bar(image, pen, page, colour_map(scale.colours), list(scale.words), scale.marks)


def bar_box(page: Page) -> Box:
    """The box of a scale of colours."""
    s = page.unit
    top = s * _BAR_TOP
    bottom = max(page.height - s * (DESIGNED[1] - _BAR_BOTTOM), top + 40.0 * s)
    return legend_left(page), top, s * _BAR_WIDTH, bottom - top


def colour_bar(
    image: Any, pen: Any, page: Page, colours: Any, words: list[str], marks: list[tuple[float, str]]
) -> None:
    """Draw a scale of colours with lines of text above it and marks at positions from 0, below, to 1."""
    s = page.unit
    x, top, width, high = bar_box(page)
    bottom = top + high
    shade = colours(np.linspace(1.0, 0.0, round(bottom) - round(top)))[:, None, :3]
    bar = np.repeat((255 * shade).astype(np.uint8), round(width), axis=1)
    image.paste(Image.fromarray(bar), (round(x), round(top)))
    pen.rectangle((round(x), round(top), round(x) + round(width), round(bottom)), outline=INK)
    for k, line in enumerate(words):
        pen.text((x, top - s * (50 + 34 * (len(words) - 1 - k))), line, INK, font=face(page, 25))
    for share, words_at in marks:
        y = bottom - (bottom - top) * share
        pen.line((x + width, y, x + width + 8 * s, y), fill=INK)
        pen.text((x + width + 16 * s, y), words_at, INK, font=face(page, 21), anchor="lm")


def ruler(
    pen: Any, page: Page, scale: float, units: str, left: float = LEFT, base: float = 52.0, most: float = 320.0
) -> None:
    """Draw a scale bar of a round length, if the page has one.

    scale: mesh units per pixel; left, base, most: distances of the bar from the left and lower edges of the page, and
    its largest length, for a page of 1600 x 1200.
    """
    if not page.ruled:
        return
    s = page.unit
    x, y = s * left, page.height - s * base
    length = round_below(most * s * scale)
    reach = length / scale
    pen.rectangle((x, y - 4 * s, x + reach, y + 4 * s), fill=INK)
    pen.text((x + reach + 16 * s, y), f"{length:g} {units}".strip(), INK, font=face(page, 25), anchor="lm")


def axes(pen: Any, page: Page, view: View) -> None:
    """Draw the axes of the model, the one towards the eye last."""
    toward, s = view.eye, page.unit
    centre, reach = np.array([page.width - s * (RIGHT - 110.0), page.height - s * 110.0]), 62.0 * s
    flat = np.stack([view.right, -view.up], axis=1)
    labels: list[Any] = []
    for axis in np.argsort(toward):
        tip = centre + reach * flat[axis]
        colour = INK if toward[axis] > -0.2 else FAINT
        pen.line((*centre, *tip), fill=colour, width=max(round(4 * s), 1))
        # an axis that points at the eye is nearly a dot: its name is put away from the other two
        plain = bool(np.linalg.norm(flat[axis]) > 0.2)
        away = flat[axis] if plain else -flat.sum(axis=0)
        away = away / max(float(np.linalg.norm(away)), 1e-300)
        label = (tip if plain else centre) + 22.0 * s * away
        if any(np.linalg.norm(label - other) < 24.0 * s for other in labels):  # two axes that coincide on the picture
            label = label + 24.0 * s * np.array([-away[1], away[0]])
        labels.append(label)
        pen.text(tuple(label), "xyz"[axis], colour, font=face(page, 25), anchor="mm")


def note(pen: Any, page: Page, lines: list[str], below: int = 0) -> None:
    """Write a few lines where other pictures have their legend, below so many rows of it."""
    s = page.unit
    top = TOP + 40 + 44 * below
    for k, line in enumerate(lines):
        pen.text((legend_left(page), s * (top + 32 * k)), line, INK, font=face(page, 23))
