"""The program of a machine in the page for a browser: the axes at its blocks, and what is wrong with them."""

from dataclasses import dataclass
from typing import TypedDict

from meshwind.core.cast import Floats
from meshwind.exporting.packing import Packed
from meshwind.filament.filament import Filament
from meshwind.results.schema import File


class AxisData(TypedDict):
    """An axis of the machine: what it moves, its name with its letter, and its unit."""

    moves: str
    words: str
    unit: str


class ProgramData(TypedDict):
    """The n blocks of a program that the page shows, and the axis of the mandrel.

    index (n,): numbers of the blocks, `blocks` in all; turns, angle (n,): of the mandrel, whole turns and the degrees
    beyond them; x, r (n,): the eye along the axis and from it; roll, yaw (n,) in degrees; point (3, n): where the fibre
    leaves the part; laid (n,): length of fibre; time (n,) in seconds.  first (k,): places in these of the first block
    of each run of one kind, layer, circuit and pass (k,); does: what the fibre does, by its kind.  faulty, fault (f,):
    places of blocks at fault, and which of `words` says it.  origin, frame: of the mandrel's axis, with rows along it,
    towards the eye at angle 0, and square to both; scale: millimetres in the unit of length.
    """

    machine: str
    axes: list[AxisData]
    blocks: int
    index: Packed
    turns: Packed
    angle: Packed
    x: Packed
    r: Packed
    roll: Packed
    yaw: Packed
    point: Packed
    laid: Packed
    time: Packed
    first: Packed
    kind: Packed
    layer: Packed
    circuit: Packed
    passed: Packed
    faulty: Packed
    fault: Packed
    words: list[str]
    does: list[str]
    origin: list[float]
    frame: list[list[float]]
    scale: float


@dataclass(frozen=True)
class Wound:
    """A program for the page: the page's file, the data, the eye (n, 3) beside the part, and the filaments in order."""

    file: File
    data: ProgramData
    eye: Floats
    filaments: tuple[Filament, ...]
