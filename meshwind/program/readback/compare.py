"""A text against the blocks of its program: axes, time, the eye, and the place where the fibre touches the part."""

from bisect import bisect_left
from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import nearest
from meshwind.program.axes import moved
from meshwind.program.blocks import Blocks
from meshwind.program.machine import Machine
from meshwind.program.mandrel import Mandrel
from meshwind.program.readback.controllers import CONTROLLERS
from meshwind.program.readback.krl import Krl
from meshwind.program.readback.reading import Reading
from meshwind.program.readback.words import Words

TURNED = 0.01
"""Degrees within which the text says the program's angles: a hundredth of what a machine repeats."""
TIMED = 1e-3
"""Share of the time within which the text says it."""
TOUCHED = 1e-6
"""Share of the part's diagonal within which the fibre of the text touches the part where the program's does."""
_DIGITS = 1.01
"""Last decimals by which a text may be off: it is rounded to the nearest, and the mandrel's count starts rounded."""
_JITTER = 1e-3
"""Seconds by which a block may be off, as waits are in whole milliseconds."""
_BRIEF = 2e-6
"""Seconds of a block below which it may be part of the next one."""
_SHOWN = 20
"""Faults that are told; one error makes all that follow wrong."""


@dataclass(frozen=True)
class Part:
    """What a program turns: its axis, the millimetres in one of its units, and its diagonal in these units."""

    mandrel: Mandrel
    millimetres: float
    diagonal: float


@dataclass(frozen=True)
class ReadBack:
    """The largest differences between a text and the blocks of its program.

    Attributes
    ----------
    rows : int
        Moves and waits of the text.
    angle : float
        Of the mandrel, in degrees.
    axis : float
        Of any other axis, in mm or degrees.
    eye : float
        Of the eye from where the program has it, over the part's diagonal.
    touch : float
        Of the line from the text's eye along the fibre from the point where it touches the part, over the diagonal.
    seconds : float
        Of the whole time, over the program's.
    faults : tuple of (int, str)
        The first lines that do not say what the program does, or that the controller would refuse, and why.
    """

    rows: int
    angle: float
    axis: float
    eye: float
    touch: float
    seconds: float
    faults: tuple[tuple[int, str], ...]

    @property
    def same(self) -> bool:
        """Whether the text says the same as the program."""
        return not self.faults


def read_text(text: str, machine: Machine) -> Reading:
    """What a text makes a machine do; its dialect is the machine's.  Raises BadInputError if that is not known."""
    controller = CONTROLLERS.get(machine.dialect)
    if controller is None:
        raise BadInputError(f"no dialect {machine.dialect!r} to read; {nearest(machine.dialect, CONTROLLERS)}")
    reader = Krl(machine, controller) if machine.dialect == "krl" else Words(machine, controller)
    lines = text.splitlines()
    for number, line in enumerate(lines, 1):
        reader.read(number, line)
    return reader.reading(len(lines))


def read_back(text: str, blocks: Blocks, machine: Machine, part: Part) -> ReadBack:
    """Read a text as its controller does and compare it with the blocks that it was written from.

    The machine is as the dialect speaks of it (`fitted`).  Whole turns before the first block, of the mandrel and of
    axes with a modulo, do not count.
    """
    reading = read_text(text, machine)
    digit = 10.0 ** -CONTROLLERS[machine.dialect].decimals(machine)
    said, start = _program_values(reading, machine)
    meant = np.stack([moved(blocks, each.moves, part.millimetres) for each in machine.axes], axis=1)
    mandrel = [each.moves for each in machine.axes].index("mandrel")
    for k, axis in enumerate(machine.axes):
        if k == mandrel or axis.modulo:
            around = 360.0 if k == mandrel else axis.modulo
            turns = around * np.rint((meant[0, k] - start[k]) / around)
            if np.isfinite(turns):
                start[k] += turns
                said[:, k] += turns
    faults = list(reading.faults)
    if not (np.abs(start - meant[0]) <= _DIGITS * digit).all():
        faults.append((1, "the approach does not lead to the first block"))
    at = _blocks_of(said, blocks.time[0] + np.cumsum(reading.seconds), meant, blocks.time, digit)
    faults += _faults_of_axes(
        reading, said, meant[at], machine, max(_DIGITS * digit, TOUCHED * part.diagonal * part.millimetres)
    )
    faults += _faults_of_time(reading, blocks, at)
    faults += _faults_of_end(reading, meant, blocks, at, digit)
    faults += _faults_of_tension(reading, blocks, at, machine)
    faults += _faults_of_stops(reading, blocks, np.append(0, at), np.vstack([start, said]), (meant, digit))
    eye, touch = _of_the_fibre(said, blocks.chosen(at), machine, part)
    held = digit / part.millimetres * np.sqrt(2.0) + np.radians(digit) * np.abs(blocks.eye_r[at])
    faults += [
        (int(reading.line[k]), f"the fibre touches {touch[k]:.3g} from where it should")
        for k in np.flatnonzero(~(touch <= TOUCHED * part.diagonal + held))
    ]
    difference = np.abs(said - meant[at])
    total = blocks.time[-1] - blocks.time[0]
    return ReadBack(
        rows=len(said),
        angle=float(difference[:, mandrel].max(initial=0.0)),
        axis=float(np.delete(difference, mandrel, axis=1).max(initial=0.0)),
        eye=float(eye.max(initial=0.0)) / part.diagonal,
        touch=float(touch.max(initial=0.0)) / part.diagonal,
        seconds=float(abs(reading.seconds.sum() - total) / total) if total > 0.0 else 0.0,
        faults=tuple(sorted(faults)[:_SHOWN]),
    )


def _program_values(reading: Reading, machine: Machine) -> tuple[Floats, Floats]:
    """The program's values (m, axes) for the machine's after each row, and those of the start."""
    sign = np.array([axis.sign for axis in machine.axes], dtype=float)
    zero = np.array([axis.zero for axis in machine.axes])
    return (reading.values - zero) / sign, (reading.start - zero) / sign


def _blocks_of(said: Floats, told: Floats, meant: Floats, time: Floats, digit: float) -> Ints:
    """Index (m,) of the block in which each row of a text ends.

    Rows follow blocks one by one, but for blocks in which no axis moves, or that take no time: those may be left out or
    be one wait.  Among such blocks a row belongs to the one with its values and next to its time.
    """
    quiet: Bools = (np.abs(np.diff(meant, axis=0)) <= _DIGITS * digit).all(axis=1) | (np.diff(time) < _BRIEF)
    loud = (np.flatnonzero(~quiet) + 1).tolist()
    last, now, found = len(time) - 1, 0, []
    for row in range(len(said)):
        place = bisect_left(loud, now + 1)
        end = loud[place] if place < len(loud) else last
        if end > now + 1:
            ways = np.arange(now + 1, end + 1)
            off = np.abs(meant[ways] - said[row]).max(axis=1)
            near = ways[off <= _DIGITS * digit]
            now = int(near[np.abs(time[near] - told[row]).argmin()]) if len(near) else end
        else:
            now = min(now + 1, last)
        found.append(now)
    return np.array(found, dtype=np.int64)


def _faults_of_axes(
    reading: Reading, said: Floats, meant: Floats, machine: Machine, length: float
) -> list[tuple[int, str]]:
    """Rows in which an axis is elsewhere."""
    allowed = np.array([TURNED if each.unit == "deg" else length for each in machine.axes])
    return [
        (
            int(reading.line[row]),
            f"{machine.axes[k].moves} comes to {said[row, k]:.4f} instead of {meant[row, k]:.4f}",
        )
        for row, k in np.argwhere(~(np.abs(said - meant) <= allowed))[:_SHOWN]
    ]


def _faults_of_time(reading: Reading, blocks: Blocks, at: Ints) -> list[tuple[int, str]]:
    """Rows that take another time, and the whole."""
    wanted = np.diff(blocks.time[np.r_[0, at]])
    wrong = np.flatnonzero(~(np.abs(reading.seconds - wanted) <= TIMED * wanted + _JITTER))[:_SHOWN]
    faults = [(int(reading.line[k]), f"takes {reading.seconds[k]:.6g} s instead of {wanted[k]:.6g}") for k in wrong]
    total, told = blocks.time[-1] - blocks.time[0], reading.seconds.sum()
    if not abs(told - total) <= TIMED * total + _JITTER:
        faults.append((_last(reading), f"the program takes {told:.6g} s instead of {total:.6g}"))
    return faults


def _faults_of_end(reading: Reading, meant: Floats, blocks: Blocks, at: Ints, digit: float) -> list[tuple[int, str]]:
    """A text that stops before its program does."""
    end = int(at[-1]) if len(at) else 0
    rest = np.abs(meant[end:] - meant[end]) > _DIGITS * digit * 2.0
    if not rest.any():
        return []
    return [(_last(reading), f"the text ends at block {end} of {len(blocks) - 1}")]


def _faults_of_tension(reading: Reading, blocks: Blocks, at: Ints, machine: Machine) -> list[tuple[int, str]]:
    """Rows with another tension."""
    if not machine.tension or not blocks.tension.any():
        return []
    wanted = blocks.tension[at]
    wrong = np.flatnonzero(~(np.abs(reading.tension - wanted) <= TIMED * np.abs(wanted)))[:_SHOWN]
    return [(int(reading.line[k]), f"tension is {reading.tension[k]:g} instead of {wanted[k]:g}") for k in wrong]


def _faults_of_stops(
    reading: Reading, blocks: Blocks, at: Ints, said: Floats, told: tuple[Floats, float]
) -> list[tuple[int, str]]:
    """Stops that are missing, or elsewhere than where the fibre is cut and tied on; told: values and their digit."""
    meant, digit = told
    wanted = blocks.travels.ravel()
    words = "the fibre is cut", "the next filament is tied on"
    if len(reading.stops) != len(wanted):
        line = reading.stops[-1][0] if reading.stops else _last(reading)
        return [(line, f"{len(reading.stops)} stops after the first, instead of {len(wanted)} to cut and tie on")]
    after = np.append(at[1:], len(meant))
    return [
        (line, f"stops elsewhere than where {words[number % 2]}")
        for number, ((line, rows), block) in enumerate(zip(reading.stops, wanted, strict=True))
        if not (at[rows] <= block < after[rows] and (np.abs(said[rows] - meant[block]) <= _DIGITS * digit).all())
    ]


def _of_the_fibre(said: Floats, meant: Blocks, machine: Machine, part: Part) -> tuple[Floats, Floats]:
    """Distance (m,) of the text's eye from the program's, and of its line along the fibre from where that touches."""
    column = {each.moves: said[:, k] for k, each in enumerate(machine.axes)}
    x = column["carriage"] / part.millimetres
    # an eye without a cross-feed keeps its distance, of which the text says nothing
    r = column["cross"] / part.millimetres if "cross" in column else meant.eye_r
    eye = part.mandrel.eye(x, r, column["mandrel"])
    across = np.cross(meant.point - eye, meant.tangent)
    return np.linalg.norm(eye - meant.eye, axis=1), np.linalg.norm(across, axis=1)


def _last(reading: Reading) -> int:
    """The last line that did something."""
    return int(reading.line[-1]) if len(reading.line) else 1
