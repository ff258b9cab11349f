"""`--config`: options from a TOML file, by their long names; the command line outranks them."""

from pathlib import Path
from typing import Annotated, Any, get_args, get_type_hints

import typer

from meshwind.cli.help import FILES
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import shortened
from meshwind.core.toml import nearest, read_toml

_PATHS = "mesh", "out", "pins"
"""Options that hold a path: relative to the file that they stand in."""
_WORD_OR_NUMBER = "revolutions", "friction", "particles"
_WORDS = {bool: "true or false", int: "a whole number", float: "a number", str: "a text in quotes"}
_NOT_IN_FILES = "config", "help"

Options = dict[str, tuple[str, tuple[type, ...]]]
"""What a file may hold: by its key the name of the parameter, and the types that its value may have."""


def take_config(context: typer.Context, file: Path | None) -> Path | None:
    """Read the file and make its values the defaults of the command's other options."""
    if file is not None and not context.resilient_parsing:
        context.default_map = read_config(file, _options(context))
    return file


Config = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        callback=take_config,
        is_eager=True,
        rich_help_panel=FILES,
        help="TOML file with options by their long names, and mesh; what is typed here outranks it.",
    ),
]


def _options(context: typer.Context) -> Options:
    """The command's parameters, by their long names; types are those of the function that it runs."""
    hints = get_type_hints(context.command.callback)
    options: Options = {}
    for parameter in context.command.params:
        name = parameter.name or ""
        key = next((word for word in parameter.opts if word.startswith("--")), name).removeprefix("--")
        if key not in _NOT_IN_FILES:
            options[key] = name, _allowed(key, hints[name])
    return options


def _allowed(key: str, hint: Any) -> tuple[type, ...]:
    """The types of TOML that stand for a parameter's type, the one to ask for first."""
    if key in _WORD_OR_NUMBER:
        return float, int, str
    kind = next((kind for kind in get_args(hint) or (hint,) if kind is not type(None)), str)
    return {bool: (bool,), int: (int,), float: (float, int)}.get(kind, (str,))


def read_config(file: Path, options: Options) -> dict[str, Any]:
    """Values of the options by their parameters' names.

    Raises BadInputError where the file cannot be read, and for a key or a value that no option has.
    """
    values: dict[str, Any] = {}
    for key, value in read_toml(file, "config").items():
        if key not in options:
            raise BadInputError(f"{file}: {key!r} is no option; {nearest(key, options)}")
        name, allowed = options[key]
        if type(value) not in allowed:
            wanted = " or ".join(_WORDS[kind] for kind in allowed if kind is not int or allowed == (int,))
            raise BadInputError(f"{file}: {key} is {shortened(repr(value))}; give {wanted}")
        if key in _PATHS and value.strip():
            value = str(file.parent / value)
        values[name] = value if isinstance(value, bool) else str(value)
    return values
