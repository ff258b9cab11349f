"""The fibres in the page for a browser: their particles, and the figures of each."""

from typing import TypedDict

import numpy as np

from meshwind.core.cast import Bools, Floats
from meshwind.exporting.packing import Packed, packed, packed_short
from meshwind.path.lengths import bridges, bridging, lengths
from meshwind.path.paths import Paths, Status
from meshwind.path.winding_angle import winding_angle
from meshwind.results.reading import Results

_MOST = 60_000
"""Particles in the page, about: each takes 40 bytes of it; they are drawn smoothly without a graphics card."""
_AS_MANY, _LEAST = 4, 3
"""Particles that take as much as the figures of a fibre, and how many of each fibre are in the page at least."""
_DIGITS = 7


class FigureData(TypedDict):
    """Figures of one fibre, lengths in the mesh's units, angles in degrees.

    length: of the fibre, not of the polyline through its particles; length_error: what it may be off by; angle: the
    least, the median and the largest winding angle; slip: largest required friction; bridges: their number; bridged:
    their length; gap: the largest.  None where a figure is not known.
    """

    family: int
    status: int
    length: float | None
    length_error: float | None
    angle: list[float | None]
    slip: float | None
    bridges: int
    bridged: float | None
    gap: float | None


class FibreData(TypedDict):
    """Fibres with their particles one after the other, n in all.

    sizes: number of particles of each fibre; step: every so manyth is in the page, and all next to where a fibre leaves
    the surface; points (3, n); uv (2, n); gap, slip, angle (n,) as of the paths, angle in degrees; off (n,): whether
    the particle counts as off the surface; statuses: what each status means.
    """

    sizes: Packed
    step: int
    points: Packed
    uv: Packed
    gap: Packed
    slip: Packed
    angle: Packed
    off: Packed
    figures: list[FigureData]
    statuses: dict[int, str]
    friction: float


def fibre_data(results: Results, most: int = _MOST) -> FibreData:
    """The fibres of a run, thinned so that they take about as much as `most` particles with few fibres."""
    paths = results.paths
    off = bridging(paths)
    step = max(-(-paths.gap.size // max(most - _AS_MANY * len(paths), _LEAST * len(paths), 1)), 1)
    kept = _kept(off, step)
    angle = np.degrees(winding_angle(paths))
    return {
        "sizes": packed(kept.sum(axis=1)),
        "step": step,
        "points": packed(paths.points[kept].T),
        "uv": packed(paths.uv[kept].T),
        "gap": packed_short(paths.gap[kept]),
        "slip": packed_short(_shown(paths.slip[kept])),
        "angle": packed(angle[kept]),
        "off": packed(off[kept].astype(np.int64)),
        "figures": _figures(paths, angle),
        "statuses": {int(status): status.meaning for status in Status},
        "friction": float(paths.friction),
    }


def _shown(slip: Floats) -> Floats:
    """Required friction without what is rounding alone."""
    return np.asarray(np.where(slip < 1e-6, 0.0, slip))


def _kept(off: Bools, step: int) -> Bools:
    """Which particles (p, n) are in the page: every `step`-th, the last, and both at each change of off (p, n)."""
    kept = np.zeros(off.shape, dtype=bool)
    kept[:, ::step] = True
    kept[:, -1] = True
    changes = off[:, 1:] != off[:, :-1]
    kept[:, 1:] |= changes
    kept[:, :-1] |= changes
    return kept


def _figures(paths: Paths, angle: Floats) -> list[FigureData]:
    each, spans = lengths(paths), bridges(paths)
    count = np.bincount(spans.path[spans.resolved], minlength=len(paths))
    spread = np.stack([angle.min(axis=1), np.median(angle, axis=1), angle.max(axis=1)], axis=1)
    return [
        {
            "family": int(paths.family[k]),
            "status": int(paths.status[k]),
            "length": _short(paths.length[k]),
            "length_error": _short(paths.length_error[k]),
            "angle": [_short(value) for value in spread[k]],
            "slip": _short(each.max_slip[k]),
            "bridges": int(count[k]),
            "bridged": _short(each.bridged_length[k]),
            "gap": _short(each.max_gap[k]),
        }
        for k in range(len(paths))
    ]


def _short(value: float) -> float | None:
    """A figure with the digits that the page shows, None where it is not known."""
    return float(f"{value:.{_DIGITS}g}") if np.isfinite(value) else None
