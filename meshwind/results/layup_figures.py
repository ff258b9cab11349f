"""Figures of the layup for report.json: crossings, coverage, spacing, windability, quads, fibre, revolutions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.filament.plain_layer import PlainLayer
from meshwind.layup.crossings import Crossings, counts
from meshwind.layup.layup import Layup
from meshwind.layup.windability import CONCAVE, CONVEX, SADDLE, Windability
from meshwind.results.pattern_types import Spread
from meshwind.results.report_types import (
    CoverageFigures,
    CrossingFigures,
    FibreFigures,
    QuadFigures,
    RevolutionFigures,
    SpacingFigures,
    WindabilityFigures,
)
from meshwind.results.station_figures import angle_figures, cover_figures, thickness_figures

if TYPE_CHECKING:
    from meshwind.planning.revolutions import Revolutions
    from meshwind.planning.spacing import Spaced

REGIONS = (4, 8)
"""Number of equal parts of u and of v in which crossings are counted."""


def spread_figures(values: Floats) -> Spread:
    """Minimum, median and maximum; None if there are no values."""
    if not len(values):
        return {"min": None, "median": None, "max": None}
    return {"min": float(values.min()), "median": float(np.median(values)), "max": float(values.max())}


def crossing_figures(crossings: Crossings, own: int) -> CrossingFigures:
    """Angles in degrees, quality as |cos|, counts by region; own: crossings of fibres of the same family."""
    return {
        "count": len(crossings),
        "angle": spread_figures(np.degrees(crossings.angle)),
        "quality": spread_figures(np.abs(np.cos(crossings.angle))),
        "off_surface": int((~crossings.on_surface).sum()),
        "own_family": own,
        "by_region": counts(crossings, *REGIONS).tolist(),
    }


def coverage_figures(layup: Layup) -> CoverageFigures:
    """Layers on cells one pitch wide, and shares of the area under no, one, two and more bands."""
    bands, cover = layup.bands, layup.coverage
    return {
        "min": cover.min,
        "median": cover.median,
        "max": cover.max,
        "band_width": cover.width,
        "cells": list(cover.layers.shape),
        "bare": bands.bare,
        "once": bands.share(1),
        "twice": bands.share(2),
        "more": bands.more,
        "most_layers": int(bands.layers.max(initial=0)),
        "on_part": bands.balance,
        "bare_caps": list(bands.caps),
    }


def spacing_figures(layup: Layup, spaced: Spaced | None) -> SpacingFigures:
    """Distances between neighbours and between crossings; the gap and overlap that the band's width leaves."""
    near, width = layup.neighbours, layup.coverage.width
    largest = near.largest
    figures: SpacingFigures = {
        "neighbours": spread_figures(largest),
        "d1": spread_figures(layup.sides.d1),
        "d2": spread_figures(layup.sides.d2),
        "widest_gap": max(float(largest.max(initial=width)) - width, 0.0),
        "neighbours_apart": float((largest > width).mean()) if len(largest) else None,
        "partings": parted(layup, spaced).tolist(),
        "widest_parting": float(largest[layup.partings].max(initial=0.0)) if spaced is None else spaced.widest,
        "kept": float(largest[~layup.partings].max(initial=0.0)) if spaced is None else spaced.gap,
    }
    if spaced is not None:
        figures["asked"] = spaced.spacing
        figures["paths_added"] = len(spaced.paths) - 2 * spaced.even
    return figures


def parted(layup: Layup, spaced: Spaced | None) -> Ints:
    """Pairs (k, 2) of neighbours that part round a body: those that spacing them has found, if it was asked for."""
    if spaced is not None:
        return spaced.partings
    near = layup.neighbours
    return np.stack([near.first, near.second], axis=1)[layup.partings]


def windability_figures(press: Windability) -> WindabilityFigures:
    """Shares of the area by class, and share of the directions in which a fibre presses."""
    share = float((press.share * press.weight).sum())
    return {
        "convex": press.area(CONVEX),
        "saddle": press.area(SADDLE),
        "concave": press.area(CONCAVE),
        "untouchable": press.untouchable,
        "directions": share,
    }


def quad_figures(layup: Layup) -> QuadFigures:
    """Counts and quality of the quad mesh."""
    mesh, quality = layup.quads, layup.quality
    return {
        "faces": len(mesh.quads) + len(mesh.triangles),
        "quads": len(mesh.quads),
        "triangles": len(mesh.triangles),
        "convex_inner": quality.convex_share,
        "scaled_jacobian": spread_figures(quality.jacobian),
        "aspect": spread_figures(quality.aspect),
        "warp": spread_figures(quality.warp),
        "off_surface_points": int((~mesh.on_surface).sum()),
        "left_out": list(mesh.left_out),
        "of": "windings as asked for" if layup.initial else "paths",
        "note": mesh.note,
    }


def fibre_figures(layup: Layup, plain: PlainLayer) -> FibreFigures:
    """The fibres on the part as a layer, as far as its band is known."""
    length, at = float(layup.paths.length.sum()), plain.stations
    fibre, resin = plain.band.masses(length)
    return {
        "length": length,
        "fibre_mass": fibre,
        "resin_mass": resin,
        "band_thickness": plain.band.thickness,
        "thickness": None if plain.thickness is None else thickness_figures(plain.thickness),
        "angle": None if at is None else angle_figures(at),
        "cover": None if at is None else cover_figures(at),
    }


def revolution_figures(chosen: Revolutions) -> RevolutionFigures:
    """The choice of revolutions and its reasons; a bound is None if there is none."""
    from meshwind.planning.alternatives import FRICTION, WIDER  # late: most runs choose no revolutions

    found = chosen.feasible
    return {
        "chosen": chosen.choice,
        "why": chosen.why,
        "bridged_fraction": chosen.chosen.bridged_share,
        "pressing": {"intervals": [list(each) for each in chosen.common], "share": chosen.common_share},
        "holding": {"low": found.low, "high": found.high, "by": found.by, "slides_off": found.slides},
        "square": chosen.square,
        "further": {
            "friction": FRICTION,
            "with_friction": chosen.with_friction or None,
            "opening": WIDER,
            "with_opening": chosen.with_opening or None,
        },
        "trials": [[each.revolutions, each.converged, each.bridged_share] for each in chosen.trials],
    }
