"""The stretches of a program whose fibre lies on the part, where the eye is in them, and where they were planned."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.threads import parallel_for
from meshwind.filament.course import Kind, runs
from meshwind.program.blocks import TRAVEL, Blocks
from meshwind.program.program import Program
from meshwind.program.rewinding.pull import Eyes, Row, feet_of
from meshwind.surface.surface import Surface

_ON = 1e-4
"""Distance from a layer's surface, over its size, up to which the plan lies on it."""
_RIM = 1e-6
"""Distance from a rim in v up to which a fibre is on it."""
_BLOCK = 200
"""Fewest points that are worth a thread."""
_DENSE = 4
"""Points of the plan in each of its pieces."""


@dataclass(frozen=True)
class Stretches:
    """Stretches (m,) of a program that lie on the part: their layer, first and last block, and (u, v) of the first."""

    layer: Ints
    first: Ints
    last: Ints
    start: Floats

    def __len__(self) -> int:
        return len(self.layer)

    def chosen(self, index: Ints) -> "Stretches":
        """Some of the stretches."""
        return Stretches(*(getattr(self, each.name)[index] for each in fields(self)))


def together(parts: Sequence[Stretches]) -> Stretches:
    """Stretches one after another."""
    return Stretches(*(np.concatenate([getattr(part, each.name) for part in parts]) for each in fields(Stretches)))


def stretches_of(blocks: Blocks, surfaces: Sequence[Surface]) -> Stretches:
    """The stretches of a program that lie on the part, each within a pass; surfaces: what each layer lies on."""
    on = np.zeros(len(blocks), dtype=bool)
    uv = np.zeros((len(blocks), 2))
    for layer, surface in enumerate(surfaces):
        rows = np.flatnonzero(blocks.layer == layer)
        feet, height = np.empty((len(rows), 2)), np.empty(len(rows))
        parallel_for(feet_of, len(rows), _BLOCK, surface.body, blocks.point[rows], feet, height)
        within = (feet[:, 1] > _RIM) & (feet[:, 1] < 1.0 - _RIM)
        # what waits at a rim belongs to the turnaround
        on[rows] = (height <= _ON * surface.size) & (within | ~np.isin(blocks.kind[rows], (Kind.TURN, Kind.DWELL)))
        uv[rows] = feet
    on &= blocks.kind != TRAVEL
    new = _new(blocks)
    # while nothing is laid the span swings about the point where the fibre comes onto the part, or leaves it
    lays = on[1:] & on[:-1] & ~new[1:] & (np.diff(blocks.arc_length) > 0.0)
    index, part = np.flatnonzero(lays), np.cumsum(~on | new)
    begins = np.append(True, np.diff(part[index]) > 0)[: len(index)]
    first, last = index[begins], index[np.append(begins[1:], True)[: len(index)]] + 1
    return Stretches(blocks.layer[first], first, last, uv[first])


def _new(blocks: Blocks) -> Bools:
    """Whether blocks (n,) are the first of their pass."""
    keys = np.stack([blocks.layer, blocks.circuit, blocks.passed])
    return np.append(True, (np.diff(keys, axis=1) != 0).any(axis=0))


def eyes_of(program: Program, found: Stretches, moves: int) -> tuple[Eyes, Ints]:
    """Where the eye is in stretches, `moves` times a block, and the block (k,) that leads to each place.

    The axes move evenly between two blocks, as a machine's do.
    """
    blocks = program.blocks
    count = (found.last - found.first) * moves + 1
    at = np.repeat(found.first, count) + runs(np.zeros_like(count), count) / moves
    number = np.arange(len(blocks))
    x, r, turned = (np.interp(at, number, values) for values in (blocks.eye_x, blocks.eye_r, blocks.mandrel))
    eye = program.mandrel.eye(x, r if program.radius is None else np.full(len(at), program.radius), turned)
    return Eyes(eye, np.concatenate([[0], np.cumsum(count)]), found.start), np.ceil(at).astype(np.int64)


def planned(program: Program, found: Stretches) -> Row:
    """Where the fibre of stretches was planned, in points that are denser than its blocks."""
    points, along, before = [], [], 0.0
    for track in program.tracks:
        at = np.append(np.arange(len(track) * _DENSE) / _DENSE, len(track))
        points.append(track.contact(at)[0])
        along.append(track.laid(at) + before)
        before = float(along[-1][-1])
    every = np.concatenate(along)
    start, stop = program.blocks.arc_length[found.first], program.blocks.arc_length[found.last]
    # both ends are put in as their blocks have them: where a filament ends, the next one starts at the same length
    inside = np.searchsorted(every, start, side="right"), np.searchsorted(every, stop)
    count = np.maximum(inside[1] - inside[0], 0)
    index = runs(inside[0], count)
    places = np.stack([np.cumsum(count) - count, np.cumsum(count)], axis=1).ravel()  # both ends of each stretch
    ends = np.stack([program.blocks.point[found.first], program.blocks.point[found.last]], axis=1).reshape(-1, 3)
    return Row(
        np.insert(np.concatenate(points)[index], places, ends, axis=0),
        np.insert(
            every[index] - np.repeat(start, count), places, np.stack([0.0 * start, stop - start], axis=1).ravel()
        ),
        np.concatenate([[0], np.cumsum(count + 2)]),
    )
