"""The one writer of programs: blocks and a machine in, the text of a dialect out."""

import math
import re
from collections.abc import Sequence

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.program.axes import moved
from meshwind.program.blocks import Blocks
from meshwind.program.machine import Machine
from meshwind.program.posts.axis_words import AxisWords
from meshwind.program.posts.dialect import RESET, Dialect, decimals_of, fitted
from meshwind.program.posts.header import Job, comments, header
from meshwind.program.posts.numbers import figures, numbers, steps

_TURN = 360.0
_LEAST_WAIT = 1e-3
"""Seconds of standing still below which the next move takes them."""
_LEAST_TIME = 1e-6
"""Seconds of a move below which it is part of the next one: no controller works through more blocks."""
_APPROACH = 0.1
"""Share of the slowest axis's speed at which the eye approaches where rapid moves need a speed."""


def program_text(blocks: Blocks, machine: Machine, dialect: Dialect, job: Job) -> str:
    """The program in the words of a dialect; raises BadInputError if the dialect cannot say it."""
    writer = _Writer(blocks, fitted(machine, dialect), dialect, job)
    writer.begin()
    for index in range(1, len(blocks)):
        writer.block(index)
    writer.lines += writer.filled(dialect.end)
    return "\n".join(_numbered(writer.lines, dialect)) + "\n"


def machine_values(blocks: Blocks, machine: Machine, millimetres: float) -> Floats:
    """Values (n, axes) that the machine's axes have in the blocks, in mm and degrees."""
    return np.stack([axis.sign * moved(blocks, axis.moves, millimetres) + axis.zero for axis in machine.axes], axis=1)


class _Writer:
    """A program that grows: its lines, where the axes stand in whole last decimals, and the time that it has said."""

    def __init__(self, blocks: Blocks, machine: Machine, dialect: Dialect, job: Job) -> None:
        values = machine_values(blocks, machine, job.millimetres)
        if len(blocks) < 2 or not (np.isfinite(values).all() and np.isfinite(blocks.time).all()):
            raise BadInputError("the program holds fewer than two blocks or numbers that are not finite; wind it again")
        self.blocks, self.machine, self.dialect, self.job = blocks, machine, dialect, job
        decimals = decimals_of(machine, dialect)
        self.unit = 10**decimals
        self.mandrel = next(k for k, axis in enumerate(machine.axes) if axis.moves == "mandrel")
        at = steps(values, decimals)
        turn = round(_TURN) * self.unit
        zero = round(machine.axes[self.mandrel].zero * self.unit)
        # the part does not know how often it was turned before: whole turns at the start are left out
        at[:, self.mandrel] -= turn * int(np.fix((at[0, self.mandrel] - zero) / turn))
        self.time: list[float] = blocks.time.tolist()
        changes = np.flatnonzero((np.diff(blocks.circuit) != 0) | (np.diff(blocks.layer) != 0)) + 1
        self.circuits = set(changes.tolist())
        self.axes = AxisWords(at, machine, dialect, changes.tolist())
        self.at = self.axes.at
        self.layers = set((np.flatnonzero(np.diff(blocks.layer) != 0) + 1).tolist())
        self.cuts = {cut + 1: (number, tied) for number, (cut, tied) in enumerate(blocks.travels.tolist(), 1)}
        self.ties = {tied: number for number, tied in self.cuts.values()}
        self.tensions = set((np.flatnonzero(np.diff(blocks.tension) != 0) + 1).tolist()) if machine.tension else set()
        self.events = self.circuits | self.layers | self.tensions | self.cuts.keys() | self.ties.keys()
        self.lines: list[str] = []
        self.last = 0
        self.said = self.time[0]

    def filled(self, lines: Sequence[str]) -> list[str]:
        """Lines of the dialect with letters and mode filled in."""
        letters = ",".join(axis.letter for axis in self.machine.axes)
        return [line.format(letters=letters, mode=self.machine.feed.removesuffix("-seconds")) for line in lines]

    def begin(self) -> None:
        """The header, the approach, and the stop before the program."""
        self.lines += [*self.dialect.head, *header(self.blocks, self.machine, self.dialect, self.job)]
        self.lines += self.filled(self.dialect.start)
        axis, first = self.machine.axes[self.mandrel], self.at[0]
        zero = round(axis.zero * self.unit)
        if self.dialect.turning == RESET and not axis.modulo:
            self.lines.append(self.dialect.reset.format(axes=self.axes.counted(self.mandrel, zero)))
        turns = self.axes.by_increments(axis)
        for chosen, stop in self._stops(turns):
            words = [self.axes.placed(k, stop[k]) for k in chosen]
            speed = 60.0 * _APPROACH * min(each.speed for each in self.machine.axes)
            self._say(self.dialect.rapid.format(axes=self._joined(words), rapid=figures(speed)))
        if turns and first[self.mandrel] != zero:
            word = self.axes.increment(self.mandrel, first[self.mandrel] - zero)
            self.lines.append(self.dialect.rapid_turn.format(axes=word))
        self.lines += [self.dialect.pause, *self.filled(self.dialect.ready)]
        self._layer(0)
        self._tension(0)

    def _stops(self, turns: bool) -> list[tuple[Sequence[int], list[int]]]:
        """The axes and places of the approach: the eye first goes out as far as it ever does.

        turns: whether the mandrel is left to an increment.
        """
        first, every = self.at[0], range(len(self.machine.axes))
        chosen = [k for k in every if not (turns and k == self.mandrel)]
        cross = next((k for k, each in enumerate(self.machine.axes) if each.moves == "cross"), None)
        if cross is None:
            return [(chosen, first)]
        clear = list(first)
        clear[cross] = (max if self.machine.axes[cross].sign > 0 else min)(row[cross] for row in self.at)
        if self.dialect.whole:  # an arm moves as a whole
            return [(every, clear), (every, first)]
        return [([cross], clear), ([k for k in chosen if k != cross], clear), ([cross], first)]

    def block(self, index: int) -> None:
        """The lines of a block, none where no axis moves by a last decimal."""
        if index in self.events:
            self._event(index)
        now, stood = self.at[index], self.at[self.last]
        end = index == len(self.at) - 1
        if now == stood:
            if end:
                self._wait(self.time[index])
            return
        if index - 1 > self.last:
            self._wait(self.time[index - 1])
        seconds = self.time[index] - self.said
        if seconds < _LEAST_TIME and not end:
            return
        self._move(index, max(seconds, _LEAST_TIME))
        self.last = index

    def _event(self, index: int) -> None:
        """The lines before a block with which something begins."""
        if index in self.cuts or index in self.ties:
            self._stop(index)
        if index in self.layers:
            self._layer(index)
        if index in self.circuits:
            self._count_again()
        if index in self.tensions - self.cuts.keys() - self.ties.keys():
            self._tension(index)

    def _move(self, index: int, seconds: float) -> None:
        """A move to a block that takes some seconds."""
        now, stood = self.at[index], self.at[self.last]
        moves = [one - other for one, other in zip(now, stood, strict=True)]
        if self.machine.feed == "G94":
            feed, told = self._speed(moves, seconds)
        elif self.machine.feed == "G93":
            text = figures(60.0 / seconds)
            feed, told = f"F{text}", 60.0 / float(text)
        else:
            text = figures(seconds)
            feed, told = f"F{text}", float(text)
        chosen = [k for k, move in enumerate(moves) if move or self.dialect.whole]
        words = [self.axes.told(k, index, self.last) for k in chosen]
        self._say(self.dialect.move.format(axes=self._joined(words), feed=feed))
        self.said += told

    def _speed(self, moves: list[int], seconds: float) -> tuple[str, float]:
        """The word of the speed at which axes move so far in some seconds, and the seconds by its figures."""
        for speeds in self.dialect.speeds:
            axes = self.machine.axes
            chosen = [k for k in range(len(axes)) if moves[k] and re.fullmatch(speeds.letters, axes[k].letter)]
            if not chosen:
                continue
            length = math.hypot(*(moves[k] for k in chosen)) / self.unit
            axis = axes[chosen[0]]
            factor = speeds.factor / axis.speed if speeds.share else speeds.factor
            text = figures(length * 60.0 * factor / seconds)
            digits = re.sub(r"\D", "", axis.letter)
            return speeds.text.format(feed=text, number=digits), length * 60.0 * factor / float(text)
        raise BadInputError(f"{self.dialect.words} has no speed for the axes; give letters that it knows")

    def _wait(self, until: float) -> None:
        """Stand still until a time."""
        wait = until - self.said
        if wait < _LEAST_WAIT:
            return
        count = round(wait / self.dialect.dwell_unit * 10**self.dialect.dwell_decimals)
        self._say(self.dialect.dwell.format(wait=numbers(np.array([count]), self.dialect.dwell_decimals)[0]))
        self.said += count * self.dialect.dwell_unit / 10**self.dialect.dwell_decimals

    def _count_again(self) -> None:
        """Take whole turns off the mandrel's count, where a block ends."""
        axis = self.machine.axes[self.mandrel]
        if self.dialect.turning != RESET or axis.modulo:
            return
        turn, now = round(_TURN) * self.unit, self.at[self.last][self.mandrel] - self.axes.count
        if abs(now) >= turn:
            taken = turn * int(math.copysign(abs(now) // turn, now))
            self.axes.set_back(taken)
            self._say(self.dialect.reset.format(axes=self.axes.counted(self.mandrel, now - taken)))

    def _stop(self, index: int) -> None:
        """The stops at which the operator cuts the fibre, with no pull on it any more, and ties it on again."""
        self._wait(self.time[index - 1])
        if index in self.cuts:
            self._tension(index)
            words = f"filament {self.cuts[index][0]} of {len(self.cuts) + 1} is done: cut the fibre"
        else:
            words = f"tie on the fibre of filament {self.ties[index] + 1}"
        self.lines += [*comments(words, self.dialect), self.dialect.pause]
        if index in self.ties:
            self._tension(index)

    def _tension(self, index: int) -> None:
        """The command of the tension from a block on."""
        tension = float(self.blocks.tension[index])
        if not self.machine.tension or not self.blocks.tension.any():
            return
        self._say(self.machine.tension.format(tension=tension))

    def _layer(self, index: int) -> None:
        self.lines += comments(f"layer {int(self.blocks.layer[index]) + 1}", self.dialect)

    def _joined(self, words: list[str]) -> str:
        """The words of axes; with the fixed ones, and in the dialect's order, where it names all."""
        if self.dialect.whole:
            taken = {axis.letter for axis in self.machine.axes}
            words = words + [
                self.dialect.word.format(letter=letter, value=f"{value:.1f}")
                for letter, value in self.dialect.fixed if letter not in taken
            ]  # fmt: skip
            words.sort(key=lambda word: "XYZABCE".index(word[0]))
        return self.dialect.between.join(words)

    def _say(self, text: str) -> None:
        """Add lines; raises BadInputError if the controller would cut one off."""
        for line in text.split("\n"):
            if len(line) > self.dialect.longest:
                raise BadInputError(
                    f"a line for {self.dialect.words} is over {self.dialect.longest} characters: {line!r}; give a "
                    "machine of fewer axes or a shorter command"
                )
            self.lines.append(line)


def _numbered(lines: list[str], dialect: Dialect) -> list[str]:
    """Lines with their numbers, but for the head and comments."""
    if not dialect.numbers:
        return lines
    mark = dialect.comment.split("{")[0]
    made, next_ = [], dialect.numbers
    for line in lines:
        if line in dialect.head or line == "%" or line.startswith(mark):
            made.append(line)
            continue
        made.append(f"N{next_} {line}")
        next_ = next_ + dialect.numbers if next_ + dialect.numbers <= dialect.highest else dialect.numbers
    return made
