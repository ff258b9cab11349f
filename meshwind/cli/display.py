"""Progress: a live line on a terminal, plain lines when piped."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress


@contextmanager
def display() -> Iterator[Callable[[str], None]]:
    """Yield a function that is told each stage as it starts.  Progress goes to standard error."""
    if sys.stderr is None or not sys.stderr.isatty():
        yield _plain
        return
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TaskID, TextColumn, TimeElapsedColumn

    columns = SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn()
    with Progress(*columns, console=Console(stderr=True)) as bars:
        running: list[TaskID] = []

        def tell(stage: str) -> None:
            for task in running:
                bars.update(task, total=1, completed=1)
            running[:] = [bars.add_task(stage, total=None)]

        yield tell
        for task in running:
            bars.update(task, total=1, completed=1)


def _plain(stage: str) -> None:
    """One line a stage; a run does not end because nobody can read its progress."""
    if sys.stderr is not None:
        with suppress(OSError):
            print(f"{stage} ...", file=sys.stderr, flush=True)  # noqa: T201
