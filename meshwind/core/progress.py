"""How a long task says how far it is."""

from collections.abc import Callable

Say = Callable[[str], None]
"""Called with a few words as a task goes on."""


def silent(words: str) -> None:
    """Say nothing."""
    del words
