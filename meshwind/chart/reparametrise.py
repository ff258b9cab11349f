"""Reparametrise a chart: v to constant mean speed along the part, u from a position that the part itself gives."""

import igl
import numpy as np
from scipy.interpolate import PchipInterpolator, make_lsq_spline

from meshwind.chart.chart import signed_areas, speeds
from meshwind.core.cast import Floats
from meshwind.mesh.geometry.mesh import Annulus

BINS = 96
"""Bands of v over which the speed is averaged."""
PIECES = 12
"""Polynomial pieces of the smooth function for log(speed): few, so that it is smoother than any fitted surface."""
CLEAR = 1e-9
"""A Fourier coefficient below this share of the whole is round-off: the part is symmetric in that order."""
ORDERS = 64
"""Number of Fourier coefficients that are tried."""


def even_speed(annulus: Annulus, uv: Floats, corner: Floats) -> tuple[Floats, Floats]:
    """Return uv and corner_uv with v replaced by a smooth, increasing function of v of constant mean speed |s_v|.

    The function is blended with the identity if a triangle would flip otherwise.
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
    """The increasing map [0, 1] -> [0, 1] whose derivative is proportional to the mean speed at v."""
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


def canonical_u(annulus: Annulus, uv: Floats, corner: Floats) -> tuple[Floats, Floats]:
    """Return uv and corner_uv, shifted in u so that u = 0 is where the part extends furthest from its centroid.

    The shift is the phase of the first Fourier coefficient over u, of area times squared distance from the centroid,
    that is above round-off.  It does not depend on the position, scale, handedness and numbering of the mesh; if a
    part is n-fold symmetric, one of n equal positions is taken.
    """
    area = np.asarray(igl.massmatrix(annulus.vertices, annulus.faces).diagonal())
    middle = np.average(annulus.vertices, axis=0, weights=area)
    reach = area * ((annulus.vertices - middle) ** 2).sum(axis=1)
    for order in range(1, ORDERS + 1):
        wave = (reach * np.exp(2j * np.pi * order * uv[:, 0])).sum() / reach.sum()
        if abs(wave) > CLEAR:
            shift = float(np.angle(wave)) / (2 * np.pi * order)
            break
    else:
        return uv, corner
    return uv - [shift, 0.0], corner - [shift, 0.0]
