"""An interpreter of KUKA's robot language: straight moves, speeds, waits and the stop."""

import math
import re

from meshwind.program.machine import Machine
from meshwind.program.readback.controllers import Controller
from meshwind.program.readback.reading import NUMBER, Interpreter

_LINEAR = re.compile(r"LIN \{(?:E6POS: )?([^{}]*)\}( C_DIS)?")
_PART = re.compile(rf"([XYZABC]|E[1-6]) ({NUMBER})")
_SPEED = re.compile(rf"\$VEL(\.CP|\.ORI1|_EXTAX\[\d\])=({NUMBER})")
_WAIT = re.compile(rf"WAIT SEC ({NUMBER})")
_SILENT = re.compile(
    r"DEF \w+\( ?\)|BAS ?\(#INITMOV,0\)|\$BASE=BASE_DATA\[\d+\]|\$TOOL=TOOL_DATA\[\d+\]|PTP \$AXIS_ACT"
    rf"|\$APO\.CDIS={NUMBER}"
)
_ARM = "XYZABC"


class Krl(Interpreter):
    """The state of a robot."""

    def __init__(self, machine: Machine, controller: Controller) -> None:
        super().__init__(machine, controller)
        self.at = {axis.letter: axis.zero for axis in machine.axes if axis.moves == "mandrel"}
        self.speeds: dict[str, float] = {}

    def carry_out(self, number: int, text: str) -> None:
        """Carry out a line."""
        if _SILENT.fullmatch(text):
            return
        if found := _SPEED.fullmatch(text):
            self.speeds[found[1]] = float(found[2])
        elif found := _LINEAR.fullmatch(text):
            self._move(number, found[1])
        elif found := _WAIT.fullmatch(text):
            self.done(number, self._values(), float(found[1]))
        elif text == "HALT":
            self.stop(number, self._values())
        elif text == "END":
            self.over = True
        else:
            self.fault(number, f"{text!r} is not understood")

    def _values(self) -> list[float]:
        return [self.at.get(axis.letter, math.nan) for axis in self.machine.axes]

    def _move(self, number: int, point: str) -> None:
        """Move to a point."""
        if re.sub(_PART, "", point).strip(", "):
            self.fault(number, f"{point!r} is not a point")
            return
        parts = {letter: float(value) for letter, value in _PART.findall(point)}
        before = dict(self.at)
        modulo = {axis.letter: axis.modulo for axis in self.machine.axes if axis.modulo}
        for letter, value in parts.items():
            if letter in modulo and letter in self.at:  # an endless axis takes the shorter way
                away = (value - self.at[letter]) % modulo[letter]
                self.at[letter] += away - modulo[letter] if away > modulo[letter] / 2.0 else away
            else:
                self.at[letter] = value
        if not self.running:
            return
        named = {axis.letter for axis in self.machine.axes}
        strange = [letter for letter in parts if letter not in named and self.at[letter] != before.get(letter)]
        if strange or not set(_ARM) <= parts.keys():
            self.fault(number, f"the arm's {', '.join(strange) or 'pose'} is open or moves for no axis")
        seconds = self._seconds(before)
        if seconds is None:
            self.fault(number, "no speed above 0")
            return
        self.done(number, self._values(), seconds)

    def _seconds(self, before: dict[str, float]) -> float | None:
        """Seconds of a move by the speed of the first kind of axis that moves; None if it has none."""
        away = {letter: value - before.get(letter, value) for letter, value in self.at.items()}
        lengths = {
            ".CP": math.hypot(*(away.get(letter, 0.0) for letter in "XYZ")),
            "_EXTAX": math.hypot(*(move for letter, move in away.items() if letter[0] == "E")),
            ".ORI1": math.hypot(*(away.get(letter, 0.0) for letter in "ABC")),
        }
        kind = next((kind for kind, length in lengths.items() if length > 0.01 * self.controller.digit), None)
        if kind is None:
            return 0.0
        if kind == "_EXTAX":
            axis = next(each for each in self.machine.axes if away.get(each.letter) and each.letter[0] == "E")
            speed = self.speeds.get(f"_EXTAX[{axis.letter[1:]}]", 0.0) / 100.0 * axis.speed
        else:
            speed = self.speeds.get(kind, 0.0) * (1000.0 if kind == ".CP" else 1.0)
        return lengths[kind] / speed if speed > 0.0 else None
