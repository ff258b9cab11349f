"""The `meshwind` command: subcommands, and one line for whatever a user can mend."""

import sys

import typer

from meshwind.cli.wind import wind
from meshwind.errors import BadInputError

BAD_INPUT = 2
INTERRUPTED = 130

app = typer.Typer(
    name="meshwind",
    help="Wind taut fibres on a freeform triangle mesh.",
    add_completion=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)
app.command()(wind)


def _version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        typer.echo(f"meshwind {version('meshwind')}")
        raise typer.Exit


@app.callback()
def _root(
    version: bool = typer.Option(False, "--version", callback=_version, is_eager=True, help="Print the version."),
) -> None:
    """Wind taut fibres on a freeform triangle mesh."""


def main() -> None:
    """Run the command line; exit 0 done, 2 bad input or usage, 3 done but not every path came to rest."""
    try:
        code = app(standalone_mode=False)
    except typer.TyperException as error:
        context = getattr(error, "ctx", None)
        where = context.command_path if context else "meshwind"
        _fail(f"{error.format_message().rstrip('.')}; see `{where} --help`")
    except typer.Abort:
        sys.exit(INTERRUPTED)
    except BadInputError as error:
        _fail(str(error))
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)
    sys.exit(code if isinstance(code, int) else 0)


def _fail(line: str) -> None:
    print(f"meshwind: error: {' '.join(line.split())}", file=sys.stderr)  # noqa: T201
    sys.exit(BAD_INPUT)
