"""Numbers as machines read them: no exponents, a point in each, and no digit that the controller cannot hold."""

import math

import numpy as np

from meshwind.core.cast import Floats, Ints

FIGURES = 7
"""Figures of a feed: a few more than the 0.1 % of the time need, and as many as single precision holds."""


def steps(values: Floats, decimals: int) -> Ints:
    """Values as whole numbers of the last decimal."""
    return np.rint(values * 10.0**decimals).astype(np.int64)


def numbers(counts: Ints, decimals: int) -> list[str]:
    """Whole numbers (n,) of the last decimal as texts."""
    form = f"%.{decimals}f"
    texts = [form % value for value in (counts / 10**decimals).tolist()]
    return [_point(text.rstrip("0")) if text[-1] == "0" else text for text in texts] if decimals else texts


def figures(value: float) -> str:
    """A positive value as text with `FIGURES` figures."""
    return _point(f"{value:.{max(1, FIGURES - 1 - math.floor(math.log10(value)))}f}".rstrip("0"))


def _point(text: str) -> str:
    """A number without zeros at its end, but for one after the point."""
    return f"{text}0" if text[-1] == "." else text
