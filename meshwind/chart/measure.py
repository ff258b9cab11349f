"""Areas and speeds of the flattened triangles: what the chart and the fit both measure."""

import numpy as np
from numba import njit

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.mesh.geometry.annulus import Annulus


def signed_areas(corner_uv: Floats) -> Floats:
    """Area (m,) of each triangle in the plane from its corners (m, 3, 2); negative where it is flipped."""
    a, b = corner_uv[:, 1] - corner_uv[:, 0], corner_uv[:, 2] - corner_uv[:, 0]
    return np.asarray((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2)


def speeds(annulus: Annulus, corner_uv: Floats) -> tuple[Floats, Floats, Floats]:
    """Each triangle's signed area in the plane and its speeds |s_u| and |s_v| on the part, (m,) each."""
    area, s_u, s_v = _speeds(annulus.vertices, annulus.faces, frozen(corner_uv))
    return area, s_u, s_v


@njit(nogil=True, cache=True, error_model="numpy")
def _speeds(vertices: Floats, faces: Ints, corner_uv: Floats) -> tuple[Floats, Floats, Floats]:
    """A tenth of the time of whole arrays: flattening and fitting measure every triangle several times."""
    area, s_u, s_v = np.empty(len(faces)), np.empty(len(faces)), np.empty(len(faces))
    for m in range(len(faces)):
        i, j, k = faces[m, 0], faces[m, 1], faces[m, 2]
        a0, a1 = corner_uv[m, 1, 0] - corner_uv[m, 0, 0], corner_uv[m, 1, 1] - corner_uv[m, 0, 1]
        b0, b1 = corner_uv[m, 2, 0] - corner_uv[m, 0, 0], corner_uv[m, 2, 1] - corner_uv[m, 0, 1]
        double = a0 * b1 - a1 * b0
        u = v = 0.0
        for d in range(3):
            p, q = vertices[j, d] - vertices[i, d], vertices[k, d] - vertices[i, d]
            u += (b1 * p - a1 * q) ** 2
            v += (a0 * q - b0 * p) ** 2
        area[m] = double / 2
        s_u[m], s_v[m] = np.sqrt(u) / abs(double), np.sqrt(v) / abs(double)
    return area, s_u, s_v
