"""Headers of PLY files: the elements with their properties, and the order of their bytes."""

import re
from typing import NamedTuple

from meshwind.mesh.io.text import own_unit

_TYPES = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4",
    "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "int64": "i8", "uint64": "u8", "float32": "f4", "float64": "f8",
}  # fmt: skip
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_MAX_HEADER = 1 << 20
_MAX_DIGITS = 15


class Property(NamedTuple):
    """A number, or with a `length_kind` a list: NumPy's types of the numbers, and of the list's length."""

    name: str
    kind: str
    length_kind: str = ""


class Element(NamedTuple):
    """Declaration of an element: name, number of rows, and properties in the order of the file."""

    name: str
    rows: int
    properties: list[Property]


class Header(NamedTuple):
    """Order of the bytes, as NumPy writes it or "" for text; elements; unit of meshwind; remarks; where the data begin.

    The remarks are the lines obj_info, in which programs say what else there is.
    """

    order: str
    elements: list[Element]
    units: str
    remarks: tuple[str, ...]
    end: int


def read_header(content: bytes) -> Header:
    """The header of a PLY file.  Raises ValueError if it has none, or one that is not as the format says."""
    first = re.match(rb"(?:\xef\xbb\xbf)?ply[ \t]*(\r\n|\n|\r)", content)
    if first is None:
        raise ValueError("its first line is not ply")
    # lines end as the first one does: a byte of the data after the header may look like an end of line
    end = rb"\r" if first[1] == b"\r" else rb"\r?\n"
    found = re.search(rb"(?<=[\r\n])end_header[ \t]*" + end, content[:_MAX_HEADER])
    if found is None:
        raise ValueError("its header does not end")
    order: str | None = None
    elements: list[Element] = []
    remarks = []
    for line in content[first.end() : found.start()].decode("latin-1").splitlines():
        words = line.split()
        if not words or words[0] == "comment":
            continue
        if words[0] == "obj_info":
            remarks.append(" ".join(words[1:]))
        elif words[0] == "format" and len(words) > 1 and words[1] in _ORDERS:
            order = _ORDERS[words[1]]
        else:
            _declare(words, elements)
    if order is None:
        raise ValueError("its header names no format")
    names = [element.name for element in elements]
    if len(set(names)) < len(names):
        raise ValueError("its header declares an element twice")
    return Header(order, elements, own_unit(content), tuple(remarks), found.end())


def _declare(words: list[str], elements: list[Element]) -> None:
    """Add the element or property of a line of the header."""
    match words:
        case ["element", name, rows] if rows.isascii() and rows.isdigit() and len(rows) <= _MAX_DIGITS:
            elements.append(Element(name, int(rows), []))
        case ["property", "list", count, kind, name] if elements and {count, kind} <= _TYPES.keys():
            if _TYPES[count][0] == "f":
                raise ValueError(f"its list {name[:40]!r} has a length that is not whole")
            elements[-1].properties.append(Property(name, _TYPES[kind], _TYPES[count]))
        case ["property", kind, name] if elements and kind in _TYPES:
            elements[-1].properties.append(Property(name, _TYPES[kind]))
        case _:
            raise ValueError(f"its header has the line {' '.join(words)[:60]!r}, which is not known")
