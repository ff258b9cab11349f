"""What the chart of a program's axes shows."""

import numpy as np

from meshwind.appearance.words import duration, quantity
from meshwind.core.cast import Floats
from meshwind.pictures.axes_picture import AxesChart, Curve
from meshwind.program.axes import moved
from meshwind.program.blocks import Blocks
from meshwind.program.program import Program
from meshwind.program.words import AXES, fault_words

_MOST = 0.6
"""Share of the program above which its first circuit is not shown beside it."""
_CUTS = 12
"""Cuts that are marked: more have no room."""


def axes_chart(made: Program) -> AxesChart:
    """The axes of a program over time, in mm and degrees, with its layers and faults."""
    blocks, machine = made.blocks, made.machine
    laid = quantity(float(blocks.arc_length[-1]), made.work.units)
    turns = float(blocks.mandrel[-1] - blocks.mandrel[0]) / 360.0
    subtitle = (
        f"{machine.name}: {machine.words}  ·  {len(blocks)} blocks, {duration(made.seconds)}, {turns:.4g} turns  ·  "
    )
    faults = _faults(made)
    wrong = "; ".join(f"{words} at {len(times)} block{'s' * (len(times) > 1)}" for words, times in faults)
    return AxesChart(
        title=f"{made.work.name}: axes of the program".removeprefix(": "),
        subtitle=f"{subtitle}{laid} of fibre laid  ·  {wrong + ' (marked)' if wrong else 'no faults'}",
        time=blocks.time,
        curves=tuple(
            Curve(f"{AXES[axis.moves]} {axis.letter}", axis.unit, moved(blocks, axis.moves, made.work.scale))
            for axis in machine.axes
        ),
        speed=_speed(blocks, made.work.scale),
        fastest=machine.fibre_speed,
        names=tuple(AXES.get(name, name) for name in made.limits),
        limiting=made.limiting,
        layers=tuple(sorted(_marks(made), key=lambda mark: mark[1])),
        faults=faults,
        circuit=_first_circuit(blocks),
    )


def _marks(made: Program) -> list[tuple[str, float]]:
    """Names of layers, where there are several, and of cuts, and the seconds at which each begins."""
    blocks = made.blocks
    layers, starts = np.unique(blocks.layer, return_index=True)
    cuts = [(f"cut {number}", float(blocks.time[k])) for number, (k, _) in enumerate(blocks.travels[:_CUTS], 1)]
    if made.work.layers == 1:
        return cuts
    return [(f"layer {layers[i] + 1}", float(blocks.time[max(k - 1, 0)])) for i, k in enumerate(starts)] + cuts


def _speed(blocks: Blocks, scale: float) -> Floats:
    """Speed (n - 1,) of the fibre through the eye on the way to each block, in mm/s; NaN where it takes no time."""
    step = np.diff(blocks.time)
    drawn = np.abs(blocks.drawn)
    return scale * np.divide(drawn, step, out=np.full(len(step), np.nan), where=step > 0.0)


def _faults(made: Program) -> tuple[tuple[str, Floats], ...]:
    """Words for each kind of fault, and the times of its blocks."""
    kinds = dict.fromkeys(fault.kind for fault in made.faults)
    times = {kind: made.blocks.time[[fault.index for fault in made.faults if fault.kind == kind]] for kind in kinds}
    return tuple((fault_words(kind), times[kind]) for kind in kinds)


def _first_circuit(blocks: Blocks) -> tuple[float, float] | None:
    """Seconds at which the first circuit starts and ends; None where it is most of the program."""
    mine = (blocks.layer == blocks.layer[0]) & (blocks.circuit == blocks.circuit[0])
    end = float(blocks.time[int(np.argmin(mine)) - 1]) if not mine.all() else float(blocks.time[-1])
    return (0.0, end) if 0.0 < end < _MOST * float(blocks.time[-1]) else None
