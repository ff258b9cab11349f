"""What people spell: fractions of whole numbers, auto for one that is to be chosen, and texts that are too long."""

from fractions import Fraction

from meshwind.core.errors import BadInputError

AUTO = "auto"


def shortened(text: str) -> str:
    """At most 40 characters of a text."""
    return text if len(text) <= 40 else text[:37] + "..."


def turns(text: str) -> float | str:
    """A number or a fraction of whole numbers: 0.5, 5/12; or auto."""
    if text.strip().lower() == AUTO:
        return AUTO
    try:
        return float(Fraction(text)) if "/" in text else float(text)
    except (ValueError, ZeroDivisionError, OverflowError) as error:
        raise BadInputError(f"revolutions is {text!r}; give a number as in 0.5 or 5/12, or auto") from error


def count(text: str) -> int | None:
    """A whole number, or None for auto."""
    if text.strip().lower() == AUTO:
        return None
    try:
        return int(text)
    except ValueError as error:
        raise BadInputError(f"particles is {text!r}; give a whole number, or auto") from error
