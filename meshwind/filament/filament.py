"""One filament in order of winding, over one layer or several."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.geometry import Block, Data, Geometric, joined
from meshwind.core.table import data_frame
from meshwind.filament.course import Course, in_a_row

if TYPE_CHECKING:
    import pandas

    from meshwind.filament.closing import ClosedLayer
    from meshwind.filament.laminate import LaidLayer, Laminate


@dataclass(frozen=True)
class Filament(Geometric):
    """A filament in order of winding, with the layer of each of its n points, and the laminate's thickness below it."""

    course: Course
    layer: Ints
    thickness: Floats

    __repr__ = brief

    @property
    def block(self) -> Block:
        """The polyline, with the fields of filament.vtp; angles in degrees."""
        course = self.course
        point_data: Data = {
            "kind": course.kind.astype(np.uint8),
            "layer": self.layer,
            "circuit": course.circuit,
            "pass": course.passed,
            "path": course.path,
            "arc_length": course.arc_length,
            "angle": np.degrees(course.angle),
            "slip": course.slip,
            "normal": course.normal,
            "thickness": self.thickness,
        }
        length = course.arc_length[-1:]
        return Block(
            course.points,
            np.array([0, len(course)]),
            point_data=point_data,
            line_data={"filament": np.zeros(1, dtype=np.int64), "length": length},
        )

    def to_dataframe(self) -> pandas.DataFrame:
        """The points as a table for pandas, a row each, with the fields of filament.vtp."""
        return data_frame(self.block.columns())


def filaments_block(filaments: Sequence[Filament]) -> Block:
    """All filaments, a polyline each."""
    block = joined([each.block for each in filaments])
    return replace(block, line_data={**block.line_data, "filament": np.arange(len(filaments))})


def backwards(filaments: Sequence[Filament]) -> tuple[Filament, ...]:
    """Each filament from its end to its start; they follow one another as before."""
    order = slice(None, None, -1)
    return tuple(
        Filament(each.course.chosen(order), frozen(each.layer[order]), frozen(each.thickness[order]))
        for each in filaments
    )


def filaments_of(layer: ClosedLayer) -> list[Filament]:
    """The filaments of one layer on the bare part."""
    return [Filament(each, np.zeros(len(each), dtype=np.int64), np.zeros(len(each))) for each in layer.filaments]


def filament_of_layers(laminate: Laminate) -> list[Filament]:
    """The filaments of all layers, one but for cuts; none where they were not wound as one.

    Paths are counted on from layer to layer, as the polylines of all layers are, of which a hoop is one.
    """
    made: list[Filament] = []
    paths, strands = 0, [layer.strand for layer in laminate.layers]
    for number, (layer, strand) in enumerate(zip(laminate.layers, strands, strict=True)):
        if strand is None:
            return []
        after = strands[number + 1] if number + 1 < len(strands) else None
        own = strand.course if after is None or after.cut else strand.left
        course = own if strand.join is None else in_a_row([strand.join, own])
        feet = _feet(layer, course)
        here = np.flatnonzero(np.isfinite(feet[:, 0]))
        deep = sum((each.raised.at(feet[here]) for each in laminate.layers[:number]), np.zeros(len(here)))
        slip = np.where(np.isfinite(course.slip), course.slip, np.nan)
        path = np.where(course.path >= 0, course.path + paths, -1)
        course = replace(course, slip=frozen(slip), path=frozen(path))
        below = np.interp(np.arange(len(course)), here, deep)
        one = Filament(course, frozen(np.full(len(course), number)), frozen(below))
        if not made or strand.cut:
            made.append(one)
        else:
            made[-1] = _led_on(made[-1], one)
        paths += 1 if layer.paths is None else len(layer.paths)
    return made


def _led_on(one: Filament, other: Filament) -> Filament:
    """A filament that goes on with another."""
    return Filament(
        in_a_row([one.course, other.course]),
        frozen(np.concatenate([one.layer, other.layer])),
        frozen(np.concatenate([one.thickness, other.thickness])),
    )


def _feet(layer: LaidLayer, course: Course) -> Floats:
    """Parameters (n, 2) of the points of a layer that lie on the part or over it; NaN elsewhere."""
    feet = np.full((len(course), 2), np.nan)
    if layer.hoop is not None:
        uv = layer.hoop.tracks.uv[0]
        feet[len(course) - len(uv) :] = uv
        return feet
    assert layer.paths is not None
    row, column = particles(course, layer.paths.family, layer.paths.gap.shape[1])
    feet[row >= 0] = layer.paths.uv[row[row >= 0], column[row >= 0]]
    return feet


def particles(course: Course, family: Ints, count: int) -> tuple[Ints, Ints]:
    """Path and particle (n,) of every point of a layer's course, -1 where it is none; `count` particles a path.

    Paths of family -1 are walked from their end to their start.
    """
    path = course.path
    run = np.concatenate([[0], np.cumsum(np.diff(path) != 0)])
    last = np.append(np.flatnonzero(np.diff(path) != 0), len(path) - 1)
    # the first particle of a path may be the last point of the turnaround before it, so they count from the last
    left = last[run] - np.arange(len(path))
    row = np.where((path >= 0) & (left < count), path, -1)
    column = np.where(family[np.maximum(row, 0)] > 0, count - 1 - left, left)
    return row, np.where(row >= 0, column, 0)
