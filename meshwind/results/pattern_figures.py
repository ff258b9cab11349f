"""The figures of closed layers for the report: pattern, turnarounds, angle and what else could be wound."""

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.units import MILLIMETRES, millimetres
from meshwind.filament.alternatives import alternatives
from meshwind.filament.closing import ClosedLayer
from meshwind.filament.filament import Filament
from meshwind.filament.laminate import LaidLayer, Laminate
from meshwind.filament.levels import levels
from meshwind.filament.pin_turn import Pins, Shaft
from meshwind.filament.stations import helix_stations
from meshwind.path.winding_angle import winding_angle
from meshwind.results.pattern_types import AlternativeFigures, MeanSpread, PatternFigures, TurnaroundFigures


def pattern_figures(layer: ClosedLayer, width: float, linear_density: float | None = None) -> PatternFigures:
    """The figures of one closed layer; width: of its band; linear_density: mass of the fibre over its length."""
    pattern, joining = layer.pattern, layer.joining
    angle = np.degrees(winding_angle(layer.paths))
    median = float(np.median(angle))
    cover = helix_stations(layer.paths, levels(layer.paths.surface), width).covers
    dwells = float(joining.start_dwell.mean() + joining.end_dwell.mean())
    return {
        "circuits": pattern.circuits,
        "shift": pattern.shift,
        "turns": pattern.turns,
        "pattern_number": pattern.number,
        "leading": pattern.leading,
        "filaments": pattern.filaments,
        "words": pattern.words,
        "revolutions": {"asked": layer.plan.revolutions, "wound": layer.revolutions},
        "dwell": {"start": mean_spread(joining.start_dwell), "end": mean_spread(joining.end_dwell)},
        "angle": {"min": float(angle.min()), "median": median, "max": float(angle.max())},
        "turnarounds": turnaround_figures(layer),
        "cover": {"min": cover[0], "max": cover[1]},
        "fibre_length": layer.length,
        "fibre_mass": None if linear_density is None else linear_density * layer.length,
        "left_out": layer.left_out,
        "alternatives": [
            AlternativeFigures(
                circuits=each.pattern.circuits,
                turns=each.pattern.turns,
                pattern_number=each.pattern.number,
                leading=each.pattern.leading,
                revolutions=each.revolutions,
                angle=each.angle,
                cover=each.cover,
                dwell=each.dwell if dwells > 0.0 else None,
            )
            for each in alternatives(pattern, layer.revolutions, dwells, median)
        ],
    }


def patterns_of_layers(laminate: Laminate, filament: Filament, units: str = "") -> list[PatternFigures]:
    """The figures of layers that are one filament; the join to a layer counts as its fibre."""
    length = np.bincount(filament.layer[1:], np.diff(filament.course.arc_length), len(laminate.layers))
    return [
        _of_layer(layer, float(mine), units) for layer, mine in zip(laminate.layers, length, strict=True)
    ]  # fmt: skip


def _of_layer(layer: LaidLayer, length: float, units: str) -> PatternFigures:
    """The figures of one of several layers, whose fibre is so long."""
    closed, roving = layer.closed, layer.roving
    scale = millimetres(units) if units in MILLIMETRES else 1.0
    mass = None if roving is None else roving.fibre_mass(length * scale)
    if closed is not None:
        figures = pattern_figures(closed, layer.laying.width)
        return {**figures, "fibre_length": length, "fibre_mass": mass}
    assert layer.hoop is not None
    least, median, most = np.degrees(layer.stations.angles)
    cover, turns = layer.stations.covers, layer.hoop.turns
    none: MeanSpread = {"min": 0.0, "mean": 0.0, "max": 0.0}
    return {
        "circuits": 1,
        "shift": 0,
        "turns": round(turns),
        "pattern_number": 0,
        "leading": False,
        "filaments": 1,
        "words": f"a hoop of {turns:.1f} turns, {layer.circuits} passes",
        "revolutions": {"asked": turns, "wound": turns},
        "dwell": {"start": none, "end": none},
        "angle": {"min": float(least), "median": float(median), "max": float(most)},
        "turnarounds": [],
        "cover": {"min": cover[0], "max": cover[1]},
        "fibre_length": length,
        "fibre_mass": mass,
        "left_out": 0,
        "alternatives": [],
    }


def mean_spread(values: Floats) -> MeanSpread:
    """Minimum, mean and maximum of values (n,)."""
    return {"min": float(values.min()), "mean": float(values.mean()), "max": float(values.max())}


def turnaround_figures(layer: ClosedLayer) -> list[TurnaroundFigures]:
    """The figures of what turns at the start and at the end."""
    return [
        {
            "end": name,
            "kind": each.name,
            "slip": each.slip,
            "reach": each.reach,
            "radius": each.radius if isinstance(each, Pins | Shaft) else None,
            "rule": each.rule,
        }
        for name, each in zip(("start", "end"), layer.turnarounds, strict=True)
    ]
