"""Turn u to a place that the part itself gives, so that the chart does not depend on the order of the vertices."""

import igl
import numpy as np

from meshwind.core.cast import Floats
from meshwind.mesh.geometry.annulus import Annulus

CLEAR = 1e-9
"""A Fourier coefficient below this share of the whole is round-off: the part is symmetric in that order."""
ORDERS = 64


def canonical(annulus: Annulus, uv: Floats, corner: Floats) -> tuple[Floats, Floats]:
    """Return uv and corner_uv with u = 0 where the part reaches furthest from its middle, on the whole.

    That is the phase of the lowest Fourier coefficient over u that stands out of round-off: for area times squared
    distance from the centroid.  Moving, scaling, mirroring and re-ordering the mesh leave the place alone; where a
    part is n-fold symmetric, one of n equal places is taken.
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
