"""Re-space v so that the mean speed along the part is constant."""

import numpy as np
from scipy.interpolate import PchipInterpolator, make_lsq_spline

from meshwind.chart.measure import signed_areas, speeds
from meshwind.core.cast import Floats
from meshwind.mesh.geometry.annulus import Annulus

BINS = 96
PIECES = 12
"""Polynomial pieces of the smooth law for log(speed): few, so that the law is smoother than any surface fit."""


def even_speed(annulus: Annulus, uv: Floats, corner: Floats) -> tuple[Floats, Floats]:
    """Return uv and corner_uv with v passed through a smooth growing law that evens out the mean speed |s_v|.

    Blends back towards the identity if a triangle would flip.
    """
    area, _, speed = speeds(annulus, corner)
    law = _law(corner[..., 1].mean(axis=1), speed, area)
    for share in (1.0, 0.75, 0.5, 0.25):
        out = [_apply(array, law, share) for array in (uv, corner)]
        if signed_areas(out[1]).min() > 0:
            return out[0], out[1]
    return uv, corner


def _apply(array: Floats, law: PchipInterpolator, share: float) -> Floats:
    out = array.copy()
    out[..., 1] = np.clip((1 - share) * array[..., 1] + share * law(array[..., 1]), 0.0, 1.0)
    return out


def _law(v: Floats, speed: Floats, area: Floats) -> PchipInterpolator:
    """The growing map [0, 1] -> [0, 1] whose derivative is proportional to the mean speed at v."""
    bins = np.minimum((v * BINS).astype(int), BINS - 1)
    weight = np.bincount(bins, area, BINS)
    filled = weight > 0
    mean = np.bincount(bins, area * speed, BINS)[filled] / weight[filled]
    middle = (np.arange(BINS)[filled] + 0.5) / BINS
    pieces = max(1, min(PIECES, filled.sum() // 4 - 3))
    fine = np.linspace(0, 1, 2001)
    if filled.sum() < 8:
        return PchipInterpolator(fine, fine)
    knots = np.r_[np.full(4, 0.0), np.quantile(middle, np.arange(1, pieces) / pieces), np.full(4, 1.0)]
    smooth = make_lsq_spline(middle, np.log(mean), knots, k=3)
    rate = np.exp(np.clip(smooth(np.clip(fine, middle[0], middle[-1])), np.log(mean).min(), np.log(mean).max()))
    total = np.r_[0.0, np.cumsum(0.5 * (rate[1:] + rate[:-1]))]
    return PchipInterpolator(fine, total / total[-1])
