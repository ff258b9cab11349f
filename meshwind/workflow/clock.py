"""Progress and wall time of the stages of a run."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import perf_counter

Progress = Callable[[str], None]
"""Called with the name of a stage as it starts."""


class Clock:
    """Reports each stage as it starts and adds up the time that it took."""

    def __init__(self, progress: Progress | None = None) -> None:
        self.progress = progress
        self.seconds: dict[str, float] = {}

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Report the stage and time what is done within it."""
        if self.progress is not None:
            self.progress(name)
        start = perf_counter()
        yield
        self.seconds[name] = self.seconds.get(name, 0.0) + perf_counter() - start
