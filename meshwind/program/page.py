"""program.html: the page of a run with the program of a machine in it."""

from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.exporting.packing import packed
from meshwind.exporting.viewer import write_viewer
from meshwind.exporting.viewer_program import ProgramData, Wound
from meshwind.filament.filament import backwards
from meshwind.program.faults import LIMIT
from meshwind.program.program import Program
from meshwind.program.words import AXES, DOES, fault_words
from meshwind.results.reading import Results
from meshwind.results.schema import PROGRAM_PAGE

_MOST = 40_000
"""Blocks in the page: each takes 66 bytes of it."""


def write_page(folder: Path, results: Results, made: Program) -> list[str]:
    """Write program.html into an existing folder."""
    filaments = backwards(results.filaments) if made.backwards else results.filaments
    return write_viewer(folder, results, Wound(PROGRAM_PAGE, program_data(made), made.blocks.eye, filaments))


def program_data(made: Program, most: int = _MOST) -> ProgramData:
    """The blocks of a program for the page, thinned to about `most` of them; none at fault is left out."""
    blocks, mandrel = made.blocks, made.mandrel
    said = {fault.index: _said(fault.kind, fault.words) for fault in made.faults}
    kept = _kept(len(blocks), [*said, *blocks.travels.ravel().tolist()], most)
    words = list(dict.fromkeys(said.values()))
    faulty = np.flatnonzero(np.isin(kept, list(said)))
    turns = np.floor(blocks.mandrel[kept] / 360.0)
    runs = np.stack([blocks.kind, blocks.layer, blocks.circuit, blocks.passed])[:, kept]
    first = np.flatnonzero(np.append(True, (np.diff(runs, axis=1) != 0).any(axis=0)))
    kind, layer, circuit, passed = (packed(row) for row in runs[:, first])

    def at(values: Floats) -> Floats:
        return values[kept]

    return {
        "machine": f"{made.machine.name}: {made.machine.words}",
        "axes": [
            {"moves": axis.moves, "words": f"{AXES[axis.moves]} {axis.letter}", "unit": axis.unit}
            for axis in made.machine.axes
        ],
        "blocks": len(blocks),
        "index": packed(kept),
        "turns": packed(turns.astype(np.int64)),
        "angle": packed(at(blocks.mandrel) - 360.0 * turns),
        "x": packed(at(blocks.eye_x)),
        "r": packed(at(blocks.eye_r)),
        "roll": packed(at(blocks.roll)),
        "yaw": packed(at(blocks.yaw)),
        "point": packed(blocks.point[kept].T),
        "laid": packed(at(blocks.arc_length)),
        "time": packed(at(blocks.time)),
        "first": packed(first),
        "kind": kind,
        "layer": layer,
        "circuit": circuit,
        "passed": passed,
        "faulty": packed(faulty),
        "fault": packed(np.array([words.index(said[index]) for index in kept[faulty].tolist()], dtype=np.int64)),
        "words": words,
        "does": list(DOES),
        "origin": mandrel.origin.tolist(),
        "frame": mandrel.frame.tolist(),
        "scale": made.work.scale,
    }


def _said(kind: str, words: str) -> str:
    """What the page says of a fault: where it is stands beside it, but an axis past its travel has a name."""
    short = fault_words(kind)
    return words if kind == LIMIT else short


def _kept(count: int, marked: list[int], most: int) -> Ints:
    """About `most` of `count` blocks, evenly spaced, with the first, the last and those that are marked."""
    step = -(-count // most)
    return np.unique(np.concatenate([np.arange(0, count, step), [count - 1], np.array(marked, dtype=np.int64)]))
