"""The page that a picture is drawn on: its size in pixels, and how it is drawn."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Integral

from meshwind.core.errors import BadInputError

LEAST, MOST = 240, 8192
"""Smallest side, in pixels, at which text is legible, and largest that graphics drivers draw reliably."""
DESIGNED = 1600, 1200
"""The size that all measures in the drawing code are for; other pages scale them."""


@dataclass(frozen=True)
class Page:
    """Size of a picture and how it is drawn.

    Parameters
    ----------
    width, height : int, default 1600 and 1200
        Size in pixels, from 240 to 8192.
    transparent : bool, default False
        Whether to leave out the background.
    perspective : bool, default False
        Whether to draw in perspective rather than in parallel projection.
    scale_bar : bool, optional
        Whether to draw a scale bar.  By default with parallel projection only: in perspective it is true at the middle
        of the part alone.
    view : str, default "auto"
        Direction from which the part is seen: "x", "-x", "y", "-y", "z", "-z", "iso", or "auto" for the long side that
        shows most of the bridges.

    Raises
    ------
    BadInputError
        If a size is out of range.

    Examples
    --------
    >>> import meshwind as mw
    >>> mw.Page(800, 600, perspective=True).ruled
    False
    """

    width: int = DESIGNED[0]
    height: int = DESIGNED[1]
    transparent: bool = False
    perspective: bool = False
    scale_bar: bool | None = None
    view: str = "auto"

    def __post_init__(self) -> None:
        sides = self.width, self.height
        if not all(isinstance(side, Integral) and LEAST <= side <= MOST for side in sides):
            raise BadInputError(f"size is {self.width}x{self.height}; give two numbers of pixels, {LEAST} to {MOST}")

    @property
    def unit(self) -> float:
        """Pixels for one pixel of a page of 1600 x 1200."""
        return min(self.width / DESIGNED[0], self.height / DESIGNED[1])

    @property
    def ruled(self) -> bool:
        """Whether there is a scale bar."""
        return not self.perspective if self.scale_bar is None else self.scale_bar


def parse_size(text: str) -> tuple[int, int]:
    """Width and height in pixels from text as in 1920x1080; raises BadInputError for other text."""
    sides = text.lower().replace("×", "x").split("x")
    if len(sides) != 2 or not all(side.strip().isdecimal() for side in sides):
        raise BadInputError(f"size is {text!r}; give width and height in pixels, as in 1920x1080")
    return int(sides[0]), int(sides[1])
