"""Checks of the arguments and options that callers give; each raises BadInputError with one line."""

from math import isfinite
from numbers import Integral, Real
from os import PathLike
from pathlib import Path
from typing import Any, TypeGuard

from meshwind.core.errors import BadInputError
from meshwind.core.parsing import shortened


def whole(value: object, name: str, least: int) -> int:
    """A whole number from `least` up."""
    if isinstance(value, bool) or not isinstance(value, Integral) or value < least:
        shown = shortened(repr(value)) if isinstance(value, float) else text(value)  # 3.0, which is no 3
        raise BadInputError(f"{name} is {shown}; give a whole number from {least} up")
    return int(value)


def is_number(value: object) -> TypeGuard[float]:
    """Whether a value is a finite number, as also NumPy has them."""
    return isinstance(value, Real) and not isinstance(value, bool) and isfinite(value)


def number(value: object, name: str, low: float, high: float | None = None, above: bool = False) -> float:
    """A finite number from low (or, with `above`, above low) to high."""
    if is_number(value) and (value > low if above else value >= low) and (high is None or value <= high):
        return float(value)
    if above:
        allowed = f"above {low:g}" if high is None else f"above {low:g} and up to {high:g}"
    else:
        allowed = f"from {low:g} up" if high is None else f"from {low:g} to {high:g}"
    raise BadInputError(f"{name} is {text(value)}; give a number {allowed}")


def check_word(value: object, name: str, words: tuple[str, ...]) -> None:
    """Raise BadInputError unless the value is one of the words."""
    if not isinstance(value, str) or value not in words:
        raise BadInputError(f"{name} is {text(value)}; give {', '.join(words[:-1])} or {words[-1]}")


def check_switch(value: object, name: str) -> None:
    """Raise BadInputError for what is neither true nor false: a text such as "no" would count as true."""
    try:
        known = value in (True, False)  # as also NumPy has them
    except ValueError:  # an array
        known = False
    if not known:
        raise BadInputError(f"{name} is {text(value)}; give true or false")


def check_type(value: object, name: str, wanted: type, advice: str = "") -> None:
    """Raise BadInputError for what is of another type; the advice says where one comes from."""
    if not isinstance(value, wanted):
        asked = f"give a {wanted.__name__}{f', {advice}' if advice else ''}"
        raise BadInputError(f"{name} is of type {type(value).__name__}; {asked}")


def path_given(value: str | PathLike[str], name: str, kind: str = "path") -> Path:
    """The path of a file or a folder."""
    if not isinstance(value, str | PathLike):
        raise BadInputError(f"{name} is of type {type(value).__name__}; give a {kind}")
    return Path(value)


def several(names: Any, name: str) -> tuple[str, ...]:
    """One or several names."""
    if isinstance(names, str):
        return (names,)
    try:
        given = tuple(names)
    except TypeError:
        given = (names,)
    wrong = [each for each in given if not isinstance(each, str)]
    if wrong:
        raise BadInputError(f"{name} is {text(names)}; give a name, or several in a list")
    return given


def text(value: object) -> str:
    """A value as a few characters of text, in one line."""
    text = f"{float(value):g}" if isinstance(value, Real) and not isinstance(value, bool) else repr(value)
    return shortened(text)
