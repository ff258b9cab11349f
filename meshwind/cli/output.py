"""What a command prints: progress while it runs, and its lines or JSON when it is done."""

import json
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from time import perf_counter

import typer

from meshwind.cli.arguments import Printed

_QUIET = 10.0
"""Seconds after which a command that counts says how far it is, where there is no terminal to show a bar."""


def print_report(lines: Sequence[str], figures: Mapping[str, object], printed: Printed) -> None:
    """Print the figures as JSON, or the lines, or with `quiet` only the warnings, these to standard error."""
    if printed.as_json:
        from meshwind.results.report import plain

        typer.echo(json.dumps(plain(figures), indent=2, allow_nan=False))
    elif not printed.quiet:
        typer.echo("\n".join(lines))
    else:
        for line in lines:
            if line.startswith("warning "):
                with suppress(OSError):
                    print(f"meshwind: {line.replace('warning  ', 'warning:').strip()}", file=sys.stderr)  # noqa: T201


def print_files(files: Sequence[Path], notes: Sequence[str], printed: Printed) -> None:
    """Print the files that were written, one per line, and the notes on them."""
    lines = [f"note      {note}" for note in notes] + [f"file      {file}" for file in _shortened(files)]
    figures = {"files": [str(file) for file in files], "notes": list(notes)}
    print_report(lines, figures, printed)


def _shortened(files: Sequence[Path]) -> list[str]:
    """The files as text; numbered ones as one line."""
    numbered = [file for file in files if file.stem.rpartition("_")[2].isdigit()]
    lines = [str(file) for file in files if file not in numbered]
    if numbered:
        lines.append(f"{numbered[0]} and {len(numbered) - 1} more" if len(numbered) > 1 else str(numbered[0]))
    return lines


@contextmanager
def stages(printed: Printed) -> Iterator[Callable[[str], None]]:
    """Yield a function to call with the name of each stage as it starts, or as it goes on: "movie, 25 of 250 frames".

    Progress goes to standard error: a live line on a terminal, plain lines otherwise.
    """
    if printed.no_progress:
        yield lambda _stage: None
        return
    if sys.stderr is None or not sys.stderr.isatty():
        yield _print_stage
        return
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TaskID, TextColumn, TimeElapsedColumn

    columns = SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn()
    with Progress(*columns, console=Console(stderr=True)) as bars:
        running: dict[str, TaskID] = {}

        def show(stage: str) -> None:
            name = stage.split(",")[0]
            if name in running:
                bars.update(running[name], description=stage)
                return
            end()
            running[name] = bars.add_task(stage, total=None)

        def end() -> None:
            for task in running.values():
                bars.update(task, total=1, completed=1)
            running.clear()

        yield show
        end()


@contextmanager
def counter(stage: str, printed: Printed) -> Iterator[Callable[[str, int, int], None]]:
    """Yield a function to call with the name of each item that is done, their number and the total: a progress bar."""
    if printed.no_progress:
        yield lambda _name, _done, _total: None
        return
    if sys.stderr is None or not sys.stderr.isatty():
        _print_stage(stage)
        told = perf_counter()

        def tell(_name: str, done: int, total: int) -> None:
            nonlocal told
            if perf_counter() - told > _QUIET and done < total:
                told = perf_counter()
                _print_stage(f"{stage}, {done} of {total}")

        yield tell
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True)) as bars:
        task = bars.add_task(stage, total=None)
        yield lambda _name, done, total: bars.update(task, completed=done, total=total)


def _print_stage(stage: str) -> None:
    """Print a line; a run does not end because nobody can read its progress."""
    if sys.stderr is not None:
        with suppress(OSError):
            print(f"{stage} ...", file=sys.stderr, flush=True)  # noqa: T201
