"""The part in the page for a browser: its grid, thinned to what a browser turns smoothly, and its maps."""

from typing import TypedDict

import numpy as np

from meshwind.appearance.layer_steps import STEP_COLOURS, LayerSteps, layer_steps, step_words
from meshwind.appearance.looks import LAMINATE, MAPS, Look
from meshwind.core.cast import Floats, Ints
from meshwind.core.geometry import Block
from meshwind.core.vectors import unit
from meshwind.exporting.packing import Packed, Stops, packed, stops
from meshwind.results.laminate_reading import read_laminate
from meshwind.results.reading import Results
from meshwind.results.schema import CLASS, LAYERS, NORMAL, UV, WINDABILITY
from meshwind.surface.evaluate import SU, SV, S
from meshwind.surface.surface import Surface

_MOST = 12_000
"""Number of points of the surface that a browser turns smoothly without a graphics card."""
_CLASSES = {-1: "−1: concave", 0: "0: saddle", 1: "1: convex"}
"""Words for the values of the map of classes."""


class ClassData(TypedDict):
    """A class of a discrete map: the least value in it, its colour and its words."""

    least: float
    colour: str
    words: str


class CellData(TypedDict):
    """Classes over an even grid of cells, `columns` along v for each u, as runs of one class and their lengths."""

    columns: int
    classes: Packed
    lengths: Packed


class MapData(TypedDict):
    """A map of the surface and how it is shown; marks are positions on its scale.

    values: at the points of the grid.  classes: of a discrete map, by rising values, none of others; cells: the classes
    by which it is drawn where these are finer than the grid, else None.  stepped: whether the colours go in steps from
    mark to mark when the map is first shown.
    """

    name: str
    title: str
    words: list[str]
    unit: str
    colours: Stops
    low: float
    high: float
    log: bool
    values: Packed
    cells: CellData | None
    marks: list[float]
    mark_words: list[str]
    classes: list[ClassData]
    stepped: bool


class SurfaceData(TypedDict):
    """The part as a grid of points (3, r c), whose r rows have one u each and c points of different v.

    closed: whether the last row is joined to the first; outward: 1 where the cross product of steps along u and v
    points out of the part, else -1; whole, shown: number of points in surface.vtu and here; off: how far the middles of
    cells lie off the surface.
    """

    points: Packed
    u: Packed
    v: Packed
    closed: bool
    outward: int
    whole: int
    shown: int
    off: float
    maps: list[MapData]


def surface_data(grid: Block, results: Results) -> SurfaceData:
    """The surface, thinned to about `_MOST` points, with its maps."""
    uv = grid.point_data[UV]
    nv = int((uv[:, 0] == uv[0, 0]).sum())
    nu = len(uv) // nv
    share = min(np.sqrt(_MOST / len(uv)), 1.0)
    rows, columns = _thinned(nu, share, results.surface.periodic), _thinned(nv, share, False)
    kept = (rows[:, None] * nv + columns).ravel()
    points = grid.points[kept]
    known = [(name, look, grid.point_data[name]) for name, look in MAPS.items() if name in grid.point_data]
    laminate = read_laminate(results.folder, results.surface)
    if laminate is not None:
        known.insert(0, ("laminate", LAMINATE, laminate.thickness))
    maps = [_map(name, look, values.astype(np.float64), kept, results.units) for name, look, values in known]
    if LAYERS in grid.point_data:
        steps = layer_steps(results.paths, results.band_width or results.layup.bands.width)
        maps = [_by_layers(each, steps) if each["name"] == LAYERS else each for each in maps]
    return {
        "points": packed(points.T),
        "u": packed(uv[rows * nv, 0]),
        "v": packed(uv[columns, 1]),
        "closed": bool(results.surface.periodic),
        "outward": _outward(points.reshape(len(rows), len(columns), 3), grid.point_data[NORMAL][kept]),
        "whole": len(uv),
        "shown": len(kept),
        "off": _facets_off(results.surface, uv[rows * nv, 0], uv[columns, 1], points),
        "maps": maps,
    }


def _facets_off(surface: Surface, u: Floats, v: Floats, points: Floats) -> float:
    """Largest distance of the middles of cells between points (r c, 3) from the surface there."""
    grid = points.reshape(len(u), len(v), 3)
    ends = np.append(u, u[0] + 1.0) if surface.periodic else u
    grid = np.concatenate([grid, grid[:1]]) if surface.periodic else grid
    corners = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    middles = np.stack(np.meshgrid(0.5 * (ends[1:] + ends[:-1]), 0.5 * (v[1:] + v[:-1]), indexing="ij"), axis=-1)
    frames = surface.frames(middles.reshape(-1, 2))
    normal = unit(np.cross(frames[:, SU], frames[:, SV]))
    away = np.mean(corners, axis=0).reshape(-1, 3) - frames[:, S]
    return float(np.abs((away * normal).sum(axis=1)).max())


def _outward(points: Floats, normal: Floats) -> int:
    along_u, along_v = np.gradient(points, axis=0), np.gradient(points, axis=1)
    facing = (np.cross(along_u, along_v).reshape(-1, 3) * normal).sum()
    return 1 if facing > 0.0 else -1


def _map(name: str, look: Look, values: Floats, kept: Ints, units: str) -> MapData:
    scale = look.scale(values, units)
    marks = scale.marks
    return {
        "name": name,
        "title": look.title,
        "words": list(scale.words),
        "unit": look.unit.format(u=units) if units or "{u}" not in look.unit else "",
        "colours": stops(scale.colours),
        "low": scale.low,
        "high": scale.high,
        "log": scale.log,
        "values": packed(values[kept]),
        "cells": None,
        "marks": [share for share, _ in marks],
        "mark_words": [words for _, words in marks],
        "classes": _classes(look) if name == CLASS else [],
        "stepped": name == WINDABILITY,
    }


def _by_layers(of: MapData, found: LayerSteps) -> MapData:
    """The map of layers with their steps as classes, by cells that are many across a band."""
    steps = found.steps.ravel()
    begin = np.flatnonzero(np.diff(steps, prepend=-1))
    cells: CellData = {
        "columns": found.steps.shape[1],
        "classes": packed(steps[begin]),
        "lengths": packed(np.diff(begin, append=len(steps))),
    }
    shown = zip(found.firsts.tolist(), STEP_COLOURS, step_words(found.firsts), strict=False)
    classes: list[ClassData] = [
        {"least": least - 0.5, "colour": colour, "words": words} for least, colour, words in shown
    ]
    return {**of, "cells": cells, "classes": classes}


def _classes(look: Look) -> list[ClassData]:
    """The classes of the map of classes."""
    shades = stops(look.colours)
    colours = shades[0][1], shades[len(shades) // 2][1], shades[-1][1]
    return [
        {"least": value - 0.5, "colour": str(colour), "words": words}
        for (value, words), colour in zip(_CLASSES.items(), colours, strict=True)
    ]


def _thinned(count: int, share: float, closed: bool) -> Ints:
    """About `share` of the numbers below `count`, evenly spaced, with both ends or around a circle."""
    many = max(round(share * count), 3)
    return np.unique(np.rint(np.linspace(0, count - (count / many if closed else 1), many)).astype(np.int64))
