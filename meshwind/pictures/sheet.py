"""sheet.png: the pictures of a run on one page."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from PIL import Image

from meshwind.pictures.page import LEAST, Page

CELL = 800, 600
"""Pixels of a picture on the sheet, at most."""


def cell(page: Page) -> Page:
    """The page for a picture that is drawn for the sheet alone: of the same shape, but no larger than need be."""
    share = min(CELL[0] / page.width, CELL[1] / page.height, 1.0)
    share = max(share, LEAST / min(page.width, page.height))
    return replace(page, width=round(share * page.width), height=round(share * page.height))


def write_sheet(sheet: Path, pictures: Sequence[Path], transparent: bool = False) -> None:
    """Lay pictures of one shape out on a sheet, in their order, row by row."""
    columns, rows = layout(len(pictures))
    images = []
    for picture in pictures:
        with Image.open(picture) as opened:
            opened.thumbnail(CELL, Image.Resampling.LANCZOS)
            images.append(opened.convert("RGBA" if transparent else "RGB"))
    width, height = (max(image.size[k] for image in images) for k in (0, 1))
    page = Image.new(images[0].mode, (columns * width, rows * height), "#ffffff00" if transparent else "#ffffff")
    for k, image in enumerate(images):
        page.paste(image, (k % columns * width, k // columns * height))
    page.save(sheet, compress_level=1)


def layout(count: int) -> tuple[int, int]:
    """Columns and rows for so many pictures: few blanks first, then about as many columns as rows."""
    choices = [(columns, -(-count // columns)) for columns in range(1, count + 1) if columns <= 4]
    return min(choices, key=lambda shape: (shape[0] * shape[1] - count) + 1.5 * abs(shape[0] - shape[1]))
