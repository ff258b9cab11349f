"""Sections of MSH files, and the numbers in them, as text or bytes."""

import re
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from meshwind.core.cast import Floats, Ints

_OPEN = re.compile(rb"^\$([A-Za-z]\w{0,60})[^\S\n]*\r?\n", re.MULTILINE)
_FORMAT = re.compile(rb"\s*(\d+(?:\.\d+)?)\s+([01])\s+(\d+)[^\S\n]*\r?\n")
_OLD_ENDS = {"NOD": b"$ENDNOD", "ELM": b"$ENDELM"}
_DATA = ("NodeData", "ElementData", "ElementNodeData")
_READ = ("MeshFormat", "Nodes", "ParametricNodes", "Elements", "NOD", "ELM")
_ONE = 1
"""The number by which a binary file shows its byte order."""


@dataclass(frozen=True)
class Sections:
    """Contents of the sections of a file by their names, and how they are written.

    version: 1, 2, 4.0 or 4.1; data: sections of values on nodes and elements in turn, as their names may repeat;
    order: "" in text, "<" or ">" in binary; size: bytes of a size in binary.
    """

    contents: dict[str, bytes]
    version: float
    data: tuple[tuple[str, bytes], ...] = ()
    order: str = ""
    size: int = 8

    def only(self, name: str) -> bytes:
        """Content of a section.  Raises ValueError if there is none."""
        if name not in self.contents:
            raise ValueError(f"it has no section ${name}")
        return self.contents[name]


def sections_of(content: bytes) -> Sections:
    """The sections of a file.  Raises ValueError if one does not end, or if the version is not known."""
    held: dict[str, bytes] = {}
    data = []
    at = 0
    while found := _OPEN.search(content, at):
        name = found[1].decode()
        end = _OLD_ENDS.get(name, f"$End{name}".encode())
        stop = content.find(end, found.end())
        if stop < 0:
            raise ValueError(f"its section ${name[:40]} does not end")
        if name in held:
            raise ValueError(f"it has two sections ${name}; save one mesh only")
        if name in _READ:
            held[name] = content[found.end() : stop]
        elif name in _DATA:
            data.append((name, content[found.end() : stop]))
        at = stop + len(end)
    if "MeshFormat" not in held:
        if "NOD" in held:
            return Sections(held, 1.0, tuple(data))
        raise ValueError("it has no section $MeshFormat")
    header = _FORMAT.match(held["MeshFormat"])
    if header is None:
        raise ValueError("its section $MeshFormat is damaged")
    version = float(header[1])
    version = 2.0 if 2.0 <= version < 3.0 else version
    if version not in (2.0, 4.0, 4.1):
        raise ValueError(
            f"it is of the version {header[1].decode()[:20]} of MSH, which is not read; save it as MSH 4.1"
        )
    if header[2] == b"0":
        return Sections(held, version, tuple(data))
    sign = held["MeshFormat"][header.end() : header.end() + 4]
    orders = {_ONE.to_bytes(4, "little"): "<", _ONE.to_bytes(4, "big"): ">"}
    if sign not in orders or int(header[3]) not in (4, 8):
        raise ValueError("its section $MeshFormat is damaged")
    return Sections(held, version, tuple(data), orders[sign], int(header[3]))


def numbers(text: bytes, name: str) -> Floats:
    """All numbers of a section of text.  Raises ValueError if something else is there."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            values = np.fromstring(text, dtype=np.float64, sep=" ")
        except (DeprecationWarning, ValueError) as error:
            raise ValueError(f"its section ${name} holds something else than numbers") from error
    return values


def whole(values: Floats) -> Ints:
    """The same as whole numbers.  Raises ValueError if they are not."""
    if not (np.abs(values) < 2.0**53).all() or (values != np.floor(values)).any():
        raise ValueError("a number or count of its nodes or elements is not whole")
    return values.astype(np.int64)


class Reader:
    """Numbers of a section one after the other, from text or bytes."""

    def __init__(self, sections: Sections, name: str) -> None:
        self.name, self.order, self.size = name, sections.order, sections.size
        content = sections.only(name)
        self.content: Any = content if self.order else numbers(content, name)
        self.at = 0

    def table(self, rows: int, *columns: tuple[str, int]) -> list[Any]:
        """Rows of columns, given by type and width: i4, f8, or "size"; each comes as a table (rows, width)."""
        if rows < 0:
            raise ValueError(f"its section ${self.name} is damaged")
        if not self.order:
            widths = [width for _, width in columns]
            whole_rows = self._take(rows * sum(widths)).reshape(rows, sum(widths))
            parts = np.split(whole_rows, np.cumsum(widths)[:-1], axis=1)
            return [part if kind == "f8" else whole(part) for part, (kind, _) in zip(parts, columns, strict=True)]
        codes = [f"u{self.size}" if kind == "size" else kind for kind, _ in columns]
        names = [(f"c{k}", self.order + code, (width,))
                 for k, (code, (_, width)) in enumerate(zip(codes, columns, strict=True))]  # fmt: skip
        dtype = np.dtype(names)
        held = np.frombuffer(self._take(rows * dtype.itemsize), dtype, rows)
        kinds = [np.float64 if kind == "f8" else np.int64 for kind, _ in columns]
        return [held[f"c{k}"].astype(kind) for k, kind in enumerate(kinds)]

    def line(self) -> int:
        """A count that is written as a line of text in binary files, too."""
        if not self.order:
            return int(self.table(1, ("i4", 1))[0][0, 0])
        stop = self.content.find(b"\n", self.at)
        text = self.content[self.at : stop] if stop >= 0 else b""
        if not text.strip().isdigit() or len(text) > 30:
            raise ValueError(f"its section ${self.name} is damaged")
        self.at = stop + 1
        return int(text)

    def _take(self, count: int) -> Any:
        if self.at + count > len(self.content):
            raise ValueError(f"its section ${self.name} ends before all that it announces")
        self.at += count
        return self.content[self.at - count : self.at]

    def end(self) -> None:
        """Raise ValueError if numbers are left."""
        left = self.content[self.at :]
        if len(left.strip()) if self.order else len(left):
            raise ValueError(f"its section ${self.name} goes on after all that it announces")
