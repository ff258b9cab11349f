"""Layout of the commands' help: options in groups, and examples at the end."""

import inspect
from collections.abc import Callable
from typing import Any

from typer.core import TyperCommand, TyperGroup

from meshwind.editing.options import EDIT
from meshwind.workflow.options import FIBRES, PART, SURFACE

FILES, PRINTED = "Files", "What is printed"
"""Groups of options that all commands share."""
FIRST, LAST = ("Arguments", PART, EDIT, FIBRES, SURFACE), (FILES, PRINTED)
"""Groups that come first and last, in this order; between them are others in the order of their options."""


class Command(TyperCommand):
    """A command whose options are listed by their groups, and whose epilog, its examples, keeps its lines."""

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write arguments and options, a section per group; those without a group come last."""
        groups: dict[str, list[tuple[str, str]]] = {group: [] for group in FIRST}
        others: list[tuple[str, str]] = []
        for parameter in self.get_params(ctx):
            record = parameter.get_help_record(ctx)
            if record is None:
                continue
            is_argument = parameter.param_type_name == "argument"
            group = "Arguments" if is_argument else getattr(parameter, "rich_help_panel", None)
            (others if group is None else groups.setdefault(group, [])).append(record)
        last = [(group, groups.pop(group, [])) for group in LAST]
        for group, records in (*groups.items(), *last, ("Other options", others)):
            if records:
                with formatter.section(group):
                    formatter.write_dl(records)

    def format_epilog(self, ctx: Any, formatter: Any) -> None:
        """Write the examples."""
        del ctx
        _write_examples(self.epilog or "", formatter)


class Group(TyperGroup):
    """The main command, with examples like those of its subcommands."""

    def format_epilog(self, ctx: Any, formatter: Any) -> None:
        """Write the examples."""
        del ctx
        _write_examples(self.epilog or "", formatter)


def _write_examples(lines: str, formatter: Any) -> None:
    """Write the examples line by line, as they are."""
    with formatter.section("Examples"):
        for line in inspect.cleandoc(lines).splitlines():
            formatter.write(f"  {line}".rstrip() + "\n")


def split_names(text: str) -> list[str]:
    """The names in a text that separates them by commas."""
    return [name.strip().lower() for name in text.split(",") if name.strip()]


def one_of(*names: str) -> Callable[[str], list[str]]:
    """Completion of an option that takes one of some names."""

    def complete(incomplete: str) -> list[str]:
        return [name for name in names if name.startswith(incomplete.lower())]

    return complete


def some_of(*names: str) -> Callable[[str], list[str]]:
    """Completion of an option that takes names separated by commas: the last one is completed."""

    def complete(incomplete: str) -> list[str]:
        before, comma, last = incomplete.rpartition(",")
        rest = [name for name in names if name not in before.split(",") and name.startswith(last.strip().lower())]
        return [f"{before}{comma}{name}" for name in rest]

    return complete
