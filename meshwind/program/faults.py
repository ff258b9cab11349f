"""What is wrong with a program, block by block."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.vectors import sizes, unit
from meshwind.filament.course import Kind
from meshwind.program.axes import moved
from meshwind.program.blocks import TRAVEL, Blocks
from meshwind.program.clear import Obstacle
from meshwind.program.head import Head, meets
from meshwind.program.machine import Machine

SPAN, EYE, LIMIT, LIES = "span", "eye", "travel", "lies"
"""Kinds of faults; the third where an axis would leave its travel; the last where the fibre, wound again,
does not come to lie where it was planned."""
_WHERE: dict[int, str] = {
    Kind.TURN: ", in its turnaround",
    Kind.DWELL: ", in its turnaround",
    TRAVEL: ", on the way to it from the filament before",
}
"""What is added on where a fault is."""
_ROUND_OFF = 1e-9
"""Degrees or mm, over the travel, that are round-off."""


@dataclass(frozen=True, order=True)
class Fault:
    """A fault: the block's number, its kind, and words on it."""

    index: int
    kind: str
    words: str


def place(blocks: Blocks, k: int) -> str:
    """Words on where a block is; they count from 1, as all words do, and numbers in files from 0."""
    end, way = _WHERE.get(int(blocks.kind[k]), ""), "back" if blocks.passed[k] % 2 else "out"
    return f"in layer {blocks.layer[k] + 1}, circuit {blocks.circuit[k] + 1}, pass {way}{end}"


def collisions(blocks: Blocks, eyes: Floats, blocked: Obstacle, head: Head | None, turned: Floats) -> list[Fault]:
    """Blocks at which the span to eyes (n, 3) meets the part, or the eye's body does, turned by frames (n, 3, 3)."""
    span, shaft = blocked.hits(blocks.point, unit(eyes - blocks.point), sizes(eyes - blocks.point))
    eye = np.zeros(len(blocks), dtype=bool)
    if head is not None:
        eye = meets(head, blocked.surface, eyes, turned) & ~span
    words = (
        (span & ~shaft, SPAN, "the free span meets the part"),
        (shaft, SPAN, "the free span meets the shaft"),
        (eye, EYE, f"the eye meets the part{' or the shaft' if blocked.held else ''}"),
    )
    return [
        Fault(int(k), kind, f"{text} {place(blocks, int(k))}")
        for which, kind, text in words
        for k in np.flatnonzero(which)
    ]


def unreachable(blocks: Blocks, machine: Machine, scale: float) -> list[Fault]:
    """The block at which each axis is farthest past each end of its travel; scale: mm in the mesh's unit."""
    found = []
    for axis in machine.axes:
        values = axis.sign * moved(blocks, axis.moves, scale) + axis.zero
        if axis.modulo is not None:
            values = np.mod(values, axis.modulo)
        needed = float(np.ptp(values))
        held = np.inf if axis.low is None or axis.high is None else axis.high - axis.low
        more = "take a machine with more travel"
        for end, name, sign in ((axis.low, "low", -1.0), (axis.high, "high", 1.0)):
            if end is None:
                continue
            past = sign * (values - end)
            k = int(past.argmax())
            if past[k] > _ROUND_OFF * max(float(np.ptp(values)), 1.0):
                fits = needed <= held
                found.append(Fault(k, LIMIT, (
                    f"{axis.moves} {axis.letter} goes to {values[k]:.6g} {axis.unit}, past {name} = {end:g}; "
                    + (f"move its zero by {-sign * past[k]:.6g}, or {more}" if fits else
                       f"it needs {needed:.6g} {axis.unit} of travel, and has {held:g}: {more}")
                )))  # fmt: skip
    return found
