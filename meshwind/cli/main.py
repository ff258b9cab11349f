"""The `meshwind` command: subcommands, and one line for whatever a user can mend."""

import errno
import json
import os
import sys
from contextlib import suppress
from typing import NoReturn

import typer

from meshwind.cli import check, export, info, redesign, render, sweep, wind
from meshwind.cli.help import Command, Group
from meshwind.cli.usage import told
from meshwind.core.errors import BadInputError

UNPRINTED = 1
BAD_INPUT = 2
INTERRUPTED = 130
_FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EPIPE, errno.EBADF}
"""What a stream says that takes no more; it names no file, and all files of a run are guarded elsewhere."""

EXAMPLES = """
    # what is this part, and can it be wound?
    meshwind check part.stl

    # wind it: results and pictures into part-wound/
    meshwind wind part.stl --paths 24

    # for a robot, a solver and a browser
    meshwind export part-wound --to frames,inp,viewer

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
app.command(cls=Command, short_help="Tell whether a mesh can be wound, and how.", epilog=check.EXAMPLES)(check.check)
app.command(cls=Command, short_help="Change a mesh until no fibre bridges.", epilog=redesign.EXAMPLES)(
    redesign.redesign
)
app.command(cls=Command, short_help="Wind many cases from one study.", epilog=sweep.EXAMPLES)(sweep.sweep)
app.command(cls=Command, short_help="Draw the pictures of a run.", epilog=render.EXAMPLES)(render.render)
app.command(cls=Command, short_help="Write results for solvers, robots and CAD.", epilog=export.EXAMPLES)(export.export)
app.command(cls=Command, short_help="Tell of a mesh, a run or this installation.", epilog=info.EXAMPLES)(info.info)


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
    but not every path came to rest.
    """
    try:
        code = app(standalone_mode=False)
        if sys.stdout is not None:
            sys.stdout.flush()
    except typer.TyperException as error:
        commands = [command.callback.__name__ for command in app.registered_commands if command.callback]
        _fail(told(error, sys.argv[1:], commands))
    except typer.Abort:
        sys.exit(INTERRUPTED)
    except BadInputError as error:
        _fail(str(error))
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)
    except OSError as error:
        if error.filename is not None or error.errno not in _FULL:
            raise
        _give_up_printing(error)
    sys.exit(code if isinstance(code, int) else 0)


def _fail(line: str, code: int = BAD_INPUT) -> NoReturn:
    with suppress(OSError):
        print(_error(" ".join(line.split()), code), file=sys.stderr, flush=True)  # noqa: T201
    sys.exit(code)


def _error(line: str, code: int) -> str:
    """An error for a person or, where the command line asks for JSON, for a script."""
    options = sys.argv[1 : sys.argv.index("--")] if "--" in sys.argv else sys.argv[1:]
    if "--json" in options:
        return json.dumps({"error": line, "exit_status": code})
    return f"meshwind: error: {line}"


def _give_up_printing(error: OSError) -> NoReturn:
    """End in one line where standard output takes no more, quietly where its reader has gone."""
    # what is still in the buffer goes nowhere, or the interpreter would complain of it on its way out
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    if isinstance(error, BrokenPipeError):
        sys.exit(UNPRINTED)
    _fail(f"cannot write to standard output: {error.strerror}; send it elsewhere", UNPRINTED)
