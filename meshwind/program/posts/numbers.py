"""Numbers as machines read them: no exponents, a point in each, and no digit that the controller cannot hold."""

import math

import numpy as np

from meshwind.core.cast import Floats, Ints

FIGURES = 7
"""Figures of a feed: a few more than the 0.1 % of the time need, and as many as single precision holds."""


def steps(values: Floats, decimals: int) -> Ints:
    """Values as whole numbers of the last decimal."""
    return np.rint(values * 10.0**decimals).astype(np.int64)


def number(count: int, decimals: int) -> str:
    """A whole number of the last decimal as text."""
    whole, part = divmod(abs(count), 10**decimals)
    text = f"{whole}.{part:0{decimals}d}".rstrip("0") if decimals else f"{whole}"
    return f"{'-' if count < 0 else ''}{text}{'0' if text.endswith('.') else ''}"


def figures(value: float) -> str:
    """A positive value as text with `FIGURES` figures."""
    text = f"{value:.{max(1, FIGURES - 1 - math.floor(math.log10(value)))}f}".rstrip("0")
    return f"{text}0" if text.endswith(".") else text
