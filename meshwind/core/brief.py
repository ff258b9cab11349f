"""Short texts of records: what a line of a console or a notebook shows of them."""

from dataclasses import fields, is_dataclass
from pathlib import PurePath
from textwrap import wrap
from typing import Any

_MOST = 6
"""Numbers of an array, and entries of a sequence, that are shown."""
_LONGEST = 60
"""Characters of a text that are shown."""
_WIDTH = 100


def brief(record: Any) -> str:
    """A record in a few lines, for its `__repr__`: the shapes of its arrays, and the names of records in it."""
    name = type(record).__name__
    shown = ", ".join(f"{each.name}={_value(getattr(record, each.name))}" for each in fields(record) if each.repr)
    return "\n".join(wrap(f"{name}({shown})", _WIDTH, subsequent_indent="    ", break_on_hyphens=False))


def _value(value: Any) -> str:
    if hasattr(value, "dtype") and hasattr(value, "shape"):  # an array; NumPy itself is not loaded for help
        return _array(value)
    if isinstance(value, str | PurePath):
        text = str(value)
        return repr(text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}...")
    if isinstance(value, dict | frozenset | set):
        return f"{type(value).__name__} of {len(value)}"
    if isinstance(value, list | tuple):
        return _sequence(value)
    if isinstance(value, float):
        return f"{value:.6g}"
    if is_dataclass(value) or ((type(value).__module__ or "").startswith("meshwind") and not isinstance(value, int)):
        return f"{type(value).__name__}(...)"
    return repr(value) if len(repr(value)) <= _LONGEST else f"{type(value).__name__}(...)"


def _array(array: Any) -> str:
    if array.ndim == 1 and array.size <= _MOST:
        return f"[{', '.join(f'{each:.6g}' if array.dtype.kind == 'f' else str(each) for each in array)}]"
    return f"{array.dtype}{list(array.shape)}"


def _sequence(values: Any) -> str:
    if len(values) <= _MOST and all(isinstance(each, int | float | str | None.__class__) for each in values):
        left, right = ("[", "]") if isinstance(values, list) else ("(", ",)" if len(values) == 1 else ")")
        return f"{left}{', '.join(_value(each) for each in values)}{right}"
    return f"{type(values).__name__} of {len(values)}"
