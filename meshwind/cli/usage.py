"""What was typed wrong, in one line that says what to type instead."""

import re
from pathlib import Path

import typer

_NUMBERS = re.compile(r"Input should be a valid (integer|number).*")
_COMMAND = re.compile(r"No such command '(.*?)'$")
_EXTRA = "Got unexpected extra argument"


def told(error: typer.TyperException, typed: list[str], commands: list[str]) -> str:
    """One line for a usage error; typed: the words after `meshwind`, commands: those that there are."""
    line = error.format_message().rstrip(".")
    line = _NUMBERS.sub(lambda kind: "give a whole number" if kind[1] == "integer" else "give a number", line)
    wrong = _COMMAND.search(line)
    if wrong and Path(wrong[1]).suffix:
        return f"{line}; to wind a mesh type `meshwind wind {wrong[1]}`"
    if line.startswith(_EXTRA):
        line += "; put a value with spaces in quotes"
    context = getattr(error, "ctx", None)
    command = f"meshwind {typed[0]}" if typed and typed[0] in commands else "meshwind"
    return f"{line}; see `{context.command_path if context else command} --help`"
