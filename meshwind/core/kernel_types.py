"""Types of the arguments of kernels as text, and back: for the table of kernels that are compiled ahead."""

from importlib import import_module
from typing import Any

from numba.core import types as _types

types: Any = _types
Text = list[Any] | str
"""A number's type by its name, or a list: a word for the kind, then its contents."""


def to_text(of: Any) -> Text:
    """The type as plain lists and words.  Raises ValueError for a kind of type that has none yet."""
    if isinstance(of, types.Array):
        return ["array", of.dtype.name, of.ndim, of.layout, of.mutable, of.aligned]
    if isinstance(of, types.NamedTuple | types.NamedUniTuple):
        kind = of.instance_class
        return ["record", kind.__module__, kind.__qualname__, *(to_text(each) for each in of)]
    if isinstance(of, types.BaseTuple):
        return ["tuple", *(to_text(each) for each in of)]
    if isinstance(of, types.Literal):
        return ["literal", of.literal_value]
    if isinstance(of, types.Omitted):
        return ["omitted", of.value]
    if isinstance(of, types.Optional):
        return ["optional", to_text(of.type)]
    if isinstance(of, types.Number | types.Boolean | types.NoneType):
        return str(of.name)
    raise ValueError(f"no text for the type {of!r} of a kernel's argument")


def from_text(text: Text) -> Any:
    """The type that `to_text` wrote."""
    if isinstance(text, str):
        return getattr(types, text)
    kind, *rest = text
    if kind == "array":
        dtype, ndim, layout, mutable, aligned = rest
        return types.Array(getattr(types, dtype), ndim, layout, readonly=not mutable, aligned=aligned)
    if kind == "record":
        module, name, *parts = rest
        return types.BaseTuple.from_types([from_text(each) for each in parts], getattr(import_module(module), name))
    if kind == "tuple":
        return types.BaseTuple.from_types([from_text(each) for each in rest])
    if kind == "literal":
        return types.literal(rest[0])
    return types.Omitted(rest[0]) if kind == "omitted" else types.Optional(from_text(rest[0]))
