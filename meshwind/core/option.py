"""Options as fields of records: name, default, meaning and unit stand once, for the library and the command line."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from typing import Any

_KEY = "option"


@dataclass(frozen=True)
class Option:
    """What is known of an option beside its name, type and default, which are those of its field.

    meaning: a noun phrase or sentence without its full stop; unit: of the value, as in "in the mesh's units";
    otherwise: what None stands for; group: heading that help lists it under; words: texts that it may be, for
    completion; metavar: placeholder of the value in help; read: how the value is read from a text, where it may be a
    number or a word; name: on the command line, where it is not the field's; is_file: whether it is a path.
    """

    meaning: str
    group: str
    unit: str = ""
    otherwise: str = ""
    words: tuple[str, ...] = ()
    metavar: str | None = None
    read: Callable[[str], Any] | None = None
    name: str = ""
    is_file: bool = False

    @property
    def help(self) -> str:
        """The option's line of help."""
        sentence = f"{self.meaning}, {self.unit}." if self.unit else f"{self.meaning}."
        return f"{sentence}  [default: {self.otherwise}]" if self.otherwise else sentence


def option(meaning: str, group: str, **more: Any) -> Mapping[str, Option]:
    """Metadata for a dataclass field that is an option; see `Option` for what it takes."""
    return {_KEY: Option(meaning, group, **more)}


def options_of(record: type) -> dict[str, Option]:
    """The options of a dataclass, by the names of their fields."""
    return {each.name: each.metadata[_KEY] for each in fields(record) if _KEY in each.metadata}
