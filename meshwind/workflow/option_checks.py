"""Checks of the values of options; each raises BadInputError with one line."""

from math import isfinite
from numbers import Integral, Real

from meshwind.core.defaults import STEPS_PER_TURN
from meshwind.core.errors import BadInputError
from meshwind.core.memory import machine_memory
from meshwind.core.parsing import shortened

FIELD = "field:"
"""Before the name of a scalar field in a mesh file."""
SHARE = 0.8
"""Of the machine's memory that a run may take: the rest is the system's, and the renderer's."""
_BYTES_PER_PARTICLE, _BYTES_PER_CROSSING = 350, 1500
"""Peak memory of a run, measured from 3e5 to 1.6e6 particles and 2e4 to 5e5 crossings."""


def check_resolution(revolutions: float | str, particles: int) -> None:
    """Raise BadInputError for more revolutions than the particles of a path can follow."""
    most = (particles - 1) / STEPS_PER_TURN
    if not isinstance(revolutions, str) and revolutions > most:
        raise BadInputError(
            f"revolutions is {text(revolutions)}; give a number from 0 to {most:g}, the most that "
            f"{particles} particles per path can follow, or more particles"
        )


def whole(value: object, name: str, least: int) -> int:
    """A whole number from `least` up."""
    if isinstance(value, bool) or not isinstance(value, Integral) or value < least:
        shown = repr(value) if isinstance(value, float) else text(value)  # 3.0, which is no 3
        raise BadInputError(f"{name} is {shown}; give a whole number from {least} up")
    return int(value)


def number(value: object, name: str, low: float, high: float | None = None, above: bool = False) -> float:
    """A finite number from low (or, with `above`, above low) to high."""
    number = float(value) if isinstance(value, Real) and not isinstance(value, bool) else float("nan")
    inside = isfinite(number) and (number > low if above else number >= low) and (high is None or number <= high)
    if inside:
        return number
    if above:
        allowed = f"above {low:g}" if high is None else f"above {low:g} and up to {high:g}"
    else:
        allowed = f"from {low:g} up" if high is None else f"from {low:g} to {high:g}"
    raise BadInputError(f"{name} is {text(value)}; give a number {allowed}")


def check_word(value: object, name: str, words: tuple[str, ...]) -> None:
    """Raise BadInputError unless the value is one of the words."""
    if value not in words:
        raise BadInputError(f"{name} is {text(value)}; give {', '.join(words[:-1])} or {words[-1]}")


def check_switch(value: object, name: str) -> None:
    """Raise BadInputError for what is neither true nor false: a text such as "no" would count as true."""
    if value not in (True, False):
        raise BadInputError(f"{name} is {text(value)}; give true or false")


def text(value: object) -> str:
    """A value as a few characters of text."""
    text = f"{float(value):g}" if isinstance(value, Real) and not isinstance(value, bool) else repr(value)
    return shortened(text)


def check_memory(paths: int, particles: int, revolutions: float) -> None:
    """Raise BadInputError for a run that would take more memory than the machine has."""
    crossings = 2.0 * revolutions * float(paths) ** 2
    needed = 2.0 * paths * particles * _BYTES_PER_PARTICLE + crossings * _BYTES_PER_CROSSING
    allowed = SHARE * machine_memory()
    if needed > allowed:
        raise BadInputError(
            f"{paths} paths per family of {particles} particles and {revolutions:g} revolutions would need about "
            f"{needed / 1e9:,.0f} GB of memory, and this machine has {allowed / 1e9:,.3g} for a run; give fewer paths"
        )


def read_friction(value: object) -> float | str:
    """The coefficient, or the name of a field."""
    if not isinstance(value, str):
        if not isinstance(value, Real):
            raise BadInputError(
                f"friction is {text(value)}; give a number, or {FIELD}NAME for a scalar of the mesh file; "
                "tables and functions are for solve(..., friction=...)"
            )
        return number(value, "friction", 0.0, 10.0)
    if value.startswith(FIELD) and value.removeprefix(FIELD).strip():
        return value
    try:
        coefficient = float(value)
    except ValueError:
        raise BadInputError(
            f"friction is {value!r}; give a coefficient such as 0.2, or {FIELD}NAME for a scalar of the mesh file"
        ) from None
    return number(coefficient, "friction", 0.0, 10.0)
