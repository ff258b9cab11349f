"""Rows of the elements of PLY files of text."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from meshwind.core.cast import Ints
from meshwind.core.errors import BadInputError
from meshwind.core.lists import spread
from meshwind.mesh.io.face_lists import Lists
from meshwind.mesh.io.lines import Lines, NotANumber
from meshwind.mesh.io.ply.header import Element
from meshwind.mesh.io.ply.rows import Columns, CutShort, Step, Table, walk


class Text:
    """Data of a text file; positions are those of numbers.

    A row may go over several lines, but where rows begin with lines they all do, so that none is taken for another.
    """

    def __init__(self, name: str, body: bytes, lines_before: int) -> None:
        self.name, self.lines_before = name, lines_before
        lines = Lines.of(body)
        filled = lines.filled()
        self.line = np.flatnonzero(filled)
        rows = lines.rows(filled)
        self.sizes = rows.sizes
        try:
            self.values = rows.floats()
        except NotANumber as error:
            raise BadInputError(f"{name}: line {self._number(error.row)} {error.words}") from None
        self._listed: list[float] = []

    def _number(self, row: int) -> int:
        return int(self.line[row]) + 1 + self.lines_before

    def table(self, element: Element, at: int) -> Table:
        """The rows of an element that begins at a number."""
        left = len(self.values) - at
        width, lengths = 0, []  # of a row that is like the first one; at which of its numbers a list's length is
        for p in element.properties:
            if p.length_kind:
                length = float(self.values[at + width]) if width < left else 0.0
                if not (0.0 <= length <= left and length.is_integer()):
                    return self._of_any_length(element, at)
                lengths.append(width)
                width += int(length)
            width += 1
        if element.rows * width <= left:
            rows = self.values[at : at + element.rows * width].reshape(element.rows, width)
            if (rows[:, lengths] == rows[:1, lengths]).all():
                return _of_one_length(element, rows, at)
        elif not lengths:
            raise CutShort(left // width)
        return self._of_any_length(element, at)

    def _of_any_length(self, element: Element, at: int) -> Table:
        if not self._listed:
            self._listed = self.values.tolist()
        steps = [Step(1, list_length if p.length_kind else None, 1) for p in element.properties]
        walked = walk(self._listed, element.rows, steps, at)
        columns: Columns = {}
        for p, begins, sizes in zip(element.properties, walked.begins, walked.sizes, strict=True):
            values = self.values[spread(begins, sizes)]
            columns.setdefault(p.name, Lists(sizes, values) if p.length_kind else values)
        return Table(columns, walked.starts, walked.end)

    def check_rows(self, tables: Sequence[tuple[Element, Table]], end: int) -> None:
        """Refuse rows that do not begin with the lines, unless the lines are broken otherwise and the numbers are all.

        Raises BadInputError.
        """
        starts: Ints = np.concatenate([table.starts for _, table in tables] or [np.zeros(0, dtype=np.int64)])
        begins = np.cumsum(self.sizes) - self.sizes
        known = min(len(starts), len(begins))
        wrong = np.flatnonzero(starts[:known] != begins[:known])
        if not len(wrong) or (len(begins) != len(starts) and end == len(self.values)):
            return
        row = max(int(wrong[0]) - 1, 0)
        place = row
        for element, table in tables:
            if place < len(table.starts):
                raise BadInputError(
                    f"{self.name}: line {self._number(row)} has {self.sizes[row]} numbers, where row {place + 1} of "
                    f"{element.name[:40]!r} has {starts[row + 1] - starts[row]} by the file's header; "
                    "export the mesh again"
                )
            place -= len(table.starts)

    def after(self, at: int) -> str:
        """Words on what follows the last element, "" if nothing does."""
        left = len(self.values) - at
        return f"{left} numbers after the last element are not read" if left else ""


def _of_one_length(element: Element, rows: Any, at: int) -> Table:
    """The table of rows whose lists are as long as those of the first one."""
    columns: Columns = {}
    place = 0
    for p in element.properties:
        values = rows[:, place]
        if p.length_kind:
            size = int(values[0]) if len(values) else 0
            values = Lists(np.full(len(rows), size, dtype=np.int64), rows[:, place + 1 : place + 1 + size].reshape(-1))
            place += size
        columns.setdefault(p.name, values)
        place += 1
    return Table(columns, at + rows.shape[1] * np.arange(len(rows)), at + rows.size)


def list_length(data: Any, at: int) -> int:
    """Length of a list.  Raises ValueError if it is not whole, or longer than the data."""
    length = float(data[at])
    if not (0.0 <= length <= len(data) and length.is_integer()):
        raise ValueError(f"has a list of {length:g} numbers")
    return int(length)
