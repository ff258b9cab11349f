"""What would make more revolutions feasible: more friction, or wider openings."""

from dataclasses import replace

import numpy as np

from meshwind.core.cast import Floats
from meshwind.path.friction import friction_of
from meshwind.planning.feasible import Feasible, coarse_interval
from meshwind.planning.windings import Windings, few, rougher
from meshwind.surface.evaluate import SU
from meshwind.surface.grid import rings
from meshwind.surface.interpolate import interpolate
from meshwind.surface.surface import Surface

FRICTION, WIDER = 0.2, 1.5
"""The alternatives: this coefficient of friction (a wet fibre's), and openings so many times as wide."""
_FEW = 3
"""Paths per family in the coarse windings of these."""
_MAX_GAIN = 3.0
"""Times the bound up to which numbers of revolutions are tried with friction."""
_RETREAT = 1.0, 0.5
"""Shares of the way from the bound to the number found, at which other paths are tried."""
_EVERY = 2
"""Every so many of those other paths are tried: those between the few that the number was found by."""
_STEP = 0.1
"""Step to the first of these numbers, over the bound."""
_RINGS, _AROUND = 201, 48
"""Rings by which the place of a wider opening is found, and points on each."""
_SHORTEST = 0.05
"""Least length of a cut-back surface in v: a shorter one is no part any more."""


def alternatives(windings: Windings, feasible: Feasible, most: float) -> tuple[float, float]:
    """About the feasible revolutions with more friction, and with wider openings; 0 where they gain nothing.

    Both are tried by few, coarse paths, those with wider openings on the surface cut back: to wind all paths as asked
    with friction would cost many times what the choice does.
    """
    surface = windings.surface
    with_friction = 0.0
    if friction_of(surface, windings.friction).largest < FRICTION:
        with_friction = _with_friction(windings, feasible.high, min(most, _MAX_GAIN * feasible.high))
    wider = with_wider_openings(surface, WIDER, feasible.slides or "both")
    high = 0.0 if wider is None else coarse_interval(wider, windings.friction, most, _FEW, slides=False).high
    return with_friction, high if high > feasible.high else 0.0


def _with_friction(windings: Windings, high: float, most: float) -> float:
    """Largest feasible revolutions with friction, 0 where none are known: found by few paths, and tried by others."""
    first = (1.0 + _STEP) * high
    best = few(windings, FRICTION).limit(most, first, high) if most > first else 0.0
    others = rougher(windings, FRICTION)
    tries = (high + share * (best - high) for share in _RETREAT if best > high)
    return next((number for number in tries if others.holds_some(number, 1, _EVERY)), 0.0)


def with_wider_openings(surface: Surface, wider: float, ends: str = "both") -> Surface | None:
    """The surface cut back to where its rings are `wider` times as long as its rims, at the ends named.

    None where it never widens so far.
    """
    v = np.linspace(0.0, 1.0, _RINGS)
    ring = np.linalg.norm(rings(surface, v, _AROUND)[:, :, SU], axis=2).mean(axis=1)
    first = _widens(v, ring, wider) if ends in ("start", "both") else 0.0
    last = 1.0 - _widens(v, ring[::-1], wider) if ends in ("end", "both") else 1.0
    if not first < last - _SHORTEST:
        return None

    def formula(around: Floats, along: Floats) -> Floats:
        where = np.stack([around, first + (last - first) * along], axis=-1)
        return surface.points(where.reshape(-1, 2)).reshape(*where.shape[:-1], 3)

    cut = interpolate(formula, surface.spans, surface.periodic)
    return replace(cut, error=surface.error)


def _widens(v: Floats, ring: Floats, wider: float) -> float:
    """The first v at which the ring is so many times the rim's length; 1 where none is."""
    wide = np.flatnonzero(ring >= wider * ring[0])
    if not len(wide):
        return 1.0
    k = int(wide[0])
    share = (wider * ring[0] - ring[k - 1]) / (ring[k] - ring[k - 1])
    return float(v[k - 1] + share * (v[k] - v[k - 1]))
