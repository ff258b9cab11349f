"""How a long task says how far it is."""

from collections.abc import Callable

Progress = Callable[[str], None]
"""Called with a few words as a task goes on: a stage that starts, or how far it is, as "choose, 0.42 revolutions"."""


def silent(words: str) -> None:
    """Say nothing."""
    del words
