"""The filament in the page for a browser: its band in the order of winding, and what the turnarounds stand on."""

from collections.abc import Sequence
from typing import TypedDict

import numpy as np
from scipy.spatial import cKDTree

from meshwind.appearance.gear import gear
from meshwind.appearance.looks import SEQUENTIAL
from meshwind.appearance.ribbons import LIFT, Fineness, ribbons, turned_by
from meshwind.appearance.strips import WORDS, Gear, Ribbons
from meshwind.core.cast import Bools, Ints
from meshwind.exporting.packing import Packed, Stops, packed, stops
from meshwind.filament.course import Kind
from meshwind.filament.filament import Filament
from meshwind.results.reading import Results
from meshwind.surface.grid import grid
from meshwind.surface.surface import Surface

_FINE = Fineness(across=3, rows=9000)
"""Points across the band, and rows along it, that a browser draws smoothly without a graphics card."""


class GearData(TypedDict):
    """What the turnarounds stand on: points, and triangles of collars and rings, and of pins and shafts."""

    points: Packed
    base: Packed
    held: Packed


class FilamentData(TypedDict):
    """The band of a filament in the order of laying, and what it does at each row of `across` points.

    sizes: rows of each strip, one strip after the other; laid: length of fibre laid before each row; total: of all
    fibre; words: what the fibre does, by kind; layers: their number.  over: whether the whole row lies over the part,
    not on a turnaround; highest: its largest distance from the part where it does; lifts: what the first
    and the last row are drawn above the part.
    """

    points: Packed
    across: int
    sizes: Packed
    laid: Packed
    total: float
    kind: Packed
    layer: Packed
    circuit: Packed
    passed: Packed
    path: Packed
    angle: Packed
    slip: Packed
    thickness: Packed
    over: Packed
    highest: float
    lifts: list[float]
    words: list[str]
    layers: int
    colours: Stops
    gear: GearData | None


def gear_of(results: Results) -> Gear:
    """What the turnarounds of a run stand on; nothing where it has no filament."""
    return gear(results.surface, results.filaments, turned_by(results.patterns))


def filament_data(results: Results, stands: Gear, filaments: Sequence[Filament]) -> FilamentData | None:
    """The filaments of a run in order of winding and what their turnarounds stand on; None if there are none."""
    if not filaments:
        return None
    turned = turned_by(results.patterns)
    surface = results.surface
    made = ribbons(filaments, surface, results.band_widths, turned, _FINE)
    over = np.asarray(~np.isin(made.kind, (Kind.TURN, Kind.DWELL)))
    return {
        "points": packed(made.points.reshape(-1, 3).T),
        "across": made.points.shape[1],
        "sizes": packed(made.sizes),
        "laid": packed(made.laid),
        "total": float(made.laid[-1]),
        "kind": packed(made.kind),
        "layer": packed(made.layer),
        "circuit": packed(made.circuit),
        "passed": packed(made.passed),
        "path": packed(made.path),
        "angle": packed(made.angle),
        "slip": packed(made.slip),
        "thickness": packed(made.thickness),
        "over": packed(over.astype(np.int64)),
        "highest": _highest(made, over, surface),
        "lifts": [surface.size * lift for lift in LIFT],
        "words": [WORDS[kind] for kind in Kind],
        "layers": int(made.layer.max()) + 1,
        "colours": stops(SEQUENTIAL),
        "gear": None
        if not len(stands.points)
        else {
            "points": packed(stands.points.T),
            "base": packed(_triangles(stands.base)),
            "held": packed(_triangles(stands.held)),
        },
    }


def _highest(made: Ribbons, over: Bools, surface: Surface) -> float:
    """Largest distance of rows of bands from the points of the part's grid."""
    off = cKDTree(grid(surface).points).query(made.points[over, made.points.shape[1] // 2])[0]
    return float(off.max(initial=0.0))


def _triangles(quads: Ints) -> Ints:
    """Triangles (3, 2 q) of quads (q, 4), two after two."""
    return np.ascontiguousarray(quads[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3).T)
