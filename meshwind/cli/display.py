"""Progress: a live line on a terminal, plain lines when piped."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress


@contextmanager
def display(quiet: bool = False) -> Iterator[Callable[[str], None]]:
    """Yield a function that is told each stage as it starts.  Progress goes to standard error, if not `quiet`."""
    if quiet:
        yield lambda _stage: None
        return
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


@contextmanager
def counter(what: str, quiet: bool = False) -> Iterator[Callable[[str, int, int], None]]:
    """Yield a function that is told of each thing done, how many are and how many there are: a bar on a terminal."""
    if quiet or sys.stderr is None or not sys.stderr.isatty():
        if not quiet:
            _plain(what)
        yield lambda _name, _done, _total: None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True)) as bars:
        task = bars.add_task(what, total=None)
        yield lambda _name, done, total: bars.update(task, completed=done, total=total)


def _plain(stage: str) -> None:
    """One line a stage; a run does not end because nobody can read its progress."""
    if sys.stderr is not None:
        with suppress(OSError):
            print(f"{stage} ...", file=sys.stderr, flush=True)  # noqa: T201
