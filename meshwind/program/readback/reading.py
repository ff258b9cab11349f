"""What a text makes a machine do, and what all interpreters have in common."""

import math
import re
from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.program.machine import Machine
from meshwind.program.readback.controllers import Controller

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)"
"""A number as controllers read it: without exponent."""


@dataclass(frozen=True)
class Reading:
    """The m moves and waits of a text after its first stop, and its faults.

    Attributes
    ----------
    start : ndarray of float, shape (axes,)
        Values of the machine's axes before the first of them, in mm and degrees; NaN where the text leaves one open.
    line : ndarray of int, shape (m,)
        Numbers of their lines, from 1.
    values : ndarray of float, shape (m, axes)
        Values of the axes after each, unwrapped.
    seconds : ndarray of float, shape (m,)
        Time that each takes.
    tension : ndarray of float, shape (m,)
        Tension in force, NaN where none was set.
    stops : tuple of (int, int)
        Line of each stop after the first, and the number of moves and waits before it.
    faults : tuple of (int, str)
        Lines that a controller would refuse, with the reason.
    """

    start: Floats
    line: Ints
    values: Floats
    seconds: Floats
    tension: Floats
    stops: tuple[tuple[int, int], ...]
    faults: tuple[tuple[int, str], ...]


class Interpreter(ABC):
    """The state of a controller that reads a text line by line: what it did, and what it would refuse."""

    def __init__(self, machine: Machine, controller: Controller) -> None:
        self.machine, self.controller = machine, controller
        self.running = self.over = False
        self.start = [math.nan] * len(machine.axes)
        self.tension = math.nan
        # of each move or wait: line, seconds, tension, and the values of all axes in a row
        self.line: list[int] = []
        self.seconds: list[float] = []
        self.tensions: list[float] = []
        self.values: list[float] = []
        self.stops: list[tuple[int, int]] = []
        self.faults: list[tuple[int, str]] = []
        before, _, after = machine.tension.partition("{")
        tension = re.escape(before) + f"({NUMBER})" + re.escape(after.partition("}")[2])
        self._comment = re.compile(controller.comment)
        letters = "|".join(re.escape(axis.letter) for axis in machine.axes)
        longer = rf"(?:{letters})[ =(IC]*[-+]?\d*\.\d{{{controller.decimals(machine) + 1},}}"
        self._longer = re.compile(longer) if controller.rounds else None
        self._tension = re.compile(tension) if machine.tension else None

    @abstractmethod
    def carry_out(self, number: int, text: str) -> None:
        """Do what a line says, of which comments are taken off."""

    def read(self, number: int, line: str) -> None:
        """Read a line."""
        if len(line) > self.controller.longest:
            self.fault(number, f"{len(line)} characters, of which {self.controller.longest} are read")
        if not line.isascii():
            self.fault(number, "a character that is not ASCII")
        text = self._comment.sub("", line.strip()).strip()
        if not text:
            return
        if self._longer and self._longer.search(text):
            held = self.controller.decimals(self.machine)
            self.fault(number, f"more than the {held} decimals that the control takes")
        if self.over:
            self.fault(number, f"{text!r} comes after the end")
        if self._tension and (found := self._tension.fullmatch(text)):
            self.tension = float(found[1])
        else:
            self.carry_out(number, text)

    def fault(self, number: int, words: str) -> None:
        """Note a fault in a line."""
        self.faults.append((number, words))

    def stop(self, number: int, values: list[float]) -> None:
        """Wait for the operator; the program begins with the first time."""
        if self.running:
            self.stops.append((number, len(self.line)))
        else:
            self.running, self.start = True, values

    def done(self, number: int, values: list[float], seconds: float) -> None:
        """Note a move or a wait."""
        self.line.append(number)
        self.seconds.append(seconds)
        self.tensions.append(self.tension)
        self.values.extend(values)

    def reading(self, lines: int) -> Reading:
        """What was read in so many lines."""
        if not self.over:
            self.fault(lines, f"no {' or '.join(self.controller.ends)} ends the program")
        if not self.running:
            self.fault(1, "no stop before the program, at which the fibre is tied on")
        return Reading(
            start=np.array(self.start),
            line=np.array(self.line, dtype=np.int64),
            values=np.array(self.values, dtype=float).reshape(len(self.line), len(self.start)),
            seconds=np.array(self.seconds, dtype=float),
            tension=np.array(self.tensions, dtype=float),
            stops=tuple(self.stops),
            faults=tuple(sorted(self.faults)),
        )
