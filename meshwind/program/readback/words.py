"""An interpreter of word addresses (G, M, F and axes): modal state, counts that are set anew, increments, feeds."""

import math
import re

from meshwind.program.machine import Machine
from meshwind.program.readback.controllers import Controller
from meshwind.program.readback.reading import NUMBER, Interpreter

_ADDRESS = rf"([A-Z]\d*)=(?:(IC|ACP|ACN)\(({NUMBER})\)|({NUMBER}))|([A-Z])\s*({NUMBER})"
_WORD = re.compile(_ADDRESS)
"""A word: its name, how it is approached, the value by that or as it is; or its letter and its value."""
_WORDS = re.compile(rf"(?:(?>[A-Z]\d*=(?:(?:IC|ACP|ACN)\({NUMBER}\)|{NUMBER})|[A-Z]\s*{NUMBER})\s*+)*+")
"""Words in a row, in which each is read as it stands: trying to read it otherwise would take ages."""
_MODES = {"G0": "rapid", "G1": "feed"}
_SILENT = {"G17", "G21", "G40", "G49", "G64", "G80", "G710"}
"""Words that move nothing and whose state the program does not depend on; all lengths are in mm."""
_FEEDS = {"G93": True, "G94": False}
_STOP = "M0"


class Words(Interpreter):
    """The state of a controller of word addresses."""

    def __init__(self, machine: Machine, controller: Controller) -> None:
        super().__init__(machine, controller)
        self.axes = {axis.letter: k for k, axis in enumerate(machine.axes)}
        # the operator sets the mandrel on its mark; where the others stand is not known
        self.at = [axis.zero if axis.moves == "mandrel" else math.nan for axis in machine.axes]
        self.offset = [0.0] * len(machine.axes)
        self.mode, self.relative, self.inverse = "", False, False
        self.feed = math.nan

    def carry_out(self, number: int, text: str) -> None:
        """Carry out a line."""
        if not _WORDS.fullmatch(text):
            self.fault(number, f"{text!r} is not understood")
            return
        codes, moves, others = [], {}, {}
        for name, way, by, value, letter, plain in _WORD.findall(text):
            if letter == "G" or letter == "M":
                codes.append(f"{letter}{float(plain):g}")
                continue
            wanted, index = float(plain or value or by), self.axes.get(letter or name)
            if index is None:
                others[letter or name] = wanted
            elif index in moves:
                self.fault(number, "an axis is named twice")
            else:
                moves[index] = wanted, way
        self._modes(number, codes)
        if "G4" in codes:
            self._wait(number, others.pop(self.controller.wait, math.nan))
        elif "G92" in codes:
            for index, (count, _) in moves.items():
                self.offset[index] = self.at[index] - count
        else:
            if "G64" in codes:
                others.pop("P", None)
            given = others.pop("F", None)
            if given is not None:
                self.feed = given
            if moves:
                self._move(number, moves, given)
        if others:
            self.fault(number, f"no axis or word {', '.join(others)}")

    def _modes(self, number: int, codes: list[str]) -> None:
        """Take over the modal words of a line."""
        for code in codes:
            if code in _MODES:
                self.mode = _MODES[code]
            elif code in ("G90", "G91"):
                self.relative = code == "G91"
            elif code in _FEEDS and (self.controller.inverse or not _FEEDS[code]):
                self.inverse, self.feed = _FEEDS[code], math.nan
            elif code == _STOP:
                self.stop(number, list(self.at))
            elif code in self.controller.ends:
                self.over = True
            elif code not in _SILENT and code not in ("G4", "G92"):
                self.fault(number, f"{code} is not known")

    def _wait(self, number: int, time: float) -> None:
        """Stand still."""
        if not time > 0.0:
            self.fault(number, "a wait without a time")
            return
        self.done(number, list(self.at), time * self.controller.wait_unit)

    def _move(self, number: int, moves: dict[int, tuple[float, str]], given: float | None) -> None:
        """Move axes."""
        before = self.at
        self.at = before.copy()
        for index, (value, way) in moves.items():
            self.at[index] = self._target(index, value, way)
        if self.mode == "rapid":
            if self.running:
                self.fault(number, "a rapid move while the fibre is laid")
            return
        if self.mode != "feed" or not self.running:
            self.fault(number, "a move at a feed before the stop, or in no mode")
            return
        feed = given if self.inverse else self.feed
        if feed is None or not feed > 0.0:
            self.fault(number, "no feed above 0")
            return
        if self.inverse:
            seconds = feed if self.machine.feed == "G93-seconds" else 60.0 / feed
        else:
            seconds = 60.0 * self._length(before) / feed
        self.done(number, self.at, seconds)

    def _length(self, before: list[float]) -> float:
        """Length in units that F is the speed of."""
        for kind in self.controller.kinds:
            length = math.sqrt(sum(
                (self.at[k] - before[k]) ** 2 for letter, k in self.axes.items() if letter[0] in kind
            ))  # fmt: skip
            if length > 0.01 * self.controller.digit:  # above the round-off of counts that are set anew
                return length
        return 0.0

    def _target(self, index: int, wanted: float, way: str) -> float:
        """Where an axis goes, in the machine's own unwrapped count."""
        axis, now = self.machine.axes[index], self.at[index]
        if way == "IC" or (self.relative and not way):
            return now + wanted
        if math.isnan(now) and (way or axis.modulo):  # how often it has turned before is not known
            return abs(wanted)
        if way:
            return turned(now, wanted, axis.modulo or 360.0, forwards=way == "ACP")
        if axis.modulo:
            return turned(now, abs(wanted), axis.modulo, forwards=math.copysign(1.0, wanted) > 0.0)
        return wanted + self.offset[index]


def turned(now: float, wanted: float, modulo: float, forwards: bool) -> float:
    """Where an axis that counts to a modulo comes to stand as it turns to a value, in one direction."""
    ahead = (wanted - now) % modulo
    close = 1e-9 * modulo  # the same place, but for round-off
    if ahead < close or ahead > modulo - close:
        return now
    return now + ahead if forwards else now + ahead - modulo
