"""Figures as the documentation writes them."""

from collections.abc import Sequence
from math import floor, log10


def figure(value: float, digits: int = 2) -> str:
    """A number with few digits: 1,300, 47, 0.75, 1.5e-4."""
    if value == 0.0:
        return "0"
    size = floor(log10(abs(float(f"{value:.{digits - 1}e}"))))
    if size < -2:
        mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
        return f"{mantissa.rstrip('0').rstrip('.') if '.' in mantissa else mantissa}e{int(exponent)}"
    return f"{round(value, digits - 1 - size):,.{max(digits - 1 - size, 0)}f}"


def span(values: Sequence[float], digits: int = 2) -> str:
    """The least and the largest: "0.7 to 10", or one of them where they are written alike."""
    low, high = (figure(pick(values), digits) for pick in (min, max))
    return low if low == high else f"{low} to {high}"


def share(part: float, digits: int = 0) -> str:
    """A share in per cent, without the sign."""
    return f"{100.0 * part:.{digits}f}"


def size(count: float) -> str:
    """A round count: 10k, 1M."""
    for unit, word in ((1e6, "M"), (1e3, "k")):
        if count >= 0.95 * unit:
            return f"{count / unit:.0f}{word}"
    return f"{count:.0f}"


def markdown(rows: Sequence[Sequence[str]]) -> str:
    """A table in Markdown, the first row as its head."""
    head, *others = (f"| {' | '.join(row)} |" for row in rows)
    return "\n".join([head, f"|{' --- |' * len(rows[0])}", *others])
