"""Areas and speeds of the flattened triangles: what the chart and the fit both measure."""

import numpy as np

from meshwind.cast import Floats
from meshwind.mandrel.annulus import Annulus


def signed_areas(corner_uv: Floats) -> Floats:
    """Area (m,) of each triangle in the plane from its corners (m, 3, 2); negative where it is flipped."""
    a, b = corner_uv[:, 1] - corner_uv[:, 0], corner_uv[:, 2] - corner_uv[:, 0]
    return np.asarray((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2)


def speeds(annulus: Annulus, corner_uv: Floats) -> tuple[Floats, Floats, Floats]:
    """Each triangle's signed area in the plane and its speeds |s_u| and |s_v| on the part, (m,) each."""
    P = annulus.vertices[annulus.faces]
    (a, b), (p, q) = ((x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]) for x in (corner_uv, P))
    area = signed_areas(corner_uv)
    s_u = (b[:, 1:] * p - a[:, 1:] * q) / (2 * area[:, None])
    s_v = (a[:, :1] * q - b[:, :1] * p) / (2 * area[:, None])
    return area, np.linalg.norm(s_u, axis=1), np.linalg.norm(s_v, axis=1)
