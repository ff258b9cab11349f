"""Figures of a layer by station, and their extremes: winding angle, cover, thickness."""

import numpy as np

from meshwind.filament.stations import Stations
from meshwind.filament.thickness import Thickness
from meshwind.results.pattern_types import CoverFigures, Spread
from meshwind.results.report_types import StationFigures

_SHOWN = 8
"""Steps from rim to rim of the stations in the report; laminate.csv has eight times as many."""


def thickness_figures(over: Thickness) -> Spread:
    """Least, median and largest thickness over the part."""
    return {"min": over.min, "median": over.median, "max": over.max}


def angle_figures(at: Stations) -> Spread:
    """Least, median and largest of the median winding angles by station, in degrees."""
    least, median, most = np.degrees(at.angles)
    return {"min": float(least), "median": float(median), "max": float(most)}


def cover_figures(at: Stations) -> CoverFigures:
    """Least and largest cover factor by station."""
    least, most = at.covers
    return {"min": least, "max": most}


def station_figures(at: Stations) -> list[StationFigures]:
    """Winding angle and cover at a few stations where fibres are."""
    spread = np.degrees(np.stack([at.least, at.angle, at.most]))
    shown = np.arange(0, len(at.v), max((len(at.v) - 1) // _SHOWN, 1))
    return [
        {
            "v": float(at.v[k]),
            "z": float(at.height[k]),
            "angle": {"min": float(spread[0, k]), "median": float(spread[1, k]), "max": float(spread[2, k])},
            "cover": float(at.cover[k]),
        }
        for k in shown
        if np.isfinite(at.angle[k])
    ]
