"""The `meshwind` command: its subcommands, and a line for each error that a user can mend."""

import errno
import gc
import json
import os
import re
import sys
from contextlib import suppress
from pathlib import Path
from typing import NoReturn

import typer

from meshwind.cli import check, compile, export, info, program, redesign, render, solve, sweep, wind
from meshwind.cli.help import Command, Group
from meshwind.core.errors import BadInputError
from meshwind.core.spoken import as_command

NOT_PRINTED = 1
BAD_INPUT = 2
INTERRUPTED = 130
_YOUNG = 100_000
"""New objects after which garbage is looked for: as often as by default that takes a tenth of a run."""
_FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EPIPE, errno.EBADF}
"""Errors of a stream that takes no more; they name no file, and those of a run's files are handled elsewhere."""
_NUMBERS = re.compile(r"Input should be a valid (integer|number).*")
_COMMAND = re.compile(r"No such command '(.*?)'$")
_EXTRA = "Got unexpected extra argument"

EXAMPLES = """
    # what is this part, and can it be wound?
    meshwind check part.stl

    # wind it: results and pictures into part-wound/
    meshwind wind part.stl --paths 24

    # for a robot, a solver and a browser
    meshwind export part-wound --to frames,step,viewer

    # for a filament winding machine
    meshwind program part-wound

    # all options of a command
    meshwind wind --help
"""

app = typer.Typer(
    name="meshwind",
    cls=Group,
    epilog=EXAMPLES,
    help="Wind taut fibres on a freeform triangle mesh.",
    add_completion=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)
app.command(cls=Command, short_help="Wind a mesh: mesh in, paths out.", epilog=wind.EXAMPLES)(wind.wind)
app.command(cls=Command, short_help="Check whether a mesh can be wound, and how.", epilog=check.EXAMPLES)(check.check)
app.command(cls=Command, short_help="Change a mesh until no fibre bridges.", epilog=redesign.EXAMPLES)(
    redesign.redesign
)
app.command(cls=Command, short_help="Wind many cases from one study.", epilog=sweep.EXAMPLES)(sweep.sweep)
app.command(cls=Command, short_help="Draw the pictures of a run.", epilog=render.EXAMPLES)(render.render)
app.command(cls=Command, short_help="Write results for solvers, robots and CAD.", epilog=export.EXAMPLES)(export.export)
app.command(cls=Command, short_help="Solve the shell deck of a run.", epilog=solve.EXAMPLES)(solve.solve)
app.command(cls=Command, short_help="Write the program of a winding machine.", epilog=program.EXAMPLES)(program.program)
app.command(cls=Command, short_help="Compile all kernels ahead.", epilog=compile.EXAMPLES)(compile.compile)
app.command(cls=Command, short_help="Describe a mesh, a run or this installation.", epilog=info.EXAMPLES)(info.info)


def _version(wanted: bool) -> None:
    if wanted:
        from meshwind.core.version import version

        typer.echo(f"meshwind {version()}")
        raise typer.Exit


@app.callback()
def _root(
    version: bool = typer.Option(False, "--version", callback=_version, is_eager=True, help="Print the version."),
) -> None:
    """Wind taut fibres on a freeform triangle mesh."""


def main() -> None:
    """Run the command line.

    Exits with 0 when done, 1 when standard output could not be written, 2 on bad input or usage, and 3 when done
    but not every path converged.
    """
    gc.set_threshold(_YOUNG)
    try:
        with as_command():
            code = app(standalone_mode=False)
        if sys.stdout is not None:
            sys.stdout.flush()
    except typer.TyperException as error:
        commands = [command.callback.__name__ for command in app.registered_commands if command.callback]
        _fail(_usage_error(error, sys.argv[1:], commands))
    except typer.Abort:
        sys.exit(INTERRUPTED)
    except BadInputError as error:
        _fail(str(error))
    except MemoryError as error:
        _fail(f"out of memory: {error or 'no more could be had'}; give fewer paths or particles, or a coarser mesh")
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)
    except OSError as error:
        if error.filename is not None or error.errno not in _FULL:
            raise
        _give_up_printing(error)
    finally:
        gc.freeze()  # the interpreter looks for garbage as it ends, which takes 0.2 s
    sys.exit(code if isinstance(code, int) else 0)


def _usage_error(error: typer.TyperException, typed: list[str], commands: list[str]) -> str:
    """One line that says what to type instead; typed: the words after `meshwind`, commands: the names of all."""
    line = error.format_message().rstrip(".")
    line = _NUMBERS.sub(lambda kind: "give a whole number" if kind[1] == "integer" else "give a number", line)
    wrong = _COMMAND.search(line)
    if wrong and Path(wrong[1]).suffix:
        return f"{line}; to wind a mesh type `meshwind wind {wrong[1]}`"
    context = getattr(error, "ctx", None)
    if line.startswith(_EXTRA):
        line += "; put a value with spaces in quotes"
        if context and any("--out" in parameter.opts for parameter in context.command.params):
            line += ", and name the folder for the results by --out"
    command = f"meshwind {typed[0]}" if typed and typed[0] in commands else "meshwind"
    return f"{line}; see `{context.command_path if context else command} --help`"


def _fail(line: str, code: int = BAD_INPUT) -> NoReturn:
    with suppress(OSError):
        print(_error(" ".join(line.split()), code), file=sys.stderr, flush=True)  # noqa: T201
    sys.exit(code)


def _error(line: str, code: int) -> str:
    """An error as a line or, with --json, as JSON."""
    options = sys.argv[1 : sys.argv.index("--")] if "--" in sys.argv else sys.argv[1:]
    if "--json" in options:
        return json.dumps({"error": line, "exit_status": code})
    return f"meshwind: error: {line}"


def _give_up_printing(error: OSError) -> NoReturn:
    """End with one line where standard output takes no more, and without one where its reader has gone."""
    # the rest of the buffer is discarded: the interpreter would report a second error when it exits
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    if isinstance(error, BrokenPipeError):
        sys.exit(NOT_PRINTED)
    _fail(f"cannot write to standard output: {error.strerror}; send it elsewhere", NOT_PRINTED)
