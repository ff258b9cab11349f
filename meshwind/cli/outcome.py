"""What a command has to tell when it is done: lines for a person, JSON for a script, or warnings alone."""

import json
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import typer


def tell(lines: Sequence[str], figures: Mapping[str, Any], as_json: bool, quiet: bool) -> None:
    """Print figures as JSON, or the lines, or with `quiet` none but warnings, these to standard error."""
    if as_json:
        from meshwind.results.report import plain

        typer.echo(json.dumps(plain(figures), indent=2, allow_nan=False))
    elif not quiet:
        typer.echo("\n".join(lines))
    else:
        for line in lines:
            if line.startswith("warning "):
                with suppress(OSError):
                    print(f"meshwind: {line.replace('warning  ', 'warning:').strip()}", file=sys.stderr)  # noqa: T201


def tell_files(files: Sequence[Path], notes: Sequence[str], as_json: bool, quiet: bool) -> None:
    """Print what was written, a file a line, and what the user should know of it."""
    lines = [f"note      {note}" for note in notes] + [f"file      {file}" for file in _few(files)]
    figures = {"files": [str(file) for file in files], "notes": list(notes)}
    tell(lines, figures, as_json, quiet)


def _few(files: Sequence[Path]) -> list[str]:
    """The files as text; many of one kind in one folder as one."""
    numbered = [file for file in files if file.stem.rpartition("_")[2].isdigit()]
    told = [str(file) for file in files if file not in numbered]
    if numbered:
        told.append(f"{numbered[0]} and {len(numbered) - 1} more" if len(numbered) > 1 else str(numbered[0]))
    return told
