"""What a program says of itself: part, machine, units, modes, axes, and how it is started."""

import re
import textwrap
import unicodedata
from dataclasses import dataclass

import numpy as np

from meshwind.core.version import version
from meshwind.program.blocks import TRAVEL, Blocks
from meshwind.program.machine import Axis, Machine
from meshwind.program.posts.dialect import ALL_INCREMENTS, INCREMENTS, ON, RESET, Dialect

_TURNING = {
    RESET: "its count set back by whole turns by G92 at each circuit, never rewound",
    INCREMENTS: "moved by increments, never rewound",
    ALL_INCREMENTS: "moved by increments, never rewound",
    ON: "it counts on, never rewound",
}
_MOVES = {
    "mandrel": "turns the mandrel",
    "carriage": "moves the eye along the mandrel",
    "cross": "is the distance of the eye from the axis of the mandrel",
    "roll": "rolls the eye",
    "yaw": "yaws the eye",
}


@dataclass(frozen=True)
class Job:
    """What is wound: the part's name, and the millimetres in one of its units of length."""

    part: str
    millimetres: float = 1.0


def header(blocks: Blocks, machine: Machine, dialect: Dialect, job: Job) -> list[str]:
    """The lines of a header, as comments."""
    seconds = float(blocks.time[-1] - blocks.time[0])
    layers, circuits = (len(np.unique(rows, axis=0)) for rows in (
        blocks.layer, np.stack([blocks.layer, blocks.circuit], axis=1),
    ))  # fmt: skip
    words = [
        f"winding program for {dialect.words}, by meshwind {version()}",
        f"part: {job.part}",
        f"machine: {machine.name}, {machine.words}" if machine.words else f"machine: {machine.name}",
        f"layers: {layers}, circuits: {circuits}, blocks: {len(blocks)}",
        f"time: {seconds:.1f} s, {seconds / 60.0:.1f} min",
        f"fibre: {(blocks.arc_length[-1] - blocks.arc_length[0]) * job.millimetres / 1e3:.3f} m",
        f"units: mm and degrees, {_feed(machine, dialect)}",
        *(f"{axis.letter} {_axis(axis, dialect)}" for axis in machine.axes),
        *(note.format(decimals=machine.decimals) for note in dialect.notes),
        f"before the start: eye clear of the part, mandrel on its mark, {_zero(machine)}",
        f"the program approaches and stops at {dialect.pause} for the fibre to be tied on",
    ]
    if len(blocks.travels):
        words.append(
            f"filaments: {len(blocks.travels) + 1}, {dialect.pause} stops to cut the fibre behind one, and again to "
            "tie it on for the next, the time has only the moves between"
        )
    if blocks.tension.any():
        pull = blocks.tension[blocks.kind != TRAVEL]
        words.insert(6, f"tension: {pull.min():g} to {pull.max():g} N{'' if machine.tension else ', set it by hand'}")
    return [line for each in words for line in comments(each, dialect)]


def comments(text: str, dialect: Dialect) -> list[str]:
    """Text as comments of a dialect, in ASCII and within the length of its lines."""
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "replace").decode("ascii")
    plain = plain.replace("'", "")
    plain = re.sub(dialect.plain, "-", plain.upper() if dialect.upper else plain)
    room = dialect.longest - len(dialect.comment.format(text=""))
    return [dialect.comment.format(text=line) for line in textwrap.wrap(plain, room)]


def _feed(machine: Machine, dialect: Dialect) -> str:
    """What the feed says."""
    if machine.feed != "G94":
        return f"G93, F is {'the seconds' if 'seconds' in machine.feed else '1 over the minutes'} of a block"
    if dialect.speeds[0].letters == ".*":
        return "F in mm a minute over all axes, a degree as 1 mm"
    what = ", ".join(each.text.split("=")[0].format(number=1, feed="") for each in dialect.speeds)
    if len({each.text for each in dialect.speeds}) == 1:
        return "F in units a minute over X, Y, Z, where they stand over U, V, W, else A, B, C"
    return f"speeds by {what}: m/s along X, Y, Z, where they stand per cent or degrees/s"


def _axis(axis: Axis, dialect: Dialect) -> str:
    """What an axis is."""
    words = f"{_MOVES[axis.moves]}, {axis.unit}, {'reversed, ' if axis.sign < 0 else ''}0 at {axis.zero:g}"
    if axis.low is not None or axis.high is not None:
        low, high = ("any" if end is None else f"{end:g}" for end in (axis.low, axis.high))
        words += f", travel {low} to {high}"
    if axis.modulo and dialect.turning != ALL_INCREMENTS:
        return f"{words}, counted from 0 to {axis.modulo:g}"
    return f"{words}, {_TURNING[dialect.turning]}" if axis.moves == "mandrel" else words


def _zero(machine: Machine) -> str:
    """Where the mandrel stands on its mark."""
    axis = next(each for each in machine.axes if each.moves == "mandrel")
    return f"{axis.letter} at {axis.zero:g}"
