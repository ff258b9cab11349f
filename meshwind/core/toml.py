"""Read a TOML file that a person wrote, or say in one line what is wrong with it."""

import difflib
import tomllib
from collections.abc import Collection
from pathlib import Path
from typing import Any

from meshwind.core.errors import BadInputError


def read_toml(file: Path, what: str) -> dict[str, Any]:
    """The tables of a file; `what` it is names it in the BadInputError that says why it cannot be read."""
    try:
        return tomllib.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise BadInputError(f"cannot read the {what} {file}: {error.strerror or error}; give a TOML file") from error
    except UnicodeDecodeError as error:
        raise BadInputError(f"the {what} {file} is no text in UTF-8; give a TOML file") from error
    except tomllib.TOMLDecodeError as error:
        raise BadInputError(f"the {what} {file} is not valid TOML: {error}; write option = value") from error


def nearest(key: str, known: Collection[str]) -> str:
    """The name that was meant, or all there are."""
    near = difflib.get_close_matches(key.lower().replace("_", "-").removeprefix("no-"), list(known), 1)
    return f"did you mean {near[0]!r}?" if near else f"give {', '.join(known)}"
