"""Progress and wall time of the stages of a run."""

from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter

from meshwind.core.progress import Progress

_EVERY = 2.0
"""Seconds between two of these at least."""


class Clock:
    """Reports each stage as it first starts and adds up the time that it took."""

    def __init__(self, progress: Progress | None = None) -> None:
        self.progress = progress
        self.seconds: dict[str, float] = {}
        self._stage, self._told = "", 0.0

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Report the stage and time what is done within it."""
        if self.progress is not None and name not in self.seconds:  # one that goes on later is not told twice
            self.progress(name)
        start = perf_counter()
        self._stage, self._told = name, start
        yield
        self.seconds[name] = self.seconds.get(name, 0.0) + perf_counter() - start

    def tell(self, words: str) -> None:
        """Report how the stage goes on, unless that was only just done."""
        if self.progress is not None and perf_counter() - self._told > _EVERY:
            self._told = perf_counter()
            self.progress(f"{self._stage}, {words}")
