"""`--config`: options from a TOML file, by their long names; command-line options override the file."""

from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin, get_type_hints

import typer

from meshwind.cli.help import FILES
from meshwind.cli.signature import InFile
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import nearest, read_toml, shortened

_PATHS = "mesh", "folder", "out", "pins", "layers"
"""Options that are paths, relative to the file that they are read from."""
_EXPECTED = {bool: "true or false", int: "a whole number", float: "a number", str: "a text in quotes"}
_NOT_IN_FILES = "config", "help", "machines"

Keys = dict[str, tuple[str, tuple[type, ...]]]
"""What a file may hold: by its key the name of the parameter, and the types that its value may have."""


def take_config(context: typer.Context, file: Path | None) -> Path | None:
    """Read the file and make its values the defaults of the command's other options."""
    if file is not None and not context.resilient_parsing:
        context.default_map = read_config(file, _keys(context))
    return file


Config = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        callback=take_config,
        is_eager=True,
        rich_help_panel=FILES,
        help="TOML file with options by their long names, and mesh or folder; command-line options override the file.",
    ),
]


def _keys(context: typer.Context) -> Keys:
    """The command's parameters, by their long names."""
    hints = get_type_hints(context.command.callback, include_extras=True)
    keys: Keys = {}
    for parameter in context.command.params:
        name = parameter.name or ""
        key = next((flag for flag in parameter.opts if flag.startswith("--")), name).removeprefix("--")
        if key not in _NOT_IN_FILES:
            keys[key] = name, _types(hints[name])
    return keys


def _types(hint: Any) -> tuple[type, ...]:
    """The types of TOML that a parameter's value may have."""
    if get_origin(hint) is Annotated:
        hint, *more = get_args(hint)
        hint = next((each.hint for each in more if isinstance(each, InFile)), hint)
    kinds = get_args(hint) if get_origin(hint) in (UnionType, Union) else (hint,)
    types = dict.fromkeys(kind if kind in (bool, int, float) else str for kind in kinds if kind is not type(None))
    return tuple(types) if float not in types else tuple(types | {int: None})


def read_config(file: Path, keys: Keys) -> dict[str, Any]:
    """Values of the options by their parameters' names.

    Raises BadInputError where the file cannot be read, and for a key or a value that no option has.
    """
    values: dict[str, Any] = {}
    for key, value in read_toml(file, "config").items():
        if key not in keys:
            raise BadInputError(f"{file}: {key!r} is no option; {nearest(key, keys)}")
        name, allowed = keys[key]
        if type(value) not in allowed:
            expected = " or ".join(_EXPECTED[kind] for kind in allowed if kind is not int or float not in allowed)
            raise BadInputError(f"{file}: {key} is {shortened(repr(value))}; give {expected}")
        if key in _PATHS and value.strip():
            value = str(file.parent / value)
        values[name] = value if isinstance(value, bool) else str(value)
    return values
