"""What each axis of a machine has to do in the blocks of a program, and the time that it needs for it."""

import numpy as np

from meshwind.core.cast import Floats
from meshwind.program.blocks import Blocks
from meshwind.program.machine import Machine
from meshwind.program.timing import FIBRE, Limits, Timing, timed


def limits_of(machine: Machine) -> Limits:
    """The fibre's speed, in mm, and the limits of each axis."""
    return Limits(
        (FIBRE, *(axis.moves for axis in machine.axes)),
        np.array([machine.fibre_speed, *(axis.speed for axis in machine.axes)]),
        np.array([np.inf, *(axis.acceleration for axis in machine.axes)]),
    )


def timing_of(blocks: Blocks, machine: Machine, scale: float) -> Timing:
    """The timing of blocks; scale: mm in the mesh's unit."""
    moves = [scale * np.diff(blocks.arc_length + blocks.free_length)]
    moves += [np.diff(moved(blocks, axis.moves, scale)) for axis in machine.axes]
    return timed(np.stack(moves, axis=1), limits_of(machine))


def moved(blocks: Blocks, moves: str, scale: float) -> Floats:
    """What an axis is to move (n,), in degrees or mm; scale: mm in the mesh's unit."""
    values = {
        "mandrel": blocks.mandrel,
        "carriage": scale * blocks.eye_x,
        "cross": scale * blocks.eye_r,
        "roll": blocks.roll,
        "yaw": blocks.yaw,
    }
    return values[moves]
