"""What is wrong with a program, block by block."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Bools
from meshwind.program.axes import moved
from meshwind.program.blocks import Blocks
from meshwind.program.clear import Obstacle
from meshwind.program.machine import Machine

SPAN, EYE, TRAVEL, BACK = "span", "eye", "travel", "turned back"
"""Kinds of faults."""
_ROUND_OFF = 1e-9
"""Degrees or mm, over the travel, that are round-off."""
_BACK = 1e-6
"""Degrees that the mandrel may turn back by round-off."""


@dataclass(frozen=True, order=True)
class Fault:
    """A fault: the block's number, its kind, and words on it."""

    index: int
    kind: str
    words: str


def collisions(blocks: Blocks, blocked: Obstacle, size: float) -> list[Fault]:
    """Blocks at which the free span meets the part, or a ball of a size about the eye does."""
    place = "layer {0}, circuit {1}, pass {2}"
    span = blocked.hits(blocks.point, blocks.tangent, blocks.free_length)
    eye = blocked.near(blocks.eye, size) & ~span if size > 0.0 else np.zeros(len(blocks), dtype=bool)
    words = (
        (span, SPAN, f"the free span meets the part in {place}"),
        (eye, EYE, f"the eye comes nearer to the part than its size in {place}"),
    )
    return [
        Fault(int(k), kind, text.format(blocks.layer[k], blocks.circuit[k], blocks.passed[k]))
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
        for end, name, sign in ((axis.low, "low", -1.0), (axis.high, "high", 1.0)):
            if end is None:
                continue
            past = sign * (values - end)
            k = int(past.argmax())
            if past[k] > _ROUND_OFF * max(float(np.ptp(values)), 1.0):
                found.append(Fault(k, TRAVEL, (
                    f"{axis.moves} {axis.letter} goes to {values[k]:.6g} {axis.unit}, past {name} = {end:g}; "
                    f"move its zero by {-sign * past[k]:.6g}, or take a machine with more travel"
                )))  # fmt: skip
    return found


def turned_back(blocks: Blocks) -> list[Fault]:
    """The first block of each stretch in which the mandrel turns back: no machine with an endless spindle does."""
    back: Bools = np.diff(blocks.mandrel) < -_BACK
    start = np.flatnonzero(back & ~np.append(False, back[:-1]))
    stop = np.flatnonzero(back & ~np.append(back[1:], False)) + 1
    return [
        Fault(int(a), BACK, f"the mandrel turns back by {blocks.mandrel[a] - blocks.mandrel[b]:.3g} degrees")
        for a, b in zip(start, stop, strict=True)
    ]
