"""Rows of the elements of PLY files: the walk over rows whose lists differ in length, and tables of binary data."""

import operator
import struct
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from meshwind.core.cast import Ints
from meshwind.core.lists import spread
from meshwind.mesh.io.face_lists import Lists
from meshwind.mesh.io.ply.header import Element, Property

Columns = dict[str, Any]
"""By name the numbers of a property (rows,), or its `Lists`."""
Length = Callable[[Any, int], int]
"""Reads the length of a list from data, at a position."""


class Table(NamedTuple):
    """Rows of one element, where each of them begins (rows,) if that matters, and where the last one ends."""

    columns: Columns
    starts: Ints
    end: int


_NOWHERE = np.zeros(0, dtype=np.int64)


class BrokenRow(ValueError):
    """A row that cannot be read; `starts`: where this one and those before it begin, as far as known."""

    def __init__(self, words: str, starts: Ints = _NOWHERE) -> None:
        super().__init__(words)
        self.starts = starts


class CutShort(BrokenRow):
    """The data end within an element, of which so many `rows` are whole."""

    def __init__(self, rows: int, starts: Ints = _NOWHERE) -> None:
        super().__init__("the data end within an element", starts)
        self.rows = rows


class Step(NamedTuple):
    """One property on the walk: size of a number; for a list the reader of its length and that length's size."""

    width: int
    length: Length | None = None
    length_width: int = 0


class Walk(NamedTuple):
    """By property where the numbers of each row begin (rows,) and how many there are; starts of rows, and the end."""

    begins: list[Ints]
    sizes: list[Ints]
    starts: Ints
    end: int


def walk(data: Any, rows: int, steps: Sequence[Step], at: int) -> Walk:
    """Go from row to row, as each says where the next one begins; numbers between lists are passed over.

    One of the steps at least is a list.  Raises CutShort, and BrokenRow for a length that is none.
    """
    lists = [k for k, step in enumerate(steps) if step.length is not None]
    before = [sum(step.width for step in steps[last + 1 : k]) for last, k in zip([-1, *lists[:-1]], lists, strict=True)]
    tail = sum(step.width for step in steps[lists[-1] + 1 :])
    plan = [(gap, steps[k].length, steps[k].length_width, steps[k].width) for gap, k in zip(before, lists, strict=True)]
    starts: list[int] = []
    ends: list[int] = []
    lengths: list[int] = []
    try:
        for _ in range(rows):
            starts.append(at)
            for gap, length_at, length_width, width in plan:
                at += gap
                length = length_at(data, at)  # type: ignore[misc]
                at += length_width + length * width
                lengths.append(length)
                ends.append(at)
            at += tail
    except (struct.error, IndexError, OverflowError):
        raise CutShort(len(starts) - 1 - (starts[-1] > len(data)), np.array(starts[:-1])) from None
    except ValueError as error:
        raise BrokenRow(f"row {len(starts)} {error}", np.array(starts)) from None
    if at > len(data):
        raise CutShort(rows - 1, np.array(starts))
    length_table = np.array(lengths, dtype=np.int64).reshape(len(starts), len(lists))
    if length_table.min(initial=0) < 0:
        row = int(np.flatnonzero((length_table < 0).any(axis=1))[0])
        raise BrokenRow(f"row {row + 1} has a list of {length_table[row].min()} numbers")
    return _placed(steps, np.array(starts), np.array(ends).reshape(length_table.shape), length_table, at)


def _placed(steps: Sequence[Step], starts: Ints, ends: Ints, lengths: Ints, end: int) -> Walk:
    """The places of all properties from those of the lists."""
    begins, sizes = [], []
    place, number = starts, -1
    for step in steps:
        if step.length is not None:
            number += 1
            sizes.append(lengths[:, number])
            begins.append(ends[:, number] - lengths[:, number] * step.width)
            place = ends[:, number]
        else:
            sizes.append(np.ones(len(starts), dtype=np.int64))
            begins.append(place)
            place = place + step.width
    return Walk(begins, sizes, starts, end)


class Binary:
    """Data of a binary file; positions are those of bytes, from the start of the file."""

    def __init__(self, content: bytes, order: str) -> None:
        self.content, self.order = content, order

    def table(self, element: Element, at: int) -> Table:
        """The rows of an element that begins at a byte."""
        table = self._of_one_length(element, at)
        if table is not None:
            return table
        steps = [self._step(p) for p in element.properties]
        walked = walk(self.content, element.rows, steps, at)
        data = np.frombuffer(self.content, np.uint8)
        columns: Columns = {}
        for p, begins, sizes in zip(element.properties, walked.begins, walked.sizes, strict=True):
            kind = np.dtype(self.order + p.kind)
            places = spread(begins, sizes, kind.itemsize)[:, None] + np.arange(kind.itemsize)
            values = data[places].view(kind).ravel()
            columns.setdefault(p.name, Lists(sizes, values) if p.length_kind else values)
        return Table(columns, _NOWHERE, walked.end)

    def _step(self, entry: Property) -> Step:
        width = int(entry.kind[1])
        return (
            Step(width, self._length(entry.length_kind), int(entry.length_kind[1]))
            if entry.length_kind
            else Step(width)
        )

    def _length(self, count: str) -> Length:
        """Reader of a list's length."""
        if count == "u1":
            return operator.getitem
        code = {"i1": "b", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "i8": "q", "u8": "Q"}[count]
        unpacked = struct.Struct(self.order + code).unpack_from
        return lambda data, at: int(unpacked(data, at)[0])

    def _of_one_length(self, element: Element, at: int) -> Table | None:
        """The rows if all lists of a property are as long as in the first row; None if they are not, or end early."""
        fields: list[Any] = []
        sizes, start = [], at
        for k, p in enumerate(element.properties):
            kind, size = np.dtype(self.order + p.kind), 1
            if p.length_kind:
                held = self.content[start : start + int(p.length_kind[1])]
                if len(held) < int(p.length_kind[1]):
                    return None
                size = int(np.frombuffer(held, self.order + p.length_kind)[0])
                start += len(held)
                if not 0 <= size * kind.itemsize <= len(self.content) - start:
                    return None
                fields.append((f"length {k}", self.order + p.length_kind))
            sizes.append(size)
            start += size * kind.itemsize
            fields.append((f"{k}", kind, (size,)) if p.length_kind else (f"{k}", kind))
        if element.rows * (start - at) > len(self.content) - at:
            if any(p.length_kind for p in element.properties):
                return None
            raise CutShort((len(self.content) - at) // (start - at))
        rows = np.frombuffer(self.content, np.dtype(fields), element.rows, at)
        columns: Columns = {}
        for k, (p, size) in enumerate(zip(element.properties, sizes, strict=True)):
            values = rows[f"{k}"]
            if p.length_kind and (rows[f"length {k}"] != size).any():
                return None
            lists = Lists(np.full(len(rows), size, dtype=np.int64), values.reshape(-1)) if p.length_kind else values
            columns.setdefault(p.name, lists)
        return Table(columns, _NOWHERE, at + element.rows * (start - at))

    def after(self, at: int) -> str:
        """Words on what follows the last element, "" if nothing does."""
        left = self.content[at:]
        return f"{len(left)} bytes after the last element are not read" if left.strip(b"\0\r\n\t ") else ""
