"""The figures of closed layers for the report: pattern, turnarounds, angle and what else could be wound."""

from collections.abc import Sequence

import numpy as np

from meshwind.core.cast import Floats
from meshwind.filament.alternatives import alternatives
from meshwind.filament.closing import ClosedLayer
from meshwind.filament.filament import Filament
from meshwind.filament.laminate import LaidLayer, Laminate
from meshwind.filament.pin_turn import Pins, Shaft
from meshwind.filament.plain_layer import Band, PlainLayer
from meshwind.results.pattern_types import AlternativeFigures, MeanSpread, PatternFigures, TurnaroundFigures
from meshwind.results.station_figures import angle_figures, cover_figures, thickness_figures


def pattern_figures(layer: ClosedLayer, plain: PlainLayer) -> PatternFigures:
    """The figures of one closed layer, and of what it is on the part."""
    pattern, joining, at = layer.pattern, layer.joining, plain.stations
    assert at is not None
    angle = angle_figures(at)
    fibre, resin = plain.band.masses(layer.length)
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
        "angle": angle,
        "turnarounds": turnaround_figures(layer),
        "cover": cover_figures(at),
        "thickness": None if plain.thickness is None else thickness_figures(plain.thickness),
        "fibre_length": layer.length,
        "fibre_mass": fibre,
        "resin_mass": resin,
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
            for each in alternatives(pattern, layer.revolutions, dwells, angle["median"] or 0.0)
        ],
    }


def patterns_of_layers(laminate: Laminate, filaments: Sequence[Filament], units: str = "") -> list[PatternFigures]:
    """The figures of layers that are one filament, but for cuts; the join to a layer counts as its fibre."""
    length = sum(
        (np.bincount(each.layer[1:], np.diff(each.course.arc_length), len(laminate.layers)) for each in filaments),
        np.zeros(len(laminate.layers)),
    )
    return [_of_layer(layer, float(mine), units) for layer, mine in zip(laminate.layers, length, strict=True)]


def _of_layer(layer: LaidLayer, length: float, units: str) -> PatternFigures:
    """The figures of one of several layers, whose fibre is so long."""
    closed, hoop = layer.closed, layer.hoop
    band = Band(layer.laying.width, layer.laying.thickness, layer.roving, units)
    fibre, resin = band.masses(length)
    if closed is not None:
        figures = pattern_figures(closed, PlainLayer(band, layer.stations, layer.thickness))
        return {**figures, "fibre_length": length, "fibre_mass": fibre, "resin_mass": resin}
    assert hoop is not None
    none: MeanSpread = {"min": 0.0, "mean": 0.0, "max": 0.0}
    return {
        "circuits": 1,
        "shift": 0,
        "turns": round(hoop.turns),
        "pattern_number": 0,
        "leading": False,
        "filaments": 1,
        "words": f"a hoop of {hoop.turns:.1f} turns, {layer.circuits} passes",
        "revolutions": {"asked": hoop.turns, "wound": hoop.turns},
        "dwell": {"start": none, "end": none},
        "angle": angle_figures(layer.stations),
        "turnarounds": [],
        "cover": cover_figures(layer.stations),
        "thickness": thickness_figures(layer.thickness),
        "fibre_length": length,
        "fibre_mass": fibre,
        "resin_mass": resin,
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
