"""A program wound again: where the fibre comes to lie that the moving eye pulls, against where it was planned.

Each stretch of a pass that lies on the part starts where it was planned, as the turnaround before holds the fibre
there.  Then only the eye counts: the fibre is straight from the last point that touches to the eye, stays where it
lies, and bridges.  Where that needs more friction than there is, the stretch is solved again, sliding from there.
"""

from dataclasses import dataclass
from time import perf_counter
from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.threads import parallel_for
from meshwind.core.vectors import TINY
from meshwind.filament.course import runs
from meshwind.mesh.geometry.facet_tree import FacetTree
from meshwind.mesh.geometry.rays import boxes_of
from meshwind.program.clear import skin_below
from meshwind.program.program import Program
from meshwind.program.rewinding.pull import LAYS, LOST, Eyes, Relaid, Row, apart_all, pull_all
from meshwind.program.rewinding.rewound import Rewound, joined, nothing
from meshwind.program.rewinding.slide import slide
from meshwind.program.rewinding.stretches import Stretches, eyes_of, planned, stretches_of
from meshwind.results.reading import Results
from meshwind.surface.grid import grid
from meshwind.surface.surface import Surface

_MOVES = 8
"""Moves of the eye in a block: a hundredth of a radian of the mandrel at most."""
_SUNK = 2e-5
"""Depth, over the part's size, at which a span has met the surface again; where it is flat facets are nearer to it."""
_PRESSES = 0.01
"""Turn over the surface in a block, in radians, from which the friction that it needs has a meaning."""
_UNEVEN = 0.1
"""Friction beyond that of the plan that even a fibre laid right seems to need, as the eye moves in steps."""


class On(NamedTuple):
    """What a layer lies on, the width of its band, and the friction."""

    surface: Surface
    width: float
    friction: float


@dataclass(frozen=True)
class Ground:
    """What a filament lies on: the surface below each layer, the width of its band, and the friction there."""

    surfaces: tuple[Surface, ...]
    widths: tuple[float, ...]
    frictions: tuple[float, ...]

    @property
    def layers(self) -> list[On]:
        """The same, layer by layer."""
        return [On(*each) for each in zip(self.surfaces, self.widths, self.frictions, strict=True)]

    @staticmethod
    def of(results: Results) -> "Ground":
        """What a run's filament lies on."""
        wound = results.wound_layers
        if wound is None:
            return Ground((results.surface,), results.band_widths, (results.paths.friction,))
        surfaces = tuple(each.paths.surface for each in wound.layers)
        return Ground(surfaces, results.band_widths, tuple(each.figures["friction"] for each in wound.layers))


def rewind(program: Program, ground: Ground) -> Rewound:
    """Wind a program again by physics and compare where the fibre comes to lie with where it was planned.

    Parameters
    ----------
    program : Program
        The program.
    ground : Ground
        What its fibre lies on.

    Returns
    -------
    Rewound
        What became of each stretch that lies on the part.
    """
    begin = perf_counter()
    found = stretches_of(program.blocks, ground.surfaces)
    layers = [
        _of_layer(program, found.chosen(np.flatnonzero(found.layer == layer)), ground.layers[layer])
        for layer in np.unique(found.layer)
    ]
    return joined(layers, perf_counter() - begin) if layers else nothing()


def _of_layer(program: Program, found: Stretches, on: On) -> Rewound:
    """What becomes of the stretches of a layer."""
    eyes, block = eyes_of(program, found, _MOVES)
    out = pulled(on.surface, eyes, on.friction)
    plan = planned(program, found)
    slip = _slip(out, eyes, block)
    kept = np.isfinite(out.point[:, 0])
    fibre = _fibres(out, eyes, plan, kept)
    away = _away(fibre, plan)
    distance = np.maximum(np.maximum.reduceat(away, fibre.first[:-1]), _farthest(plan, fibre))
    followed = out.end != LOST
    number = np.arange(len(found))
    places = np.stack([fibre.first[:-1] - 2 * number, fibre.first[1:] - 2 * (number + 1)], axis=1).ravel()
    blocks = np.insert(block[kept], places, np.stack([found.first, found.last], axis=1).ravel())
    slid = followed & (slip > on.friction + _UNEVEN)
    if slid.any():
        index = np.flatnonzero(slid)
        rest, line = slide(on.surface, on.friction, out, eyes, index)
        other = _rows(plan, index)
        distance[index] = np.maximum(_farthest(line, other), _farthest(other, line))
        followed[index] = rest
    return Rewound(
        found, distance, blocks[_last_of_largest(away, fibre.first)], slip, slid, followed, _slack(out, eyes),
        np.full(len(found), 0.5 * on.width),
    )  # fmt: skip


def pulled(surface: Surface, eyes: Eyes, friction: float) -> Relaid:
    """Pull the fibre of stretches over a surface."""
    places, many = len(eyes.eye), len(eyes.start)
    tree = FacetTree.of(*skin_below(grid(surface), _SUNK * surface.size))
    numbers = [np.full(places, np.nan) for _ in range(4)]
    ends = [np.zeros(many, dtype=np.int64) for _ in range(2)]
    out = Relaid._make([np.full((places, 2), np.nan), np.full((places, 3), np.nan), *numbers, *ends])
    parallel_for(pull_all, many, 1, surface.body, boxes_of(tree), friction, eyes, out)
    return out


def _fibres(out: Relaid, eyes: Eyes, plan: Row, kept: Bools) -> Row:
    """Where the fibre of stretches lies: the start, the places kept, and the span up to where the plan ends."""
    tail = plan.points[plan.first[1:] - 1]
    start, eye = out.point[out.last], eyes.eye[out.last]
    span = eye - start
    share = ((tail - start) * span).sum(axis=1) / np.maximum((span**2).sum(axis=1), TINY)
    more = np.where(out.end == LAYS, np.clip(share, 0.0, 1.0), 0.0)[:, None] * span
    ends = np.cumsum(kept)[eyes.first[1:] - 1]
    first = np.concatenate([[0], ends])
    places = np.stack([first[:-1], ends], axis=1).ravel()
    extra = np.stack([plan.points[plan.first[:-1]], start + more], axis=1).reshape(-1, 3)
    length = out.laid[out.last] + np.linalg.norm(more, axis=1)
    points = np.insert(out.point[kept], places, extra, axis=0)
    along = np.insert(out.laid[kept], places, np.stack([0.0 * length, length], axis=1).ravel())
    return Row(points, along, first + 2 * np.arange(len(first)))


def _rows(rows: Row, index: Ints) -> Row:
    """Some of the lines."""
    count = np.diff(rows.first)[index]
    at = runs(rows.first[index], count)
    return Row(rows.points[at], rows.along[at], np.concatenate([[0], np.cumsum(count)]))


def _away(one: Row, other: Row) -> Floats:
    """Distances (k,) of the points of lines from the same lines in another row."""
    out = np.empty(len(one.points))
    parallel_for(apart_all, len(one.first) - 1, 8, one, other, out)
    return out


def _farthest(one: Row, other: Row) -> Floats:
    """The largest (m,) of each line."""
    return np.asarray(np.maximum.reduceat(_away(one, other), one.first[:-1]))


def _last_of_largest(values: Floats, first: Ints) -> Ints:
    """Where (m,) the largest of the values of each run is."""
    run = np.repeat(np.arange(len(first) - 1), np.diff(first))
    return np.asarray(np.lexsort((values, run))[first[1:] - 1])


def _slip(out: Relaid, eyes: Eyes, block: Ints) -> Floats:
    """The largest friction (m,) that the fibre of each stretch needs in a block."""
    stays = np.isfinite(out.point[:, 0]) & ~(out.bridge > 0.0)
    many = int(block.max()) + 1
    aside = np.abs(np.bincount(block[stays], out.aside[stays], many))
    press = np.bincount(block[stays], out.press[stays], many)
    needed = np.where(press >= _PRESSES, aside / np.maximum(press, TINY), 0.0)
    return np.asarray(np.maximum.reduceat(needed[block], eyes.first[:-1]))


def _slack(out: Relaid, eyes: Eyes) -> Floats:
    """Length (m,) by which laid fibre and span together fall in each stretch, at most."""
    whole = out.laid + np.linalg.norm(eyes.eye - out.point, axis=1)
    apart = 2.0 * float(np.nanmax(whole)) * np.repeat(np.arange(len(out.end)), np.diff(eyes.first))
    fall = np.fmax.accumulate(whole + apart) - (whole + apart)
    return np.asarray(np.maximum.reduceat(np.nan_to_num(fall), eyes.first[:-1]))
