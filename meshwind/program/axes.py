"""What each axis of a machine has to do in the blocks of a program, and the time that it needs for it."""

from itertools import pairwise

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
    """The timing of blocks, at rest where the fibre is cut and tied on; scale: mm in the mesh's unit."""
    columns = [scale * blocks.drawn]
    columns += [np.diff(moved(blocks, axis.moves, scale)) for axis in machine.axes]
    moves, limits = np.stack(columns, axis=1), limits_of(machine)
    rests = [0, *blocks.travels.ravel().tolist(), len(moves)]
    parts = [timed(moves[first:last], limits) for first, last in pairwise(rests)]
    return Timing(
        np.concatenate([each.seconds for each in parts]),
        np.concatenate([each.limit for each in parts]),
        max(each.over for each in parts),
    )


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
