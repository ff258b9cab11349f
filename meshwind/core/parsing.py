"""Text that a user wrote: numbers, fractions, `auto`, TOML files, and names that were misspelt."""

import codecs
import difflib
import re
import tomllib
from collections.abc import Collection
from fractions import Fraction
from pathlib import Path
from typing import Any, cast

from meshwind.core.errors import BadInputError

AUTO = "auto"
_UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


def turns(text: str) -> float | str:
    """Number of revolutions as a number or a fraction of whole numbers, such as 0.5 or 5/12, or `AUTO`."""
    if text.strip().lower() == AUTO:
        return AUTO
    try:
        return float(Fraction(text)) if "/" in text else float(text)
    except (ValueError, ZeroDivisionError, OverflowError) as error:
        raise BadInputError(f"revolutions is {text!r}; give a number as in 0.5 or 5/12, or auto") from error


def several_turns(text: str) -> float | str | tuple[float, ...]:
    """One number of revolutions or `AUTO`, or several numbers separated by commas."""
    given = [turns(each) for each in text.split(",")]
    if len(given) == 1:
        return given[0]
    if AUTO in given:
        raise BadInputError(f"revolutions is {shortened(repr(text))}; auto chooses one number and stands alone")
    return tuple(float(each) for each in given)


def paths(text: str) -> int | None:
    """Whole number of paths, or None for auto."""
    return count(text, "paths")


def count(text: str, name: str = "particles") -> int | None:
    """Whole number, or None for auto."""
    if text.strip().lower() == AUTO:
        return None
    try:
        return int(text)
    except ValueError as error:
        raise BadInputError(f"{name} is {text!r}; give a whole number, or auto") from error


def number_or_auto(given: int | str | None) -> int | None:
    """A whole number, or None where `AUTO` leaves it open; other words are left to the check of the number."""
    return None if isinstance(given, str) and given.strip().lower() == AUTO else cast(int | None, given)


def read_toml(file: Path, kind: str) -> dict[str, Any]:
    """Read a TOML file; `kind` is what its messages call it.  Raises BadInputError if it cannot be read."""
    try:
        data = file.read_bytes()
        if data.startswith(_UTF_16) or re.search(rb"[ -~]\0|\0[ -~]", data):
            raise BadInputError(f"the {kind} {file} is text in UTF-16 or UTF-32; save it as UTF-8")
        return tomllib.loads(re.sub("\r\n?", "\n", data.decode("utf-8-sig")))
    except OSError as error:
        raise BadInputError(f"cannot read the {kind} {file}: {error.strerror or error}; give a TOML file") from error
    except UnicodeDecodeError as error:
        raise BadInputError(f"the {kind} {file} is not text in UTF-8; save it as UTF-8") from error
    except tomllib.TOMLDecodeError as error:
        raise BadInputError(f"the {kind} {file} is not valid TOML: {error}; {_mend(data, error)}") from error


_COMMA = re.compile(r"=\s*[-+]?\d+,\d+")
"""A number with a decimal comma, at its end or before more of it."""


def _mend(data: bytes, error: tomllib.TOMLDecodeError) -> str:
    """What to write instead, by the line that the error names."""
    place = re.search(r"at line (\d+)", str(error))
    lines = data.decode("utf-8-sig").splitlines()
    line = lines[int(place[1]) - 1] if place and int(place[1]) <= len(lines) else ""
    if "\\" in line and '"' in line:
        return "write folders with /, or the path in single quotes"
    return "write decimals with a point" if _COMMA.search(line) else "write option = value"


def nearest(key: str, known: Collection[str]) -> str:
    """Advice on an unknown name: the one that was probably meant, or a list of all."""
    plain = key.lower().replace("_", "-")
    if plain.startswith("no-") and plain.removeprefix("no-") in known:
        return f"write {plain.removeprefix('no-')} = false"
    near = difflib.get_close_matches(plain.removeprefix("no-"), list(known), 1)
    return f"did you mean {near[0]!r}?" if near else f"give {', '.join(known)}"


def shortened(text: str) -> str:
    """At most 40 characters of a text, in one line, for messages."""
    text = " ".join(text.split())
    return text if len(text) <= 40 else text[:37] + "..."
