"""Lines of text files as arrays: those that begin with a word, and the numbers in them, without a loop over lines."""

import re
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshwind.core.cast import Bools, Floats, Ints

Bytes = NDArray[np.uint8]
JOINED = 1
"""Byte that stands for the end of a line that the next one continues."""
_BLANK, _END = 32, 10
_AS_BLANKS = bytes.maketrans(b"\t\v\f", b"   ")
_FORTRAN = bytes.maketrans(b"Dd", b"ee")
_MAX_INDENT = 64
_NO_NUMBER = re.compile(
    rb"(?<!\S)(?!(?:[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|[+-]?(?i:nan|inf|infinity))(?!\S))\S+"
)
_NOT_WHOLE = re.compile(rb"(?<!\S)(?![+-]?\d+(?!\S))\S+")
_DECIMAL_COMMA = re.compile(r"[-+]?\d*,\d+(?:[eE][-+]?\d+)?")


class NotANumber(ValueError):
    """A word that should be a number: in which of the rows, counted from 0, and what it is."""

    def __init__(self, row: int, word: str) -> None:
        advice = "write numbers with decimal points" if _DECIMAL_COMMA.fullmatch(word) else "export the mesh again"
        super().__init__(f"{word[:40]!r} is no number")
        self.row, self.words = row, f"has {word[:40]!r} where a number should be; {advice}"


@dataclass(frozen=True)
class Rows:
    """Some lines one after the other, each with its end, and where each of them begins."""

    text: Bytes
    start: Ints

    @cached_property
    def sizes(self) -> Ints:
        """How many words each row has."""
        blank = self.text <= _BLANK
        words = np.flatnonzero(blank[:-1] & ~blank[1:]) + 1
        before = np.searchsorted(words, self.start)
        if len(self.text) and not blank[0]:
            before[1:] += 1
        return np.diff(before, append=len(words) + bool(len(self.text) and not blank[0]))

    def floats(self) -> Floats:
        """All numbers, row by row; exponents may be those of Fortran.  Raises NotANumber."""
        return self._numbers(self.text.tobytes().translate(_FORTRAN), np.float64)

    def ints(self) -> Ints:
        """All whole numbers, row by row; too large ones become the largest.  Raises NotANumber."""
        return self._numbers(self.text.tobytes(), np.int64)

    def _numbers(self, text: bytes, kind: Any) -> Any:
        if not text.strip():
            return np.zeros(0, dtype=kind)
        try:
            numbers = np.fromstring(text, dtype=kind, sep=" ")
        except (ValueError, DeprecationWarning):
            numbers = np.zeros(0, dtype=kind)
        if len(numbers) == self.sizes.sum():  # NumPy passes over a sign without a number
            return numbers
        found = _NO_NUMBER.search(text) or _NOT_WHOLE.search(text)
        at, word = (0, b"") if found is None else (found.start(), found[0])
        row = int(np.searchsorted(self.start, at, side="right")) - 1
        raise NotANumber(row, word.decode("latin-1"))


@dataclass(frozen=True)
class Lines:
    """The lines of a text: where each begins, where its first word begins with what byte, and where its end is.

    The first byte is that of the line's end if there is no word.
    """

    text: Bytes
    start: Ints
    first: Ints
    end: Ints
    initial: Bytes

    @classmethod
    def of(cls, content: bytes) -> "Lines":
        """The lines of a text that are ended by line feeds; tabs count as blanks."""
        content = content.translate(_AS_BLANKS)
        if not content.endswith(b"\n"):
            content += b"\n"
        text = np.frombuffer(content, dtype=np.uint8)
        end = np.flatnonzero(text == _END)
        start = np.concatenate([[0], end[:-1] + 1])
        first = _past_blanks(text, start)
        return cls(text, start, first, end, text[first])

    def filled(self) -> Bools:
        """Lines with a word."""
        return self.first < self.end

    def number(self, line: int) -> int:
        """Number from 1 of a line, counted from 0, in the file: lines that were joined count as they are written."""
        return line + 1 + int(np.count_nonzero(self.text[: self.first[line]] == JOINED))

    def begin_with(self, word: bytes, whole: bool = True) -> Bools:
        """Lines whose first word is `word`, or with `whole` false begins with it."""
        found = np.flatnonzero(self.initial == word[0])
        found = found[self.end[found] - self.first[found] >= len(word)]
        for place, letter in enumerate(word[1:], 1):
            found = found[self.text[self.first[found] + place] == letter]
        if whole:
            found = found[self.text[self.first[found] + len(word)] <= _BLANK]
        marks = np.zeros(len(self.first), dtype=bool)
        marks[found] = True
        return marks

    def words(self, line: int) -> list[bytes]:
        """The words of one line."""
        return bytes(self.text[self.first[line] : self.end[line]]).replace(bytes([JOINED]), b" ").split()

    def rows(self, which: Bools, skip: int = 0) -> Rows:
        """Some lines, each without the first `skip` bytes of its first word."""
        length = self.end + 1 - self.start
        text = self.text[np.repeat(which, length)] if not which.all() else self.text.copy()
        start = np.cumsum(length[which]) - length[which]
        key = start + (self.first - self.start)[which]
        for place in range(skip):
            text[key + place] = _BLANK
        text[text == JOINED] = _BLANK
        return Rows(text, start)


def _past_blanks(text: Bytes, start: Ints) -> Ints:
    """Positions of the first bytes from each start on that are no blank."""
    first = start.copy()
    moving = np.flatnonzero(text[first] == _BLANK)
    for _ in range(_MAX_INDENT):
        if not len(moving):
            return first
        first[moving] += 1
        moving = moving[text[first[moving]] == _BLANK]
    solid = np.flatnonzero(text != _BLANK)
    first[moving] = solid[np.searchsorted(solid, first[moving])]
    return first


def without_comments(content: bytes) -> bytes:
    """A text without what follows # in each line."""
    return re.sub(rb"#[^\n]*", b"", content) if b"#" in content else content
