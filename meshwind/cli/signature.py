"""Commands that take records: each option of a record becomes a parameter of the command line."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from functools import wraps
from inspect import Parameter, signature
from pathlib import Path
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import typer

from meshwind.cli.help import one_of
from meshwind.core.option import Option, options_of


@dataclass(frozen=True)
class Pick:
    """The fields of a record that a command takes, in this order, and what differs from the record there.

    names: of the fields, all where there are none; defaults, options: by the names of the fields.
    """

    names: tuple[str, ...] = ()
    defaults: Mapping[str, Any] = field(default_factory=dict)
    options: Mapping[str, Option] = field(default_factory=dict)


@dataclass(frozen=True)
class InFile:
    """The type of an option's value in a configuration file, where it is not that of the parameter."""

    hint: Any


@dataclass(frozen=True)
class _Filled:
    """A field of a record, the parameter of the command line that fills it, and how its text is read, if it is one."""

    field: str
    parameter: Parameter
    read: Callable[[Any], Any] | None = None

    def value(self, given: Any) -> Any:
        """The field's value from the parameter's."""
        return given if self.read is None or given is None else self.read(given)


def with_records(command: Callable[..., int]) -> Callable[..., int]:
    """Replace each parameter of a command that is a record by the options of that record.

    Options are the fields with an `Option` for their metadata and those with an annotation for typer.  A parameter
    whose annotation holds a `Pick` takes only some of them.
    """
    hints = get_type_hints(command, include_extras=True)
    records: dict[str, tuple[type, list[_Filled]]] = {}
    parameters: list[Parameter] = []
    for name, parameter in signature(command).parameters.items():
        record, *more = get_args(hints[name]) if get_origin(hints[name]) is Annotated else (hints[name],)
        if isinstance(record, type) and is_dataclass(record):
            pick = next((each for each in more if isinstance(each, Pick)), Pick())
            records[name] = record, list(_filled(record, pick))
            parameters += [each.parameter for each in records[name][1]]
        else:
            parameters.append(_parameter(name, hints[name], parameter.default))

    @wraps(command)
    def run(**values: Any) -> int:
        for name, (record, filled) in records.items():
            given = {each.field: each.value(values.pop(each.parameter.name)) for each in filled}
            values[name] = record(**given)
        return command(**values)

    run.__signature__ = signature(command).replace(parameters=parameters)  # type: ignore[attr-defined]
    run.__annotations__ = {each.name: each.annotation for each in parameters} | {"return": int}
    return run


def _filled(record: type, pick: Pick) -> Iterator[_Filled]:
    """The fields of a record that are options, with their parameters."""
    hints, options = get_type_hints(record, include_extras=True), options_of(record) | dict(pick.options)
    defaults = {each.name: each.default for each in fields(record)} | dict(pick.defaults)
    for name in pick.names or defaults:
        if name in options:
            yield _from_option(name, hints[name], defaults[name], options[name])
        elif get_origin(hints[name]) is Annotated:
            yield _Filled(name, _parameter(name, hints[name], defaults[name]))


def _from_option(name: str, hint: Any, default: Any, option: Option) -> _Filled:
    """An option that a record of the library describes; one that may be a number or a word is typed as a text."""
    kind, read = hint, option.read
    if option.is_file:
        kind, read = Path | None, str
    elif read is not None:
        kind, default = (str | None, None) if default is None else (str, str(default))
    about = typer.Option(
        metavar=option.metavar,
        help=option.help,
        autocompletion=one_of(*option.words) if option.words else None,
        rich_help_panel=option.group,
    )
    in_file = InFile(hint | str if read is not None else hint)
    return _Filled(name, _parameter(option.name or name, Annotated[kind, about, in_file], default), read)


def _parameter(name: str, hint: Any, default: Any) -> Parameter:
    return Parameter(name, Parameter.KEYWORD_ONLY, default=default, annotation=hint)
