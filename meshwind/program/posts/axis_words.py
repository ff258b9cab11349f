"""The words of axes: where each axis is to stand, in whole last decimals, and the text that leads it there."""

from bisect import bisect_right
from collections.abc import Sequence

import numpy as np

from meshwind.core.cast import Ints
from meshwind.program.machine import Axis, Machine
from meshwind.program.posts.dialect import ALL_INCREMENTS, INCREMENTS, Dialect, decimals_of
from meshwind.program.posts.numbers import numbers


class AxisWords:
    """The words of a machine's axes in n blocks.

    They are made for a stretch of blocks at once, as long as the mandrel's count is set back nowhere in it.

    Attributes
    ----------
    at : list of list of int
        Values (n, axes) of the machine's axes in whole last decimals.
    count : int
        What the mandrel's count was set back by, in whole last decimals.
    """

    def __init__(self, at: Ints, machine: Machine, dialect: Dialect, circuits: Sequence[int]) -> None:
        self.at: list[list[int]] = at.tolist()
        self.count = 0
        self._machine, self._dialect, self._at = machine, dialect, at
        self._decimals = decimals_of(machine, dialect)
        self._unit = 10**self._decimals
        self._ends = [*circuits, len(at)]
        self._stretch = 0, 0
        self._texts: list[list[str]] = []

    def set_back(self, by: int) -> None:
        """Take off the mandrel's count."""
        self.count += by
        self._stretch = 0, 0

    def told(self, k: int, index: int, last: int) -> str:
        """The word of axis k that moves to a block from another one, the last that it moved to."""
        if last != index - 1:
            move = self.at[index][k] - self.at[last][k]
            return self._of(k, np.array([self.at[index][k]]), np.array([move]))[0]
        first, end = self._stretch
        if not first <= index < end:
            first, end = self._stretch = index, self._ends[bisect_right(self._ends, index)]
            values, before = self._at[first:end].T, self._at[first - 1 : end - 1].T
            self._texts = [self._of(i, to, to - off) for i, (to, off) in enumerate(zip(values, before, strict=True))]
        return self._texts[k][index - first]

    def placed(self, k: int, value: int) -> str:
        """The word of axis k that moves to a value, and not by an increment."""
        if self._machine.axes[k].modulo:
            return self._in_turn(k, np.array([value]), np.array([value]))[0]  # from the mark, by its sign
        return self.counted(k, value - (self.count if self._machine.axes[k].moves == "mandrel" else 0))

    def counted(self, k: int, value: int) -> str:
        """The word of axis k with a value as the controller counts."""
        return self._filled(self._dialect.word, k, np.array([value]))[0]

    def increment(self, k: int, move: int) -> str:
        """The word of axis k that moves by an increment."""
        return self._filled(self._dialect.increment, k, np.array([move]))[0]

    def by_increments(self, axis: Axis) -> bool:
        """Whether an axis moves by increments in this dialect."""
        if self._dialect.turning == ALL_INCREMENTS:
            return True
        return self._dialect.turning == INCREMENTS and axis.moves == "mandrel" and not axis.modulo

    def _of(self, k: int, values: Ints, moves: Ints) -> list[str]:
        """The words of axis k that goes to values (n,) by moves (n,)."""
        axis = self._machine.axes[k]
        if self.by_increments(axis):
            return self._filled(self._dialect.increment, k, moves)
        if axis.modulo:
            return self._in_turn(k, values, moves)
        return self._filled(self._dialect.word, k, values - (self.count if axis.moves == "mandrel" else 0))

    def _in_turn(self, k: int, values: Ints, moves: Ints) -> list[str]:
        """The words of an axis with a modulo."""
        values = values % round((self._machine.axes[k].modulo or 0.0) * self._unit)
        if self._dialect.turned is None or self._dialect.turning == ALL_INCREMENTS:
            return self._filled(self._dialect.word, k, values)
        ways = [self._filled(text, k, values) for text in self._dialect.turned]
        return [forth if move >= 0 else back for forth, back, move in zip(*ways, moves.tolist(), strict=True)]

    def _filled(self, text: str, k: int, values: Ints) -> list[str]:
        """A text with the letter of axis k and each of values (n,) in it."""
        before, _, after = text.format(letter=self._machine.axes[k].letter, value="\0").partition("\0")
        return [f"{before}{value}{after}" for value in numbers(values, self._decimals)]
