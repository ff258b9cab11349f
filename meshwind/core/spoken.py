"""Names of arguments and functions in messages: in the words of a script, or as options and commands where one runs.

A message says `band_width=5` to who calls `meshwind.wind`, and `--band-width 5` to who runs `meshwind wind`.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

_TO_COMMAND = ContextVar("to_command", default=False)


@contextmanager
def as_command() -> Iterator[None]:
    """Speak of options and commands for a while, as the command line does."""
    before = _TO_COMMAND.set(True)
    try:
        yield
    finally:
        _TO_COMMAND.reset(before)


def argument(name: str, value: object = None) -> str:
    """An argument by its name in Python, with a value where one is meant; a word may be in quotes."""
    if _TO_COMMAND.get():
        option = f"--{name.replace('_', '-')}"
        return option if value is None or value is True else f"{option} {value}"
    if value is None:
        return name
    plain = not isinstance(value, str) or value[:1] in "'\"-0123456789"
    return f"{name}={value if plain else repr(value)}"


def called(function: str, rest: str = "", **arguments: object) -> str:
    """A function or its command, in backticks; rest: what is given without a name, such as "MESH"."""
    if _TO_COMMAND.get():
        words = ["meshwind", function, rest, *(argument(name, value) for name, value in arguments.items())]
        return f"`{' '.join(filter(None, words))}`"
    if not (rest or arguments):
        return f"`meshwind.{function}`"
    given = [rest.lower() or "...", *(f"{name}={value}" for name, value in arguments.items())]
    return f"`meshwind.{function}({', '.join(given)})`"
