"""Numbers in the lines of data of a deck."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.deck.blocks import Block

_PIECE = 4_000_000
"""Bytes that are taken apart at a time, which bounds the memory."""
_LARGEST = 1e100
"""Largest size of a number: squares and products of larger ones are not finite."""
_EXPONENT_E = bytes.maketrans(b"dD", b"eE")
_BLANK = b" \t\v\f"
_EXPONENT = re.compile(rb"(?i)^([+-]?(?:\d+\.?\d*|\.\d+))([+-]\d+)$")
"""Numbers as Fortran also writes them: 1.0+3 for 1.0E+3."""


@dataclass(frozen=True)
class Numbers:
    """Numbers of a block, one line after the other: of line k those from `start[k]` on, (lines + 1,) in all.

    continued: whether a line ends with a comma; blank lines and remarks are left out.
    """

    values: Any
    start: Ints
    continued: Bools

    def table(self, width: int) -> Floats:
        """The first numbers of each line, filled with 0."""
        count = np.diff(self.start)
        if len(count) and (count == count[0]).all():
            rows = self.values.reshape(len(count), -1)[:, :width]
            return np.asarray(np.pad(rows, ((0, 0), (0, max(0, width - rows.shape[1])))))
        filled = np.zeros((len(count), width), dtype=self.values.dtype)
        for column in range(width):
            has = count > column
            filled[has, column] = self.values[self.start[:-1][has] + column]
        return filled

    def rows(self) -> list[list[float]]:
        """The numbers as lists, for blocks of few lines."""
        given, start = self.values.tolist(), self.start.tolist()
        return [given[a:b] for a, b in pairwise(start)]


def floats_of(block: Block) -> Numbers:
    """Numbers of a block; an empty field is 0.  Raises BadInputError."""
    return _numbers(block, float, np.dtype(np.float64))


def ints_of(block: Block) -> Numbers:
    """Whole numbers of a block; an empty field is 0.  Raises BadInputError."""
    return _numbers(block, int, np.dtype(np.int64))


def first_ints_of(block: Block) -> Ints:
    """The first number of each line that no comma joins to the one before; 0 where it is none."""
    starts, joined = [], False
    for line in block.data.split(b"\n"):
        text = line.strip()
        if text and not text.startswith(b"**"):
            if not joined:
                word = text.partition(b",")[0].strip()
                starts.append(int(word) if word.isdigit() and len(word) < 19 else 0)
            joined = text.endswith(b",")
    return np.array(starts, dtype=np.int64)


def line_of(block: Block, row: int) -> tuple[int, str]:
    """Number and text, shortened, of a line of data that is neither blank nor a remark."""
    seen = -1
    for number, line in enumerate(block.data.split(b"\n"), block.first):
        text = line.strip()
        seen += bool(text.strip(b", \t") and not text.startswith(b"**"))
        if seen == row:
            return number, repr(text[:40].decode("utf-8", "replace"))
    return block.line, "''"


def _numbers(block: Block, number: Callable[[bytes], float], kind: np.dtype[Any]) -> Numbers:
    parts: list[Any] = []
    counts: list[Ints] = []
    commas: list[Bools] = []
    data, at = block.data, 0
    while at < len(data):
        end = data.find(b"\n", at + _PIECE) + 1 or len(data)
        piece, at = data[at:end], end
        given = [line for each in piece.split(b"\n") if (line := each.strip(_BLANK))]
        if b"*" in piece:
            given = [line for line in given if not line.startswith(b"**")]
        lines = [line.rstrip(b", \t") for line in given]
        if b"" in lines:
            given = [line for line in given if line.strip(b", \t")]
            lines = [line for line in lines if line]
        text = b"\n".join(lines)
        plain = text.replace(b"\n", b",")
        words = (plain.translate(_EXPONENT_E) if number is float else plain).split(b",") if lines else []
        try:
            if b"_" in piece:  # Python would take 1_0 for 10
                raise ValueError
            values = np.fromiter(map(number, words), kind, len(words))
        except (ValueError, OverflowError):
            values = np.array([_mended(word, number, block, sum(map(len, counts)), lines) for word in words], kind)
        if not ((values <= _LARGEST) & (values >= -_LARGEST)).all():
            raise block.refusal("has a number that is not finite, or too large; mend it")
        parts.append(values)
        counts.append(_words_of_lines(text))
        commas.append(_last_characters(b"\n".join(given)) == ord(","))
    start = np.cumsum(np.concatenate([np.zeros(1, dtype=np.int64), *counts]))
    return Numbers(np.concatenate([*parts, np.empty(0, kind)]), start, np.concatenate([*commas, np.empty(0, np.bool_)]))


def _words_of_lines(text: bytes) -> Ints:
    """Number of fields of each line."""
    held = np.frombuffer(text + b"\n", dtype=np.uint8)
    ends = np.searchsorted(np.flatnonzero(held == ord(",")), np.flatnonzero(held == ord("\n")))
    return np.diff(ends, prepend=0) + 1 if text else np.empty(0, dtype=np.int64)


def _last_characters(text: bytes) -> Any:
    """Codes of the last character of each line; no line is empty."""
    held = np.frombuffer(text + b"\n", dtype=np.uint8)
    return held[np.flatnonzero(held == ord("\n")) - 1] if text else held[:0]


def _mended(word: bytes, number: Callable[[bytes], float], block: Block, before: int, lines: list[bytes]) -> float:
    """Number of a field that is empty or written as Fortran does.  Raises BadInputError if it is none."""
    text = word.strip()
    try:
        if b"_" in text:
            raise ValueError
        if not text:
            return 0
        found = _EXPONENT.match(text) if number is float else None
        value = number(found[1] + b"e" + found[2] if found else text)
        if abs(value) < 2**63:
            return value
    except ValueError:
        pass
    row = next((k for k, line in enumerate(lines) if word in line.split(b",")), 0)
    at, shown = line_of(block, before + row)
    what = "has a parameter in angle brackets, which is not read; write the deck with numbers" if b"<" in text else (
        f"is not all {'whole ' if number is int else ''}numbers; mend it")  # fmt: skip
    raise BadInputError(f"{block.file}: line {at}, {shown}, below *{block.key} {what}")
